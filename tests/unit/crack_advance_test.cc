// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Cracks that run through breaking bonds: their surface, their tips and speeds.

#include <deal.II/base/mpi.h>

#include <perideal/analysis/crack_surface.h>

#include <gtest/gtest.h>

#include <cmath>

#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    constexpr double h = 0.1, reach = 3. * h, speed = 7.;


    /** Of a lattice whose nodes lie at odd multiples of h/2: between (x, 0) and (x + h, 0). */
    CrackFacet<2> along_x(const double x, const double y, const double time)
    {
      return {{x, y}, {x + h, y}, time, 0.4};
    }


    /** From the origin along x, n facets with a common speed. */
    std::vector<CrackFacet<2>> straight(const unsigned int n)
    {
      std::vector<CrackFacet<2>> facets;
      for (unsigned int k = 0; k < n; ++k)
        facets.push_back(along_x(k * h, 0., 1. + (k + 1) * h / speed));
      return facets;
    }


    std::vector<CrackFront<2>> at_origin()
    {
      const Point<2> p;
      return {{"crack 1 end 2", {{p, p}}}};
    }


    /** All bonds that cross the plane x = 0.5 broken, on a number of cells along that axis. */
    template <int dim>
    Settings torn(const char *const cells_of_box)
    {
      return box<dim>() + Settings{{"Elasticity/Solver", "dynamics"},
                                   {"Domain/Cells", cells_of_box},
                                   {"Domain/Nodes", "cell centers"},
                                   {"Material/Critical stretch", "0.001"}};
    }


    template <int dim>
    Tensor<1, dim> apart(const Point<dim> &p)
    {
      Tensor<1, dim> u;
      u[0] = p[0] > 0.5 ? 0.1 : 0.;
      return u;
    }


    template <int dim>
    struct Found
    {
      double                       area, volume;
      std::vector<CrackFacet<dim>> facets;
    };


    template <int dim>
    Found<dim> tear(const Settings &settings, const MPI_Comm communicator = MPI_COMM_WORLD)
    {
      const Body<dim> body(settings, ModelKind::peridynamics, communicator);
      body.op().break_bonds(body.values(apart<dim>), 2.);
      const auto            &layout = *body.nodes->partitioner();
      std::vector<BondBreak> breaks;
      std::size_t            n_known = 0;
      for (const NodePair &pair : body.op().broken_since(n_known))
        breaks.push_back({layout.global_to_local(pair[0]), layout.global_to_local(pair[1]), 2.});
      const std::vector<double> damage = body.states->breaking().damage();
      const CrackSurface<dim>   surface(body.states->bonds().families);
      return {surface.area(breaks),
              surface.damaged_volume(breaks, damage, 0.35),
              surface.facets(breaks, damage)};
    }
  } // namespace


  TEST(CrackAdvance, a_straight_crack_has_its_length_and_speed)
  {
    const double now   = 1. + 40 * h / speed;
    const auto   found = find_advances(straight(40), at_origin(), reach, now);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].tip[0], 40 * h, 1e-12);
    EXPECT_NEAR(found[0].tip[1], 0., 1e-12);
    EXPECT_NEAR(found[0].length, 40 * h, 1e-12);
    EXPECT_EQ(found[0].n_tips, 1u);
    EXPECT_NEAR(found[0].speed, speed, 0.01 * speed); // by steps of a cell
  }


  TEST(CrackAdvance, the_speed_falls_once_the_crack_stands)
  {
    double last = 1.1 * speed;
    for (const double rest : {0., 0.5, 1., 2., 4.}) // in units of what four reaches take
      {
        const double now   = 1. + 40 * h / speed + rest * 4. * reach / speed;
        const double found = find_advances(straight(40), at_origin(), reach, now)[0].speed;
        EXPECT_LT(found, last);
        EXPECT_GT(found, 0.);
        last = found;
      }
    EXPECT_LT(last, 0.15 * speed);
    EXPECT_EQ(find_advances(straight(2), at_origin(), reach, 1.5)[0].speed, 0.);
  }


  TEST(CrackAdvance, fits_what_goes_at_one_speed)
  {
    std::vector<std::pair<double, double>> steps;
    for (unsigned int k = 0; k <= 1000; ++k)
      steps.emplace_back(0.01 * k, 0.03 * k);
    EXPECT_NEAR(fitted_speed(steps, 5., 10.), 3., 1e-3);
    EXPECT_EQ(fitted_speed({}, 5., 10.), 0.);
    EXPECT_EQ(fitted_speed({{10., 1.}, {10., 2.}}, 5., 10.), 0.);
  }


  TEST(CrackAdvance, branches_are_counted)
  {
    auto facets = straight(20);
    for (unsigned int k = 0; k < 20; ++k)
      for (const double side : {-1., 1.})
        {
          const double time = 10. + k, x = (20 + k) * h, y = side * k * h;
          facets.push_back(along_x(x, y, time));
          facets.push_back(
            {{x + h, std::min(y, y + side * h)}, {x + h, std::max(y, y + side * h)}, time, 0.4});
          const auto found = find_advances(facets, at_origin(), reach, time)[0];
          if (k > 10 && side > 0.)
            {
              EXPECT_EQ(found.n_tips, 2u);
            }
        }
    const auto found = find_advances(facets, at_origin(), reach, 40.)[0];
    EXPECT_NEAR(found.tip[0], 40 * h, 1e-12);
    EXPECT_NEAR(found.tip[1], -20 * h, 1e-12); // of two that are equally far the first in space
    EXPECT_NEAR(found.length, 20 * h * (1. + std::sqrt(2.)), 0.5 * h);
  }


  TEST(CrackAdvance, what_does_not_hang_together_with_a_front_is_left)
  {
    auto           facets = straight(10);
    const Point<2> other(5., 5.);
    auto           fronts = at_origin();
    fronts.push_back({"crack 2 end 1", {{other, other}}});
    for (const double x : {2., 3.})
      facets.push_back(along_x(x, 1., 3.));
    const auto found = find_advances(facets, fronts, reach, 4.);
    EXPECT_NEAR(found[0].length, 10 * h, 1e-12);
    EXPECT_EQ(found[0].n_tips, 1u);
    EXPECT_EQ(found[1].n_tips, 0u);
  }


  TEST(CrackAdvance, a_front_in_space_is_an_edge)
  {
    std::vector<CrackFacet<3>> facets;
    for (unsigned int k = 0; k < 12; ++k)
      for (unsigned int l = 0; l < 8; ++l)
        facets.push_back({{k * h, 0., l * h}, {(k + 1) * h, 0., (l + 1) * h}, 1. * k, 0.4});
    const Point<3>                   begin(0., 0., 0.), end(0., 0., 8 * h), tip(12 * h, 0., 4 * h);
    const std::vector<CrackFront<3>> fronts{{"crack 1", {{begin, end}}}};
    const auto                       found = find_advances(facets, fronts, reach, 12.);
    EXPECT_NEAR(found[0].length, 12 * h, 1e-12);
    EXPECT_NEAR(found[0].tip.distance(tip), 0., 1e-12);
  }


  TEST(CrackSurface, a_torn_body_has_its_cross_section_on_any_number_of_processes)
  {
    const auto found = tear<2>(torn<2>("24, 18")),
               alone = tear<2>(torn<2>("24, 18"), MPI_COMM_SELF);
    EXPECT_NEAR(found.area, 0.75, 0.15 * 0.75 / 18); // of a cell
    EXPECT_NEAR(found.area, alone.area, 1e-12);
    EXPECT_EQ(found.volume, alone.volume);
    EXPECT_NEAR(found.volume, 2. / 24 * 0.75, 1e-12); // a column on each side
    ASSERT_EQ(found.facets.size(), 18u);
    for (unsigned int k = 0; k < 18; ++k)
      {
        EXPECT_EQ(found.facets[k].lower, alone.facets[k].lower);
        EXPECT_NEAR(found.facets[k].lower[0], 0.5, 1e-14);
        EXPECT_NEAR(found.facets[k].upper[1] - found.facets[k].lower[1], 0.75 / 18, 1e-14);
        EXPECT_EQ(found.facets[k].damage, alone.facets[k].damage);
        EXPECT_EQ(found.facets[k].time, 2.);
        EXPECT_EQ(found.facets[k].normal(), 0u);
      }
  }


  TEST(CrackSurface, in_space)
  {
    const auto found = tear<3>(torn<3>("8, 9, 6")),
               alone = tear<3>(torn<3>("8, 9, 6"), MPI_COMM_SELF);
    EXPECT_NEAR(found.area, 0.375, 0.015 * 0.375);
    EXPECT_NEAR(found.area, alone.area, 1e-12);
    ASSERT_EQ(found.facets.size(), 54u);
    EXPECT_EQ(found.facets[0].corners().size(), 4u);
    EXPECT_EQ(found.facets[0].corners()[2], found.facets[0].upper);
  }
} // namespace PeriDeal
