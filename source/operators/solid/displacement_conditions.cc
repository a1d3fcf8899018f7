// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/parts/condition_faces.h>
#include <perideal/operators/solid/displacement_conditions.h>
#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The direction that a side is normal to. Collective. */
    template <int dim>
    unsigned int normal_direction(const std::vector<NodeOnSide<dim>> &nodes,
                                  const types::boundary_id            side,
                                  const BodyParameters<dim>          &body,
                                  const MPI_Comm                      communicator)
    {
      const bool box = body.domain.has_lattice();
      if (box)
        return side / 2;
      // Lowest coordinates and lowest negative ones.
      std::vector<double> ends(2 * dim, std::numeric_limits<double>::max()), all(2 * dim);
      for (const NodeOnSide<dim> &node : nodes)
        if (node.side == side)
          for (unsigned int d = 0; d < dim; ++d)
            {
              ends[d]       = std::min(ends[d], node.position[d]);
              ends[dim + d] = std::min(ends[dim + d], -node.position[d]);
            }
      Utilities::MPI::min(ends, communicator, all);
      double longest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        longest = std::max(longest, -all[dim + d] - all[d]);
      unsigned int found = dim;
      for (unsigned int d = 0; d < dim; ++d)
        if (-all[dim + d] - all[d] <= 1e-9 * longest)
          found = d;
      AssertThrow(found < dim,
                  UserError("'Symmetry' in section 'Boundary conditions': the side '" +
                            body.boundary_conditions.name_of(side) +
                            "' is not normal to an axis."));
      return found;
    }


    /** Nodes in a plane of symmetry are held on a crack that lies in it, too: it would be none. */
    template <int dim>
    void require_uncracked(const BodyParameters<dim> &body, const types::boundary_id side)
    {
      if (!body.domain.has_lattice() || side >= 2 * dim)
        return;
      const unsigned int axis  = side / 2;
      const double       plane = side % 2 == 0 ? body.domain.lower[axis] : body.domain.upper[axis],
                   slack       = 1e-6 * body.domain.spacing()[axis];
      const std::string name   = body.boundary_conditions.name_of(side);
      std::string       held;
      for (unsigned int d = 0; d < dim; ++d)
        held += std::string(d > 0 ? ", " : "") + (d == axis ? "0" : "free");
      for (const CrackPiece<dim> &piece : body.cracks.pieces(body.cracks.end_time))
        body.cracks.refuse(
          std::all_of(piece.corners.begin(),
                      piece.corners.end(),
                      [&](const Point<dim> &p) { return std::abs(p[axis] - plane) <= slack; }),
          dim == 2 ? "Segments" : "Polygons",
          "a crack lies in the plane of 'Symmetry = " + name +
            "' (section 'Boundary conditions'), whose nodes are held: it would have no effect. "
            "Hold there what is whole, without the crack: 'Parts = ligament: " +
            name + " if FORMULA' and 'Displacement = ligament: " + held +
            "' in place of 'Symmetry = " + name +
            "'; or take both halves of the body. 'Models = peridynamics' with 'Nodes = cell centers' "
            "(section 'Domain') and 'Surface correction = auto' (section 'Peridynamics') has no nodes "
            "in that plane, and takes such cracks.");
    }


    /** Whether a place is within `Displacement layer` of a side of the box. */
    template <int dim>
    bool is_in_layer(Point<dim> p, const types::boundary_id id, const BodyParameters<dim> &body)
    {
      const Domain<dim> &domain   = body.domain;
      const auto         side     = body.boundary_conditions.side_of(id);
      const unsigned int axis     = side / 2;
      const double       width    = domain.upper[axis] - domain.lower[axis];
      const double       distance = side % 2 == 0 ? p[axis] - domain.lower[axis] :
                                                    domain.upper[axis] - p[axis];
      p[axis]                     = side % 2 == 0 ? domain.lower[axis] : domain.upper[axis];
      return distance <= body.boundary_conditions.displacement_layer + 1e-9 * width &&
             body.boundary_conditions.holds_at(id, p);
    }
  } // namespace


  template <int dim>
  void require_layer(const BodyParameters<dim>          &body,
                     const std::vector<VectorCondition> &list,
                     const std::string                  &name,
                     const double                        depth)
  {
    const BoundaryConditions<dim> &conditions = body.boundary_conditions;
    for (const VectorCondition &condition : list)
      {
        const types::boundary_id side = conditions.side_of(condition.id);
        conditions.refuse(side >= 2 * dim,
                          name + " layer",
                          "needs flat sides, and '" + name + "' names '" + condition.name +
                            "'. Leave it empty.");
        const double width = body.domain.upper[side / 2] - body.domain.lower[side / 2];
        conditions.refuse(depth > width,
                          name + " layer",
                          "found " + number_text(depth) +
                            ", wider than the body behind the side '" + condition.name + "', " +
                            number_text(width) +
                            (body.domain.has_extra_layers() ? " with its extra layers." : "."));
      }
  }


  template <int dim>
  void DisplacementConditions<dim>::require(const BodyParameters<dim> &body)
  {
    const BoundaryConditions<dim> &conditions = body.boundary_conditions;
    if (conditions.displacement_layer <= 0.)
      return;
    conditions.refuse(
      !body.domain.has_lattice(),
      "Displacement layer",
      "is for the sides of a box, and 'Shape' in section 'Domain' is 'mesh file'. Leave it empty.");
    require_layer(body, conditions.displacement, "Displacement", conditions.displacement_layer);
  }


  template <int dim>
  DisplacementConditions<dim>::DisplacementConditions(const std::vector<NodeOnSide<dim>> &nodes,
                                                      const std::vector<Point<dim>>      &positions,
                                                      const BodyParameters<dim>          &body,
                                                      const bool     at_centers,
                                                      const MPI_Comm communicator)
  {
    const auto                        &conditions = body.boundary_conditions;
    const auto                         beyond     = beyond_sides(body);
    std::map<unsigned int, Prescribed> found;
    std::vector<unsigned long long>    n_nodes(conditions.displacement.size(), 0), n_held(n_nodes);
    const auto require = [&](const types::boundary_id side, const std::string &entry) {
      const bool any = std::any_of(nodes.begin(), nodes.end(), [&](const NodeOnSide<dim> &node) {
        return node.side == side;
      });
      AssertThrow(Utilities::MPI::max(any ? 1 : 0, communicator) > 0,
                  UserError("'" + entry +
                            "' in section 'Boundary conditions': no node lies on the side '" +
                            conditions.name_of(side) + "'."));
    };
    for (std::size_t k = 0; k < conditions.displacement.size(); ++k)
      {
        const VectorCondition &condition = conditions.displacement[k];
        if (conditions.part(condition.id) == nullptr)
          require(condition.id, condition.rate ? "Velocity" : "Displacement");
        for (unsigned int d = 0; d < dim; ++d)
          if (condition.values[d])
            {
              varies          = varies || condition.rate || condition.values[d]->depends_on_time();
              const auto hold = [&](const unsigned int node, const Point<dim> &position) {
                ++n_nodes[k];
                if (condition.holds(d, position))
                  n_held[k] += found
                                 .try_emplace(dim * node + d,
                                              Prescribed{dim * node + d,
                                                         condition.id,
                                                         &*condition.values[d],
                                                         position,
                                                         condition.rate})
                                 .second;
              };
              for (const NodeOnSide<dim> &node : nodes)
                if (node.side == condition.id)
                  hold(node.node, node.position);
              for (unsigned int i = 0; i < positions.size() && conditions.displacement_layer > 0.;
                   ++i)
                if (is_in_layer(positions[i], condition.id, body))
                  hold(i, positions[i]);
            }
      }
    require_held_parts(conditions,
                       conditions.displacement,
                       n_nodes,
                       n_held,
                       "Displacement",
                       communicator);
    for (const types::boundary_id side : conditions.symmetry)
      {
        require(side, "Symmetry");
        if (at_centers && side < 2 * dim && beyond[side] == BeyondSide::mirrored)
          continue; // families go on beyond the side, on which no node lies
        require_uncracked(body, side);
        const unsigned int d = normal_direction(nodes, side, body, communicator);
        for (const NodeOnSide<dim> &node : nodes)
          if (node.side == side)
            found.try_emplace(dim * node.node + d,
                              Prescribed{dim * node.node + d, side, nullptr, node.position});
      }
    for (const auto &[unknown, entry] : found)
      prescribed.push_back(entry);
  }


  template <int dim>
  void DisplacementConditions<dim>::pin(const std::vector<Point<dim>> &positions,
                                        const BodyParameters<dim>     &body,
                                        const bool                     at_centers)
  {
    if (body.domain.islands.pins.empty())
      return;
    const double slack = 1e-6 * body.domain.spacing().norm();
    for (unsigned int node = 0; node < positions.size(); ++node)
      for (const Pin<dim> &pin : body.domain.islands.pins)
        if (pin.at_center == at_centers && pin.position.distance(positions[node]) < slack)
          {
            const unsigned int unknown = dim * node + pin.component;
            if (std::none_of(prescribed.begin(), prescribed.end(), [&](const Prescribed &entry) {
                  return entry.unknown == unknown;
                }))
              prescribed.push_back(
                {unknown, numbers::internal_face_boundary_id, nullptr, positions[node]});
          }
  }


  template <int dim>
  void DisplacementConditions<dim>::let_follow(std::vector<unsigned int> unknowns)
  {
    following = std::move(unknowns);
    prescribed.erase(
      std::remove_if(prescribed.begin(),
                     prescribed.end(),
                     [&](const Prescribed &entry) {
                       return std::binary_search(following.begin(), following.end(), entry.unknown);
                     }),
      prescribed.end());
  }


  template <int dim>
  void DisplacementConditions<dim>::distribute(Vector &u, const double t, const double factor) const
  {
    for (const Prescribed &entry : prescribed)
      u.local_element(entry.unknown) =
        entry.value == nullptr ?
          0. :
          factor * (entry.rate ? moved(entry, t) : entry.value->value(entry.position, t));
  }


  template <int dim>
  double DisplacementConditions<dim>::moved(const Prescribed &entry, const double t) const
  {
    if (t < entry.time) // another beginning
      entry.time = entry.way = 0.;
    entry.way += integral_over_time(*entry.value, entry.position, entry.time, t);
    entry.time = t;
    return entry.way;
  }


  template <int dim>
  void DisplacementConditions<dim>::mask(Vector &y, const double value) const
  {
    for (const Prescribed &entry : prescribed)
      y.local_element(entry.unknown) = value;
    for (const unsigned int unknown : following)
      y.local_element(unknown) = value;
  }


  template <int dim>
  void DisplacementConditions<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    KeyedPairs pairs; // a node and a component
    for (const Prescribed &entry : prescribed)
      if (entry.rate && !archive.loads())
        {
          pairs.keys.push_back({keys[entry.unknown / dim], entry.unknown % dim});
          pairs.values.insert(pairs.values.end(), {entry.time, entry.way});
        }
    archive.exchange("prescribed velocities", pairs, keys);
    if (!archive.loads())
      return;
    std::map<KeyedPairs::Key, std::size_t> found;
    for (std::size_t k = 0; k < pairs.keys.size(); ++k)
      found[pairs.keys[k]] = k;
    for (Prescribed &entry : prescribed)
      if (entry.rate)
        {
          const std::size_t k = found.at({keys[entry.unknown / dim], entry.unknown % dim});
          entry.time          = pairs.values[2 * k];
          entry.way           = pairs.values[2 * k + 1];
        }
  }


  template <int dim>
  void DisplacementConditions<dim>::add_reactions(
    const Vector                                 &v,
    std::map<types::boundary_id, Tensor<1, dim>> &forces) const
  {
    for (const Prescribed &entry : prescribed)
      forces[entry.side][entry.unknown % dim] += v.local_element(entry.unknown);
  }


  template <int dim>
  ForceBalance gather_forces(const std::map<types::boundary_id, Tensor<1, dim>> &forces,
                             const BodyParameters<dim>                          &body,
                             const MPI_Comm                                      communicator)
  {
    const auto                     &conditions = body.boundary_conditions;
    std::vector<types::boundary_id> sides      = conditions.symmetry;
    for (const auto *const list : {&conditions.displacement, &conditions.traction})
      for (const VectorCondition &condition : *list)
        sides.push_back(condition.id);
    ForceBalance result;
    const auto   total = [&](const types::boundary_id side) {
      const auto           found = forces.find(side);
      const Tensor<1, dim> own   = found == forces.end() ? Tensor<1, dim>() : found->second;
      const Tensor<1, dim> sum   = Utilities::MPI::sum(own, communicator);
      return std::vector<double>(sum.begin_raw(), sum.end_raw());
    };
    result.body = total(numbers::internal_face_boundary_id);
    for (const types::boundary_id side : sides)
      if (const std::string name = conditions.name_of(side); result.sides.count(name) == 0)
        result.sides[name] = total(side);
    return result;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(require_layer);
  PERIDEAL_INSTANTIATE_CLASS(class DisplacementConditions);
  PERIDEAL_INSTANTIATE_FUNCTION(gather_forces);
} // namespace PeriDeal
