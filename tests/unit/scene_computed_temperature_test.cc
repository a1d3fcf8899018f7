// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Elastic scenes whose temperature is computed: the heat problem in them, and what is said about
// mistakes.

#include "scene_tables.h"

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
    expect_elastic_faults(warm, R"(
Time/Steady=true & Boundary conditions/Dirichlet= & Boundary conditions/Convection= => Time/Steady | without a side in 'Dirichlet' or 'Convection' or 'Radiation'
Time/Steady=true & Boundary conditions/Dirichlet=right: t => Boundary conditions/Dirichlet | depends on t
Material/Conductivity=0 => Material/Conductivity | greater than 0
Boundary conditions/Flux=right: 1 => Boundary conditions/Flux | 'Dirichlet' | contradicts
Elasticity/Solver=dynamics => Elasticity/Temperature change | bodies at rest | 'dynamics'
Domain/Extra layers=3 => Domain/Extra layers | 'Temperature change = computed'
Time/Stepper=verlet => Time/Stepper | is for motion
Material/Thermal expansion=0 => Elasticity/Temperature change | 'Thermal expansion' in section 'Material' is 0
)");
    expect_elastic_faults({}, R"(
Boundary conditions/Dirichlet=left: 0 => Boundary conditions/Dirichlet | 'Temperature change = computed' in section 'Elasticity'
Boundary conditions/Flux=left: 0.1 => Boundary conditions/Flux | 'Temperature change = computed' in section 'Elasticity'
Boundary conditions/Convection=left: 1, 2 => Boundary conditions/Convection | 'Temperature change = computed' in section 'Elasticity'
Initial and source/Initial value=1 => Initial and source/Initial value | 'Temperature change = computed' in section 'Elasticity'
Initial and source/Source=1 => Initial and source/Source | 'Temperature change = computed' in section 'Elasticity'
Time/Stepper=sdirk2 => Time/Stepper | 'Temperature change = computed'
Elasticity/Reference temperature=20 => Elasticity/Reference temperature | 'Temperature change' is '0'
Elasticity/Temperature change=computd & Material/Thermal expansion=1 => Elasticity/Temperature change
)");
  }
} // namespace PeriDeal
