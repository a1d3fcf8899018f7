// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/held_rows.h>
#include <perideal/scene/held_sides.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The node that one on a side follows, or an invalid number: none, or none is there. */
    template <int dim>
    unsigned int node_behind(const Families<dim>             &families,
                             const std::array<bool, 2 * dim> &sides,
                             const unsigned int               node,
                             const types::boundary_id         side)
    {
      const Nodes<dim> &nodes = families.nodes();
      if (side >= 2 * dim || !sides[side] || !nodes.lattice())
        return numbers::invalid_unsigned_int;
      auto site = nodes.lattice()->index(nodes.position(node));
      site[side / 2] += side % 2 == 0 ? 1 : -1;
      return families.neighbors().node_at(site);
    }
  } // namespace


  template <int dim>
  std::vector<NodeOnSide<dim>> HeldRows<dim>::nodes_on_sides(const Families<dim>       &families,
                                                             const BodyParameters<dim> &body)
  {
    const Nodes<dim>            &nodes = families.nodes();
    const auto                   sides = sides_held_themselves(body);
    std::vector<NodeOnSide<dim>> list;
    for (const BoundaryShare &share : nodes.condition_shares())
      if (share.inside)
        {
          const types::boundary_id side  = body.boundary_conditions.side_of(share.id);
          Point<dim>               place = nodes.position(share.node);
          if (node_behind(families, sides, share.node, side) != numbers::invalid_unsigned_int)
            place[side / 2] = (side % 2 == 0 ? body.domain.lower : body.domain.upper)[side / 2];
          list.push_back({share.node, share.id, place});
        }
    return list;
  }


  template <int dim>
  HeldRows<dim>::HeldRows(const Families<dim>                &families,
                          const std::vector<NodeOnSide<dim>> &on_sides,
                          const BodyParameters<dim>          &body,
                          const Layout                       &layout)
  {
    // As DisplacementConditions: the side named first holds.
    const auto                           sides = sides_held_themselves(body);
    std::map<unsigned int, unsigned int> node_of;
    for (const VectorCondition &condition : body.boundary_conditions.displacement)
      for (unsigned int d = 0; d < dim; ++d)
        for (const NodeOnSide<dim> &node : on_sides)
          if (condition.values[d] && node.side == condition.id && condition.holds(d, node.position))
            node_of.try_emplace(dim * node.node + d,
                                node_behind(families,
                                            sides,
                                            node.node,
                                            body.boundary_conditions.side_of(condition.id)));
    std::vector<Row> rows;
    for (const auto &[unknown, behind] : node_of)
      if (behind != numbers::invalid_unsigned_int)
        rows.push_back({unknown, dim * behind + unknown % dim});
    on_any_process = Utilities::MPI::max(rows.empty() ? 0 : 1, layout->get_mpi_communicator()) > 0;
    if (on_any_process)
      find_levels(rows, layout);
  }


  template <int dim>
  void HeldRows<dim>::find_levels(const std::vector<Row> &rows, const Layout &layout)
  {
    // Each step of a chain of rows is along another axis.
    Vector depth(layout);
    for (const Row &row : rows)
      depth.local_element(row.unknown) = 1.;
    for (unsigned int step = 1; step < dim; ++step)
      {
        std::vector<double> next;
        depth.update_ghost_values();
        for (const Row &row : rows)
          next.push_back(depth.local_element(row.behind) + 1.);
        depth.set_ghost_state(false);
        for (std::size_t k = 0; k < rows.size(); ++k)
          depth.local_element(rows[k].unknown) = next[k];
      }
    const bool any_ghost = std::any_of(rows.begin(), rows.end(), [&](const Row &row) {
      return row.behind >= layout->locally_owned_size();
    });
    has_ghosts = Utilities::MPI::max(any_ghost ? 1 : 0, layout->get_mpi_communicator()) > 0;
    levels.resize(static_cast<unsigned int>(depth.linfty_norm()));
    for (const Row &row : rows)
      levels[static_cast<unsigned int>(depth.local_element(row.unknown)) - 1].push_back(row);
  }


  template <int dim>
  void HeldRows<dim>::follow(Vector &u) const
  {
    for (const std::vector<Row> &level : levels)
      {
        if (has_ghosts)
          u.update_ghost_values();
        for (const Row &row : level)
          u.local_element(row.unknown) =
            (2. * u.local_element(row.unknown) + u.local_element(row.behind)) / 3.;
        u.set_ghost_state(false);
      }
  }


  template <int dim>
  void HeldRows<dim>::pass_on(Vector &forces, const double share) const
  {
    for (auto level = levels.rbegin(); level != levels.rend(); ++level)
      {
        if (has_ghosts)
          forces.zero_out_ghost_values();
        for (const Row &row : *level)
          forces.local_element(row.behind) += share * forces.local_element(row.unknown);
        if (has_ghosts)
          forces.compress(VectorOperation::add);
      }
  }


  template <int dim>
  void HeldRows<dim>::keep_share_of_side(Vector &forces) const
  {
    for (const std::vector<Row> &level : levels)
      for (const Row &row : level)
        forces.local_element(row.unknown) *= 2. / 3.;
  }


  template <int dim>
  void HeldRows<dim>::move_mass(Vector &mass) const
  {
    if (!on_any_process)
      return;
    pass_on(mass, 1.);
    const double nothing = std::numeric_limits<double>::epsilon() * mass.l1_norm() / mass.size();
    for (const std::vector<Row> &level : levels)
      for (const Row &row : level)
        mass.local_element(row.unknown) = nothing;
  }


  template class HeldRows<1>;
  template class HeldRows<2>;
  template class HeldRows<3>;
} // namespace PeriDeal
