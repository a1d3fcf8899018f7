// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/displacement_conditions.h>
#include <perideal/operators/solid/traction_layer.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The columns of a lattice behind one side of a box, numbered across the side. */
    template <int dim>
    class Columns
    {
    public:
      Columns(const Lattice<dim> &lattice, const types::boundary_id side)
        : lattice(lattice)
        , axis(side / 2)
        , at_upper(side % 2 == 1)
      {
        for (unsigned int d = 0; d < dim; ++d)
          if (d != axis)
            count *= lattice.n_sites[d];
      }

      std::size_t size() const
      {
        return count;
      }

      std::size_t column_of(const Point<dim> &p) const
      {
        const typename Lattice<dim>::Index site   = lattice.index(p);
        std::size_t                        column = 0;
        for (unsigned int d = dim; d-- > 0;)
          if (d != axis)
            column = column * lattice.n_sites[d] + site[d];
        return column;
      }

      /** The part of a node's cell that lies in the layer. */
      double part_of(const Point<dim> &p, const double depth) const
      {
        const double half     = 0.5 * lattice.spacing[axis],
                     width    = lattice.upper[axis] - lattice.lower[axis],
                     distance = at_upper ? lattice.upper[axis] - p[axis] :
                                           p[axis] - lattice.lower[axis];
        return part_within(std::max(0., distance - half), std::min(width, distance + half), depth);
      }

      /** How many sites lie between a node and the side. */
      unsigned int row_of(const Point<dim> &p) const
      {
        const int k = lattice.index(p)[axis];
        return at_upper ? lattice.n_sites[axis] - 1 - k : k;
      }

      /** Sites of a column that may have a part within the depth. */
      unsigned int n_rows(const double depth) const
      {
        const double reach = std::ceil(depth / lattice.spacing[axis]) + 1.;
        return static_cast<unsigned int>(std::min<double>(lattice.n_sites[axis], reach));
      }

      /** The place of the column's node on the side. */
      Point<dim> outermost(const Point<dim> &p) const
      {
        typename Lattice<dim>::Index site = lattice.index(p);
        site[axis]                        = at_upper ? lattice.n_sites[axis] - 1 : 0;
        return lattice.position(site);
      }

    private:
      const Lattice<dim> &lattice;
      const unsigned int  axis;
      const bool          at_upper;
      std::size_t         count = 1;
    };


    template <int dim>
    void spread(const Nodes<dim>                &nodes,
                const BoundaryConditions<dim>   &conditions,
                const types::boundary_id         side,
                const double                     depth,
                std::vector<TractionShare<dim>> &shares)
    {
      const Columns<dim>  columns(*nodes.lattice(), conditions.side_of(side));
      std::vector<double> areas(columns.size(), 0.), volumes(columns.size(), 0.);
      for (const BoundaryShare &share : nodes.condition_shares())
        if (share.id == side)
          areas[columns.column_of(nodes.position(share.node))] += share.area;
      // A column ends where a node is missing: what lies beyond a hole is not pulled.
      const unsigned int        n_rows = columns.n_rows(depth);
      std::vector<unsigned int> exists(columns.size() * n_rows, 0);
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        if (const unsigned int row = columns.row_of(nodes.position(i)); row < n_rows)
          exists[columns.column_of(nodes.position(i)) * n_rows + row] = 1;
      Utilities::MPI::max(exists, nodes.communicator(), exists);
      const auto is_reached = [&](const Point<dim> &p) {
        const unsigned int row   = columns.row_of(p);
        const auto         first = exists.begin() + columns.column_of(p) * n_rows;
        return row < n_rows && std::find(first, first + row, 0u) == first + row;
      };
      std::vector<double> part(nodes.n_owned(), 0.);
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        if (is_reached(nodes.position(i)))
          {
            part[i] = nodes.volume(i) * columns.part_of(nodes.position(i), depth);
            volumes[columns.column_of(nodes.position(i))] += part[i];
          }
      Utilities::MPI::sum(areas, nodes.communicator(), areas);
      Utilities::MPI::sum(volumes, nodes.communicator(), volumes);
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        {
          const Point<dim> &p      = nodes.position(i);
          const std::size_t column = columns.column_of(p);
          if (part[i] > 0. && areas[column] > 0.)
            shares.push_back(
              {i, side, areas[column] * part[i] / volumes[column], columns.outermost(p)});
        }
    }
  } // namespace


  double part_within(const double lower, const double upper, const double depth)
  {
    return std::max(0., std::min(upper, depth) - lower) / (upper - lower);
  }


  template <int dim>
  void require_traction_layer(const BodyParameters<dim> &body)
  {
    const BoundaryConditions<dim> &conditions = body.boundary_conditions;
    const double                   depth      = conditions.traction_layer;
    if (depth <= 0.)
      return;
    conditions.refuse(
      !body.domain.has_lattice(),
      "Traction layer",
      "needs nodes in rows along the side, which 'Shape = mesh file' in section 'Domain' does not have. Leave it empty.");
    require_layer(body, conditions.traction, "Traction", depth);
    for (const VectorCondition &condition : conditions.traction)
      conditions.refuse(
        body.cracks.distance_to_side(conditions.side_of(condition.id)) < depth,
        "Traction layer",
        "a crack lies within it at the side '" + condition.name +
          "', and what is behind the crack would be pulled. Leave it empty, or make it thinner.");
  }


  template <int dim>
  std::vector<TractionShare<dim>> traction_shares(const Nodes<dim>              &nodes,
                                                  const BoundaryConditions<dim> &conditions)
  {
    std::vector<TractionShare<dim>> shares;
    for (const VectorCondition &condition : conditions.traction)
      if (conditions.traction_layer > 0.)
        {
          Assert(nodes.lattice() && conditions.side_of(condition.id) < 2 * dim,
                 ExcInternalError()); // the scene was checked
          spread(nodes, conditions, condition.id, conditions.traction_layer, shares);
        }
      else
        for (const BoundaryShare &share : nodes.condition_shares())
          if (share.id == condition.id)
            shares.push_back({share.node, share.id, share.area, nodes.place_of(share)});
    return shares;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(require_traction_layer);
  PERIDEAL_INSTANTIATE_FUNCTION(traction_shares);
} // namespace PeriDeal
