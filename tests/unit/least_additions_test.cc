// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "../../source/operators/solid/least_additions.h"

namespace
{
  using namespace PeriDeal;

  constexpr std::size_t n_moments = 5;
  using Moments                   = std::array<double, n_moments>;

  /** Fourth-order moments of a direction in the plane, as the norm of the tensor counts them. */
  Moments moments_of(const double angle)
  {
    const double c = std::cos(angle), s = std::sin(angle);
    return {{c * c * c * c,
             2. * c * c * c * s,
             std::sqrt(6.) * c * c * s * s,
             2. * c * s * s * s,
             s * s * s * s}};
  }

  /**
   * A node at the tip of a wedge with horizon m: its own bonds, those of irregular nodes, and what
   * the rest would have.
   */
  struct Tip
  {
    Tip(const double m, const double opening, const double turned, const double moved = 0.)
    {
      const int n = static_cast<int>(m) + 1;
      for (int i = -n; i <= n; ++i)
        for (int j = -n; j <= n; ++j)
          {
            const double x      = i + moved * std::sin(7. * i + 3. * j),
                         y      = j + moved * std::cos(5. * i + 11. * j);
            const double length = std::hypot(x, y), angle = std::atan2(y, x);
            if ((i == 0 && j == 0) || length > m + 1e-9)
              continue;
            const double  weight = length; // w x^2 with w ~ 1/x
            const Moments all    = moments_of(angle + turned);
            if (angle > -1e-9 && angle < opening + 1e-9)
              {
                moments.push_back(all);
                weights.push_back(weight);
              }
            else
              for (std::size_t k = 0; k < n_moments; ++k)
                gap[k] += weight * all[k];
          }
    }

    std::vector<Moments> moments;
    std::vector<double>  weights;
    Moments              gap{};
  };


  double norm(const Moments &v)
  {
    double sum = 0.;
    for (const double x : v)
      sum += x * x;
    return std::sqrt(sum);
  }


  Moments missing(const Tip &tip, const std::vector<double> &additions)
  {
    Moments left = tip.gap;
    for (std::size_t m = 0; m < additions.size(); ++m)
      for (std::size_t k = 0; k < n_moments; ++k)
        left[k] -= tip.weights[m] * additions[m] * tip.moments[m][k];
    return left;
  }
} // namespace


TEST(LeastAdditions, half_a_family_counts_twice)
{
  // Without the bonds along the side, which both halves share.
  Tip tip(3., 0., 0.);
  tip.moments.clear();
  tip.weights.clear();
  tip.gap = Moments{};
  for (int i = -3; i <= 3; ++i)
    for (int j = 1; j * j + i * i <= 9; ++j)
      {
        tip.moments.push_back(moments_of(std::atan2(j, i)));
        tip.weights.push_back(std::hypot(i, j));
        for (std::size_t k = 0; k < n_moments; ++k)
          tip.gap[k] += tip.weights.back() * tip.moments.back()[k];
      }
  for (const double a : least_additions(tip.moments, tip.weights, tip.gap, 1e-6))
    EXPECT_NEAR(a, 1., 1e-4);
}


TEST(LeastAdditions, come_nearest_where_they_cannot_meet_a_gap)
{
  for (const double m : {2., 3., 4., 6.})
    for (const double opening : {30., 45., 60., 75., 90.})
      for (const double turned : {0., 0.3, 1.})
        for (const double moved : {0., 0.15, 0.3})
          {
            const Tip                 tip(m, opening * M_PI / 180., turned, moved);
            const std::vector<double> additions =
              least_additions(tip.moments, tip.weights, tip.gap, 1e-6);
            const Moments left = missing(tip, additions);
            // No bond could come nearer by growing, nor one that has grown by growing less.
            double sum = 0.;
            for (std::size_t k = 0; k < additions.size(); ++k)
              {
                double slope = 0.;
                for (std::size_t n = 0; n < n_moments; ++n)
                  slope += left[n] * tip.moments[k][n];
                EXPECT_GE(additions[k], 0.);
                EXPECT_LT(slope, 1e-3 * norm(tip.gap)) << m << " " << opening << " " << turned;
                if (additions[k] > 0.)
                  {
                    EXPECT_GT(slope, -1e-3 * norm(tip.gap)) << m << " " << opening << " " << turned;
                  }
                sum += tip.weights[k] * additions[k];
              }
            EXPECT_LT(norm(left), norm(tip.gap));
            // The trace of the moments is 1: additions cannot be many times the gap.
            EXPECT_LT(sum, 3. * norm(tip.gap)) << m << " " << opening << " " << turned;
          }
}


TEST(LeastAdditions, do_not_depend_on_the_axes)
{
  const Tip  along(3., 0.5 * M_PI, 0.), turned(3., 0.5 * M_PI, 0.4);
  const auto a = least_additions(along.moments, along.weights, along.gap, 1e-6),
             b = least_additions(turned.moments, turned.weights, turned.gap, 1e-6);
  for (std::size_t m = 0; m < a.size(); ++m)
    EXPECT_NEAR(a[m], b[m], 1e-6);
}
