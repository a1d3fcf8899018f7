// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Elastic scenes whose temperature is computed: the heat problem in them, and what is said about
// mistakes.

#include "elastic_scene_tools.h"

namespace PeriDeal
{
  using namespace SceneTests;
  using dealii::Point;

  namespace
  {
    const std::string m = "Material/", b = "Boundary conditions/", e = "Elasticity/";
  } // namespace


  TEST(ElasticScenes, computed_temperature)
  {
    const Overrides warm{e + "Temperature change=computed",
                         m + "Thermal expansion=1e-5",
                         m + "Conductivity=3*x + 1",
                         b + "Dirichlet=right: 5",
                         b + "Convection=top: 2, 30"};
    const auto      with = [&](const Overrides &more) {
      Overrides all = warm;
      all.insert(all.end(), more.begin(), more.end());
      return all;
    };
    {
      Scene<2> scene;
      parse_scene<2>(elastic_scene<2>(with({"Time/Steady=true", e + "Reference temperature=20"})),
                     scene);
      EXPECT_TRUE(scene.elasticity.computes_temperature);
      EXPECT_EQ(scene.elasticity.reference_temperature, 20.);
      EXPECT_TRUE(is_zero(scene.elasticity.temperature_change));
      EXPECT_TRUE(scene.time.steady);
      EXPECT_FALSE(scene.warms_slowly());
      ASSERT_TRUE(scene.heat);
      EXPECT_EQ(scene.heat->general.physics, Physics::heat);
      EXPECT_TRUE(scene.heat->time.steady);
      EXPECT_TRUE(scene.heat->boundary_conditions.displacement.empty());
      EXPECT_EQ(scene.heat->boundary_conditions.dirichlet.size(), 1);
      EXPECT_EQ(scene.heat->boundary_conditions.transfers.size(), 1);
      EXPECT_EQ(scene.heat->material.conductivity.value(Point<2>(1., 0.)), 4.);
      EXPECT_EQ(scene.heat->peridynamics.kernel_exponent, 2);
      EXPECT_EQ(scene.peridynamics.kernel_exponent, 0);
    }
    for (const std::string correction : {"energy", "moments"})
      {
        Scene<2> scene;
        parse_scene<2>(elastic_scene<2>(with(
                         {"Time/Steady=true", "Peridynamics/Surface correction=" + correction})),
                       scene);
        EXPECT_EQ(scene.heat->peridynamics.surface_correction, SurfaceCorrection::none);
      }
    {
      Scene<2> scene; // slow loads and a steady temperature
      parse_scene<2>(elastic_scene<2>(with({"Time/Steady=true", b + "Traction=right: t, 0"})),
                     scene);
      EXPECT_FALSE(scene.time.steady);
      EXPECT_FALSE(scene.warms_slowly());
      EXPECT_TRUE(scene.is_loaded_slowly());
    }
    {
      Scene<2> scene; // one that changes
      parse_scene<2>(elastic_scene<2>(with({"Time/Stepper=sdirk2",
                                            "Output/Write every=0.25",
                                            "Initial and source/Initial value=x"})),
                     scene);
      EXPECT_FALSE(scene.time.steady);
      EXPECT_TRUE(scene.warms_slowly());
      EXPECT_EQ(scene.output.write_times.size(), 3);
    }
    expect(elastic_fault(with({"Time/Steady=true", b + "Dirichlet=", b + "Convection="})),
           "Time/Steady",
           {"without a side in 'Dirichlet' or 'Convection'"});
    expect(elastic_fault(with({"Time/Steady=true", b + "Dirichlet=right: t"})),
           b + "Dirichlet",
           {"depends on t"});
    expect(elastic_fault(with({m + "Conductivity=0"})), m + "Conductivity", {"greater than 0"});
    expect(elastic_fault(with({b + "Flux=right: 1"})), b + "Flux", {"'Dirichlet'", "contradicts"});
    expect(elastic_fault(with({e + "Solver=dynamics"})),
           e + "Temperature change",
           {"bodies at rest", "'dynamics'"});
    expect(elastic_fault(with({"Domain/Extra layers=3"})),
           "Domain/Extra layers",
           {"'Temperature change = computed'"});
    expect(elastic_fault(with({"Time/Stepper=verlet"})), "Time/Stepper", {"is for motion"});
    expect(elastic_fault(with({m + "Thermal expansion=0"})),
           e + "Temperature change",
           {"'Thermal expansion' in section 'Material' is 0"});
    const std::string or_computed = "'Temperature change = computed' in section 'Elasticity'";
    for (const std::string given : {"Dirichlet=left: 0", "Flux=left: 0.1", "Convection=left: 1, 2"})
      expect(elastic_fault({b + given}), b + given.substr(0, given.find('=')), {or_computed});
    for (const std::string given : {"Initial value=1", "Source=1"})
      expect(elastic_fault({"Initial and source/" + given}),
             "Initial and source/" + given.substr(0, given.find('=')),
             {or_computed});
    expect(elastic_fault({"Time/Stepper=sdirk2"}),
           "Time/Stepper",
           {"'Temperature change = computed'"});
    expect(elastic_fault({e + "Reference temperature=20"}),
           e + "Reference temperature",
           {"'Temperature change' is '0'"});
    expect(elastic_fault({e + "Temperature change=computd", m + "Thermal expansion=1"}),
           e + "Temperature change");
  }
} // namespace PeriDeal
