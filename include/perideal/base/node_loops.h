// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>

namespace PeriDeal
{
  /**
   * The loops over nodes in which operators and time steppers spend their time beside the stencil,
   * compiled for several instruction sets. Multiplications and additions are never contracted, so
   * that a node's value depends neither on where in a loop it stands nor on the machine. Arrays
   * must not overlap.
   */
  namespace NodeLoops
  {
    /** to_i = v from_i. */
    void scale(double *to, const double *from, const double v, const std::size_t n);

    /** to_i = v_i from_i. */
    void scale(double *to, const double *from, const double *v, const std::size_t n);

    /** y_i = v (d u_i - y_i). */
    void combine(double *y, const double *u, const double v, const double d, const std::size_t n);

    /** y_i = v_i (d_i u_i - y_i). */
    void combine(double *y, const double *u, const double *v, const double *d, const std::size_t n);

    /** y_i = -y_i. */
    void negate(double *y, const std::size_t n);

    /** y_i = load_i - y_i. */
    void subtract_from(double *y, const double *load, const std::size_t n);

    /** next_i = u_i + a s_i r_i. */
    void advance(double           *next,
                 const double     *u,
                 const double     *s,
                 const double     *r,
                 const double      a,
                 const std::size_t n);

    /** sum_i += a s_i r_i. */
    void accumulate(double           *sum,
                    const double     *s,
                    const double     *r,
                    const double      a,
                    const std::size_t n);

    /** v_i += a s_i r_i, last_i = u_i, then u_i += b v_i: the begin of a step of a motion. */
    void kick_and_drift(double           *v,
                        double           *u,
                        double           *last,
                        const double     *s,
                        const double     *r,
                        const double      a,
                        const double      b,
                        const std::size_t n);

    /** The sum of s_i r_i^2, in eight parts, whatever the machine. */
    double weighted_square(const double *s, const double *r, const std::size_t n);

    /** The sum of r_i^2/s_i over s_i > 0, likewise. */
    double square_over(const double *s, const double *r, const std::size_t n);

    /**
     * last_i = 2 now_i - last_i - a s_i r_i, and sum_i += c last_i: a term of a Chebyshev
     * expansion.
     */
    void chebyshev_term(double           *last,
                        double           *sum,
                        const double     *now,
                        const double     *s,
                        const double     *r,
                        const double      a,
                        const double      c,
                        const std::size_t n);

    /**
     * next_i = a[0] u_i + a[1] last_i + a[2] before_i + a[3] s_i r_i + a[4] rate_i: a stage of
     * RKC2.
     */
    void rkc_stage(double       *next,
                   const double *u,
                   const double *last,
                   const double *before,
                   const double *s,
                   const double *r,
                   const double *rate,
                   const double (&a)[5],
                   const std::size_t n);
  } // namespace NodeLoops
} // namespace PeriDeal
