// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds and cells that the tips of cracks cut in part.

#include <cmath>

#include "elastic_coupling_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;

  /** 20 x 15 cells of 0.05; a crack that ends a part of a cell beyond an edge of cells. */
  Settings cracked(const double part)
  {
    return box<2>() + Settings{{"Domain/Cells", "20, 15"},
                               {"Cracks/Bonds through tips", "in part"},
                               {"Cracks/Segments",
                                "0.3,0.375 ; " + std::to_string(0.6 + 0.05 * part) + ",0.375"}};
  }


  /** Of the bonds of the body, how much the crack takes away: p of each. */
  double taken(const double part)
  {
    const Body<2>                    body(cracked(part), ModelKind::peridynamics);
    const Families<2>               &families = body.states->bonds().families;
    std::vector<Families<2>::Member> members;
    double                           sum = 0.;
    for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
      {
        families.members_of(i, members);
        for (const auto &bond : members)
          sum += (1. - bond.kept) / (1. + 0.5 * bond.kept); // p
      }
    return sum_of_all(sum);
  }


  /** K x of a field, summed with its square as weight, and |K x| of a rigid motion. */
  std::pair<double, double> answers(const Settings &settings, const ModelKind model)
  {
    const Body<2> body(settings, model);
    const Vector  x = body.values(bumpy_vector<2>), turned = body.values([](const Point<2> &p) {
      return Point<2>(1. - p[1], 2. + p[0]);
    });
    return {x * body.product(x), body.product(turned).linfty_norm()};
  }
} // namespace


TEST(CrackGeometry, cuts_bonds_in_part_at_open_ends)
{
  CrackGeometry<2> crack({Point<2>(0., 0.), Point<2>(2., 0.)});
  const auto       part = [&](const double x) {
    return crack.cut_part(Point<2>(x, 0.5), Point<2>(x, -0.5), 0.4);
  };
  EXPECT_DOUBLE_EQ(part(1.), 1.);
  EXPECT_DOUBLE_EQ(part(2.), 0.5);
  EXPECT_NEAR(part(2.1), 0.25, 1e-12);
  EXPECT_NEAR(part(-0.1), 0.25, 1e-12);
  EXPECT_NEAR(part(1.9), 0.75, 1e-12);
  EXPECT_DOUBLE_EQ(part(2.2), 0.);
  EXPECT_DOUBLE_EQ(crack.cut_part(Point<2>(1., 0.5), Point<2>(1., 0.2), 0.4), 0.);
  EXPECT_DOUBLE_EQ(crack.cut_part(Point<2>(2.3, 0.5), Point<2>(1.7, -0.5), 0.4),
                   crack.cut_part(Point<2>(1.7, -0.5), Point<2>(2.3, 0.5), 0.4));
  crack.close(1);
  EXPECT_DOUBLE_EQ(part(2.), 1.);
  EXPECT_DOUBLE_EQ(part(2.1), 0.);
  EXPECT_NEAR(part(-0.1), 0.25, 1e-12);
}


TEST(CrackTips, bonds_are_taken_in_proportion_to_the_length)
{
  const double begin = taken(0.), end = taken(1.);
  EXPECT_GT(end, 1.05 * begin);
  for (const double part : {0.1, 0.25, 0.37, 0.5, 0.8})
    EXPECT_NEAR(taken(part), begin + part * (end - begin), 1e-6 * end) << part;
}


TEST(CrackTips, operators_do_not_jump)
{
  for (const ModelKind model :
       {ModelKind::peridynamics, ModelKind::coupled, ModelKind::finite_elements})
    for (const std::string correction : {"none", "crack scaling"})
      {
        if (correction != "none" && model != ModelKind::coupled)
          continue;
        const Settings more{{"Peridynamics/Surface correction", correction}};
        const double   all = answers(cracked(0.) + more, model).first;
        for (const double part : {0., 0.5, 1.})
          {
            const auto before = answers(cracked(part - 1e-4) + more, model),
                       after  = answers(cracked(part + 1e-4) + more, model);
            EXPECT_NEAR(before.first, after.first, 1e-3 * all);
            EXPECT_LT(before.second, 1e-11 * all);
          }
      }
}


TEST(CrackTips, bonds_are_whole_elsewhere)
{
  const auto n_in_part = [](const Settings &more) {
    const Body<2>                    body(cracked(0.3) + more, ModelKind::peridynamics);
    std::vector<Families<2>::Member> members;
    unsigned int                     n = 0;
    for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
      {
        body.states->bonds().families.members_of(i, members);
        for (const auto &bond : members)
          n += bond.kept > 0. && bond.kept < 1. ? 1 : 0;
      }
    return sum_of_all(n);
  };
  EXPECT_GT(n_in_part({}), 0u);
  EXPECT_EQ(n_in_part({{"Cracks/Bonds through tips", "cut"}}), 0u);
  // A tip on another crack is none.
  EXPECT_EQ(n_in_part({{"Cracks/Segments",
                        "0.3,0.375 ; 0.613,0.375 ; 0.613,0 ; 0.613,0.75 ; 0.3,0 ; 0.3,0.75"}}),
            0u);
}


TEST(CrackTips, same_on_all_processes)
{
  for (const std::string correction : {"none", "crack scaling"})
    expect_same_on_all_processes(
      cracked(0.3) +
      Settings{{"Peridynamics/Surface correction", correction}, {"Coupling/Zone", "cracks: 1"}});
}
