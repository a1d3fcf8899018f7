// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    const Settings plate{{"Domain/Cells", "21, 18"}, {"Domain/Upper corner", "1.05, 0.9"}};
    const Settings crack{{"Cracks/Segments", "0.2,0.31 ; 0.71,0.52"}};
    const Settings crack_on_nodes{{"Cracks/Segments", "0.2,0.45 ; 0.8,0.45"}};
    const Settings centers{{"Domain/Nodes", "cell centers"}};
    const Settings scaling{{"Peridynamics/Surface correction", "crack scaling"}};
    const Settings mirror{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                          {"Boundary conditions/Dirichlet", "left: 1 + y ; bottom: 2"},
                          {"Boundary conditions/Symmetry", "top"}};


    /** Both forms give the same residual, up to a few units in the last place of the largest. */
    template <int dim>
    void expect_same_forms(const std::string &what, const Settings &settings)
    {
      const Problem<dim> lattice(settings + Settings{{"Peridynamics/Operator form", "lattice"}}),
        stored(settings + Settings{{"Peridynamics/Operator form", "stored"}});
      EXPECT_EQ(lattice.op().size().form, "lattice");
      EXPECT_EQ(stored.op().size().form, "stored");
      EXPECT_EQ(lattice.op().size().bonds, stored.op().size().bonds) << what;
      Vector u = lattice.values(bumpy<dim>);
      lattice.op().distribute(u, 0.3);
      const Vector a = lattice.residual(u, 0.3), b = stored.residual(u, 0.3);
      const double size = u.linfty_norm() * lattice.op().diagonal().linfty_norm();
      EXPECT_LT(largest_difference(a, b), 1e-13 * size) << what;
      EXPECT_GT(a.linfty_norm(), 1e-6 * size) << what;
      EXPECT_LT(relative_difference(stored.op().diagonal(), lattice.op().diagonal()), 1e-13)
        << what;
    }


    template <int dim>
    void conserves(const std::string &what, const Settings &settings)
    {
      expect_conservation(Problem<dim>(settings), what, 2e-14);
    }
  } // namespace


  TEST(FieldOfBonds, lattice_form_is_stored_form_2D)
  {
    const Settings hole{{"Domain/Shape", "plate with hole"},
                        {"Domain/Hole center", "0.5, 0.4"},
                        {"Domain/Hole radius", "0.22"}};
    const Settings transmission{{"Cracks/Transmission", "0.25"}};
    for (const Settings &placement : {Settings(), centers})
      {
        const Settings    base  = plate + placement;
        const std::string where = placement.empty() ? "vertices" : "cell centers";
        expect_same_forms<2>(where, base);
        expect_same_forms<2>(where + ", crack", base + crack);
        expect_same_forms<2>(where + ", crack on nodes", base + crack_on_nodes + transmission);
        expect_same_forms<2>(where + ", scaled", base + crack + scaling);
        expect_same_forms<2>(where + ", hole", base + hole);
        expect_same_forms<2>(where + ", hole, crack", base + hole + crack + scaling);
        expect_same_forms<2>(where + ", mirror", base + mirror);
        expect_same_forms<2>(where + ", mirror, crack", base + mirror + crack + scaling);
        expect_same_forms<2>(
          where + ", constant layer",
          base + mirror + Settings{{"Peridynamics/Boundary treatment", "fictitious constant"}});
        expect_same_forms<2>(where + ", layer",
                             base + Settings{{"Peridynamics/Boundary treatment", "layer"},
                                             {"Peridynamics/Layer rows", "2"},
                                             {"Boundary conditions/Dirichlet", "left: y"}});
        expect_same_forms<2>(where + ", full volumes",
                             base + Settings{{"Peridynamics/Nodal volume", "full"}} + mirror);
        expect_same_forms<2>(where + ", self term",
                             base + Settings{{"Peridynamics/Self term", "paper"}} + crack);
        expect_same_forms<2>(where + ", self term, mirror",
                             base + Settings{{"Peridynamics/Self term", "paper"}} + mirror);
        expect_same_forms<2>(
          where + ", slaves",
          base + Settings{{"Peridynamics/Flux treatment", "extrapolation"},
                          {"Boundary conditions/Dirichlet", "left: 1"},
                          {"Boundary conditions/Flux", "right: 2 ; bottom: 0 ; top: y"}});
        expect_same_forms<2>(
          where + ", oblong cells",
          base + crack + Settings{{"Domain/Cells", "21, 54"}, {"Peridynamics/Horizon", "0.17"}});
        for (const std::string kernel : {"constant", "gaussian"})
          expect_same_forms<2>(where + ", " + kernel,
                               base + Settings{{"Peridynamics/Kernel", kernel},
                                               {"Peridynamics/Kernel exponent", "1"},
                                               {"Peridynamics/Volume fraction", "exact"},
                                               {"Peridynamics/Horizon ratio", "4.3"},
                                               {"Peridynamics/Calibration", "analytic"}});
      }
  }


  TEST(FieldOfBonds, lattice_form_is_stored_form_1D)
  {
    for (const std::string cells : {"40", "37"})
      for (const Settings &placement : {Settings(), centers})
        {
          const Settings bar = placement + Settings{{"Domain/Cells", cells}};
          expect_same_forms<1>("bar", bar);
          expect_same_forms<1>("self term", bar + Settings{{"Peridynamics/Self term", "paper"}});
          expect_same_forms<1>("mirror",
                               bar +
                                 Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                                          {"Boundary conditions/Dirichlet", "left: 1 + t"},
                                          {"Boundary conditions/Symmetry", "right"}});
          expect_same_forms<1>("layer extrapolation",
                               bar +
                                 Settings{{"Peridynamics/Flux treatment", "layer extrapolation"},
                                          {"Boundary conditions/Flux", "right: 1"},
                                          {"Boundary conditions/Dirichlet", "left: 1"}});
        }
  }


  TEST(FieldOfBonds, lattice_form_is_stored_form_3D)
  {
    const Settings square{
      {"Cracks/Polygons", "0.2,0.2,0.52 ; 0.8,0.2,0.52 ; 0.8,0.8,0.61 ; 0.2,0.8,0.61"}};
    for (const Settings &placement : {Settings(), centers})
      {
        const Settings brick = placement + Settings{{"Domain/Cells", "10, 9, 8"},
                                                    {"Domain/Upper corner", "1, 0.9, 0.8"},
                                                    {"Peridynamics/Horizon ratio", "2"}};
        expect_same_forms<3>("brick", brick);
        expect_same_forms<3>("crack", brick + square + scaling);
        expect_same_forms<3>(
          "mirror",
          brick + square +
            Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                     {"Boundary conditions/Dirichlet", "left: 1 ; bottom: 2 ; front: x"},
                     {"Boundary conditions/Symmetry", "top"}});
      }
  }


  TEST(FieldOfBonds, conserves_heat_and_is_semidefinite)
  {
    const Settings small{{"Domain/Cells", "9, 7"}, {"Domain/Upper corner", "0.9, 0.7"}};
    const Settings through{{"Cracks/Segments", "0.2,0.3 ; 0.7,0.45"}};
    for (const Settings &placement : {Settings(), centers})
      for (const std::string form : {"lattice", "stored"})
        {
          const Settings base = small + placement + Settings{{"Peridynamics/Operator form", form}};
          conserves<2>("plain", base);
          conserves<2>("crack", base + through);
          conserves<2>("scaled", base + through + scaling);
          conserves<2>("contact", base + through + Settings{{"Cracks/Contact conductance", "3"}});
        }
    const Settings varying{{"Material/Conductivity", "1 + x*x + 3*(y > 0.4)"}};
    for (const std::string rule : {"minimum", "arithmetic", "harmonic"})
      conserves<2>(rule, small + varying + through + Settings{{"Material/Interface rule", rule}});
    conserves<2>("doubled",
                 Settings{{"Domain/Cells", "8, 8"},
                          {"Cracks/Mesh", "faces"},
                          {"Cracks/Segments", "0.25,0.5 ; 0.75,0.5"}});
    conserves<1>("bar", {{"Domain/Cells", "19"}});
    conserves<3>("brick", {{"Domain/Cells", "4, 4, 4"}, {"Peridynamics/Horizon ratio", "2"}});
  }


  namespace
  {
    /**
     * Largest |K u - expected V| / V among nodes with a full family, relative to the size of the
     * terms.
     */
    template <int dim>
    double interior_defect(const Settings                                  &settings,
                           const double                                     expected,
                           const std::function<double(const Point<dim> &)> &field)
    {
      const Problem<dim> problem(settings);
      const auto        &scene = problem.scene;
      const Vector       u = problem.values(field), y = problem.product(u);
      double             largest = 0.;
      unsigned int       n       = 0;
      const double       size    = u.linfty_norm();
      const double reach = bonds_of(problem.op()).diffusion_bonds().weights().reach() * (1. + 1e-9);
      for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
        {
          bool inside = true;
          for (unsigned int d = 0; d < dim; ++d)
            inside = inside && problem.positions[i][d] > scene.domain.lower[d] + reach &&
                     problem.positions[i][d] < scene.domain.upper[d] - reach;
          if (!inside)
            continue;
          ++n;
          const double volume = problem.nodes->volume(i);
          largest             = std::max(largest,
                             std::abs(y.local_element(i) - expected * volume) /
                               (size * problem.op().diagonal().local_element(i) * 1e-3 +
                                std::abs(expected) * volume));
        }
      EXPECT_GT(sum_of_all(n), 10u);
      return max_of_all(largest);
    }
  } // namespace


  TEST(FieldOfBonds, linear_and_quadratic_fields)
  {
    // K u = -kappa Laplace(u) V, exactly for quadratics with discrete calibration: -2 kappa V for
    // x^2.
    for (const std::string kernel : {"constant", "conical", "gaussian"})
      for (const Settings &placement : {Settings(), centers})
        {
          const Settings common =
            placement + Settings{{"Peridynamics/Kernel", kernel}, {"Material/Conductivity", "1.7"}};
          const Settings bar    = common + Settings{{"Domain/Cells", "40"}},
                         square = common + Settings{{"Domain/Cells", "24, 24"},
                                                    {"Peridynamics/Horizon ratio", "3.6"}},
                         oblong = common + Settings{{"Domain/Cells", "12, 36"},
                                                    {"Peridynamics/Horizon", "0.26"}},
                         brick  = common + Settings{{"Domain/Cells", "9, 9, 9"},
                                                   {"Peridynamics/Horizon ratio", "2"}};
          const auto line       = [](const auto &p) { return 3. * p[0]; };
          const auto plane      = [](const auto &p) { return 3. * p[0] - p[1]; };
          const auto space      = [](const auto &p) { return p[0] - p[1] + 2. * p[2]; };
          const auto xx         = [](const auto &p) { return p[0] * p[0]; };
          const auto yy         = [](const auto &p) { return p[1] * p[1]; };
          const auto zz         = [](const auto &p) { return p[2] * p[2]; };
          const auto xy         = [](const auto &p) { return p[0] * p[1]; };
          EXPECT_LT(interior_defect<1>(bar, 0., line), 1e-12);
          EXPECT_LT(interior_defect<1>(bar, -3.4, xx), 1e-11);
          for (const Settings &body : {square, oblong})
            {
              EXPECT_LT(interior_defect<2>(body, 0., plane), 1e-12);
              EXPECT_LT(interior_defect<2>(body, -3.4, xx), 1e-11);
              EXPECT_LT(interior_defect<2>(body, -3.4, yy), 1e-11);
              EXPECT_LT(interior_defect<2>(body, 0., xy), 1e-11);
            }
          EXPECT_LT(interior_defect<3>(brick, 0., space), 1e-12);
          EXPECT_LT(interior_defect<3>(brick, -3.4, zz), 1e-11);
        }
  }


  TEST(FieldOfBonds, number_of_bonds)
  {
    // On 30 x 30 nodes: each offset (a, b) of half a family gives (30 - a)(30 - b) bonds.
    for (const std::string form : {"lattice", "stored"})
      {
        const Problem<2> problem(
          {{"Domain/Cells", "29, 29"}, {"Peridynamics/Operator form", form}});
        unsigned long long n = 0;
        for (int a = -4; a <= 4; ++a)
          for (int b = -4; b <= 4; ++b)
            if ((b > 0 || (b == 0 && a > 0)) && a * a + b * b < 3.5 * 3.5)
              n += (30 - std::abs(a)) * (30 - std::abs(b));
        EXPECT_EQ(problem.op().size().bonds, n);
      }
  }


  TEST(FieldOfBonds, capacity_and_loads)
  {
    const Problem<2> problem({{"Domain/Cells", "10, 10"},
                              {"Material/Density", "2"},
                              {"Material/Heat capacity", "3 + x"},
                              {"Initial and source/Source", "1 + t"},
                              {"Boundary conditions/Flux", "top: 2*t"},
                              {"Boundary conditions/Convection", "left: 4, 10*t"}});
    const Vector    &capacity = problem.op().lumped_capacity();
    EXPECT_NEAR(capacity.mean_value() * capacity.size(), 7., 1e-12);
    EXPECT_TRUE(problem.op().depends_on_time());
    EXPECT_TRUE(problem.op().has_steady_state());
    // At zero temperature the residual is the load.
    const Vector u = problem.vector(), r = problem.residual(u, 3.);
    EXPECT_NEAR(r.mean_value() * r.size(), 4. + 6. + 4. * 30., 1e-12 * 130.);
    const Balance balance = problem.op().balance(u, 3., false);
    EXPECT_NEAR(balance.sources, 4., 1e-13);
    EXPECT_NEAR(balance.sides.at("top"), 6., 1e-13);
    EXPECT_NEAR(balance.sides.at("left"), 120., 1e-11);
    EXPECT_NEAR(balance.stored, 130., 1e-11);
  }
} // namespace PeriDeal
