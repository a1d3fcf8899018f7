// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/quadratic_elements.h>

namespace PeriDeal
{
  /** What is asked of a solution. */
  template <int dim>
  struct Goal
  {
    static Goal value_at(const dealii::Point<dim> &point)
    {
      return {point, ""};
    }

    /** What enters the body through a side or a part of one, by name. */
    static Goal flow_through(const std::string &side)
    {
      return {dealii::Point<dim>(), side};
    }

    dealii::Point<dim> point;
    std::string        side; // empty: the value at the point
  };


  /** The error of a goal J. */
  struct GoalError
  {
    double              value    = 0.; // J(u_h)
    double              estimate = 0.; // of J(u) - J(u_h): added to the value it makes it better
    std::vector<double> cells; // what owned cells contribute, by active cell index: where to refine
  };


  /**
   * Errors of goals of one steady solution u_h by dual-weighted residuals (doc/estimators.md). With
   * the dual solution z of a goal, K z = j or K z = 0 with z = 1 on the side,
   *
   *   J(u) - J(u_h) = r(z - z_h),   r(v) = f(v) - a(u_h, v),
   *
   * and of z - z_h the bubbles are taken that second derivatives of z_h recover. What values on
   * sides that are no straight lines add, and what the solver and the quadrature left, counts. For
   * values at points, where z is singular, the estimate is that of FieldError, with z_h as weights:
   * J(w) - a(w, z_h) with the bubbles w of u.
   *
   * Each goal takes one solution with K, which has to be symmetric. Where the material depends on
   * the solution, K is that of u_h, and the estimate that of a linear body.
   */
  template <int dim>
  class GoalErrors
  {
  public:
    /** All arguments must outlive this. @param u through distribute(). Collective. */
    GoalErrors(const QuadraticElements<dim> &elements,
               const SolveSystem            &solve,
               const Vector                 &u,
               const double                  t = 0.);

    /**
     * Throws UserError for points outside the body, and for names that are no side with a value or
     * a transfer. Collective.
     */
    GoalError of(const Goal<dim> &goal) const;

    /** Bubbles of the solution, and what is prescribed of them. Not collective. */
    const Vector &solution_bubbles() const
    {
      return bubbles;
    }

  private:
    struct Dual;

    Dual point_dual(const dealii::Point<dim> &point) const;
    Dual transfer_dual(const SurfaceTransfer &transfer) const;
    Dual reaction_dual(const std::string &side) const;

    const QuadraticElements<dim> &elements;
    const SolveSystem            &solve;
    const Vector                 &u;
    const double                  time;
    Vector                        bubbles;
    Vector                        residual_with_bubbles;
    Vector residual, linear_residual, solver_residual; // of u; Q1 with straight sides; of all cells
  };
} // namespace PeriDeal
