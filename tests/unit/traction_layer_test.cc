// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Tractions that are spread over a layer.

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

TEST(TractionLayer, part_of_an_interval)
{
  EXPECT_DOUBLE_EQ(part_within(0., 0.5, 2.), 1.);
  EXPECT_DOUBLE_EQ(part_within(1.5, 2.5, 2.), 0.5);
  EXPECT_DOUBLE_EQ(part_within(2.5, 3.5, 2.), 0.);
  EXPECT_DOUBLE_EQ(part_within(0., 1., 0.25), 0.25);
}


namespace
{
  /** Loads without and with a layer: the same in each column, and within the layer only. */
  template <int dim>
  void check_columns(const Settings &more, const std::string &traction, const double depth)
  {
    const Settings loaded =
      box<dim>() + Settings{{"Boundary conditions/Traction", traction}} + more;
    const Body<dim> plain(loaded, ModelKind::peridynamics),
      layered(loaded + Settings{{"Boundary conditions/Traction layer", std::to_string(depth)}},
              ModelKind::peridynamics);
    const unsigned int axis = layered.scene.boundary_conditions.traction.front().id / 2;
    const double       side = layered.scene.domain.upper[axis];
    // Sums over columns, by their place across the side.
    const auto sums = [&](const Body<dim> &body, double &n_loaded) {
      Vector loads;
      body.op().initialize_vector(loads);
      body.op().mechanical_loads(loads, 0.);
      std::map<std::array<double, dim>, double> local;
      n_loaded = 0.;
      for (unsigned int k = 0; k < loads.locally_owned_size(); ++k)
        {
          std::array<double, dim> key;
          for (unsigned int d = 0; d < dim; ++d)
            key[d] = d == axis ? k % dim : body.position(k / dim)[d];
          local[key] += loads.local_element(k);
          const double distance = side - body.position(k / dim)[axis];
          n_loaded += loads.local_element(k) != 0. ? 1. : 0.;
          // Too deep, or beyond the hole.
          if (distance > depth + 0.1 ||
              (body.scene.domain.shape == Shape::plate_with_hole && distance > 0.15 &&
               std::abs(body.position(k / dim)[1] - 0.4) < 0.03))
            {
              EXPECT_EQ(loads.local_element(k), 0.);
            }
        }
      std::map<std::array<double, dim>, double> all;
      for (const auto &part : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, local))
        for (const auto &[key, value] : part)
          all[key] += value;
      n_loaded = sum_of_all(n_loaded);
      return all;
    };
    double     n_loaded, n_in_layer;
    const auto wanted = sums(plain, n_loaded), found = sums(layered, n_in_layer);
    ASSERT_EQ(wanted.size(), found.size());
    for (const auto &[key, value] : wanted)
      EXPECT_NEAR(found.at(key), value, 1e-14);
    EXPECT_GT(n_in_layer, 2. * n_loaded);
    const ForceBalance balance = layered.op().forces(
                         layered.values([](const auto &) { return dealii::Tensor<1, dim>(); }),
                         0.),
                       before = plain.op().forces(
                         plain.values([](const auto &) { return dealii::Tensor<1, dim>(); }),
                         0.);
    for (const auto &[name, force] : before.sides)
      for (unsigned int d = 0; d < dim; ++d)
        EXPECT_NEAR(balance.sides.at(name)[d], force[d], 1e-14);
  }
} // namespace


TEST(TractionLayer, carries_the_same_in_each_column)
{
  for (const std::string nodes : {"vertices", "cell centers"})
    {
      const Settings placed{{"Domain/Nodes", nodes}};
      check_columns<1>(placed, "right: 2", 0.125);
      check_columns<1>(placed, "right: 2", 0.14);
      check_columns<2>(placed, "right: 1 + y, 2 - y*y", 0.2);
      check_columns<2>(placed, "top: x, 1 ", 0.21);
      check_columns<2>(placed + Settings{{"Domain/Shape", "plate with hole"},
                                         {"Domain/Hole center", "0.85, 0.4"},
                                         {"Domain/Hole radius", "0.1"}},
                       "right: 1 + y, 2 - y*y",
                       0.2);
      check_columns<3>(placed, "front: x, y, 1", 0.3);
    }
}
