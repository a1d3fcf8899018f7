// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Elastic scenes: what bodies at rest do without, and the kinds of bonds.

#include "elastic_scene_tools.h"

namespace PeriDeal
{
  using namespace SceneTests;

  namespace
  {
    const std::string e = "Elasticity/";
  } // namespace


  TEST(ElasticScenes, only_motion_needs_density)
  {
    EXPECT_EQ(elastic_fault({"Material/Density=0"}), "");
    expect(elastic_fault({"Material/Density=0", e + "Solver=dynamics"}),
           "Material/Density",
           {"greater than 0"});
  }


  TEST(ElasticScenes, constant_micromodulus_is_for_bonds_alone)
  {
    const std::string bonds = e + "Model=bond-based", constant = e + "Micromodulus=constant";
    expect(elastic_fault({constant}), e + "Micromodulus", {"bond-based"});
    EXPECT_EQ(elastic_fault({"Models=peridynamics", bonds, constant}), "");
    expect(elastic_fault({"Models=finite elements", bonds, constant}),
           e + "Micromodulus",
           {"'peridynamics'"});
    expect(elastic_fault(
             {"Models=peridynamics", bonds, constant, "Peridynamics/Surface correction=moments"}),
           e + "Micromodulus",
           {"'Surface correction'"});
  }
} // namespace PeriDeal
