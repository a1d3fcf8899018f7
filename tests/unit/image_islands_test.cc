// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Parts of an image that nothing holds.

#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/operators/solid/state_operator.h>
#include <perideal/solvers/linear_solver.h>

#include "image_test_tools.h"

namespace PeriDeal
{
  using namespace ImageTests;
  using namespace OperatorTests;
  using dealii::Point;
  using SceneTests::expect_parts;

  TEST(Image, islands_are_named_and_removed)
  {
    // 3 cells that are not attached to anything.
    const Image    image({"99900099", "99000099", "99050099", "99055099", "99000099", "99999999"});
    const Settings body = image.settings({{"Domain/Nodes", "vertices"}});
    expect_parts(fault(body + elastic()),
                 {"'Islands' in section 'Domain'",
                  "1 part",
                  "3 cells around (3.83333, 2.83333)",
                  "'remove' or 'pin'"});
    EXPECT_EQ(fault(body + Settings{{"Time/End time", "1"}}), ""); // heat stays in a part
    expect_parts(
      fault(body + Settings{{"Time/Steady", "true"}, {"Boundary conditions/Dirichlet", "left: 0"}}),
      {"'Islands' in section 'Domain'", "3 cells", "steady state"});
    EXPECT_EQ(
      fault(body + Settings{{"Time/Steady", "true"}, {"Boundary conditions/Dirichlet", "hole: 0"}}),
      "");
    Scene<2> scene;
    fill(scene, body + elastic({{"Domain/Islands", "remove"}}));
    EXPECT_EQ(scene.domain.image->counts().back(), 48u - 29u);
    expect_parts(scene.domain.notes.front(), {"3 cells", "removed"});
    // With m = 3 bonds reach across the gap of one cell, if they may.
    const Settings with_bonds = image.settings() + elastic({{"Models", "peridynamics"}});
    expect_parts(fault(with_bonds), {"'Islands' in section 'Domain'", "3 cells"});
    Scene<2> bonds;
    fill(bonds, with_bonds + Settings{{"Peridynamics/Bonds across voids", "keep"}});
    EXPECT_EQ(bonds.domain.image->counts().back(), 48u - 32u);
    expect_parts(bonds.domain.notes.back(), {"reach across a void", "'Bonds across voids = cut'"});
    // What is held in one direction only is no better.
    const Image half({"9900999", "9900999"});
    expect_parts(fault(half.settings() + elastic({{"Boundary conditions/Displacement",
                                                   "left: 0, 0 ; right: 1, free"}})),
                 {"6 cells around (5.5, 1)"});
    expect_parts(fault(half.settings() +
                       elastic({{"Boundary conditions/Displacement", "left: 0, 0 ; right: 1, free"},
                                {"Domain/Islands", "remove"}})),
                 {"'remove'", "60 %"});
  }


  TEST(Image, islands_of_a_body_whose_temperature_is_computed)
  {
    const Image    image({"99900099", "99000099", "99050099", "99055099", "99000099", "99999999"});
    const Settings body = image.settings({{"Domain/Nodes", "vertices"}}) +
                          elastic({{"Elasticity/Temperature change", "computed"},
                                   {"Material/Thermal expansion", "1e-3"},
                                   {"Boundary conditions/Dirichlet", "left: 0"}});
    const Settings steady{{"Time/Steady", "true"}};
    const Settings in_time{{"Time/End time", "1"}};
    expect_parts(fault(body + steady), {"3 cells", "displacement", "'remove' or 'pin'"});
    expect_parts(fault(body + steady + Settings{{"Domain/Islands", "pin"}}),
                 {"heat problem", "3 cells", "temperature", "'Steady = false'"});
    EXPECT_EQ(fault(body + in_time + Settings{{"Domain/Islands", "pin"}}), "");
    // What the body loses its heat has lost, too; what it keeps stays.
    for (const Settings &times : {steady, in_time})
      {
        Scene<2> scene;
        fill(scene, body + times + Settings{{"Domain/Islands", "remove"}});
        EXPECT_EQ(scene.domain.image->counts().back(), 48u - 29u);
        EXPECT_EQ(scene.heat->domain.image->counts().back(), 48u - 29u);
      }
    const Image    half({"9900999", "9900999"});
    const Settings held =
      half.settings() + elastic({{"Elasticity/Temperature change", "computed"},
                                 {"Material/Thermal expansion", "1e-3"},
                                 {"Domain/Islands", "remove"},
                                 {"Boundary conditions/Displacement", "left: 0, 0 ; right: 0, 0"},
                                 {"Boundary conditions/Dirichlet", "left: 0"}});
    expect_parts(fault(held + steady), {"heat problem", "6 cells", "'Steady = false'"});
    Scene<2> scene;
    fill(scene, held + in_time);
    EXPECT_EQ(scene.heat->domain.image->counts().back(), 4u);
  }


  TEST(Image, pinned_islands_rest)
  {
    const Image image({"99900099", "99000099", "99050099", "99055099", "99000099", "99999999"});
    for (const std::string placement : {"vertices", "cell centers"})
      {
        Scene<2> scene;
        fill(scene,
             image.settings({{"Domain/Nodes", placement},
                             {"Domain/Islands", "pin"},
                             {"Domain/Cells per pixel", "2"},
                             {"Peridynamics/Horizon ratio", "2"}}) +
               elastic());
        EXPECT_EQ(scene.domain.islands.pins.size(), 6u);
        std::vector<std::string>         notes;
        const auto                       mesh = build_mesh(scene, MPI_COMM_WORLD, notes);
        dealii::DoFHandler<2>            handler(*mesh);
        std::unique_ptr<Nodes<2>>        nodes;
        std::unique_ptr<ElasticOperator> op;
        std::vector<Point<2>>            positions;
        if (placement == "vertices")
          {
            handler.distribute_dofs(dealii::FE_Q<2>(1));
            auto elements = std::make_unique<ElasticElements<2>>(handler, scene);
            for (unsigned int i = 0; i < handler.n_locally_owned_dofs(); ++i)
              positions.push_back(elements->position(i));
            op = std::move(elements);
          }
        else
          {
            handler.distribute_dofs(dealii::FE_DGQ<2>(0));
            number_along_lattice(handler, scene.domain);
            nodes =
              std::make_unique<Nodes<2>>(handler, scene.domain, scene.cracks, NodalVolume::partial);
            for (unsigned int i = 0; i < nodes->n_owned(); ++i)
              positions.push_back(nodes->position(i));
            op = std::make_unique<StateOperator<2>>(*nodes, scene);
          }
        Vector u, r, change;
        for (Vector *v : {&u, &r, &change})
          op->initialize_vector(*v);
        op->distribute(u, 0.);
        op->residual(r, u, 0.);
        LinearSolver solver(*op, 1e-12, 2000, 0);
        solver.solve(0., 1., change, r);
        u += change;
        for (unsigned int i = 0; i < positions.size(); ++i)
          if (std::abs(positions[i][0] - 4.) < 1.01 && std::abs(positions[i][1] - 3.) < 1.01)
            {
              for (unsigned int d = 0; d < 2; ++d)
                EXPECT_NEAR(u.local_element(2 * i + d), 0., 1e-8)
                  << placement << " at " << positions[i];
            }
        EXPECT_NEAR(op->forces(u, 0.).imbalance(), 0., 1e-8 * op->forces(u, 0.).throughput());
      }
  }
} // namespace PeriDeal
