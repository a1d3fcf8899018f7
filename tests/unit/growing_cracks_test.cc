// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/crack_kink.h>
#include <perideal/study/growing_cracks.h>
#include <perideal/study/lattice_fit.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace PeriDeal;
  using dealii::Point;

  const double degree = std::acos(-1.) / 180.;


  TEST(CrackKink, follows_published_angles)
  {
    // Pure mode II: Amestoy and Leblond (1992), 75.6 degrees, and 70.53 and 2/sqrt(3) of Erdogan
    // and Sih (1963).
    const CrackKink energy = kink_of_most_release(0., 1.), hoop = kink_of_hoop_stress(0., 1.);
    EXPECT_NEAR(energy.angle, -75.7 * degree, 0.2 * degree);
    EXPECT_NEAR(energy.release(), 1.517, 0.002);
    EXPECT_NEAR(hoop.angle, -70.5288 * degree, 1e-3 * degree);
    EXPECT_NEAR(hoop.mode_1, 2. / std::sqrt(3.), 1e-12);
    const CrackKink straight = kink_of_most_release(1.5, 0.);
    EXPECT_EQ(straight.angle, 0.);
    EXPECT_EQ(straight.release(), 2.25);
    // What closes a crack does not open it.
    EXPECT_NEAR(kink_of_most_release(-1., 1.).release(), energy.release(), 1e-12);
  }


  TEST(CrackKink, little_shear_turns_by_twice_its_share)
  {
    for (const double shear : {-1e-3, 1e-3, 1e-2})
      {
        const CrackKink kink = kink_of_most_release(1., shear);
        EXPECT_NEAR(kink.angle, -2. * shear, 10. * std::pow(std::abs(shear), 2.5));
        EXPECT_NEAR(kink.mode_2, 0., 1e-3 * std::abs(shear));
        EXPECT_NEAR(kink.angle, kink_of_hoop_stress(1., shear).angle, 1e-2 * std::abs(shear));
      }
    // cos(a/2)^3 and sin(a/2) cos(a/2)^2 are exact to first order of K_II and second of the angle.
    const CrackKink turned = kink_at(0.05, 1., 0.);
    EXPECT_NEAR(turned.mode_1, std::pow(std::cos(0.025), 3), 1e-5);
    EXPECT_NEAR(turned.mode_2, std::sin(0.025) * std::pow(std::cos(0.025), 2), 1e-4);
  }


  GrowingCracks two_cracks()
  {
    CrackedBox box;
    box.lower  = {0., 0.};
    box.upper  = {2., 1.};
    box.cells  = {2, 1};
    box.cracks = {{{0., 0.5}, {0.5, 0.5}}, {{1., 0.2}, {1.25, 0.2}}};
    return GrowingCracks(box);
  }


  TEST(GrowingCracks, go_on_turn_and_come_to_a_side)
  {
    GrowingCracks cracks = two_cracks();
    ASSERT_EQ(cracks.ends().size(), 3u); // one of six lies on a side
    const GrowingCracks::End first = cracks.ends()[0], left = cracks.ends()[1];
    EXPECT_EQ(cracks.name(first), "crack 1 end 2");
    EXPECT_EQ(cracks.name(left), "crack 2 end 1");
    cracks.grow(first, 0., 0.25);
    EXPECT_EQ(cracks.segments(), "0,0.5 ; 0.75,0.5 ; 1,0.2 ; 1.25,0.2");
    EXPECT_DOUBLE_EQ(cracks.last_stretch(first), 0.75);
    cracks.grow(first, 90. * degree, 0.25);
    EXPECT_EQ(cracks.name(first), "crack 2 end 2");
    EXPECT_EQ(cracks.name(left), "crack 3 end 1");
    EXPECT_NEAR(cracks.place(first).distance(Point<2>(0.75, 0.75)), 0., 1e-14);
    EXPECT_NEAR(cracks.grown(), 0.5, 1e-14);
    cracks.grow(first, 0., 1.);
    EXPECT_EQ(cracks.ends().size(), 2u);
    EXPECT_NEAR(cracks.place(first).distance(Point<2>(0.75, 1.)), 0., 1e-14);
    ASSERT_EQ(cracks.paths().size(), 1u);
    ASSERT_EQ(cracks.paths()[0].size(), 3u); // from where it was, a turn, the side
    EXPECT_NEAR(cracks.paths()[0][0].distance(Point<2>(0.5, 0.5)), 0., 1e-14);
  }


  TEST(GrowingCracks, end_at_other_cracks)
  {
    GrowingCracks            cracks = two_cracks();
    const GrowingCracks::End first  = cracks.ends()[0];
    cracks.grow(first, std::atan2(-0.3, 0.6), 2.); // meets (1.1, 0.2)
    EXPECT_EQ(cracks.ends().size(), 2u);
    EXPECT_NEAR(cracks.place(first).distance(Point<2>(1.1, 0.2)), 0., 1e-12);
    GrowingCracks            other = two_cracks();
    const GrowingCracks::End left  = other.ends()[1];
    other.grow(left, -90. * degree, 0.1); // ahead is to the left, so up
    EXPECT_NEAR(other.place(left).distance(Point<2>(1., 0.3)), 0., 1e-14);
    EXPECT_EQ(other.name(left), "crack 2 end 1");
    EXPECT_EQ(other.name(other.ends()[2]), "crack 3 end 2");
  }


  TEST(GrowingCracks, know_what_is_around_their_ends)
  {
    const GrowingCracks      cracks = two_cracks();
    const GrowingCracks::End first = cracks.ends()[0], left = cracks.ends()[1];
    EXPECT_NEAR(cracks.way_ahead(first), 1.5, 1e-12); // to the side
    EXPECT_NEAR(cracks.way_ahead(left), 1., 1e-12);   // below the other crack
    EXPECT_NEAR(cracks.room(first), 0.25, 1e-14);     // half of the crack
    EXPECT_NEAR(cracks.room(left), 0.125, 1e-14);
    GrowingCracks longer = two_cracks();
    longer.grow(first, std::atan2(-0.3, 0.6), 0.6); // to 0.06 above the other
    EXPECT_NEAR(longer.room(longer.ends()[0]),
                std::abs(0.5 - 0.6 * std::sin(std::atan2(0.3, 0.6)) - 0.2),
                1e-12);
    EXPECT_NEAR(longer.way_ahead(longer.ends()[0]), std::hypot(0.3, 0.6) - 0.6, 1e-12);
  }


  TEST(GrowingCracks, meet_on_one_line_and_part_the_body)
  {
    CrackedBox box;
    box.lower  = {0., 0.};
    box.upper  = {2., 1.};
    box.cells  = {2, 1};
    box.cracks = {{{0., 0.5}, {0.5, 0.5}}, {{1., 0.5}, {1.25, 0.5}}};
    GrowingCracks            cracks(box);
    const GrowingCracks::End first = cracks.ends()[0], last = cracks.ends()[2];
    EXPECT_NEAR(cracks.way_ahead(first), 0.5, 1e-12);
    cracks.grow(first, 0., 0.75); // and no farther than to the other one
    EXPECT_NEAR(cracks.place(first).distance(Point<2>(1., 0.5)), 0., 1e-14);
    ASSERT_EQ(cracks.ends().size(), 1u); // the two that met are none any more
    EXPECT_EQ(cracks.ends()[0].line, last.line);
    EXPECT_FALSE(cracks.part_the_body());
    GrowingCracks just(box);
    just.grow(first, 0., 0.5);
    EXPECT_EQ(just.ends().size(), 1u);
    cracks.let_through(last);
    EXPECT_TRUE(cracks.ends().empty());
    EXPECT_TRUE(cracks.part_the_body());
  }


  TEST(GrowingCracks, distance_is_the_farthest_of_the_nearest)
  {
    const std::vector<GrowingCracks::Path> one   = {{Point<2>(0., 0.), Point<2>(1., 0.)}},
                                           other = {{Point<2>(0., 0.),
                                                     Point<2>(0.5, 0.),
                                                     Point<2>(1., 0.5)}};
    EXPECT_NEAR(distance_of_paths(one, other), 0.5, 1e-14);
    EXPECT_EQ(distance_of_paths(one, one), 0.);
    EXPECT_NEAR(distance_of_paths(one, {{Point<2>(0., 0.), Point<2>(0.75, 0.)}}), 0.25, 1e-14);
  }


  TEST(LatticeFit, finds_the_limit_and_how_far_it_is)
  {
    std::vector<OnLattice> found = {{1., 3.}, {0.5, 2.5}};
    EXPECT_LT(error_of_last(found), 0.); // too little
    found.push_back({0.25, 2.25});
    EXPECT_NEAR(fit_of_lattices(found).limit, 2., 1e-14);
    EXPECT_NEAR(error_of_last(found), 0.25, 1e-14);
    found[1].value += 0.1;
    found.push_back({0.2, 2.2});
    EXPECT_GT(error_of_last(found), 0.2);
    EXPECT_LT(std::abs(fit_of_lattices(found).limit - 2.),
              2. * fit_of_lattices(found).uncertainty + 0.05);
    EXPECT_LT(error_of_last({{1., 1.}, {1., 2.}, {1., 3.}}), 0.); // all alike
  }
} // namespace
