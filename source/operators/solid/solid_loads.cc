// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/solid_loads.h>
#include <perideal/scene/beyond_sides.h>

#include <algorithm>
#include <array>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * A traction acts on the side, where the displacement is 3/2 u_0 - 1/2 u_1 of the cell centres
     * in the two outermost rows: of a whole side or a part of it, each node of the second row bears
     * -1/2 of what its neighbour in the outermost row does. Collective.
     */
    template <int dim>
    void draw_on_to_side(const Families<dim>                   &families,
                         const BoundaryConditions<dim>         &conditions,
                         const std::array<BeyondSide, 2 * dim> &sides,
                         std::vector<TractionShare<dim>>       &tractions)
    {
      const Nodes<dim>   &nodes   = families.nodes();
      const Lattice<dim> &lattice = *nodes.lattice();
      const auto          next =
        [&](const unsigned int node, const types::boundary_id side, const int step) {
          auto site = lattice.index(nodes.position(node));
          site[side / 2] += side % 2 == 0 ? step : -step;
          return families.neighbors().node_at(site);
        };
      std::vector<TractionShare<dim>> second;
      std::array<Vector, dim + 1>     carried; // areas and places of the outermost row
      for (const VectorCondition &condition : conditions.traction)
        {
          const types::boundary_id side = conditions.side_of(condition.id);
          if (side >= 2 * dim || sides[side] != BeyondSide::continued ||
              lattice.n_sites[side / 2] == 1)
            continue;
          for (Vector &values : carried)
            values.reinit(nodes.partitioner());
          for (TractionShare<dim> &share : tractions)
            if (share.side == condition.id &&
                next(share.node, side, 1) != numbers::invalid_unsigned_int)
              {
                carried[dim].local_element(share.node) = share.area;
                for (unsigned int d = 0; d < dim; ++d)
                  carried[d].local_element(share.node) = share.place[d];
                share.area *= 1.5;
              }
          for (Vector &values : carried)
            values.update_ghost_values();
          const int row = side % 2 == 0 ? 1 : lattice.n_sites[side / 2] - 2;
          for (unsigned int i = 0; i < nodes.n_owned(); ++i)
            {
              if (lattice.index(nodes.position(i))[side / 2] != row)
                continue;
              const unsigned int outer = next(i, side, -1);
              if (outer == numbers::invalid_unsigned_int || carried[dim].local_element(outer) == 0.)
                continue;
              Point<dim> place;
              for (unsigned int d = 0; d < dim; ++d)
                place[d] = carried[d].local_element(outer);
              second.push_back({i, condition.id, -0.5 * carried[dim].local_element(outer), place});
            }
        }
      tractions.insert(tractions.end(), second.begin(), second.end());
    }


    bool is_no_load(const VectorCondition &traction)
    {
      return std::all_of(traction.values.begin(), traction.values.end(), [](const auto &value) {
        return !value || is_zero(*value);
      });
    }
  } // namespace


  template <int dim>
  SolidLoads<dim>::SolidLoads(const SolidBonds<dim> &bonds, const BodyParameters<dim> &body)
    : body(body)
    , nodes(bonds.families.nodes())
    , tractions(traction_shares(nodes, body.boundary_conditions))
  {
    if (bonds.ends.images && nodes.lattice() && nodes.lattice()->at_centers &&
        body.boundary_conditions.traction_layer <= 0.)
      draw_on_to_side(bonds.families, body.boundary_conditions, beyond_sides(body), tractions);
  }


  template <int dim>
  std::vector<unsigned int> SolidLoads<dim>::sides_nearby(const Families<dim> &families) const
  {
    const auto                                 &list = body.boundary_conditions.traction;
    std::vector<typename Families<dim>::Member> family;
    std::vector<unsigned int> nearby(nodes.n_local(), numbers::invalid_unsigned_int);
    for (unsigned int number = 0; number < list.size(); ++number)
      {
        if (is_no_load(list[number]))
          continue;
        Vector beside(nodes.partitioner());
        for (const TractionShare<dim> &share : tractions)
          if (share.side == list[number].id && share.area != 0.)
            {
              families.members_of(share.node, family);
              beside.local_element(share.node) += 1.;
              for (const auto &bond : family)
                beside.local_element(bond.neighbor) += 1.;
            }
        beside.compress(VectorOperation::add);
        beside.update_ghost_values();
        for (unsigned int i = 0; i < nodes.n_local(); ++i)
          if (beside.local_element(i) > 0. && nearby[i] == numbers::invalid_unsigned_int)
            nearby[i] = number;
      }
    return nearby;
  }


  PERIDEAL_INSTANTIATE_CLASS(class SolidLoads);
} // namespace PeriDeal
