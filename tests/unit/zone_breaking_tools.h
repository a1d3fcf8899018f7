// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "elastic_coupling_tools.h"

namespace PeriDeal
{
  namespace OperatorTests
  {
    const Settings warm{{"Material/Thermal expansion", "1e-3"},
                        {"Elasticity/Temperature change", "2"}};


    /** The lists of all processes as one, in ascending order. Collective. */
    inline std::vector<NodePair> pairs_of_all(const std::vector<NodePair> &own)
    {
      std::vector<NodePair> all;
      for (const auto &list : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, own))
        all.insert(all.end(), list.begin(), list.end());
      std::sort(all.begin(), all.end());
      return all;
    }


    /** As bonds that break for good. */
    inline std::vector<DamagedBond> broken(const std::vector<NodePair> &pairs)
    {
      std::vector<DamagedBond> list;
      for (const NodePair &pair : pairs)
        list.push_back({pair, {0., 1.}});
      return list;
    }


    /** Of a body that is warm, about a fifth of whose bonds are to break. */
    template <int dim>
    void check_a_fifth_broken(Body<dim> &body, const std::vector<NodePair> &some)
    {
      const double n    = body.elements->size().bonds;
      const Vector u    = body.values(bumpy_vector<dim>);
      const double full = body.elements->energy(u);
      body.elements->break_bonds(broken(some), u, 0.);
      EXPECT_NEAR(some.size() / n, 0.2, 0.1);
      EXPECT_EQ(body.elements->size().bonds, static_cast<unsigned long long>(n) - some.size());
      // What the rest of the body gives up is what is counted.
      const double left = body.elements->energy(u);
      EXPECT_GT(full, left);
      EXPECT_NEAR((full - left) / body.elements->released_energy(), 1., 1e-11);
      check_sound(body);
      // A body that is warm all over and free is as large as it wants to be, and stores nothing.
      const Vector free =
        body.values([](const dealii::Point<dim> &p) { return dealii::Tensor<1, dim>(2e-3 * p); });
      const Vector held = body.vector();
      EXPECT_LT(body.unbalanced(free).linfty_norm(), 1e-12 * body.unbalanced(held).linfty_norm());
      EXPECT_LT(std::abs(body.elements->energy(free)), 1e-12 * body.elements->energy(held));
    }


    /** A displacement of a height, exp(-sharpness r^2), about a place beside the lower side. */
    template <int dim>
    Vector peak(const Body<dim> &body, const double height, const double sharpness)
    {
      Vector u = body.values([&](const dealii::Point<dim> &p) {
        dealii::Tensor<1, dim> value;
        value[0] = height * std::exp(-sharpness *
                                     (p - 0.5 * dealii::Point<dim>::unit_vector(0)).norm_square());
        return value;
      });
      body.op().distribute(u, 0.);
      return u;
    }


    /**
     * A zone that follows what a peak() stretches, of less than a share of the body: energies and
     * forces that change with it.
     */
    template <int dim>
    void check_following_zone(Body<dim>   &body,
                              const double height,
                              const double sharpness,
                              const double largest_share)
    {
      EXPECT_EQ(body.elements->size().bonds, 0U);
      const Vector u      = peak(body, height, sharpness);
      Vector       forces = body.unbalanced(u);
      const double whole  = body.op().energy(u);
      ASSERT_TRUE(body.op().widen_zone(u));
      EXPECT_NEAR(whole - body.op().energy(u), body.op().released().by_joining, 1e-12 * whole);
      EXPECT_GT(body.elements->size().bonds, 0U);
      EXPECT_LT(body.elements->bonds().zone_share(), largest_share);
      ASSERT_GT(body.op().break_bonds(u, 0.1), 0U);
      EXPECT_NEAR((whole - body.op().energy(u)) / body.op().released_energy(), 1., 1e-11);
      // What broke joins nothing in vain, and nothing breaks twice.
      body.op().mend_unbalanced(forces, u, 0.);
      EXPECT_LT(relative_difference(forces, body.unbalanced(u)), 1e-12);
      EXPECT_EQ(body.op().break_bonds(u, 0.2), 0U);
    }
  } // namespace OperatorTests
} // namespace PeriDeal
