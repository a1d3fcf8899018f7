// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// This file wants -O3 -ffp-contract=off.

#include <perideal/base/for_all_vectors.h>
#include <perideal/base/node_loops.h>

namespace PeriDeal
{
  namespace NodeLoops
  {
    namespace
    {
      // A pointer to what no other pointer of the same loop points to.
      using Out = double *__restrict__;
      using In  = const double *__restrict__;

      PERIDEAL_FOR_ALL_VECTORS void scale_constant(Out               to,
                                                   In                from,
                                                   const double      v,
                                                   const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          to[i] = v * from[i];
      }

      PERIDEAL_FOR_ALL_VECTORS void scale_varying(Out to, In from, In v, const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          to[i] = v[i] * from[i];
      }

      PERIDEAL_FOR_ALL_VECTORS void combine_constant(Out               y,
                                                     In                u,
                                                     const double      v,
                                                     const double      d,
                                                     const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          y[i] = v * (d * u[i] - y[i]);
      }

      PERIDEAL_FOR_ALL_VECTORS void combine_varying(Out y, In u, In v, In d, const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          y[i] = v[i] * (d[i] * u[i] - y[i]);
      }

      PERIDEAL_FOR_ALL_VECTORS void negate_all(Out y, const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          y[i] = -y[i];
      }

      PERIDEAL_FOR_ALL_VECTORS void subtract_all(Out y, In load, const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          y[i] = load[i] - y[i];
      }

      PERIDEAL_FOR_ALL_VECTORS void advance_all(Out               next,
                                                In                u,
                                                In                s,
                                                In                r,
                                                const double      a,
                                                const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          next[i] = u[i] + a * (s[i] * r[i]);
      }

      PERIDEAL_FOR_ALL_VECTORS void accumulate_all(Out               sum,
                                                   In                s,
                                                   In                r,
                                                   const double      a,
                                                   const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          sum[i] += a * (s[i] * r[i]);
      }

      PERIDEAL_FOR_ALL_VECTORS void kick_and_drift_all(Out               v,
                                                       Out               u,
                                                       Out               last,
                                                       In                s,
                                                       In                r,
                                                       const double      a,
                                                       const double      b,
                                                       const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          {
            v[i] += a * (s[i] * r[i]);
            last[i] = u[i];
            u[i] += b * v[i];
          }
      }

      /** The sum of term(i), as eight sums of every eighth one, in this order on any machine. */
      template <typename Term>
      PERIDEAL_INLINE double sum_in_parts(const std::size_t n, const Term &term)
      {
        constexpr std::size_t n_parts = 8;
        double                sums[n_parts]{};
        std::size_t           i = 0;
        for (; i + n_parts <= n; i += n_parts)
          for (std::size_t k = 0; k < n_parts; ++k)
            sums[k] += term(i + k);
        for (; i < n; ++i)
          sums[i % n_parts] += term(i);
        double all = 0.;
        for (const double sum : sums)
          all += sum;
        return all;
      }

      PERIDEAL_FOR_ALL_VECTORS double weighted_square_of_all(In s, In r, const std::size_t n)
      {
        return sum_in_parts(n, [=](const std::size_t i) PERIDEAL_INLINED {
          return s[i] * (r[i] * r[i]);
        });
      }

      PERIDEAL_FOR_ALL_VECTORS double square_over_all(In s, In r, const std::size_t n)
      {
        return sum_in_parts(n, [=](const std::size_t i) PERIDEAL_INLINED {
          return s[i] > 0. ? r[i] * r[i] / s[i] : 0.;
        });
      }

      PERIDEAL_FOR_ALL_VECTORS void chebyshev_all(Out               last,
                                                  Out               sum,
                                                  In                now,
                                                  In                s,
                                                  In                r,
                                                  const double      a,
                                                  const double      c,
                                                  const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          {
            const double next = 2. * now[i] - last[i] - a * (s[i] * r[i]);
            last[i]           = next;
            sum[i] += c * next;
          }
      }

      PERIDEAL_FOR_ALL_VECTORS void rkc_all(Out               next,
                                            In                u,
                                            In                last,
                                            In                before,
                                            In                s,
                                            In                r,
                                            In                rate,
                                            const double     *coefficients,
                                            const std::size_t n)
      {
        const double a = coefficients[0], b = coefficients[1], c = coefficients[2],
                     d = coefficients[3], e = coefficients[4];
        for (std::size_t i = 0; i < n; ++i)
          next[i] = a * u[i] + b * last[i] + c * before[i] + d * (s[i] * r[i]) + e * rate[i];
      }
    } // namespace


    void scale(double *to, const double *from, const double v, const std::size_t n)
    {
      scale_constant(to, from, v, n);
    }

    void scale(double *to, const double *from, const double *v, const std::size_t n)
    {
      scale_varying(to, from, v, n);
    }

    void combine(double *y, const double *u, const double v, const double d, const std::size_t n)
    {
      combine_constant(y, u, v, d, n);
    }

    void combine(double *y, const double *u, const double *v, const double *d, const std::size_t n)
    {
      combine_varying(y, u, v, d, n);
    }

    void kick_and_drift(double           *v,
                        double           *u,
                        double           *last,
                        const double     *s,
                        const double     *r,
                        const double      a,
                        const double      b,
                        const std::size_t n)
    {
      kick_and_drift_all(v, u, last, s, r, a, b, n);
    }

    double weighted_square(const double *s, const double *r, const std::size_t n)
    {
      return weighted_square_of_all(s, r, n);
    }

    double square_over(const double *s, const double *r, const std::size_t n)
    {
      return square_over_all(s, r, n);
    }

    void negate(double *y, const std::size_t n)
    {
      negate_all(y, n);
    }

    void subtract_from(double *y, const double *load, const std::size_t n)
    {
      subtract_all(y, load, n);
    }

    void advance(double           *next,
                 const double     *u,
                 const double     *s,
                 const double     *r,
                 const double      a,
                 const std::size_t n)
    {
      advance_all(next, u, s, r, a, n);
    }

    void accumulate(double           *sum,
                    const double     *s,
                    const double     *r,
                    const double      a,
                    const std::size_t n)
    {
      accumulate_all(sum, s, r, a, n);
    }

    void chebyshev_term(double           *last,
                        double           *sum,
                        const double     *now,
                        const double     *s,
                        const double     *r,
                        const double      a,
                        const double      c,
                        const std::size_t n)
    {
      chebyshev_all(last, sum, now, s, r, a, c, n);
    }

    void rkc_stage(double       *next,
                   const double *u,
                   const double *last,
                   const double *before,
                   const double *s,
                   const double *r,
                   const double *rate,
                   const double (&a)[5],
                   const std::size_t n)
    {
      rkc_all(next, u, last, before, s, r, rate, a, n);
    }
  } // namespace NodeLoops
} // namespace PeriDeal
