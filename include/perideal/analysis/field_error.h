// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/quadratic_elements.h>

namespace PeriDeal
{
  /**
   * The error u - u_h of a steady solution of bilinear elements as a field of quadratic ones, from
   * this solution alone. The bubbles w of u are recovered, and what they do to the values at the
   * vertices follows from one more solution with K:
   *
   *   u - u_h = w + e,   a(e, v) = f(v) - a(u_h + w, v) for all v of the bilinear elements.
   *
   * From it the error in the mean, at points and of flows are read (doc/estimators.md). Where the
   * material depends on the solution as for GoalErrors. Vectors need no ghosts.
   */
  template <int dim>
  class FieldError
  {
  public:
    /** @param elements must outlive this. @param u through distribute(). Collective. */
    FieldError(const QuadraticElements<dim> &elements,
               const SolveSystem            &solve,
               const Vector                 &u,
               const double                  t = 0.);

    /** Of quadratic elements. Not collective. */
    const Vector &field() const
    {
      return error;
    }

    /** Root of the mean square over the body. Collective. */
    double root_mean_square() const;

    /** u - u_h at points. Collective. Throws UserError for points outside the body. */
    std::vector<double> at(const std::vector<std::vector<double>> &points) const;

    /** Error of what enters through a side with a value, added up as in a balance. Collective. */
    double of_flow_through(const std::string &side) const;

  private:
    const QuadraticElements<dim> &elements;
    Vector                        error;
    Vector                        residual; // of u_h + w
    Vector changed_reactions; // what enters at Q1 unknowns with a value, beyond that of u_h
  };


  /**
   * Root of the mean square, over the body, of the difference of two fields on different meshes of
   * it: at the quadrature points of the first, which should be the finer one. Points that are not
   * in the other mesh do not count. Neither vector needs ghosts. Processes may have different parts
   * of both. Collective.
   */
  template <int dim>
  double difference_on_meshes(const dealii::DoFHandler<dim> &dofs,
                              const Vector                  &u,
                              const dealii::DoFHandler<dim> &other_dofs,
                              const Vector                  &other);

  /**
   * The error of the finer of two solutions whose difference is known, if errors go with size^order
   * (Richardson): difference/((coarse size/fine size)^order - 1).
   */
  double extrapolated_error(const double difference,
                            const double coarse_size,
                            const double fine_size,
                            const double order);
} // namespace PeriDeal
