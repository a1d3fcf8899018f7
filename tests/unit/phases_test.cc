// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/phases.h>

#include <gtest/gtest.h>

#include <cmath>

#include "scene_test_tools.h"

namespace PeriDeal
{
  using dealii::Point;

  namespace
  {
    std::unique_ptr<Phases> phases_of(
      const std::vector<std::pair<std::string, std::string>> &entries)
    {
      auto phases = std::make_unique<Phases>();
      for (const auto &[entry, text] : entries)
        phases->set(entry, text);
      phases->parse();
      return phases;
    }


    std::string message_of(const std::vector<std::pair<std::string, std::string>> &entries)
    {
      return SceneTests::message_of([&] { phases_of(entries); });
    }
  } // namespace


  TEST(Phases, regions_hold_their_rims)
  {
    const Region circle("circle(1, 2, sqrt(0.25))", "w");
    EXPECT_TRUE(circle.contains(Point<2>(1., 2.5)));
    EXPECT_TRUE(circle.contains(Point<2>(1. + 0.5 * std::sqrt(0.5), 2. + 0.5 * std::sqrt(0.5))));
    EXPECT_FALSE(circle.contains(Point<2>(1., 2.5 + 1e-8)));
    const Region rectangle("rectangle(0, 0, 0.3, 1)", "w");
    EXPECT_TRUE(rectangle.contains(Point<2>(0.1 + 0.2, 0.5)));
    EXPECT_FALSE(rectangle.contains(Point<2>(0.31, 0.5)));
    const Region sphere("sphere(0, 0, 1, 1)", "w"), box("box(0,0,0, 1,2,3)", "w");
    EXPECT_TRUE(sphere.contains(Point<3>(0., 0., 2.)));
    EXPECT_FALSE(sphere.contains(Point<3>(0.1, 0., 2.)));
    EXPECT_TRUE(box.contains(Point<3>(1., 2., 3.)));
    EXPECT_FALSE(box.contains(Point<3>(1., 2., 3.1)));
    // Not convex: an L.
    const Region polygon("polygon(0,0, 2,0, 2,1, 1,1, 1,2, 0,2)", "w");
    EXPECT_TRUE(polygon.contains(Point<2>(0.5, 1.5)));
    EXPECT_TRUE(polygon.contains(Point<2>(1., 1.5)));
    EXPECT_FALSE(polygon.contains(Point<2>(1.5, 1.5)));
    // A formula is a region where it is greater than 0, and may use the names of no shape.
    const Region formula("0.2 - y", "w");
    EXPECT_TRUE(formula.contains(Point<2>(0., 0.1)));
    EXPECT_FALSE(formula.contains(Point<2>(0., 0.2)));
  }


  TEST(Phases, properties_of_the_phase_at_a_point)
  {
    const auto phases = phases_of({{"Regions", "core: circle(0, 0, 1) ; rim: x > 2"},
                                   {"Conductivity", "core: 7 ; rim: 2 + y"},
                                   {"Density", "rim: 3"}});
    const auto kappa  = phases->property("Conductivity", Expression("1 + x", "w"));
    EXPECT_DOUBLE_EQ(kappa.value(Point<2>(0., 0.5)), 7.);
    EXPECT_DOUBLE_EQ(kappa.value(Point<2>(3., 0.5)), 2.5);
    EXPECT_DOUBLE_EQ(kappa.value(Point<2>(1.5, 0.)), 2.5);
    EXPECT_FALSE(kappa.is_constant());
    const auto density = phases->property("Density", Expression(5.));
    EXPECT_DOUBLE_EQ(density.value(Point<2>(0., 0.5)), 5.);
    EXPECT_DOUBLE_EQ(density.value(Point<2>(3., 0.5)), 3.);
    // No phase has its own value: as without phases.
    EXPECT_TRUE(phases->property("Heat capacity", Expression(5.)).is_constant());
    EXPECT_EQ(phases->all().at(Point<2>(0., 0.)), 0);
    EXPECT_EQ(phases->all().at(Point<2>(9., 0.)), 1);
    EXPECT_EQ(phases->all().at(Point<2>(1.5, 0.)), -1);
  }


  TEST(Phases, mistakes)
  {
    using SceneTests::expect_parts;
    const std::pair<std::string, std::string> one{"Regions", "core: x > 0"};
    expect_parts(message_of({one}), {"'Regions'", "'core'", "no material", "'Conductivity'"});
    expect_parts(message_of({one, {"Conductivity", "cora: 2"}}),
                 {"'cora'", "Did you mean 'core'?"});
    expect_parts(message_of({one, {"Conductivity", "core: -2"}}), {"'core'", "greater than 0"});
    expect_parts(message_of({one, {"Density", "core: 2 ; core: 3"}}), {"'Density'", "named twice"});
    expect_parts(message_of({one, {"Conductivity", "core: t"}}), {"depends on t"});
    expect_parts(message_of({{"Regions", "a: x > 0 ; a: y > 0"}}), {"'a'", "named twice"});
    expect_parts(message_of({{"Regions", "a: circle(0, 0)"}}), {"circle(x, y, radius)"});
    expect_parts(message_of({{"Regions", "a: circle(0, 0, -1)"}}), {"no size"});
    expect_parts(message_of({{"Regions", "a: rectangle(1, 0, 0, 1)"}}), {"lower corner first"});
    expect_parts(message_of({{"Regions", "a: polygon(0, 0, 1, 0, 1)"}}), {"polygon(x0, y0"});
    expect_parts(message_of({{"Regions", "a: circle(x, 0, 1)"}}), {"shapes need numbers"});
    expect_parts(SceneTests::message_of([] {
                   phases_of({{"Regions", "a: x > 0 ; b: y > 0"}, {"Conductivity", "a: 2 ; b: 3"}})
                     ->property("Conductivity", Expression(1.))
                     .value(Point<2>(1., 1.));
                 }),
                 {"'a'", "'b'", "overlap at (1, 1)"});
  }
} // namespace PeriDeal
