// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Everything on all processes against the same on one process alone.


#include <perideal/solvers/stepper.h>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    const Settings cracked{{"Domain/Cells", "40, 36"},
                           {"Domain/Upper corner", "1, 0.9"},
                           {"Cracks/Segments", "0.2,0.31 ; 0.71,0.52 ; 0.3,0.7 ; 0.6,0.7"}};


    const Settings conditions{{"Boundary conditions/Dirichlet", "left: y ; top: 2*t"},
                              {"Boundary conditions/Flux", "right: 1"},
                              {"Boundary conditions/Convection", "bottom: 3, x"},
                              {"Initial and source/Source", "x*y"}};
    const Settings crossed{{"Domain/Cells", "32, 32"},
                           {"Cracks/Mesh", "faces"},
                           {"Cracks/Segments", "0.25,0.5 ; 0.75,0.5 ; 0.5,0.25 ; 0.5,0.75"}};
    const Settings hole{{"Domain/Shape", "plate with hole"},
                        {"Domain/Cells", "30, 30"},
                        {"Domain/Hole center", "0.4, 0.5"},
                        {"Domain/Hole radius", "0.2"},
                        {"Boundary conditions/Dirichlet", "hole: 1"}};
    const Settings brick{{"Domain/Cells", "12, 12, 8"},
                         {"Domain/Upper corner", "1.2, 1.2, 0.8"},
                         {"Peridynamics/Horizon ratio", "2.2"},
                         {"Cracks/Polygons", "0.2,0.2,0.43 ; 0.8,0.2,0.43 ; 0.8,0.8,0.61"},
                         {"Boundary conditions/Dirichlet", "left: y ; front: 1"}};


    /** Residual, diagonal and bounds agree to the given accuracy; zero: to the last bit. */
    template <int dim>
    void expect_same(const std::string &what,
                     const Settings    &settings,
                     const double       accuracy,
                     const ModelKind    model = ModelKind::peridynamics)
    {
      const Problem<dim> all(settings, model), alone(settings, model, MPI_COMM_SELF);
      const auto         residual = [](const Problem<dim> &problem) {
        Vector u = problem.values(bumpy<dim>);
        problem.op().distribute(u, 0.3);
        return problem.residual(u, 0.3);
      };
      const auto after_steps = [](const Problem<dim> &problem) {
        StepperOptions options;
        options.time_step = 0.5 / problem.op().spectrum().safe;
        Vector u          = problem.values(bumpy<dim>);
        problem.op().distribute(u, 0.);
        make_stepper("rk4", problem.op(), options)->advance(u, 0., 5. * options.time_step);
        return u;
      };
      const double size = alone.op().diagonal().linfty_norm();
      EXPECT_LE(difference(all, residual(all), alone, residual(alone)), accuracy * size) << what;
      EXPECT_LE(difference(all, all.op().diagonal(), alone, alone.op().diagonal()), accuracy * size)
        << what;
      EXPECT_LE(difference(all, all.op().lumped_capacity(), alone, alone.op().lumped_capacity()),
                accuracy)
        << what;
      if (all.op().capacity_is_diagonal())
        {
          EXPECT_LE(difference(all, after_steps(all), alone, after_steps(alone)), 10. * accuracy)
            << what;
        }
      EXPECT_EQ(all.op().size().bonds, alone.op().size().bonds) << what;
      EXPECT_EQ(all.op().size().unknowns, alone.op().size().unknowns) << what;
      EXPECT_NEAR(all.op().spectrum().sharp,
                  alone.op().spectrum().sharp,
                  1e-9 * alone.op().spectrum().sharp)
        << what;
      EXPECT_NEAR(all.op().spectrum().safe,
                  alone.op().spectrum().safe,
                  1e-12 * alone.op().spectrum().safe)
        << what;
    }
  } // namespace


  TEST(RankIndependence, peridynamics_to_the_last_bit_2D)
  {
    for (const std::string placement : {"vertices", "cell centers"})
      for (const std::string form : {"lattice", "stored"})
        {
          const Settings base =
            cracked + conditions +
            Settings{{"Domain/Nodes", placement}, {"Peridynamics/Operator form", form}};
          const std::string what = placement + ", " + form;
          expect_same<2>(what, base, 0.);
          expect_same<2>(what + ", mirror",
                         base + Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                                         {"Boundary conditions/Flux", ""},
                                         {"Boundary conditions/Symmetry", "right"}},
                         0.);
          expect_same<2>(what + ", scaled, wide",
                         base + Settings{{"Peridynamics/Surface correction", "crack scaling"},
                                         {"Peridynamics/Horizon ratio", "5.3"},
                                         {"Peridynamics/Boundary treatment", "layer"},
                                         {"Peridynamics/Layer rows", "3"}},
                         0.);
        }
  }


  TEST(RankIndependence, peridynamics_to_the_last_bit_1D_3D)
  {
    for (const std::string cells : {"40", "43"})
      expect_same<1>("bar " + cells,
                     {{"Domain/Cells", cells},
                      {"Peridynamics/Horizon ratio", "6"},
                      {"Boundary conditions/Dirichlet", "left: t"},
                      {"Peridynamics/Boundary treatment", "fictitious mirror"}},
                     0.);
    for (const std::string form : {"lattice", "stored"})
      expect_same<3>("brick", brick + Settings{{"Peridynamics/Operator form", form}}, 0.);
  }


  TEST(RankIndependence, peridynamics_off_the_plain_lattice)
  {
    expect_same<2>("doubled nodes", crossed, 0.);
    expect_same<2>("hole", hole + Settings{{"Boundary conditions/Symmetry", "left"}}, 0.);
    for (const std::string rule : {"minimum", "arithmetic", "harmonic"})
      expect_same<2>(rule,
                     cracked + Settings{{"Material/Conductivity", "1 + x + 4*(y > 0.44)"},
                                        {"Material/Interface rule", rule}},
                     0.);
  }


  TEST(RankIndependence, extrapolated_fluxes)
  {
    for (const std::string order :
         {"right: 2 ; bottom: x ; top: 0", "top: 0 ; right: 2 ; bottom: x"})
      expect_same<2>(order,
                     cracked + Settings{{"Peridynamics/Flux treatment", "extrapolation"},
                                        {"Boundary conditions/Dirichlet", "left: 1"},
                                        {"Boundary conditions/Flux", order}},
                     1e-13);
    for (const std::string m : {"3", "2.6", "4"})
      for (const std::string fraction : {"none", "linear"})
        expect_same<1>("layer, m = " + m,
                       {{"Domain/Cells", "40"},
                        {"Peridynamics/Horizon ratio", m},
                        {"Peridynamics/Volume fraction", fraction},
                        {"Peridynamics/Flux treatment", "layer extrapolation"},
                        {"Boundary conditions/Dirichlet", "left: 1"},
                        {"Boundary conditions/Flux", "right: 2"}},
                       1e-13);
  }


  TEST(RankIndependence, coupled)
  {
    for (const std::string scheme : {"exchange", "blending", "splice"})
      for (const std::string zone : {"cracks: 1", "everywhere", "0.4 - abs(x - 0.5)"})
        for (const std::string correction : {"none", "crack scaling"})
          expect_same<2>(scheme + ", " + zone + ", " + correction,
                         cracked + conditions +
                           Settings{{"Coupling/Scheme", scheme},
                                    {"Coupling/Zone", zone},
                                    {"Peridynamics/Surface correction", correction}},
                         1e-13,
                         ModelKind::coupled);
    expect_same<2>("materials and hole",
                   hole + Settings{{"Material/Conductivity", "1 + x + 4*(y > 0.44)"},
                                   {"Coupling/Zone", "everywhere"}},
                   1e-13,
                   ModelKind::coupled);
    expect_same<1>("bar",
                   {{"Domain/Cells", "33"}, {"Coupling/Zone", "0.6 - x"}},
                   1e-13,
                   ModelKind::coupled);
    for (const std::string zone : {"cracks: 0.5", "everywhere"})
      expect_same<3>("brick", brick + Settings{{"Coupling/Zone", zone}}, 1e-13, ModelKind::coupled);
  }


  TEST(RankIndependence, graded_meshes)
  {
    const Settings graded{{"Domain/Cells", "80, 72"},
                          {"Domain/Coarsening", "2"},
                          {"Peridynamics/Surface correction", "crack scaling"}};
    for (const ModelKind model : {ModelKind::coupled, ModelKind::finite_elements})
      {
        expect_same<2>("plate", cracked + conditions + graded, 1e-13, model);
        expect_same<3>("brick",
                       {{"Domain/Cells", "16, 16, 16"},
                        {"Domain/Coarsening", "2"},
                        {"Peridynamics/Horizon ratio", "2"},
                        {"Cracks/Polygons", "0.1,0.1,0.1 ; 0.2,0.1,0.1 ; 0.2,0.2,0.15"},
                        {"Coupling/Zone", "cracks: 0.5"},
                        {"Boundary conditions/Dirichlet", "left: y ; front: 1"}},
                       1e-13,
                       model);
        expect_same<1>("bar",
                       {{"Domain/Cells", "64"},
                        {"Domain/Coarsening", "2"},
                        {"Domain/Fine where", "0.2 - x"},
                        {"Coupling/Zone", "0.1 - x"}},
                       1e-13,
                       model);
      }
  }


  TEST(RankIndependence, finite_elements)
  {
    for (const std::string mesh : {"pairs", "removed"})
      expect_same<2>(mesh,
                     cracked + conditions + Settings{{"Cracks/Mesh", mesh}},
                     1e-13,
                     ModelKind::finite_elements);
    expect_same<2>("scaled, consistent",
                   cracked + conditions +
                     Settings{{"Peridynamics/Surface correction", "crack scaling"},
                              {"Finite elements/Capacity", "consistent"}},
                   1e-13,
                   ModelKind::finite_elements);
    expect_same<2>("faces", crossed, 1e-13, ModelKind::finite_elements);
    expect_same<1>("bar", {{"Domain/Cells", "33"}}, 1e-13, ModelKind::finite_elements);
    expect_same<3>("brick",
                   {{"Domain/Cells", "6, 6, 4"}, {"Boundary conditions/Dirichlet", "back: x"}},
                   1e-13,
                   ModelKind::finite_elements);
    expect_same<2>("Q2",
                   {{"Domain/Cells", "8, 8"},
                    {"Finite elements/Degree", "2"},
                    {"Boundary conditions/Dirichlet", "left: y*y"}},
                   1e-12,
                   ModelKind::finite_elements);
  }


  TEST(RankIndependence, steady_solutions)
  {
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      {
        const Settings settings =
          cracked + Settings{{"Boundary conditions/Dirichlet", "left: 1 ; right: y"}};
        const Problem<2> all(settings, model), alone(settings, model, MPI_COMM_SELF);
        EXPECT_LT(difference(all, all.steady(1e-13), alone, alone.steady(1e-13)), 1e-10);
      }
  }
} // namespace PeriDeal
