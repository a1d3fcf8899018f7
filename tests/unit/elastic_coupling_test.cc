// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/laws/elasticity.h>
#include <perideal/solvers/linear_solver.h>

#include <cmath>

#include "elastic_coupling_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  /** Linear patch, symmetry, momentum and moment of momentum, positive remainders. */
  template <int dim>
  void check_patch(const Settings &settings)
  {
    const Body<dim> body(settings, ModelKind::coupled);
    EXPECT_LT(defect(body, linear_field<dim>), 1e-12);
    EXPECT_LT(asymmetry(body), 1e-13);
    EXPECT_LT(unbalanced(body), 1e-13);
    EXPECT_GT(body.elements->lowest_remainder(), -1e-12);
  }


} // namespace


TEST(ElasticExchange, linear_patch)
{
  check_patch<1>(zoned<1>("x - 0.75", 0.));
  check_patch<1>(zoned<1>("everywhere", 0.));
  for (const std::string zone :
       {"everywhere", "0.16 - (x-0.6)^2 - (y-0.5)^2", "x - 0.75", "sin(50*x)*sin(70*y+1)"})
    {
      for (const double nu : {-0.3, 0., 0.2, 1. / 3., 0.45})
        check_patch<2>(zoned<2>(zone, nu));
      for (const double nu : {-0.3, 0., 0.25, 0.45})
        check_patch<2>(zoned<2>(zone, nu, "strain"));
    }
  for (const std::string zone : {"everywhere", "x - 0.35", "sin(50*x)*sin(70*y+1) + z - 0.3"})
    for (const double nu : {-0.2, 0.25, 0.45})
      check_patch<3>(zoned<3>(zone, nu));
}


TEST(ElasticExchange, linear_patch_on_rectangles)
{
  check_patch<2>(zoned<2>("x - 0.75", 0.3) + Settings{{"Domain/Upper corner", "1.4, 1.8"}});
  check_patch<3>(zoned<3>("x - 0.35", 0.3) + Settings{{"Domain/Upper corner", "0.8, 0.84, 0.66"}});
}


TEST(ElasticExchange, linear_patch_on_graded_meshes)
{
  const auto graded = [](const std::string &n, const std::string &cells, const std::string &fine) {
    return Settings{{"Domain/Cells", cells}, {"Domain/Coarsening", n}, {"Domain/Fine where", fine}};
  };
  for (const std::string ratio : {"2", "3"})
    for (const std::string levels : {"1", "2"})
      {
        const Settings m{{"Peridynamics/Horizon ratio", ratio}};
        check_patch<2>(zoned<2>("0.1 - abs(x-0.8)", 0.3) +
                       graded(levels, "28, 24", "0.1 - abs(x-0.8)") + m);
        check_patch<2>(zoned<2>("0.03 - (x-0.6)^2 - (y-0.5)^2", 0.2, "strain") +
                       graded(levels, "28, 24", "-1") + m);
      }
  check_patch<1>(zoned<1>("x - 1.2", 0.) + graded("2", "32", "x - 1.2"));
  check_patch<3>(zoned<3>("x - 0.55", 0.25) + graded("1", "16, 14, 12", "x - 0.55"));
}


TEST(ElasticExchange, layers_stay_exact)
{
  // Two phases in series: the strain jumps at the interface, across which no bond is active.
  const Settings layers =
    zoned<2>("everywhere", 0.) + Settings{{"Material/Young modulus", "3"},
                                          {"Material/Phases/Regions", "stiff: x > 0.7"},
                                          {"Material/Phases/Young modulus", "stiff: 30"}};
  const Body<2> body(layers, ModelKind::coupled);
  Matrix        with;
  body.elements->assemble_intact(with, true);
  Vector y = body.vector(), x = body.values([](const dealii::Point<2> &p) {
    return dealii::Tensor<1, 2>({p[0] < 0.7 ? p[0] : 0.7 + 0.1 * (p[0] - 0.7), 0.});
  });
  with.vmult(y, x);
  for (unsigned int i = 0; i < y.locally_owned_size() / 2; ++i)
    if (body.position(i)[0] > 0.01 && body.position(i)[0] < 1.39)
      {
        EXPECT_NEAR(y.local_element(2 * i), 0., 1e-12);
      }
}


TEST(ElasticExchange, free_thermal_expansion)
{
  constexpr auto coupled = ModelKind::coupled;
  const Settings warm{{"Material/Thermal expansion", "0.001"},
                      {"Elasticity/Temperature change", "10"}};
  // alpha dT, in plane strain times 1 + nu
  expect_free_expansion(Body<2>(zoned<2>("x - 0.7", 0.3) + warm, coupled), 0.01, 1e-13);
  expect_free_expansion(Body<2>(zoned<2>("x - 0.7", 0.3, "strain") + warm, coupled), 0.013, 1e-13);
  expect_free_expansion(Body<3>(zoned<3>("x - 0.3", 0.2) + warm, coupled), 0.01, 1e-13);
}


TEST(ElasticExchange, same_on_all_processes)
{
  expect_same_on_all_processes(zoned<2>("cracks: 1", 0.3) +
                               Settings{{"Cracks/Segments", "0.4, 0.55 ; 1.0, 0.75"},
                                        {"Peridynamics/Surface correction", "crack scaling"}});
  expect_same_on_all_processes(zoned<2>("cracks: 0.5", 0.3) +
                               Settings{{"Domain/Cells", "56, 48"},
                                        {"Domain/Coarsening", "2"},
                                        {"Cracks/Segments", "0.4, 0.55 ; 0.7, 0.65"}});
}


namespace
{
  const std::vector<std::string> schemes{"splice", "blending"};

  const Settings nodal{{"Elasticity/Model", "correspondence"},
                       {"Peridynamics/Horizon ratio", "2"},
                       {"Peridynamics/Kernel exponent", "auto"},
                       {"Peridynamics/Operator form", "stored"}};

  /** Without the moduli of box(). */
  Settings nodal_orthotropic(const unsigned int dim)
  {
    return nodal + Settings{{"Material/Young modulus", ""},
                            {"Material/Poisson ratio", ""},
                            {"Material/Young moduli", "15, 2, 3"},
                            {"Material/Shear moduli", "1, 0.8, 0.7"},
                            {"Material/Poisson ratios", "0.3, 0.25, 0.2"},
                            {"Material/Material angle", dim == 3 ? "20, 30, 40" : "25"}};
  }


  /**
   * A block in the middle, with its overlap of half a horizon more than two horizons of 0.2 clear
   * of the surface.
   */
  template <int dim>
  Settings block(const std::string &scheme, const std::string &overlap = "0")
  {
    const std::string half     = overlap == "0" ? "0.15" : "0.05";
    const std::string zones[]  = {"",
                                  half + " - abs(x-0.8)",
                                  half + " - max(abs(x-0.7), abs(y-0.6))",
                                  half + " - max(max(abs(x-0.6), abs(y-0.6)), abs(z-0.6))"};
    Settings          settings = zoned<dim>(zones[dim], 0.25);
    if (dim == 3)
      settings = settings +
                 Settings{{"Domain/Upper corner", "1.2, 1.2, 1.2"}, {"Domain/Cells", "12, 12, 12"}};
    return settings + Settings{{"Peridynamics/Horizon ratio", "2"},
                               {"Coupling/Scheme", scheme},
                               {"Coupling/Overlap", overlap}};
  }


  /**
   * With peridynamics everywhere both schemes are the operator of peridynamics, heat and cracks
   * included.
   */
  template <int dim>
  void expect_peridynamics(const std::string &scheme, const Settings &more = {})
  {
    Settings settings = zoned<dim>("everywhere", dim == 1 ? 0. : 0.4) +
                        Settings{{"Coupling/Scheme", scheme},
                                 {"Material/Thermal expansion", "0.001"},
                                 {"Elasticity/Temperature change", "3 + x*x + 2*x"}} +
                        more;
    const Body<dim> coupled(settings, ModelKind::coupled), alone(settings, ModelKind::peridynamics);
    // Both have ghosts of their own.
    const Vector x = coupled.values(bumpy_vector<dim>), x_alone = alone.values(bumpy_vector<dim>);
    const auto   expect_same = [&](const std::string &what, const Vector &y, const Vector &z) {
      EXPECT_LE(largest_difference(y, z), 1e-13 * y.linfty_norm())
        << scheme << ", " << dim << "D: " << what;
    };
    expect_same("K", coupled.product(x), alone.product(x_alone));
    expect_same("forces", coupled.unbalanced(x), alone.unbalanced(x_alone));
    EXPECT_NEAR(coupled.op().energy(x) / alone.op().energy(x_alone), 1., 1e-12);
    EXPECT_EQ(coupled.op().size().bonds, alone.op().size().bonds);

    for (const Body<dim> *body : {&coupled, &alone})
      {
        Vector warmer;
        body->op().initialize_nodal_vector(warmer);
        for (unsigned int i = 0; i < warmer.locally_owned_size(); ++i)
          warmer.local_element(i) = 2. + body->position(i)[0];
        body->op().set_temperature_change(warmer);
      }
    expect_same("another temperature", coupled.unbalanced(x), alone.unbalanced(x_alone));
  }
} // namespace


TEST(StateCouplings, everywhere_is_peridynamics)
{
  for (const std::string &scheme : schemes)
    {
      expect_peridynamics<1>(scheme);
      expect_peridynamics<2>(scheme,
                             {{"Cracks/Segments", "0.43, 0.55 ; 1.01, 0.75"},
                              {"Elasticity/Contact", "false"}}); // which these do not know
      expect_peridynamics<2>(scheme,
                             {{"Elasticity/Plane", "strain"},
                              {"Material/Phases/Regions", "stiff: x > 0.7"},
                              {"Material/Phases/Young modulus", "stiff: 30"}});
      expect_peridynamics<3>(scheme);
      expect_peridynamics<2>(scheme,
                             nodal + Settings{{"Cracks/Segments", "0.43, 0.55 ; 1.01, 0.75"},
                                              {"Elasticity/Contact", "false"}});
      expect_peridynamics<2>(scheme, nodal + Settings{{"Elasticity/Plane", "strain"}});
      expect_peridynamics<3>(scheme, nodal);
    }
}


TEST(StateCouplings, orthotropic_bodies_everywhere_are_correspondence)
{
  const auto check = [](const auto &coupled, const auto &alone, const auto &field) {
    const Vector x = coupled.values(field), y = coupled.product(x),
                 z = alone.product(alone.values(field));
    EXPECT_LE(largest_difference(y, z), 1e-13 * y.linfty_norm());
    EXPECT_NEAR(coupled.op().energy(x) / alone.op().energy(alone.values(field)), 1., 1e-12);
  };
  const Settings blended{{"Coupling/Scheme", "blending"}};
  for (const std::string plane : {"stress", "strain"})
    {
      const Settings plate = zoned<2>("everywhere", 0., plane) + nodal_orthotropic(2) + blended;
      check(Body<2>(plate, ModelKind::coupled),
            Body<2>(plate, ModelKind::peridynamics),
            bumpy_vector<2>);
    }
  const Settings block_3d = zoned<3>("everywhere", 0.) + nodal_orthotropic(3) + blended;
  check(Body<3>(block_3d, ModelKind::coupled),
        Body<3>(block_3d, ModelKind::peridynamics),
        bumpy_vector<3>);
}


TEST(StateCouplings, splice_is_exact_for_linear_fields_but_does_not_balance)
{
  for (const std::string overlap : {"0", "0.5"})
    {
      const Body<1> bar(block<1>("splice", overlap), ModelKind::coupled);
      const Body<2> plate(block<2>("splice", overlap), ModelKind::coupled);
      EXPECT_LT(defect(bar, linear_field<1>), 1e-13);
      EXPECT_LT(defect(plate, linear_field<2>), 1e-13);
      EXPECT_LT(defect(Body<3>(block<3>("splice", overlap), ModelKind::coupled), linear_field<3>),
                1e-13);
      EXPECT_LT(
        defect(Body<2>(block<2>("splice", overlap) + nodal_orthotropic(2), ModelKind::coupled),
               linear_field<2>),
        1e-13);
      EXPECT_FALSE(plate.elements->symmetric());
      EXPECT_GT(asymmetry(plate), 1e-3);
      EXPECT_GT(unbalanced(plate), 1e-4);
    }
}


TEST(StateCouplings, blending_balances_but_is_not_exact)
{
  for (const std::string overlap : {"0", "0.5", "1"})
    {
      const Body<2> plate(block<2>("blending", overlap), ModelKind::coupled);
      EXPECT_TRUE(plate.elements->symmetric());
      EXPECT_LT(asymmetry(plate), 1e-14);
      EXPECT_LT(unbalanced(plate), 1e-14);
      EXPECT_GE(plate.elements->lowest_remainder(), -1e-14);
      const double linear = defect(plate, linear_field<2>);
      EXPECT_GT(linear, 1e-2);
      EXPECT_LT(linear, 0.3);
    }
  for (const Settings &more : {Settings{}, nodal, nodal_orthotropic(3)})
    {
      const Body<3> block_3d(block<3>("blending", "0.5") + more, ModelKind::coupled);
      EXPECT_LT(asymmetry(block_3d), 1e-14);
      EXPECT_LT(unbalanced(block_3d), 1e-14);
      EXPECT_GE(block_3d.elements->lowest_remainder(), -1e-14);
    }
}


/** A uniform strain has its energy at all nodes and points, and the weights of both are one. */
TEST(StateCouplings, blended_correspondence_has_the_energy_of_uniform_strains)
{
  const auto check = [](const auto &blended, const auto &elements, const auto &field) {
    const double energy = elements.op().energy(elements.values(field));
    EXPECT_NEAR(blended.op().energy(blended.values(field)) / energy, 1., 1e-13);
    EXPECT_LT(defect(blended, field), 0.1);
  };
  for (const std::string overlap : {"0.5", "1"})
    for (const Settings &more : {nodal, nodal_orthotropic(2)})
      {
        const Settings plate = block<2>("blending", overlap) + more;
        check(Body<2>(plate, ModelKind::coupled),
              Body<2>(plate, ModelKind::finite_elements),
              linear_field<2>);
      }
}


/** The certificate says the same. */
TEST(StateCouplings, certificates)
{
  for (const std::string scheme : {"exchange", "splice", "blending"})
    {
      const Body<2> plate(block<2>(scheme) + Settings{{"Peridynamics/Calibration", "discrete"}},
                          ModelKind::coupled);
      const CouplingCertificate found = examine_coupling(*plate.elements);
      EXPECT_EQ(found.linear < 1e-12, scheme != "blending") << scheme << ": " << found.linear;
      EXPECT_EQ(found.asymmetry < 1e-13, scheme != "splice") << scheme << ": " << found.asymmetry;
      EXPECT_EQ(*found.unbalanced < 1e-13, scheme != "splice")
        << scheme << ": " << *found.unbalanced;
      EXPECT_EQ(found.fault().empty(), scheme == "exchange") << found.fault();
      EXPECT_GT(found.lowest_eigenvalue, 0.);
      EXPECT_GT(found.quadratic, 1e-7);
      EXPECT_LT(found.quadratic, 0.02);
      EXPECT_LT(found.cubic, 0.02);
    }
}


TEST(StateCouplings, free_thermal_expansion)
{
  for (const std::string &scheme : schemes)
    {
      const Settings warm{{"Material/Thermal expansion", "0.001"},
                          {"Elasticity/Temperature change", "10"}};
      SCOPED_TRACE(scheme);
      for (const Settings &more : {Settings{}, nodal})
        expect_free_expansion(Body<2>(block<2>(scheme, "0.5") + warm + more, ModelKind::coupled),
                              0.01,
                              1e-14);
    }
}


TEST(StateCouplings, same_on_all_processes)
{
  const Settings crack{{"Cracks/Segments", "0.4, 0.55 ; 1.0, 0.75"}};
  for (const std::string &scheme : schemes)
    {
      const Settings with{{"Coupling/Scheme", scheme}, {"Coupling/Overlap", "1"}};
      expect_same_on_all_processes(zoned<2>("cracks: 1", 0.3) + crack + with);
      expect_same_on_all_processes(zoned<2>("cracks: 1", 0.3) + crack + with +
                                   nodal_orthotropic(2));
      // Rows that reach far beyond the halo.
      expect_same_on_all_processes(zoned<2>("everywhere", 0.3) + crack + with +
                                   Settings{{"Peridynamics/Horizon ratio", "5"}});
      expect_same_on_all_processes(
        zoned<2>("x - 0.5", 0.3) + with +
        Settings{{"Peridynamics/Horizon ratio", "5"},
                 {"Peridynamics/Surface correction", "fictitious nodes"}});
    }
}
