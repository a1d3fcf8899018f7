// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/numbers.h>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    const char *const kernels[] = {"constant", "conical", "gaussian"};


    /** All sides of a box named, each with the same text after the colon. */
    std::string on_sides(const unsigned int dim, const std::string &text)
    {
      std::string list;
      for (unsigned int s = 0; s < 2 * dim; ++s)
        list += (s > 0 ? ";" : "") + box_side_names()[s] + (text.empty() ? "" : ": " + text);
      return list;
    }


    std::string comma_list(const unsigned int dim, const std::string &text)
    {
      std::string list = text;
      for (unsigned int d = 1; d < dim; ++d)
        list += "," + text;
      return list;
    }


    Settings harmonic_box(const unsigned int dim,
                          const std::string &m,
                          const std::string &kernel,
                          const unsigned int n,
                          const std::string &placement)
    {
      return {{"Domain/Cells", comma_list(dim, "20")},
              {"Domain/Nodes", placement},
              {"Peridynamics/Horizon ratio", m},
              {"Peridynamics/Kernel", kernel},
              {"Peridynamics/Kernel exponent", std::to_string(n)}};
    }


    Settings mirror_box(const unsigned int dim)
    {
      return {{"Peridynamics/Boundary treatment", "fictitious mirror"},
              {"Boundary conditions/Dirichlet", on_sides(dim, "0")}};
    }


    template <int dim>
    double sines(const Point<dim> &p)
    {
      double s = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        s *= std::sin(dealii::numbers::PI * p[d]);
      return s;
    }


    /** Largest |C^{-1} K u - lambda u|, relative to lambda. */
    template <int dim>
    double eigenvector_residual(const Problem<dim> &problem, Vector u, const double lambda)
    {
      problem.op().distribute(u, 0.);
      const Vector r       = problem.residual(u);
      double       largest = 0.;
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        if (problem.op().diagonal().local_element(i) != 1. || r.local_element(i) != 0.)
          largest =
            std::max(largest,
                     std::abs(r.local_element(i) / problem.op().lumped_capacity().local_element(i) +
                              lambda * u.local_element(i)));
      return max_of_all(largest) / lambda;
    }


    // Calculated by an independent program (numpy): the lattice's eigenvalue of the product of
    // sines on 20 cells.
    const double lambda_1d[3][3] = {{9.6632771539588, 9.69874355642944, 9.74311667614839},
                                    {9.73411989596521, 9.76593062469284, 9.79711490608956},
                                    {9.76385471710018, 9.79228572387711, 9.81600705338756}};
    const double lambda_2d[3][3] = {{19.3504712840649, 19.3927794156245, 19.4464026787584},
                                    {19.4541887752557, 19.5001227089786, 19.5482242423404},
                                    {19.5136903469776, 19.5564502687756, 19.5958055800045}};
    const double lambda_3d[3][3] = {{28.8481766586912, 28.9072520710594, 28.9818934484461},
                                    {29.0255490359774, 29.095421996098, 29.1739370556158},
                                    {29.1251162553531, 29.1968187756035, 29.2703989196857}};


    template <int dim>
    void expect_harmonics(const std::string &m, const double (&lambda)[3][3])
    {
      const bool alone = n_processes() == 1;
      for (const std::string placement : {"vertices", "cell centers"})
        for (unsigned int k = 0; k < 3; ++k)
          for (unsigned int n = 0; n < 3; ++n)
            for (const std::string form : {"lattice", "stored"})
              {
                if (dim == 3 && n != 2 && (form == "stored" || !alone))
                  continue; // slow
                const Problem<dim> problem(harmonic_box(dim, m, kernels[k], n, placement) +
                                           mirror_box(dim) +
                                           Settings{{"Peridynamics/Operator form", form}});
                EXPECT_LT(eigenvector_residual(problem, problem.values(sines<dim>), lambda[k][n]),
                          2e-13)
                  << dim << "D, " << placement << ", " << kernels[k] << ", n = " << n << ", "
                  << form;
              }
    }
  } // namespace


  TEST(FictitiousNodes, sines_are_eigenvectors_1D)
  {
    expect_harmonics<1>("4", lambda_1d);
  }

  TEST(FictitiousNodes, sines_are_eigenvectors_2D)
  {
    expect_harmonics<2>("3", lambda_2d);
  }

  TEST(FictitiousNodes, sines_are_eigenvectors_3D)
  {
    expect_harmonics<3>("3", lambda_3d);
  }


  TEST(FictitiousNodes, cosines_on_symmetry_sides)
  {
    // Cosines across symmetry planes, in 2D mixed with sines; eigenvalues are those of the sines.
    const auto mixed = [](const Point<2> &p) {
      return std::cos(dealii::numbers::PI * p[0]) * std::sin(dealii::numbers::PI * p[1]);
    };
    const auto both = [](const Point<2> &p) {
      return std::cos(dealii::numbers::PI * p[0]) * std::cos(dealii::numbers::PI * p[1]);
    };
    for (const std::string placement : {"vertices", "cell centers"})
      for (unsigned int k = 0; k < 3; ++k)
        {
          const Settings   box = harmonic_box(2, "3", kernels[k], 2, placement);
          const Problem<2> all(
            box + Settings{{"Boundary conditions/Symmetry", "left, right, bottom, top"}});
          EXPECT_LT(eigenvector_residual(all, all.values(both), lambda_2d[k][2]), 2e-13);
          const Problem<2> two(box +
                               Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                                        {"Boundary conditions/Dirichlet", "bottom: 0 ; top: 0"},
                                        {"Boundary conditions/Symmetry", "left, right"}});
          EXPECT_LT(eigenvector_residual(two, two.values(mixed), lambda_2d[k][2]), 2e-13);
        }
  }


  TEST(FictitiousNodes, linear_field_between_mirrors_is_steady)
  {
    // T = 1 + 2 x, mirrored about its own boundary values, is linear to the outside, too.
    const auto f = [](const Point<2> &p) { return 1. + 2. * p[0]; };
    for (const std::string placement : {"vertices", "cell centers"})
      {
        const Problem<2> problem(
          harmonic_box(2, "3", "conical", 2, placement) +
          Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                   {"Boundary conditions/Dirichlet", "left: 1 ; right: 1 + 2*x"},
                   {"Boundary conditions/Symmetry", "bottom, top"}});
        Vector u = problem.values(f);
        problem.op().distribute(u, 0.);
        EXPECT_LT(problem.residual(u).linfty_norm(), 1e-13 * 20.) << placement;
      }
  }


  TEST(FictitiousNodes, constant_layers_hold_their_value)
  {
    for (const std::string placement : {"vertices", "cell centers"})
      {
        const Problem<2> problem(
          harmonic_box(2, "3", "conical", 2, placement) +
          Settings{{"Peridynamics/Boundary treatment", "fictitious constant"},
                   {"Boundary conditions/Dirichlet", "left: 1 + t; right: 5 + y"}});
        const Vector u = problem.values([](const Point<2> &) { return 7.; });
        u.update_ghost_values();
        const std::vector<double> &outside = bonds_of(problem.op()).values({u, 2.});
        const auto &fictitious = bonds_of(problem.op()).diffusion_bonds().neighbors().outside();
        for (unsigned int f = 0; f < fictitious.size(); ++f)
          {
            const Point<2> p = problem.nodes->lattice()->position(fictitious[f].site);
            EXPECT_NEAR(outside[f], fictitious[f].side == 0 ? 3. : 5. + p[1], 1e-13);
          }
        EXPECT_GT(sum_of_all(fictitious.size()), 100u);
      }
  }


  TEST(FictitiousNodes, every_family_within_the_layers_is_full)
  {
    // Corners too: with layers on all sides each node has the whole family; of the row on a side
    // half the volume is fictitious.
    for (const std::string placement : {"vertices", "cell centers"})
      {
        const Problem<2> problem(harmonic_box(2, "3", "conical", 2, placement) + mirror_box(2));
        const auto      &families = bonds_of(problem.op()).diffusion_bonds();
        std::vector<typename DiffusionBonds<2>::Bond> bonds;
        for (unsigned int i = 0; i < problem.nodes->n_owned(); ++i)
          {
            families.bonds_of(i, bonds);
            double sum = 0., expected = 0.;
            for (const auto &bond : bonds)
              sum += bond.weight / problem.nodes->volume(i);
            for (const auto &member : families.weights().members())
              expected += member.weight / 400.;
            EXPECT_NEAR(sum, expected, 1e-12 * expected) << problem.positions[i];
          }
      }
  }


  TEST(FictitiousNodes, cracks_are_mirrored)
  {
    // Half a body with its half of a crack and a symmetry plane is the whole body.
    for (const std::string placement : {"vertices", "cell centers"})
      {
        const Settings   common{{"Domain/Nodes", placement},

                              {"Peridynamics/Surface correction", "crack scaling"}};
        const Problem<2> half(
          common + Settings{{"Domain/Cells", "8, 16"},
                            {"Domain/Upper corner", "0.5, 1"},
                            {"Boundary conditions/Symmetry", "left"},
                            {"Cracks/Segments", "0,0.28 ; 0.2,0.28 ; 0.05,0.47 ; 0.2,0.72"}});
        const Problem<2> whole(
          common +
          Settings{{"Domain/Cells", "16, 16"},
                   {"Domain/Lower corner", "-0.5, 0"},
                   {"Domain/Upper corner", "0.5, 1"},
                   {"Cracks/Segments",
                    "-0.2,0.28 ; 0.2,0.28 ; 0.05,0.47 ; 0.2,0.72 ; -0.05,0.47 ; -0.2,0.72"}});
        const auto rates = [](const Problem<2> &problem) {
          Vector rate = problem.product(problem.values(
            [](const Point<2> &p) { return std::cos(3. * p[0]) + p[1] * (1. + p[0] * p[0]); }));
          for (unsigned int i = 0; i < rate.locally_owned_size(); ++i)
            rate.local_element(i) /= problem.op().lumped_capacity().local_element(i);
          return gathered(problem, rate);
        };
        const auto   of_half = rates(half), of_whole = rates(whole);
        unsigned int n = 0;
        for (const auto &[key, value] : of_whole)
          {
            // Nodes on the axis lie a little to the right in the half body, as seen from its cells.
            auto found = of_half.find(key);
            if (found == of_half.end() && key[0] == 0)
              for (auto other = of_half.begin(); other != of_half.end(); ++other)
                if (std::abs(other->first[0]) < 1000 && std::abs(other->first[1] - key[1]) < 1000)
                  found = other;
            if (found == of_half.end())
              continue;
            ++n;
            EXPECT_NEAR(found->second, value, 1e-11) << key[0] << " " << key[1];
          }
        EXPECT_GT(n, 100u);
        EXPECT_TRUE(half.op().symmetric());
        EXPECT_LT(DenseProperties(half.op()).asymmetry, 1e-13);
      }
  }


  TEST(FictitiousNodes, body_narrower_than_the_horizon_is_an_error)
  {
    SceneTests::expect_error(
      [] {
        Problem<2>({{"Domain/Cells", "4, 20"},
                    {"Domain/Upper corner", "1, 5"},
                    {"Peridynamics/Horizon ratio", "6"},
                    {"Boundary conditions/Symmetry", "left"}});
      },
      {"'Horizon'", "narrower"});
  }
} // namespace PeriDeal
