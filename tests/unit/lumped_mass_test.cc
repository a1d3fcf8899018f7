// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/parts/lumped_mass.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace PeriDeal
{
  using dealii::Vector;

  namespace
  {
    /** A quadratic element of length 1, with nodes at 0, 1 and 1/2. */
    struct Element
    {
      /** @param left, right the densities of both halves; Simpson's rule on 100 parts */
      Element(const double left, const double right)
        : diagonal(3)
        , sums(3)
      {
        constexpr unsigned int n = 100;
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int q = 0; q < 3; ++q)
            {
              const double x = (k + 0.5 * q) / n, w = (q == 1 ? 4. : 1.) / (6. * n);
              const double density = k < n / 2 ? left : right;
              const double shape[] = {(1. - x) * (1. - 2. * x),
                                      x * (2. * x - 1.),
                                      4. * x * (1. - x)};
              for (unsigned int a = 0; a < 3; ++a)
                {
                  sums(a) += w * density * shape[a];
                  diagonal(a) += w * density * shape[a] * shape[a];
                }
            }
      }

      Vector<double> diagonal, sums;
    };
  } // namespace


  TEST(LumpedMass, of_a_uniform_cell_stays_that_of_rows)
  {
    Element element(2., 2.);
    make_positive(element.diagonal, element.sums);
    EXPECT_NEAR(element.sums(0), 2. / 6., 1e-12);
    EXPECT_NEAR(element.sums(1), 2. / 6., 1e-12);
    EXPECT_NEAR(element.sums(2), 8. / 6., 1e-12);
  }


  TEST(LumpedMass, is_positive_where_the_density_jumps)
  {
    Element element(1., 100.);
    EXPECT_LT(element.sums(0), 0.); // N_0 is negative in the right half
    make_positive(element.diagonal, element.sums);
    EXPECT_GT(*std::min_element(element.sums.begin(), element.sums.end()), 0.);
    EXPECT_NEAR(element.sums(0) + element.sums(1) + element.sums(2), 50.5, 1e-10);
    EXPECT_NEAR(element.sums(1) / element.sums(2),
                element.diagonal(1) / element.diagonal(2),
                1e-12);
  }


  TEST(LumpedMass, may_be_nothing)
  {
    Element element(0., 0.);
    make_positive(element.diagonal, element.sums);
    EXPECT_EQ(element.sums.linfty_norm(), 0.);
  }
} // namespace PeriDeal
