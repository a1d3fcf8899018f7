// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/node_constraints.h>
#include <perideal/operators/interface/operator.h>

#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What flows through the sides of a body by bonds with the fictitious nodes beyond them. Nothing
   * where there are none.
   *
   * Vectors have their ghosts up to date. The bonds must outlive this. Not collective unless
   * stated.
   */
  template <int dim>
  class OutsideFlow
  {
  public:
    explicit OutsideFlow(const DiffusionBonds<dim> &bonds);

    /** The fictitious nodes' values at time t; they stay until the next call. */
    const double *values(const Vector &u, const double t) const;

    /** The same with prescribed values of zero. */
    const double *homogeneous_values(const Vector &u) const;

    /** As many as there are fictitious nodes, of the last call. */
    const std::vector<double> &last_values() const
    {
      return outside;
    }

    /** Conductances have changed. */
    void update()
    {
      sums.known = false;
    }

    /** Only those of some owned nodes' bonds. */
    void update(const std::vector<unsigned int> &rows);

    /** Add what flows into the body, per time, with the last values. */
    void add_to(double &sum, const Vector &u) const;

    /**
     * The same by the sides of this process, with what prescribed nodes get from beyond under their
     * own condition. Collective.
     */
    void add_to(Balance                       &balance,
                const Vector                  &u,
                const NodeConstraints<dim>    &constraints,
                const BoundaryConditions<dim> &conditions) const;

  private:
    /** Call visit(node, bonds) for the owned nodes that may have bonds with fictitious nodes. */
    template <typename Visit>
    void for_each_family(const Visit &visit) const;

    bool reaches_outside(const unsigned int node) const;
    void find_sums() const;

    /** Conductances of bonds with fictitious nodes: their sums, so that flows are sums of nodes. */
    struct Sums
    {
      bool                                         known = false;
      std::vector<double>                          of_outside; // by fictitious node
      std::vector<std::pair<unsigned int, double>> of_nodes;
    };

    const DiffusionBonds<dim>  &bonds;
    mutable std::vector<double> outside;
    mutable Sums                sums;
  };
} // namespace PeriDeal
