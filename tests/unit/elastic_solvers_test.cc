// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Full kinematics, equilibria by all solvers, and bodies in motion.

#include <perideal/base/user_error.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/static_solver.h>

#include <Eigen/Dense>
#include <functional>

#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace ElasticTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    const Settings moving{{"Elasticity/Solver", "dynamics"}};
    const Settings full = moving + Settings{{"Elasticity/Kinematics", "full"}};


    template <int dim>
    Tensor<2, dim> rotation(const double angle)
    {
      Tensor<2, dim> r;
      for (unsigned int d = 0; d < dim; ++d)
        r[d][d] = 1.;
      r[0][0] = r[1][1] = std::cos(angle);
      r[0][1]           = -std::sin(angle);
      r[1][0]           = std::sin(angle);
      return r;
    }


    /** A rotation makes no force, and turns the forces of a deformed body. */
    template <int dim>
    void check_rotation(const Settings &more)
    {
      const Body<dim>        body(box<dim>() + full + more, Model::peridynamics);
      const ElasticOperator &op    = body.op();
      const Tensor<2, dim>   turn  = rotation<dim>(2.);
      const auto             place = [](const Point<dim> &p) {
        return Point<dim>(p + 0.1 * bumpy_vector<dim>(p));
      };
      Vector f, turned;
      op.initialize_vector(f);
      op.initialize_vector(turned);
      op.unbalanced(f, body.values([&](const Point<dim> &p) { return place(p) - p; }), 0.);
      op.unbalanced(turned,
                    body.values([&](const Point<dim> &p) { return turn * place(p) - p; }),
                    0.);
      const double size = f.linfty_norm();
      double       gap  = 0.;
      for (unsigned int i = 0; i < f.locally_owned_size() / dim; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          {
            double expected = 0.;
            for (unsigned int e = 0; e < dim; ++e)
              expected += turn[d][e] * f.local_element(dim * i + e);
            gap = std::max(gap, std::abs(expected - turned.local_element(dim * i + d)));
          }
      EXPECT_LT(gap, 1e-12 * size);
      op.unbalanced(f, body.values([&](const Point<dim> &p) { return turn * p - p; }), 0.);
      EXPECT_LT(f.linfty_norm(), 1e-12 * size);
      EXPECT_LT(op.energy(body.values([&](const Point<dim> &p) { return turn * p - p; })), 1e-24);
    }


    /** To first order the linear body; the energy's gradient; the tangent. */
    template <int dim>
    void check_derivatives(const Settings &more)
    {
      Body<dim>        body(box<dim>() + full + more, Model::peridynamics);
      const Body<dim>  linear(box<dim>() + moving + more, Model::peridynamics);
      ElasticOperator &op = body.op();
      Vector           r, s, y;
      for (Vector *v : {&r, &s, &y})
        op.initialize_vector(*v);
      const Vector w = body.values(bumpy_vector<dim>);
      linear.op().residual(s, linear.values(bumpy_vector<dim>), 0.);
      double gaps[2];
      for (unsigned int k = 0; k < 2; ++k)
        {
          const double size = k == 0 ? 1e-4 : 1e-5;
          Vector       u    = w;
          u *= size;
          op.residual(r, u, 0.);
          r *= 1. / size;
          r -= s;
          gaps[k] = r.linfty_norm() / s.linfty_norm();
        }
      if (dim > 1) // bars stretch linearly
        {
          EXPECT_NEAR(gaps[0] / gaps[1], 10., 0.1);
        }
      EXPECT_LT(gaps[1], dim > 1 ? 1e-3 : 1e-10);

      const Vector u = body.values([&](const Point<dim> &p) {
        Tensor<1, dim> value = 0.1 * bumpy_vector<dim>(p);
        value[0] += 0.3 * p[0];
        return value;
      });
      op.linearize(u);
      op.multiply(y, w);
      constexpr double h  = 1e-5;
      Vector           up = u, down = u;
      up.add(h, w);
      down.add(-h, w);
      const double slope = (op.energy(up) - op.energy(down)) / (2. * h);
      op.unbalanced(r, u, 0.);
      EXPECT_NEAR(slope, -(r * w), 1e-8 * std::abs(slope));
      op.unbalanced(r, up, 0.);
      op.unbalanced(s, down, 0.);
      r -= s;
      r *= 1. / (2. * h);
      r += y;
      EXPECT_LT(r.linfty_norm(), 1e-7 * y.linfty_norm());
      const DenseProperties dense(op);
      EXPECT_LT(dense.asymmetry, 1e-13);
      const Spectrum spectrum = op.spectrum();
      EXPECT_LE(dense.largest, spectrum.safe * (1. + 1e-12));
      EXPECT_LE(dense.largest, spectrum.sharp * 1.02);
    }


    template <int dim>
    void check_damping(const Model model)
    {
      const Body<dim>        body(box<dim>(), model);
      const ElasticOperator &op = body.op();
      Vector                 y, z;
      op.initialize_vector(y);
      op.initialize_vector(z);
      Vector v = body.values(bumpy_vector<dim>), w = body.values([](const Point<dim> &p) {
        Point<dim> q(p);
        q *= 1.7;
        return bumpy_vector<dim>(q);
      });
      op.clear_constrained(v);
      op.clear_constrained(w);
      op.damping_force(y, v);
      op.damping_force(z, w);
      EXPECT_NEAR(y * w, z * v, 1e-12 * std::abs(y * v));
      double mass = 0.;
      for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
        mass += v.local_element(i) * v.local_element(i) * op.lumped_capacity().local_element(i);
      mass = dealii::Utilities::MPI::sum(mass, MPI_COMM_WORLD);
      EXPECT_GT(y * v, 0.);
      EXPECT_LT(y * v, op.damping_bound() * mass);
    }


    template <int dim>
    Vector solution(const Body<dim> &body, const std::string &name, const StaticOptions &options)
    {
      Vector       u;
      const double size = start_statics(body.op(), u, 0., options);
      const auto   n    = make_static_solver(name, body.op(), options)->solve(u, 0., size);
      EXPECT_GT(n, 0u);
      if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::cout << dim << "D, " << name << ": " << n << " iterations" << std::endl;
      return u;
    }


    /** All solvers find the same displacement as a process alone. */
    template <int dim>
    void check_statics(const Settings                 &more,
                       const Model                     model,
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
      std::map<std::string, double> expected;
      for (unsigned int i = 0; i < first.locally_owned_size(); ++i)
        expected[alone.op().place_of(i) + std::to_string(i % dim)] = first.local_element(i);
      for (const std::string &name : names)
        {
          const Body<dim> body(settings, model);
          options.multigrid = !options.multigrid;
          const Vector u    = solution(body, name, options);
          double       gap  = 0.;
          for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
            gap = std::max(gap,
                           std::abs(u.local_element(i) -
                                    expected.at(body.op().place_of(i) + std::to_string(i % dim))));
          EXPECT_LT(gap, 1e-6 * first.linfty_norm()) << name;
        }
    }


    /** The exact motion of a linear body on this process, by the eigenvectors of M^-1/2 K M^-1/2; no loads. */
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
    void check_orders(const Settings &more, const Model model)
    {
      const Settings  settings = box<dim>() + moving + more;
      const Body<dim> body(settings, model), alone(settings, model, MPI_COMM_SELF);
      Vector          u, v;
      start_motion(alone, u, v);
      const double                  t_end = 2.;
      const Vector                  exact = Modes<dim>(alone).at(u, v, t_end);
      std::map<std::string, double> expected;
      for (unsigned int i = 0; i < exact.locally_owned_size(); ++i)
        expected[alone.op().place_of(i) + std::to_string(i % dim)] = exact.local_element(i);
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
              double worst = 0.;
              for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
                worst =
                  std::max(worst,
                           std::abs(u.local_element(i) -
                                    expected.at(body.op().place_of(i) + std::to_string(i % dim))));
              errors[k]                 = dealii::Utilities::MPI::max(worst, MPI_COMM_WORLD);
              const MotionEnergy energy = stepper->energy(u, v);
              lost[k]                   = std::abs(energy.imbalance()) / energy.start;
            }
          EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2., 0.15) << name;
          EXPECT_LT(errors[1], 0.1 * exact.linfty_norm());
          EXPECT_LT(lost[1], name == "newmark" ? 1e-14 : 5e-4);
          if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
            std::cout << dim << "D, " << name << ": order " << std::log2(errors[0] / errors[1])
                      << ", energy lost " << lost[0] << ", " << lost[1] << std::endl;
        }
    }


    /** omega^2 of plane waves along x, u along the direction: sums over the lattice written down here. */
    template <int dim>
    double lattice_frequency_square(const double       m,
                                    const double       k,
                                    const unsigned int direction,
                                    const double       volumetric,
                                    const double       extension,
                                    const double       density)
    {
      // spacing 1, conical kernel over r^2, linear volume fraction
      const int reach = static_cast<int>(m + 1.);
      double    q = 0., odd = 0., even = 0.;
      for (int a = -reach; a <= reach; ++a)
        for (int b = dim > 1 ? -reach : 0; b <= (dim > 1 ? reach : 0); ++b)
          {
            const double r = std::hypot(a, b);
            if (r == 0. || r >= m + 0.5)
              continue;
            const double f = std::min(1., m + 0.5 - r);
            const double s = r < m - 0.5 ? r : r <= m ? r - 0.5 * (1. - f) : m - 0.5 * f;
            const double w = (1. - s / m) / (r * r) * f;
            q += w * r * r;
            odd += w * a * std::sin(k * a);
            const double along = direction == 0 ? a : b;
            even += w * along * along / (r * r) * (1. - std::cos(k * a));
          }
      return ((direction == 0 ? dim * volumetric * odd * odd / (q * q) : 0.) +
              2. * extension * even / q) /
             density;
    }


    template <int dim>
    void check_dispersion(const Settings &more, const double m, const unsigned int direction)
    {
      Settings        settings{{"Domain/Lower corner", zeros[dim]},
                        {"Domain/Upper corner", dim == 1 ? "40" : "40, 20"},
                        {"Domain/Cells", dim == 1 ? "40" : "40, 20"},
                        {"Peridynamics/Horizon ratio", std::to_string(m)},
                        {"Material/Young modulus", "3"},
                        {"Material/Poisson ratio", "0.2"},
                        {"Material/Density", "0.7"}};
      const Body<dim> body(settings + moving + more, Model::peridynamics);
      const StateLaw  law =
        state_law(body.scene.material.moduli(Point<dim>()), dim, body.scene.elasticity.plane);
      Vector y;
      body.op().initialize_vector(y);
      for (const double k : {0.05, 0.4, 1.5, 3.})
        {
          const Vector u = body.values([&](const Point<dim> &p) {
            Tensor<1, dim> value;
            value[direction] = std::cos(k * (p[0] - 20.));
            return value;
          });
          body.op().multiply(y, u);
          const double square =
            lattice_frequency_square<dim>(m, k, direction, law.volumetric, law.extension, 0.7);
          const double reach = 2. * (m + 1.);
          double       worst = 0.;
          for (unsigned int i = 0; i < y.locally_owned_size() / dim; ++i)
            {
              const Point<dim> &p = body.position(i);
              if (p[0] < reach || p[0] > 40. - reach ||
                  (dim > 1 && (p[dim - 1] < reach || p[dim - 1] > 20. - reach)))
                continue;
              const double mass = body.op().lumped_capacity().local_element(dim * i);
              for (unsigned int d = 0; d < dim; ++d)
                worst = std::max(worst,
                                 std::abs(y.local_element(dim * i + d) / mass -
                                          square * u.local_element(dim * i + d)));
            }
          EXPECT_LT(worst, 1e-12 * std::max(square, 1e-2)) << k;
        }
    }
  } // namespace


  TEST(FullKinematics, rotations_make_no_force)
  {
    for (const std::string nu : {"-0.3", "0.45"})
      {
        check_rotation<2>({{"Material/Poisson ratio", nu}});
        check_rotation<3>({{"Domain/Cells", "6, 4, 3"}, {"Material/Poisson ratio", nu}});
      }
    check_rotation<2>({{"Elasticity/Model", "bond-based"}, {"Elasticity/Plane", "strain"}});
  }


  TEST(FullKinematics, derivatives)
  {
    check_derivatives<1>({});
    check_derivatives<2>({{"Domain/Cells", "8, 6"}});
    check_derivatives<2>({{"Domain/Cells", "8, 6"}, {"Elasticity/Plane", "strain"}});
    check_derivatives<3>({{"Domain/Cells", "4, 3, 2"}});
  }


  TEST(ElasticOperator, viscosity)
  {
    for (const Model model : {Model::finite_elements, Model::peridynamics})
      check_damping<2>(model);
    check_damping<3>(Model::peridynamics);
  }


  TEST(StaticSolvers, agree)
  {
    const Settings loads{{"Boundary conditions/Displacement", "left: 0, 0; right: free, 0.01*x"},
                         {"Boundary conditions/Traction", "right: 0.1, 0"},
                         {"Initial and source/Body force", "x, y"}};
    // Relaxation with viscosity takes (L/h)^2 steps.
    const std::vector<std::string> quick{"linear",
                                         "conjugate gradients",
                                         "adaptive dynamic relaxation"};
    for (const Model model : {Model::finite_elements, Model::peridynamics})
      {
        check_statics<1>({{"Initial and source/Body force", "x"}, {"Domain/Cells", "12"}},
                         model,
                         static_solver_names());
        check_statics<2>(loads + Settings{{"Domain/Cells", "12, 9"}}, model, quick);
      }
    check_statics<3>(
      {{"Domain/Cells", "6, 4, 3"}, {"Boundary conditions/Traction", "right: 0, 1, 0"}},
      Model::peridynamics,
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
    check_statics<2>(bent, Model::peridynamics, names);
    check_statics<2>(Settings{{"Elasticity/Kinematics", "full"},
                              {"Domain/Cells", "12, 9"},
                              {"Material/Thermal expansion", "0.05"},
                              {"Elasticity/Temperature change", "x"}},
                     Model::peridynamics,
                     names);
  }


  TEST(StaticSolvers, messages)
  {
    StaticOptions options;
    options.max_iterations = 3;
    const Body<2> body(box<2>() + Settings{{"Initial and source/Body force", "1, 0"}},
                       Model::peridynamics);
    for (unsigned int k = 1; k < static_solver_names().size(); ++k)
      {
        options.multigrid         = false;
        const std::string name    = static_solver_names()[k];
        const std::string message = SceneTests::message_of([&] { solution(body, name, options); });
        EXPECT_NE(message.find("'Solver = " + name + "'"), std::string::npos) << message;
        EXPECT_NE(message.find("after 3 iterations"), std::string::npos) << message;
      }
    const Body<2> bent(box<2>() + Settings{{"Elasticity/Kinematics", "full"},
                                           {"Elasticity/Solver", "conjugate gradients"}},
                       Model::peridynamics);
    EXPECT_NE(SceneTests::message_of([&] {
                make_static_solver("linear", bent.op(), options);
              }).find("'Kinematics = linear'"),
              std::string::npos);
  }


  TEST(MotionSteppers, order_two)
  {
    for (const Model model : {Model::finite_elements, Model::peridynamics})
      {
        check_orders<1>({{"Domain/Cells", "12"}}, model);
        check_orders<2>({{"Domain/Cells", "8, 6"}}, model);
      }
    check_orders<3>({{"Domain/Cells", "4, 3, 2"}}, Model::peridynamics);
  }


  TEST(MotionSteppers, moving_supports_and_loads)
  {
    // What supports and loads give is found again as energy.
    const Settings driven{{"Domain/Cells", "12, 9"},
                          {"Boundary conditions/Displacement", "left: 0.1*sin(t)^2, 0"},
                          {"Boundary conditions/Traction", "right: 0, 0.1*t"}};
    for (const Model model : {Model::finite_elements, Model::peridynamics})
      for (const std::string name : {"verlet", "newmark"})
        {
          double lost[2];
          for (unsigned int k = 0; k < 2; ++k)
            {
              const Body<2> body(box<2>() + moving + driven, model);
              const double  dt      = (k == 0 ? 0.4 : 0.2) * stable_motion_step(body.op());
              const auto    stepper = make_motion_stepper(name, body.op(), with_step(dt));
              Vector        u, v;
              body.op().initialize_vector(u);
              body.op().initialize_vector(v);
              body.op().distribute(u, 0.);
              stepper->advance(u, v, 0., 3.);
              const MotionEnergy energy = stepper->energy(u, v);
              EXPECT_GT(energy.work, 1e-4);
              EXPECT_EQ(energy.start, 0.);
              lost[k] = std::abs(energy.imbalance()) / energy.work;
            }
          if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
            std::cout << name << ": energy lost " << lost[0] << ", " << lost[1] << std::endl;
          EXPECT_LT(lost[1], name == "newmark" ? 1e-13 : 3e-5);
        }
  }


  TEST(MotionSteppers, spinning_body)
  {
    // Free, with full kinematics: the moment of momentum stays, and energy.
    for (const std::string name : {"verlet", "newmark"})
      {
        const Body<2> body(
          box<2>() + full +
            Settings{{"Domain/Cells", "8, 6"}, {"Boundary conditions/Displacement", ""}},
          Model::peridynamics);
        Vector u, v = body.values([](const Point<2> &p) {
          return Tensor<1, 2>({-0.5 * (p[1] - 0.375), 0.5 * (p[0] - 0.5)});
        });
        body.op().initialize_vector(u);
        const auto momentum = [&] {
          double sum = 0.;
          for (unsigned int i = 0; i < u.locally_owned_size() / 2; ++i)
            {
              const Point<2> &p = body.position(i);
              const double    m = body.op().lumped_capacity().local_element(2 * i);
              sum += m * ((p[0] + u.local_element(2 * i)) * v.local_element(2 * i + 1) -
                          (p[1] + u.local_element(2 * i + 1)) * v.local_element(2 * i));
            }
          return dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
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
        if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
          std::cout << name << ": moment " << after / before - 1. << ", energy "
                    << energy.imbalance() / energy.start << std::endl;
      }
  }


  TEST(MotionSteppers, unstable_steps)
  {
    const Body<2> body(box<2>() + moving, Model::peridynamics);
    const double  limit   = stable_motion_step(body.op());
    std::string   message = SceneTests::message_of(
      [&] { make_motion_stepper("verlet", body.op(), with_step(1.01 * limit)); });
    for (const std::string words : {"'Time step' in section 'Time'", "stable up to", "newmark"})
      EXPECT_NE(message.find(words), std::string::npos) << message;
    // The factory does not let it through: the stepper itself finds out.
    const auto stepper = make_verlet(body.op(), with_step(1.1 * limit));
    Vector     u, v;
    start_motion(body, u, v);
    message = SceneTests::message_of([&] { stepper->advance(u, v, 0., 2000. * limit); });
    EXPECT_NE(message.find("unstable"), std::string::npos) << message;
    EXPECT_NE(message.find("kinetic energy"), std::string::npos) << message;
  }


  TEST(StateOperator, plane_waves)
  {
    check_dispersion<1>({}, 3., 0);
    check_dispersion<1>({}, 2., 0);
    for (const std::string nu : {"-0.3", "0.2", "0.45"})
      for (const unsigned int direction : {0u, 1u})
        check_dispersion<2>({{"Material/Poisson ratio", nu}}, 3., direction);
    check_dispersion<2>({{"Elasticity/Plane", "strain"}}, 2., 0);
  }
} // namespace PeriDeal
