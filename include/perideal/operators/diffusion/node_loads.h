// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/node_constraints.h>
#include <perideal/operators/interface/operator.h>

#include <vector>

namespace PeriDeal
{
  /**
   * What enters peridynamic nodes from outside: the source s, and through the area A of a node on a
   * side f + h (a - u) (SurfaceTransfer). All are positive into the body:
   *
   *   f_i = s V_i + sum_sides (f A_i + h A_i a),
   *
   * and sides add h A_i to the diagonal of K. Prescribed nodes have no equation, but what enters
   * there counts in the balance of heat; slaves follow the flux through their sides. What their
   * nodes are does not change (NodeConstraints).
   *
   * The arguments of the constructor must outlive this. No function is collective.
   */
  template <int dim>
  class NodeLoads
  {
  public:
    struct SideLoad
    {
      unsigned int           node;
      double                 area, coefficient; // A, h A
      const SurfaceTransfer *transfer;
      dealii::Point<dim>     place; // where formulas are taken

      /** What enters where u is the value of the node. */
      double entering(const double t, const double u) const
      {
        const double given = area * transfer->flux.value(place, t);
        return coefficient == 0. ? given :
                                   given + coefficient * (transfer->ambient.value(place, t) - u);
      }
    };

    NodeLoads(const Nodes<dim>           &nodes,
              const NodeConstraints<dim> &constraints,
              const BodyParameters<dim>  &body);

    /** Loads, or prescribed values of the conditions, change with time. */
    bool depends_on_time() const
    {
      return varies || values_vary;
    }

    /** Loads do. */
    bool vary() const
    {
      return varies;
    }

    /** The f of owned nodes if it is constant and not zero everywhere, else null. */
    const double *constant() const
    {
      return kept.size() > 0 ? kept.begin() : nullptr;
    }

    /** Its sum over free nodes; 0 without. */
    double constant_sum() const
    {
      return kept_sum;
    }

    /** Add f(t). Returns the sum of what free nodes have got. */
    double add_to(Vector &f, const double t) const;

    /** In the order of nodes. */
    const std::vector<SideLoad> &with_coefficient() const
    {
      return relaxing;
    }

    /** Add to y what sides add to K x in the rows [begin, end). */
    void add_transfer(Vector            &y,
                      const Vector      &x,
                      const unsigned int begin,
                      const unsigned int end) const;

    /** What enters this process's nodes where f and a are 0, per time. */
    double through_transfer(const Vector &u) const;

    /** What enters through the sides of slaves. */
    double through_slaves(const double t) const;

    /** Add this process's share of what enters through sides and from sources, with the field u. */
    void add_to(Balance &balance, const Vector &u, const double t) const;

    std::size_t memory_consumption() const
    {
      return kept.memory_consumption();
    }

  private:
    const Nodes<dim>           &nodes;
    const NodeConstraints<dim> &constraints;
    const Expression           &source;
    const bool                  varies, values_vary;
    std::vector<SideLoad>       fluxes, of_slaves, relaxing;
    Vector                      kept;
    double                      kept_sum = 0.;
  };
} // namespace PeriDeal
