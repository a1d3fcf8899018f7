// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/operators/solid/elastic_operator.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Work of the loads and of the supports of a body along its way, by the trapezoidal rule: wrong
   * by O(step^2). Vectors are allocated once.
   */
  class WorkOfForces
  {
  public:
    /** @param op is referred to. */
    explicit WorkOfForces(ElasticOperator &op);

    /**
     * The next step starts here, at time t. @param unbalanced ElasticOperator::unbalanced() there:
     * what is left of it at prescribed unknowns is what the supports bear.
     */
    void begin(const Vector &unbalanced, const double t);

    /**
     * Work (J; in 2D per unit thickness) of a step to time t, and begin() there. Collective.
     * @param from displacements before the step @param to after it
     */
    double step(const Vector &from, const Vector &to, const Vector &unbalanced, const double t);

    /** What the next step depends on. Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

    /** Loads without the supports' forces at the end of the last step. */
    const Vector &loads() const
    {
      return load;
    }

  private:
    void find_active();
    void find_load(const double t);
    void find_forces(const Vector &unbalanced);

    ElasticOperator          &op;
    const std::vector<bool>   held;   // prescribed unknowns
    std::vector<unsigned int> active; // prescribed or loaded: elsewhere forces are zero
    bool                      begun = false;
    Vector                    load, forces, last_forces;
  };
} // namespace PeriDeal
