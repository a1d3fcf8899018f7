// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Equilibria by all solvers, and bodies in motion.


#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/static_solver.h>

#include <Eigen/Dense>

#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    const Settings moving{{"Elasticity/Solver", "dynamics"}};
    const Settings full = moving + Settings{{"Elasticity/Kinematics", "full"}};


    template <int dim>
    Vector solution(const Body<dim> &body, const std::string &name, const StaticOptions &options)
    {
      Vector       u;
      const double size = start_statics(body.op(), u, 0., options);
      const auto   n    = make_static_solver(name, body.op(), options)->solve(u, 0., size);
      EXPECT_GT(n, 0u);
      return u;
    }


    /** All solvers find the same displacement as a process alone. */
    template <int dim>
    void check_statics(const Settings                 &more,
                       const ModelKind                 model,
                       const std::vector<std::string> &names)
    {
      StaticOptions options;
      options.tolerance        = 1e-9;
      options.max_iterations   = 1000000;
      const Settings  settings = box<dim>() + Settings{{"Elasticity/Solver", names[0]}} + more;
      const Body<dim> alone(settings, model, MPI_COMM_SELF);
      Vector          first;
      const double    start = start_statics(alone.op(), first, 0., options);
      make_static_solver(names[0], alone.op(), options)->solve(first, 0., start);
      for (const std::string &name : names)
        {
          const Body<dim> body(settings, model);
          options.multigrid = !options.multigrid;
          EXPECT_LT(difference(body, solution(body, name, options), alone, first),
                    1e-6 * first.linfty_norm())
            << name;
        }
    }


    /**
     * The exact motion of a linear body on this process, by the eigenvectors of M^-1/2 K M^-1/2; no
     * loads.
     */
    template <int dim>
    struct Modes
    {
      explicit Modes(const Body<dim> &body)
        : root(body.op().lumped_capacity())
      {
        const ElasticOperator &op = body.op();
        const unsigned int     n  = root.locally_owned_size();
        Eigen::MatrixXd        k(n, n);
        Vector                 x, y;
        op.initialize_vector(x);
        op.initialize_vector(y);
        for (double &m : root)
          m = std::sqrt(m);
        for (unsigned int i = 0; i < n; ++i)
          {
            x                  = 0.;
            x.local_element(i) = 1. / root.local_element(i);
            op.clear_constrained(x);
            op.apply(y, x);
            for (unsigned int j = 0; j < n; ++j)
              k(j, i) = y.local_element(j) / root.local_element(j);
          }
        solver.compute(0.5 * (k + k.transpose()));
      }

      Vector at(const Vector &u, const Vector &v, const double t) const
      {
        const unsigned int n = u.locally_owned_size();
        Eigen::VectorXd    a(n), b(n);
        for (unsigned int i = 0; i < n; ++i)
          {
            a[i] = u.local_element(i) * root.local_element(i);
            b[i] = v.local_element(i) * root.local_element(i);
          }
        a = solver.eigenvectors().transpose() * a;
        b = solver.eigenvectors().transpose() * b;
        for (unsigned int i = 0; i < n; ++i)
          {
            const double omega = std::sqrt(std::max(solver.eigenvalues()[i], 0.));
            a[i] =
              a[i] * std::cos(omega * t) + b[i] * (omega > 1e-8 ? std::sin(omega * t) / omega : t);
          }
        a             = solver.eigenvectors() * a;
        Vector result = u;
        for (unsigned int i = 0; i < n; ++i)
          result.local_element(i) = a[i] / root.local_element(i);
        return result;
      }

      Vector                                         root;
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    };


    template <int dim>
    void start_motion(const Body<dim> &body, Vector &u, Vector &v)
    {
      u = body.values([](const Point<dim> &p) {
        Tensor<1, dim> value;
        for (unsigned int d = 0; d < dim; ++d)
          value[d] = 0.01 * (1. - std::cos((2. + d) * p[0]));
        return value;
      });
      v = body.values([](const Point<dim> &p) {
        Tensor<1, dim> value;
        value[dim - 1] = 0.02 * p[0] * p[0];
        return value;
      });
      body.op().distribute(u, 0.);
      body.op().clear_constrained(v);
    }


    StepperOptions with_step(const double dt)
    {
      StepperOptions options;
      options.time_step        = dt;
      options.solver_tolerance = 1e-13;
      return options;
    }


    /** Orders against the exact motion, and energies. */
    template <int dim>
    void check_orders(const Settings &more, const ModelKind model)
    {
      const Settings  settings = box<dim>() + moving + more;
      const Body<dim> body(settings, model), alone(settings, model, MPI_COMM_SELF);
      Vector          u, v;
      start_motion(alone, u, v);
      const double t_end = 2.;
      const Vector exact = Modes<dim>(alone).at(u, v, t_end);
      const double limit = stable_motion_step(body.op());
      for (const std::string name : {"verlet", "newmark"})
        {
          double errors[2], lost[2];
          for (unsigned int k = 0; k < 2; ++k)
            {
              const auto stepper =
                make_motion_stepper(name, body.op(), with_step((k == 0 ? 0.125 : 0.0625) * limit));
              start_motion(body, u, v);
              stepper->advance(u, v, 0., 0.7);
              stepper->advance(u, v, 0.7, t_end);
              errors[k]                 = max_of_all(difference(body, u, alone, exact));
              const MotionEnergy energy = stepper->energy(u, v);
              lost[k]                   = std::abs(energy.imbalance()) / energy.start;
            }
          EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2., 0.15) << name;
          EXPECT_LT(errors[1], 0.1 * exact.linfty_norm());
          EXPECT_LT(lost[1], name == "newmark" ? 1e-14 : 5e-4);
        }
    }


  } // namespace


  TEST(StaticSolvers, agree)
  {
    const Settings loads{{"Boundary conditions/Displacement", "left: 0, 0; right: free, 0.01*x"},
                         {"Boundary conditions/Traction", "right: 0.1, 0"},
                         {"Initial and source/Body force", "x, y"}};
    // Relaxation with viscosity takes (L/h)^2 steps.
    const std::vector<std::string> quick{"linear",
                                         "conjugate gradients",
                                         "adaptive dynamic relaxation"};
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      {
        check_statics<1>({{"Initial and source/Body force", "x"}, {"Domain/Cells", "12"}},
                         model,
                         static_solver_names());
        check_statics<2>(loads + Settings{{"Domain/Cells", "12, 9"}}, model, quick);
      }
    check_statics<3>(
      {{"Domain/Cells", "6, 4, 3"}, {"Boundary conditions/Traction", "right: 0, 1, 0"}},
      ModelKind::peridynamics,
      quick);
  }


  TEST(StaticSolvers, agree_with_full_kinematics)
  {
    // A strip that is bent by more than its height, and stretched.
    const Settings                 bent{{"Elasticity/Kinematics", "full"},
                        {"Domain/Upper corner", "1, 0.25"},
                        {"Domain/Cells", "24, 6"},
                        {"Boundary conditions/Displacement", "left: 0, 0; right: free, 0.4"}};
    const std::vector<std::string> names{"conjugate gradients", "adaptive dynamic relaxation"};
    check_statics<2>(bent, ModelKind::peridynamics, names);
    check_statics<2>(Settings{{"Elasticity/Kinematics", "full"},
                              {"Domain/Cells", "12, 9"},
                              {"Material/Thermal expansion", "0.05"},
                              {"Elasticity/Temperature change", "x"}},
                     ModelKind::peridynamics,
                     names);
  }


  TEST(StaticSolvers, messages)
  {
    StaticOptions options;
    options.max_iterations = 3;
    const Body<2> body(box<2>() + Settings{{"Initial and source/Body force", "1, 0"}},
                       ModelKind::peridynamics);
    for (unsigned int k = 1; k < static_solver_names().size(); ++k)
      {
        options.multigrid      = false;
        const std::string name = static_solver_names()[k];
        SceneTests::expect_error([&] { solution(body, name, options); },
                                 {"'Solver = " + name + "'", "after 3 iterations"});
      }
    const Body<2> bent(box<2>() + Settings{{"Elasticity/Kinematics", "full"},
                                           {"Elasticity/Solver", "conjugate gradients"}},
                       ModelKind::peridynamics);
    SceneTests::expect_error([&] { make_static_solver("linear", bent.op(), options); },
                             {"'Kinematics = linear'"});
  }


  TEST(MotionSteppers, order_two)
  {
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      {
        check_orders<1>({{"Domain/Cells", "12"}}, model);
        check_orders<2>({{"Domain/Cells", "8, 6"}}, model);
      }
    check_orders<3>({{"Domain/Cells", "4, 3, 2"}}, ModelKind::peridynamics);
  }


  TEST(MotionSteppers, moving_supports_and_loads)
  {
    // What supports and loads give is found again as energy.
    const Settings driven{{"Domain/Cells", "12, 9"},
                          {"Boundary conditions/Displacement", "left: 0.1*sin(t)^2, 0"},
                          {"Boundary conditions/Traction", "right: 0, 0.1*t"}};
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      for (const std::string name : {"verlet", "newmark"})
        {
          double lost[2];
          for (unsigned int k = 0; k < 2; ++k)
            {
              const Body<2> body(box<2>() + moving + driven, model);
              const double  dt      = (k == 0 ? 0.4 : 0.2) * stable_motion_step(body.op());
              const auto    stepper = make_motion_stepper(name, body.op(), with_step(dt));
              Vector        u = body.vector(), v = u;
              body.op().distribute(u, 0.);
              stepper->advance(u, v, 0., 3.);
              const MotionEnergy energy = stepper->energy(u, v);
              EXPECT_GT(energy.work, 1e-4);
              EXPECT_EQ(energy.start, 0.);
              lost[k] = std::abs(energy.imbalance()) / energy.work;
            }
          EXPECT_LT(lost[1], name == "newmark" ? 1e-13 : 3e-5);
        }
  }


  TEST(MotionSteppers, spinning_body)
  {
    // Free, with full kinematics: the moment of momentum stays, and energy.
    for (const std::string name : {"verlet", "newmark"})
      {
        const Body<2> body(box<2>() + full +
                             Settings{{"Domain/Cells", "8, 6"},
                                      {"Boundary conditions/Displacement", ""},
                                      {"Peridynamics/Kernel exponent", "2"}},
                           ModelKind::peridynamics);
        Vector        u = body.vector(), v = body.values([](const Point<2> &p) {
          return Tensor<1, 2>({-0.5 * (p[1] - 0.375), 0.5 * (p[0] - 0.5)});
        });
        const auto    momentum = [&] {
          double sum = 0.;
          for (unsigned int i = 0; i < u.locally_owned_size() / 2; ++i)
            {
              const Point<2> &p = body.position(i);
              const double    m = body.op().lumped_capacity().local_element(2 * i);
              sum += m * ((p[0] + u.local_element(2 * i)) * v.local_element(2 * i + 1) -
                          (p[1] + u.local_element(2 * i + 1)) * v.local_element(2 * i));
            }
          return sum_of_all(sum);
        };
        const double before = momentum();
        const auto   stepper =
          make_motion_stepper(name, body.op(), with_step(0.5 * stable_motion_step(body.op())));
        stepper->advance(u, v, 0., 6.); // half a turn
        EXPECT_GT(u.linfty_norm(), 1.);
        const double after = momentum();
        // Verlet keeps it.
        EXPECT_NEAR(after, before, (name == "verlet" ? 1e-12 : 2e-4) * before);
        const MotionEnergy energy = stepper->energy(u, v);
        EXPECT_LT(std::abs(energy.imbalance()), 5e-4 * energy.start) << name;
      }
  }


  TEST(MotionSteppers, unstable_steps)
  {
    const Body<2> body(box<2>() + moving, ModelKind::peridynamics);
    const double  limit = stable_motion_step(body.op());
    SceneTests::expect_error(
      [&] { make_motion_stepper("verlet", body.op(), with_step(1.01 * limit)); },
      {"'Time step' in section 'Time'", "stable up to", "newmark"});
    // The factory does not let it through: the stepper itself finds out.
    const auto stepper = make_verlet(body.op(), with_step(1.1 * limit));
    Vector     u, v;
    start_motion(body, u, v);
    SceneTests::expect_error([&] { stepper->advance(u, v, 0., 2000. * limit); },
                             {"unstable", "kinetic energy"});
  }
} // namespace PeriDeal
