// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/solid/element_loads.h>

#include <cmath>
#include <map>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  /** Sums over all unknowns, of each side and component, on all processes. */
  template <int dim>
  std::map<dealii::types::boundary_id, Tensor<1, dim>> sums_of(const Body<dim>   &body,
                                                               const double       t,
                                                               const unsigned int n_sides)
  {
    const ElementLoads<dim>                              loads(body.handler,
                                  body.scene,
                                  body.elements->node_layout(),
                                  [](const auto) { return false; });
    std::map<dealii::types::boundary_id, Tensor<1, dim>> sums;
    loads.for_each(t, [&](const auto side, const auto unknown, const auto d, const double value) {
      EXPECT_EQ(unknown % dim, d);
      sums[side][d] += value;
    });
    const auto add_up = [&](const dealii::types::boundary_id side) {
      Tensor<1, dim> &sum = sums[side];
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] = sum_of_all(sum[d]);
    };
    for (unsigned int side = 0; side < n_sides; ++side)
      add_up(side);
    add_up(first_part_id);
    add_up(dealii::numbers::internal_face_boundary_id);
    return sums;
  }
} // namespace


TEST(ElementLoads, add_up_to_what_acts_on_the_body)
{
  const Settings   settings{{"Initial and source/Body force", "0, -2*x*t"},
                          {"Boundary conditions/Parts", "half: top if x < 0.5"},
                          {"Boundary conditions/Traction", "right: 3*y, t ; half: 0, -4"}};
  const Body<2>    body(box<2>() + settings, ModelKind::finite_elements);
  constexpr double t    = 0.75;
  const auto       sums = sums_of(body, t, 4);
  // A box of 1 x 0.75, whose right side is number 1.
  EXPECT_NEAR(sums.at(dealii::numbers::internal_face_boundary_id)[1], -0.75 * t, 1e-14);
  EXPECT_EQ(sums.at(dealii::numbers::internal_face_boundary_id)[0], 0.);
  EXPECT_NEAR(sums.at(1)[0], 1.5 * 0.75 * 0.75, 1e-14);
  EXPECT_NEAR(sums.at(1)[1], 0.75 * t, 1e-14);
  EXPECT_NEAR(sums.at(first_part_id)[1], -4. * 0.5, 1e-13);
  for (const unsigned int side : {0, 2, 3}) // held, and without a load
    EXPECT_EQ(sums.at(side).norm(), 0.);
}


/** A traction on a region or at a point is a force, shared by its nodes. */
TEST(ElementLoads, are_shared_by_the_nodes_of_regions)
{
  for (const char *const place : {"region x > 0.7", "point 0.5, 0.375"})
    {
      const Settings settings{{"Boundary conditions/Parts", std::string("pulled: ") + place},
                              {"Boundary conditions/Traction", "pulled: 2, -1"}};
      const Body<2>  body(box<2>() + settings, ModelKind::finite_elements);
      const auto     sums = sums_of(body, 0., 4);
      EXPECT_NEAR(sums.at(first_part_id)[0], 2., 1e-14) << place;
      EXPECT_NEAR(sums.at(first_part_id)[1], -1., 1e-14) << place;
    }
}
