// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Causes of runs that diverge which lie in the body.

#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <perideal/problems/guards.h>
#include <perideal/scene/expression.h>

#include <cmath>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace SceneTests;
  using dealii::Point;

  namespace
  {
    using Property = std::function<double(const Point<2> &)>;

    /** On a square of 10 x 10 cells of all processes. */
    std::string cause_of(const Property &property, const std::string &monitor)
    {
      dealii::parallel::distributed::Triangulation<2> mesh(MPI_COMM_WORLD);
      dealii::GridGenerator::subdivided_hyper_cube(mesh, 10);
      return cause_in_contrast<2>(mesh, "'Conductivity'", property, monitor);
    }


    Property right_half(const double value)
    {
      return [=](const Point<2> &p) { return p[0] > 0.5 ? value : 1.; };
    }
  } // namespace


  TEST(GuardCauses, contrast)
  {
    // The first of ten faces that are as bad as each other, on any number of processes.
    expect_parts(cause_of(right_half(1e7), "solver"),
                 {"'Conductivity' in section 'Material' is 1e+07 in one cell and 1 in the next",
                  "at (0.5, 0.05)",
                  "iterations hardly get across"});
    expect_parts(cause_of(right_half(1e-7), "solver"), {"is 1 in one cell and 1e-07 in the next"});
    expect_parts(cause_of(right_half(1e12), "balance"), {"1e+12 in one cell", "round-off"});
  }


  TEST(GuardCauses, no_contrast)
  {
    EXPECT_EQ(cause_of(right_half(1e4), "solver"), "");
    EXPECT_EQ(cause_of(right_half(1e7), "balance"), "");
    EXPECT_EQ(cause_of(right_half(1e12), "growth"), "");
    // As much in all, but not from one cell to the next.
    EXPECT_EQ(cause_of([](const Point<2> &p) { return std::exp(16. * p[0]); }, "solver"), "");
    // Without a value somewhere.
    EXPECT_EQ(cause_of([](const Point<2> &p) { return std::sqrt(0.5 - p[0]); }, "solver"), "");
    const Property reports = [](const Point<2> &p) {
      if (p[0] > 0.5)
        report_formula_error("no value");
      return 1.;
    };
    EXPECT_EQ(cause_of(reports, "solver"), "");
  }
} // namespace PeriDeal
