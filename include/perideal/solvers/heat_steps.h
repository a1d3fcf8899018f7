// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/operators/interface/diffusion_operator.h>

namespace PeriDeal
{
  /**
   * The sum of the owned entries of y that are not free, of this process. @p work is overwritten.
   * Not collective.
   */
  double sum_of_held(const DiffusionOperator &op, const Vector &y, Vector &work);


  /**
   * What prescribed unknowns take up while a stepper advances with a capacity that is constant:
   * nothing unless their values change with time or, as slaves, with those of others (rows that are
   * not symmetric), or share a capacity matrix with others.
   */
  class HeldHeat
  {
  public:
    explicit HeldHeat(const DiffusionOperator &op);

    /** The span of time begins with u, distributed. */
    void begin(const Vector &u);

    /** What they have taken up when it ends with u, distributed; of this process. Collective. */
    double taken(const Vector &u);

    /** The values that the span began with. Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

  private:
    const DiffusionOperator &op;
    bool                     needed;
    Vector                   before, heat, work;
  };


  /**
   * Steps that conserve the heat where the capacity depends on the temperature. A step with the
   * capacity C of its beginning brings C_i (v_i - u_i) to a free unknown; what it then holds more
   * is the integral of its capacity from u to v, which is another. correct() moves v until both
   * agree: one step of Newton's method, with the slope that the two capacities tell. What is left
   * is of second order in that change, and steps are of second order in time where they were of
   * first order by the frozen capacity.
   */
  class ConservativeStep
  {
  public:
    explicit ConservativeStep(const DiffusionOperator &op);

    /** The capacity depends on the solution: otherwise there is nothing to correct. */
    bool needed() const;

    /**
     * From u with the operator's present capacity to v, both distributed; v has to be distributed
     * again. Returns what prescribed unknowns take up, of this process. Collective.
     */
    double correct(const Vector &u, Vector &v);

    std::size_t memory_consumption() const;

  private:
    const DiffusionOperator &op;
    Vector                   heat, work;
  };
} // namespace PeriDeal
