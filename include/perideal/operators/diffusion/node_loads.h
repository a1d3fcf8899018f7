// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/diffusion_loads.h>
#include <perideal/operators/diffusion/node_constraints.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Loads of peridynamic nodes, with the area A of a node on a side:
   *
   *   f_i = s V_i + sum_sides (f A_i + h A_i a),
   *
   * and sides add h A_i to the diagonal of K; a source that is a function of u adds its own h V_i
   * (LoadTangents). Prescribed nodes have no equation, but what enters there counts in the balance
   * of heat; slaves follow the flux through their sides and have no load. What their nodes are does
   * not change (NodeConstraints).
   */
  template <int dim>
  class NodeLoads : public DiffusionLoads<dim>
  {
  public:
    NodeLoads(const Nodes<dim>           &nodes,
              const NodeConstraints<dim> &constraints,
              const BodyParameters<dim>  &body);

    double through_slaves(const double t) const override;
    void   add_to(Balance &balance, const Vector &u, const double t) const override;

  private:
    struct SideLoad
    {
      unsigned int           node;
      double                 area, coefficient; // A, h A
      const SurfaceTransfer *transfer;
      dealii::Point<dim>     place; // where formulas are taken

      bool is_curved() const
      {
        return transfer->depends_on_temperature();
      }

      /** What enters where u is the value of the node, of a line. */
      double entering(const double t, const double u) const
      {
        const double given = area * transfer->flux.value(place, t);
        return coefficient == 0. ? given :
                                   given + coefficient * (transfer->ambient.value(place, t) - u);
      }
    };

    void assemble(const double t) const override;
    void find_coefficients() override;

    /** Call visit(node) for the owned nodes in which a source acts: all but slaves. */
    template <typename Visit>
    void for_each_source(const Visit &visit) const;

    const Nodes<dim>           &nodes;
    const NodeConstraints<dim> &constraints;
    std::vector<SideLoad>       fluxes, of_slaves, relaxing;
  };
} // namespace PeriDeal
