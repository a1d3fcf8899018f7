// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds that break: critical stretch, irreversibility, energies, slow loading.

#include <perideal/base/user_error.h>
#include <perideal/solvers/slow_loading.h>

#include <array>
#include <cmath>
#include <map>

#include "dimensions.h"
#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    const Settings moving{{"Elasticity/Solver", "dynamics"}};

    Settings breaking_at(const double stretch)
    {
      return moving + Settings{{"Material/Critical stretch", std::to_string(stretch)}};
    }


    /** A square that is pulled, with a crack. */
    Settings edge_cracked(const std::string &cells,
                          const std::string &crack,
                          const std::string &height)
    {
      return {{"Domain/Lower corner", "0, 0"},
              {"Domain/Upper corner", "1, 1"},
              {"Domain/Cells", cells},
              {"Domain/Nodes", "cell centers"},
              {"Peridynamics/Horizon ratio", "3"},
              {"Material/Young modulus", "3"},
              {"Material/Poisson ratio", "0.2"},
              {"Material/Critical stretch", "0.02"},
              {"Cracks/Segments", crack},
              {"Boundary conditions/Displacement", "bottom: 0, 0; top: 0, " + height}};
    }


    template <int dim>
    Tensor<1, dim> pulled(const Point<dim> &p)
    {
      Tensor<1, dim> u;
      u[0] = 0.1 * p[0];
      return u;
    }


    /**
     * The critical stretch for a fracture energy of 1, alike at all nodes, over the one of the
     * continuum with a constant micromodulus.
     */
    template <int dim>
    double ratio_to_continuum(const Settings &more)
    {
      const Body<dim>            body(box<dim>() + moving +
                             Settings{{"Material/Fracture energy", "1"},
                                      {"Elasticity/Model", "bond-based"},
                                      {"Peridynamics/Kernel", "constant"},
                                      {"Peridynamics/Kernel exponent", "1"}} +
                             more,
                           ModelKind::peridynamics);
      const std::vector<double> &found    = body.states->breaking().critical_stretches();
      const Scene<dim>          &scene    = body.scene;
      const double               expected = critical_stretch_constant(1.,
                                                        scene.material.moduli(Point<dim>()),
                                                        scene.horizon(),
                                                        dim,
                                                        scene.elasticity.plane);
      for (const double s : found)
        EXPECT_DOUBLE_EQ(s, found[0]);
      return found[0] / expected;
    }


    /**
     * Pulled in one direction, the bonds near to it break, the same on all numbers of processes,
     * for good, and no energy is lost.
     */
    template <int dim>
    void check_breaking(const Settings &more, const bool full)
    {
      const double   critical = 0.075; // of 0.1: bonds at less than 30 degrees from the x axis
      const Settings settings = box<dim>() + breaking_at(critical) +
                                Settings{{"Elasticity/Kinematics", full ? "full" : "linear"}} +
                                more;
      const Body<dim> body(settings, ModelKind::peridynamics),
        alone(settings, ModelKind::peridynamics, MPI_COMM_SELF);
      unsigned long long expected = 0;
      for (unsigned int i = 0; i < alone.nodes->n_owned(); ++i)
        {
          std::vector<typename Families<dim>::Member> family;
          alone.states->bonds().families.members_of(i, family);
          for (const auto &bond : family)
            {
              const Tensor<1, dim> xi  = alone.position(bond.neighbor) - alone.position(i);
              const Tensor<1, dim> eta = pulled(Point<dim>(xi));
              const double         x   = xi.norm();
              expected += (full ? (xi + eta).norm() - x : eta * xi / x) > critical * x;
            }
        }
      const auto squeezed = [](const Point<dim> &p) { return -1. * pulled(p); };
      for (const Body<dim> *b : {&body, &alone})
        {
          ElasticOperator &op     = b->op();
          const Vector     u      = b->values(pulled<dim>);
          const double     before = op.energy(u);
          EXPECT_TRUE(op.brittle());
          EXPECT_EQ(op.break_bonds(b->values(squeezed), 0.), 0u);
          EXPECT_EQ(op.break_bonds(u, 0.), expected / 2);
          EXPECT_EQ(op.n_broken_bonds(), expected / 2);
          EXPECT_GT(op.released_energy(), 0.1 * before);
          EXPECT_NEAR(op.energy(u) + op.released_energy(), before, 1e-12 * before);
          EXPECT_EQ(op.break_bonds(u, 0.), 0u);
          EXPECT_EQ(op.break_bonds(b->vector(), 0.), 0u);
          EXPECT_EQ(op.n_broken_bonds(), expected / 2); // they do not heal
          if (!full)
            {
              EXPECT_NEAR(0.5 * (u * b->product(u)), op.energy(u), 1e-12 * before);
            }
        }
      EXPECT_NEAR(body.op().released_energy(),
                  alone.op().released_energy(),
                  1e-12 * alone.op().released_energy());
      double most = 0.;
      for (const double d : body.states->breaking().damage())
        most = std::max(most, d);
      most = max_of_all(most);
      EXPECT_GT(most, 0.1);
      EXPECT_LE(most, dim == 1 ? 1. : 0.9);
    }
  } // namespace


  TEST(Damage, FractureEnergyOfAConstantMicromodulus)
  {
    // The lattice sums converge to the integrals.
    for (const char *m : {"4", "8"})
      {
        const double bound = std::string(m) == "4" ? 0.03 : 0.008;
        EXPECT_NEAR(ratio_to_continuum<1>({{"Peridynamics/Horizon ratio", m}}), 1., bound);
        for (const char *plane : {"stress", "strain"})
          EXPECT_NEAR(
            ratio_to_continuum<2>({{"Peridynamics/Horizon ratio", m}, {"Elasticity/Plane", plane}}),
            1.,
            bound);
      }
    EXPECT_NEAR(ratio_to_continuum<3>({{"Peridynamics/Horizon ratio", "4"}}), 1., 0.03);
  }


  TEST_IN_DIMENSIONS(Damage, OverstretchedBondsBreakForGood, 1, 2, 3)
  {
    for (const char *model : {"state-based", "bond-based"})
      for (const bool full : {false, true})
        check_breaking<dim>({{"Elasticity/Model", model}}, full);
  }


  TEST(Damage, CooledBondsAreStretched)
  {
    const Settings cold{{"Elasticity/Temperature change", "-10"},
                        {"Material/Thermal expansion", "0.01"}};
    for (const bool breaks : {false, true})
      {
        const Body<2>    body(box<2>() + breaking_at(breaks ? 0.099 : 0.101) + cold,
                           ModelKind::peridynamics);
        ElasticOperator &op     = body.op();
        const Vector     u      = body.vector();
        const double     before = op.energy(u);
        EXPECT_EQ(op.break_bonds(u, 0.) > 0, breaks);
        // Without bonds there is neither energy nor force left.
        EXPECT_EQ(body.unbalanced(u).linfty_norm() == 0., breaks);
        EXPECT_NEAR(op.energy(u), breaks ? 0. : before, 1e-14 * before);
      }
  }


  TEST(Damage, SlowLoadingKeepsTheEnergy)
  {
    // A plate with an edge crack is pulled, breaks, and is let go.
    const Settings settings = edge_cracked("16, 16", "0,0.5 ; 0.25,0.5", "0.1*sin(t)");
    StaticOptions  options;
    options.tolerance        = 1e-11;
    options.breaks_in_motion = false;
    for (const char *name : {"linear", "conjugate gradients"})
      {
        options.breaks_in_motion = !options.breaks_in_motion; // the second time at rest
        const Body<2> body(settings, ModelKind::peridynamics);
        SlowLoading   loading(body.op(), make_static_solver(name, body.op(), options), options);
        Vector        u;
        loading.begin(u, 0.);
        double most = 0., last = 0.;
        for (unsigned int k = 1; k <= 32; ++k)
          {
            loading.step(u, k * 3.14159265358979 / 32.);
            const LoadingEnergy energy = loading.energy(u);
            EXPECT_NEAR(energy.imbalance(), 0., 1e-10 * (energy.work + 1e-6));
            EXPECT_GE(energy.dissipated, last * (1. - 1e-12));
            // A motion takes more than bonds release: by damping, and what moves at its end. That
            // is more than the error of its steps.
            EXPECT_GE(energy.dissipated, body.op().released_energy() * (1. - 1e-9));
            last = energy.dissipated;
            most = std::max(most, energy.strain);
            Vector r(u);
            body.op().residual(r, u, k * 3.14159265358979 / 32.);
            EXPECT_LT(r.linfty_norm(), 1e-10);
          }
        EXPECT_GT(body.op().n_broken_bonds(), 50u);
        EXPECT_NEAR(loading.energy(u).strain, 0., 1e-10 * most);
      }
  }


  TEST(Damage, EnergyOfTheBreakingMotionIsOfSecondOrder)
  {
    const Settings settings = edge_cracked("20, 20", "0,0.5 ; 0.3,0.5", "t");
    StaticOptions  options;
    options.tolerance = 1e-12;
    std::vector<double> gaps; // over what bonds release
    for (const double share : {0.8, 0.4, 0.2, 0.1})
      {
        const Body<2>    body(settings, ModelKind::peridynamics);
        ElasticOperator &op = body.op();
        Vector           u;
        const double     size = start_statics(op, u, 1., options);
        make_static_solver("conjugate gradients", op, options)->solve(u, 1., size);
        const double t = 1.03 / op.stretch_over_critical(u, 1.); // linear in t
        u *= t;
        EXPECT_NEAR(op.stretch_over_critical(u, t), 1.03, 1e-9);
        BreakingMotion motion(op, share);
        const double   strain = op.energy(u);
        op.break_bonds(u, t, 0.9);
        motion.run(u, t);
        EXPECT_GT(op.n_broken_bonds(), 100u);
        EXPECT_GT(motion.lost(), 0.);
        // Supports are at rest, and there are no loads.
        const double released = op.released_energy();
        gaps.push_back(std::abs(strain - op.energy(u) - released - motion.lost()) / released);
      }
    // Measured: 0.026, 0.0095, 0.0030, 0.00077; which bonds break depends a little on the step.
    EXPECT_LT(gaps[0], 0.04);
    EXPECT_GT(gaps[1] / gaps[2], 2.5);
    EXPECT_NEAR(gaps[2] / gaps[3], 4., 1.);
  }


  TEST(Damage, StrengthScattersAsWeibullSays)
  {
    const auto scattered = [](const std::string &modulus, const std::string &seed) {
      return Settings{{"Domain/Lower corner", "0, 0"},
                      {"Domain/Upper corner", "1, 1"},
                      {"Domain/Cells", "100, 100"},
                      {"Material/Young modulus", "3"},
                      {"Material/Poisson ratio", "0.2"},
                      {"Material/Critical stretch", "0.02*(1 + x)"},
                      {"Boundary conditions/Displacement", "bottom: 0, 0"},
                      {"Material/Weibull modulus", modulus},
                      {"Material/Strength seed", seed}};
    };
    for (const double modulus : {1.5, 10.})
      {
        const Body<2> body(scattered(std::to_string(modulus), "1"), ModelKind::peridynamics);
        const Body<2> alone(scattered(std::to_string(modulus), "1"),
                            ModelKind::peridynamics,
                            MPI_COMM_SELF);
        const Body<2> other(scattered(std::to_string(modulus), "2"), ModelKind::peridynamics);
        const auto    factors = [](const Body<2> &of) {
          std::map<std::array<double, 2>, double> list;
          const std::vector<double> &found = of.states->breaking().critical_stretches();
          for (unsigned int i = 0; i < found.size(); ++i) // owned nodes and ghosts
            list[{{of.nodes->position(i)[0], of.nodes->position(i)[1]}}] =
              found[i] / (0.02 * (1. + of.nodes->position(i)[0]));
          return list;
        };
        const auto   all = factors(alone), here = factors(body), others = factors(other);
        unsigned int n_alike = 0;
        for (const auto &[place, factor] : here)
          {
            EXPECT_EQ(factor, all.at(place)); // to the bit, on any number of processes
            n_alike += factor == others.at(place);
          }
        EXPECT_EQ(n_alike, 0u);

        // Mean 1; the modulus by its maximum likelihood, sum x^k ln x / sum x^k - mean ln x = 1/k.
        const double n   = all.size();
        double       sum = 0., logs = 0., neighbors = 0.;
        for (const auto &[place, factor] : all)
          {
            sum += factor;
            logs += std::log(factor) / n;
          }
        const auto likelihood = [&](const double k) {
          double powers = 0., weighted = 0.;
          for (const auto &[place, factor] : all)
            {
              powers += std::pow(factor, k);
              weighted += std::pow(factor, k) * std::log(factor);
            }
          return weighted / powers - logs - 1. / k;
        };
        double low = 0.5 * modulus, high = 2. * modulus;
        while (high - low > 1e-6 * modulus)
          (likelihood(0.5 * (low + high)) > 0. ? high : low) = 0.5 * (low + high);
        // Standard deviations of samples: of the modulus 0.78 k/sqrt(n), of the mean that of a
        // value over sqrt(n).
        const double deviation = std::sqrt(
          std::tgamma(1. + 2. / modulus) / std::pow(std::tgamma(1. + 1. / modulus), 2) - 1.);
        EXPECT_NEAR(low / modulus, 1., 3. * 0.78 / std::sqrt(n));
        EXPECT_NEAR(sum / n, 1., 3. * deviation / std::sqrt(n));
        // Nodes beside each other know nothing of each other.
        double before = 0.;
        for (const auto &[place, factor] : all) // along y
          {
            neighbors += (before - 1.) * (factor - 1.) / (n * deviation * deviation);
            before = factor;
          }
        EXPECT_NEAR(neighbors, 0., 3. / std::sqrt(n));
      }
    const auto fault_of = [&](const std::string &modulus, const std::string &seed) {
      return message_of([&] { Body<2>(scattered(modulus, seed), ModelKind::peridynamics); });
    };
    expect_parts(fault_of("10", ""), {"Strength seed", "is empty", "Weibull modulus"});
    expect_parts(fault_of("", "1"), {"Strength seed", "no effect", "Weibull modulus"});
    expect_parts(fault_of("0", "1"), {"Weibull modulus", "greater than 0"});
  }


  TEST(Damage, EntriesThatHaveNoEffectAreRefused)
  {
    const auto fault_of = [](const ModelKind model, const Settings &more) {
      return message_of([&] {
        Body<2>(box<2>() + Settings{{"Material/Fracture energy", "1"}} + more, model);
      });
    };
    expect_parts(fault_of(ModelKind::finite_elements, {}), {"Fracture energy", "no effect"});
    expect_parts(fault_of(ModelKind::coupled, {{"Coupling/Zone", "cracks: 1"}}),
                 {"'Zone'", "is empty", "'follow'"});
    expect_parts(fault_of(ModelKind::coupled, {{"Coupling/Scheme", "splice"}}),
                 {"Fracture energy", "'Scheme'", "without an energy"});
    EXPECT_EQ(fault_of(ModelKind::coupled, {{"Coupling/Scheme", "blending"}}), "");
    expect_parts(fault_of(ModelKind::peridynamics, {{"Material/Critical stretch", "1"}}),
                 {"Critical stretch", "Fracture energy"});
    expect_parts(fault_of(ModelKind::peridynamics, {{"Material/Fracture energy", "x - 0.5"}}),
                 {"Fracture energy", "not positive"});
  }
} // namespace PeriDeal
