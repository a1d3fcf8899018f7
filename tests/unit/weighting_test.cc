// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/coupling/weighting.h>

#include <gtest/gtest.h>

using namespace PeriDeal;


TEST(Weighting, models_share_a_place)
{
  for (const CouplingScheme scheme : {CouplingScheme::blending, CouplingScheme::splice})
    {
      const Weighting weighting(scheme);
      // Where beta does not change both models together are one.
      for (const double beta : {0., 0.125, 0.5, 1.})
        {
          EXPECT_DOUBLE_EQ(weighting.of_family(beta) * weighting.of_row(beta) +
                             weighting.of_cell(beta) * weighting.of_cell_row(beta),
                           1.);
          EXPECT_DOUBLE_EQ(weighting.of_bond(beta, beta), beta);
        }
      // Nothing of peridynamics far from the zone, nothing of finite elements in it.
      EXPECT_EQ(weighting.of_family(0.) * weighting.of_row(0.), 0.);
      EXPECT_EQ(weighting.of_cell(1.) * weighting.of_cell_row(1.), 0.);
      EXPECT_EQ(weighting.of_cell(1. + 1e-15) * weighting.of_cell_row(1.), 0.);
    }
}


TEST(Weighting, symmetric_where_it_says_so)
{
  const Weighting blending(CouplingScheme::blending), splice(CouplingScheme::splice);
  EXPECT_TRUE(blending.symmetric());
  EXPECT_DOUBLE_EQ(blending.of_bond(0.25, 0.75), 0.5);
  EXPECT_EQ(blending.of_bond(0.25, 0.75), blending.of_bond(0.75, 0.25));
  EXPECT_FALSE(splice.symmetric());
  EXPECT_DOUBLE_EQ(splice.of_bond(0.25, 0.75), 0.25);
  EXPECT_DOUBLE_EQ(splice.of_bond(0.75, 0.25), 0.75);
}
