// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/nodes.h>
#include <perideal/operators/interface/capacity.h>
#include <perideal/scene/body_parameters.h>

namespace PeriDeal
{
  /**
   * Capacity of peridynamic nodes: rho c V_i; of steady states, where it only sets a scale, V_i.
   * What depends on the temperature starts with the initial value.
   */
  template <int dim>
  class NodeCapacity : public Capacity
  {
  public:
    /**
     * The arguments must outlive this. Collective. Throws UserError for a storage that is not
     * positive.
     */
    NodeCapacity(const Nodes<dim> &nodes, const BodyParameters<dim> &body);

    bool depends_on_solution() const override
    {
      return body.material.storage_depends_on_temperature();
    }

    void   take_at(const Vector &u) override;
    void   heat_between(Vector &y, const Vector &u, const Vector &v) const override;
    double content(const Vector &u) const override;

  private:
    /** @param u null: initial values */
    void find(const Vector *u);

    const Nodes<dim>          &nodes;
    const BodyParameters<dim> &body;
  };
} // namespace PeriDeal
