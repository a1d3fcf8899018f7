// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/coupling_certificate.h>

#include "distorted_mesh.h"
#include "elastic_coupling_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  template <int dim>
  Settings on(const std::string &mesh, const std::string &horizon, const std::string &zone)
  {
    return {{"Domain/Shape", "mesh file"},
            {"Domain/Mesh file", mesh},
            {"Material/Young modulus", "3"},
            {"Peridynamics/Horizon", horizon},
            {"Boundary conditions/Displacement", dim == 2 ? "0: 0, 0" : "0: 0, 0, 0"},
            {"Coupling/Zone", zone}};
  }


  /** Linear patch, symmetry, momentum and moment of momentum, positive remainders. */
  template <int dim>
  void check(const Settings &settings, const double least_kept)
  {
    const Body<dim>           body(settings, ModelKind::coupled);
    const CouplingCertificate found = examine_coupling(*body.elements);
    EXPECT_LT(defect(body, linear_field<dim>), 1e-12);
    EXPECT_LT(asymmetry(body), 1e-13);
    EXPECT_LT(unbalanced(body), 1e-13);
    EXPECT_LT(found.linear, 1e-12);
    EXPECT_GT(found.lowest_remainder, -1e-12);
    EXPECT_GT(found.lowest_eigenvalue, 0.);
    EXPECT_GT(found.kept_share, least_kept);
    EXPECT_GT(body.elements->size().bonds, 0u);
  }
} // namespace


TEST(ElasticMeshExchange, quadrilaterals_distorted_by_30_percent)
{
  const std::string mesh = distorted_mesh<2>(12, 0.3);
  for (const std::string zone : {"everywhere", "0.3 - max(abs(x - 0.5), abs(y - 0.5))", "0.55 - x"})
    for (const std::string nu : {"-0.3", "0", "0.3", "0.45"})
      for (const std::string plane : {"stress", "strain"})
        check<2>(on<2>(mesh, "0.25", zone) +
                   Settings{{"Material/Poisson ratio", nu}, {"Elasticity/Plane", plane}},
                 0.3);
}


TEST(ElasticMeshExchange, hexahedra_distorted_by_10_percent)
{
  const std::string mesh = distorted_mesh<3>(6, 0.1);
  for (const std::string zone : {"everywhere", "0.55 - x"})
    for (const std::string nu : {"0.1", "0.25", "0.4"})
      check<3>(on<3>(mesh, "0.4", zone) + Settings{{"Material/Poisson ratio", nu}}, 0.3);
}


TEST(ElasticMeshExchange, crack_cut_into_a_lattice)
{
  const Settings faces{{"Domain/Cells", "14, 12"},
                       {"Cracks/Segments", "0.4,0.6 ; 1,0.6"},
                       {"Cracks/Mesh", "faces"}};
  for (const std::string zone : {"everywhere", "cracks: 1"})
    check<2>(zoned<2>(zone, 0.3) + faces, 0.6);
}


TEST(ElasticMeshExchange, free_thermal_expansion)
{
  const Settings warm{{"Material/Thermal expansion", "0.001"},
                      {"Material/Poisson ratio", "0.3"},
                      {"Elasticity/Temperature change", "10"}};
  const Body<2>  body(on<2>(distorted_mesh<2>(12, 0.3), "0.25", "0.55 - x") + warm,
                     ModelKind::coupled);
  expect_free_expansion(body, 0.01, 1e-13);
}


TEST(ElasticMeshExchange, same_on_all_processes)
{
  expect_same_on_all_processes(on<2>(distorted_mesh<2>(12, 0.3), "0.25", "cracks: 1") +
                               Settings{{"Material/Poisson ratio", "0.3"},
                                        {"Cracks/Segments", "0.2,0.31 ; 0.71,0.52"},
                                        {"Peridynamics/Surface correction", "crack scaling"}});
}
