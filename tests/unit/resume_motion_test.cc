// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bodies in motion and under slow loading, saved on the way and taken up again by new objects.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/mesh/node_keys.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/slow_loading.h>

#include <algorithm>

#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;

  namespace
  {
    const Settings plate{{"Domain/Lower corner", "0, 0"},
                         {"Domain/Upper corner", "1, 1"},
                         {"Domain/Cells", "16, 16"},
                         {"Peridynamics/Horizon ratio", "3"},
                         {"Material/Young modulus", "3"},
                         {"Material/Poisson ratio", "0.2"},
                         {"Cracks/Segments", "0,0.49 ; 0.25,0.49"}};
    const Settings brittle{{"Material/Critical stretch", "0.02"}};
    const Settings moving{{"Elasticity/Solver", "dynamics"},
                          {"Time/End time", "2"},
                          {"Boundary conditions/Displacement", "bottom: 0, 0"},
                          {"Boundary conditions/Velocity", "top: 0, 0.03*(1 - exp(-4*t))"}};
    const Settings growing{{"Cracks/Growth", "2: 0.1, 0.2,0.02"}};
    const Settings slow{{"Boundary conditions/Displacement", "bottom: 0, 0; top: 0, 0.1*sin(t)"}};
    const Settings centers{{"Domain/Nodes", "cell centers"}};
    const Settings full{{"Elasticity/Kinematics", "full"}};


    /** Values of all nodes in the order of their places, on all processes. */
    std::vector<double> sorted_values(const Body<2> &body, const Vector &u, const MPI_Comm all)
    {
      std::vector<std::array<double, 4>> own;
      for (unsigned int i = 0; i < u.locally_owned_size() / 2; ++i)
        own.push_back({body.position(i)[0],
                       body.position(i)[1],
                       u.local_element(2 * i),
                       u.local_element(2 * i + 1)});
      std::vector<std::array<double, 4>> list;
      for (const auto &some : dealii::Utilities::MPI::all_gather(all, own))
        list.insert(list.end(), some.begin(), some.end());
      std::sort(list.begin(), list.end());
      std::vector<double> values;
      for (const auto &entry : list)
        values.insert(values.end(), {entry[2], entry[3]});
      return values;
    }


    /** The largest difference over the largest value. */
    double difference(const std::vector<double> &a, const std::vector<double> &b)
    {
      EXPECT_EQ(a.size(), b.size());
      double most = 0., size = 0.;
      for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
        {
          most = std::max(most, std::abs(a[k] - b[k]));
          size = std::max(size, std::abs(a[k]));
        }
      EXPECT_GT(size, 0.);
      return most / size;
    }


    /** A body in motion, in two spans of time. */
    struct Motion
    {
      Motion(const Settings    &settings,
             const ModelKind    model,
             const std::string &method,
             const MPI_Comm     communicator)
        : body(settings, model, communicator)
        , communicator(communicator)
        , keys(node_keys(body.handler))
      {
        body.op().initialize_vector(u);
        body.op().initialize_vector(v);
        body.op().distribute(u, 0.);
        body.op().linearize(u);
        StepperOptions options;
        options.solver_tolerance = 1e-14;
        stepper                  = make_motion_stepper(method, body.op(), options);
      }

      void exchange(Archive &archive)
      {
        archive.exchange("u", u, keys);
        archive.exchange("v", v, keys);
        body.op().exchange(archive, keys);
        stepper->exchange(archive, keys);
      }

      std::vector<double> displacement() const
      {
        return sorted_values(body, u, communicator);
      }

      Body<2>                        body;
      const MPI_Comm                 communicator;
      const NodeKeys                 keys;
      Vector                         u, v;
      std::unique_ptr<MotionStepper> stepper;
    };


    void expect_resumable(const Settings    &more,
                          const ModelKind    model,
                          const std::string &method,
                          const unsigned int n_before,
                          const double       tolerance,
                          const double       tolerance_alone)
    {
      SCOPED_TRACE(method + ", " + to_string(model));
      const Settings   settings = plate + moving + more;
      constexpr double first = 1.3, end = 2.;
      MemoryArchive    saved(MPI_COMM_WORLD);
      Motion           whole(settings, model, method, MPI_COMM_WORLD);
      unsigned int     n_steps = 0;
      whole.stepper->advance(whole.u, whole.v, 0., first, [&](const double) {
        if (++n_steps == n_before)
          whole.exchange(saved);
      });
      ASSERT_GT(n_steps, n_before);
      const unsigned long long n_broken = whole.body.op().n_broken_bonds();
      whole.stepper->advance(whole.u, whole.v, first, end);
      const MotionEnergy energy = whole.stepper->energy(whole.u, whole.v);
      EXPECT_EQ(n_broken > 0, whole.body.op().brittle());
      for (const MPI_Comm communicator : {MPI_COMM_WORLD, MPI_COMM_SELF})
        {
          Motion        resumed(settings, model, method, communicator);
          MemoryArchive archive(saved, communicator);
          resumed.exchange(archive);
          ASSERT_TRUE(resumed.stepper->is_inside_span());
          resumed.stepper->go_on(resumed.u, resumed.v);
          EXPECT_EQ(resumed.body.op().n_broken_bonds(), n_broken);
          resumed.stepper->advance(resumed.u, resumed.v, first, end);
          const bool alone = communicator == MPI_COMM_SELF;
          EXPECT_LE(difference(whole.displacement(), resumed.displacement()),
                    alone ? tolerance_alone : tolerance);
          EXPECT_EQ(resumed.stepper->cost().steps, whole.stepper->cost().steps);
          EXPECT_EQ(resumed.body.op().n_broken_bonds(), whole.body.op().n_broken_bonds());
          const MotionEnergy found = resumed.stepper->energy(resumed.u, resumed.v);
          const double       same  = alone ? 1e-9 : std::max(tolerance, 1e-13);
          EXPECT_NEAR(found.work, energy.work, same * energy.exchanged);
          EXPECT_NEAR(found.released, energy.released, same * energy.exchanged);
          EXPECT_NEAR(found.drift, energy.drift, same * energy.exchanged);
        }
    }
  } // namespace


  TEST(Resume, verlet_goes_on_to_the_last_bit)
  {
    constexpr auto bonds = ModelKind::peridynamics;
    // On another number of processes sums over nodes beyond the sides have another order, and steps
    // that follow the body come from sums over all processes.
    constexpr double round_off = 1e-13;
    for (const unsigned int n_before : {1u, 12u, 26u})
      expect_resumable(brittle, bonds, "verlet", n_before, 0., round_off);
    expect_resumable(brittle + centers, bonds, "verlet", 26, 0., round_off);
    expect_resumable(brittle + full, bonds, "verlet", 26, 0., round_off);
    expect_resumable(full + centers, bonds, "verlet", 26, 0., round_off);
    for (const Settings &more : {Settings(), full, brittle, centers})
      expect_resumable(growing + more, bonds, "verlet", 26, 0., round_off);
    expect_resumable({}, ModelKind::finite_elements, "verlet", 20, 0., 1e-12);
    // A matrix that is mended again and again has the round-off of that.
    expect_resumable(growing, ModelKind::finite_elements, "verlet", 20, 1e-12, 1e-12);
  }


  TEST(Resume, newmark_goes_on)
  {
    expect_resumable({}, ModelKind::peridynamics, "newmark", 3, 1e-12, 1e-10);
    expect_resumable(full, ModelKind::peridynamics, "newmark", 3, 1e-12, 1e-10);
    expect_resumable(growing, ModelKind::peridynamics, "newmark", 3, 1e-12, 1e-10);
    expect_resumable({}, ModelKind::finite_elements, "newmark", 3, 1e-12, 1e-10);
  }


  TEST(Resume, slow_loading_goes_on_within_a_step)
  {
    StaticOptions options;
    options.tolerance               = 1e-12;
    const Settings         settings = plate + brittle + slow;
    constexpr double       end      = 0.3;
    constexpr unsigned int n_steps  = 4;
    for (const char *name : {"linear", "conjugate gradients"})
      for (const bool moves : {false, true})
        {
          SCOPED_TRACE(name);
          const unsigned int n_before = 2; // rounds
          options.breaks_in_motion    = moves;
          const auto time             = [](const unsigned int k) { return k * end / n_steps; };
          const auto make             = [&](const Body<2> &body) {
            return std::make_unique<SlowLoading>(body.op(),
                                                 make_static_solver(name, body.op(), options),
                                                 options);
          };
          MemoryArchive  saved(MPI_COMM_WORLD);
          const Body<2>  body(settings, ModelKind::peridynamics);
          const NodeKeys keys    = node_keys(body.handler);
          const auto     loading = make(body);
          Vector         u;
          loading->begin(u, 0.);
          unsigned int n_rounds = 0, step_of_save = 0;
          for (unsigned int k = 1; k <= n_steps; ++k)
            loading->step(u, time(k), [&](const double t) {
              // Steps are divided where bonds begin to break.
              EXPECT_GT(t, time(k - 1));
              EXPECT_LE(t, time(k));
              if (++n_rounds != n_before)
                return;
              step_of_save = k;
              saved.exchange("u", u, keys);
              body.op().exchange(saved, keys);
              loading->exchange(saved, keys);
            });
          ASSERT_GT(step_of_save, 0u);
          for (const MPI_Comm communicator : {MPI_COMM_WORLD, MPI_COMM_SELF})
            {
              const Body<2>  other(settings, ModelKind::peridynamics, communicator);
              const NodeKeys own     = node_keys(other.handler);
              const auto     resumed = make(other);
              MemoryArchive  archive(saved, communicator);
              Vector         w;
              other.op().initialize_vector(w);
              archive.exchange("u", w, own);
              other.op().exchange(archive, own);
              resumed->exchange(archive, own);
              ASSERT_TRUE(resumed->is_inside_step());
              resumed->go_on(w);
              for (unsigned int k = step_of_save + 1; k <= n_steps; ++k)
                resumed->step(w, time(k));
              EXPECT_LE(difference(sorted_values(body, u, MPI_COMM_WORLD),
                                   sorted_values(other, w, communicator)),
                        1e-9);
              EXPECT_EQ(other.op().n_broken_bonds(), body.op().n_broken_bonds());
              const LoadingEnergy energy = loading->energy(u), found = resumed->energy(w);
              EXPECT_NEAR(found.work, energy.work, 1e-9 * energy.exchanged);
              EXPECT_NEAR(found.dissipated, energy.dissipated, 1e-9 * energy.exchanged);
              EXPECT_EQ(resumed->n_steps(), loading->n_steps());
            }
        }
  }


  /** A preconditioner is made for the body as it was when it was made in the run before. */
  TEST(Resume, the_surrogate_is_the_one_of_then)
  {
    const Settings zone{{"Coupling/Zone", "cracks: 1"}, {"Time/End time", "2"}};
    const Settings grows = growing + Settings{{"Time/End time", "2"}};
    for (const auto &[more, model] : {std::make_pair(brittle, ModelKind::peridynamics),
                                      std::make_pair(brittle + centers, ModelKind::peridynamics),
                                      std::make_pair(brittle + grows, ModelKind::peridynamics),
                                      std::make_pair(grows, ModelKind::finite_elements),
                                      std::make_pair(grows + zone, ModelKind::coupled)})
      {
        SCOPED_TRACE(to_string(model));
        const Body<2>    body(plate + slow + more, model), other(plate + slow + more, model);
        ElasticOperator &op   = body.op();
        const NodeKeys   keys = node_keys(body.handler);
        Vector           u;
        op.initialize_vector(u);
        const auto change = [&](const double t) {
          u = body.values([&](const dealii::Point<2> &p) { return 0.1 * t * bumpy_vector(p); });
          const bool grown = op.grow_cracks(u, t);
          return grown || op.break_bonds(u, t, 0.9) > 0;
        };
        EXPECT_TRUE(change(0.5));
        dealii::TrilinosWrappers::SparseMatrix then, now, resumed;
        op.surrogate(then);
        const Vector diagonal = op.surrogate_diagonal();
        EXPECT_TRUE(change(1.1));
        MemoryArchive saved(MPI_COMM_WORLD);
        op.exchange(saved, keys);
        MemoryArchive archive(saved, MPI_COMM_WORLD);
        other.op().exchange(archive, keys);
        // K as it is now, but the first preconditioner as it was.
        EXPECT_LE(largest_difference(other.op().diagonal(), op.diagonal()),
                  1e-13 * op.diagonal().linfty_norm());
        other.op().surrogate(resumed);
        EXPECT_LE(largest_difference(other.op().surrogate_diagonal(), diagonal),
                  1e-13 * diagonal.linfty_norm());
        op.surrogate(now);
        const double size = then.frobenius_norm();
        now.add(-1., then);
        EXPECT_GT(now.frobenius_norm(), 1e-4 * size);
        resumed.add(-1., then);
        EXPECT_LE(resumed.frobenius_norm(), 1e-13 * size);
        op.surrogate(now);
        other.op().surrogate(resumed);
        resumed.add(-1., now);
        EXPECT_LE(resumed.frobenius_norm(), 1e-13 * size);
        EXPECT_LE(largest_difference(other.op().surrogate_diagonal(), op.surrogate_diagonal()),
                  1e-13 * diagonal.linfty_norm());
      }
  }
} // namespace PeriDeal
