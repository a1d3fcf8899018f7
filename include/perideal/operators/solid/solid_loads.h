// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/solid_bonds.h>
#include <perideal/operators/solid/traction_layer.h>

#include <vector>

namespace PeriDeal
{
  /** Tractions and body forces on the nodes of a peridynamic solid. */
  template <int dim>
  class SolidLoads
  {
  public:
    /**
     * Where families go on beyond sides between which and the nodes there is half a cell, tractions
     * are drawn on to the side. Collective.
     */
    SolidLoads(const SolidBonds<dim> &bonds, const BodyParameters<dim> &body);

    /**
     * Call visit(side, unknown, force) for all of time t on this process's unknowns; the side of
     * body forces is dealii::numbers::internal_face_boundary_id. Not collective.
     */
    template <typename Visit>
    void for_each(const double t, const Visit &visit) const
    {
      const auto &force = body.initial_and_source.body_force;
      for (unsigned int i = 0; i < nodes.n_owned() && !force.empty(); ++i)
        for (unsigned int d = 0; d < dim; ++d)
          visit(dealii::numbers::internal_face_boundary_id,
                dim * i + d,
                nodes.volume(i) * force[d].value(nodes.position(i), t));
      for (const TractionShare<dim> &share : tractions)
        {
          const auto &values =
            find_condition(body.boundary_conditions.traction, share.side)->values;
          for (unsigned int d = 0; d < dim; ++d)
            visit(share.side, dim * share.node + d, share.area * values[d]->value(share.place, t));
        }
    }

    /**
     * Which in `Traction`, if it loads anything, is within a horizon of each node, owned or ghost;
     * dealii::numbers::invalid_unsigned_int: none. Collective.
     */
    std::vector<unsigned int> sides_nearby(const Families<dim> &families) const;

  private:
    const BodyParameters<dim>      &body;
    const Nodes<dim>               &nodes;
    std::vector<TractionShare<dim>> tractions;
  };
} // namespace PeriDeal
