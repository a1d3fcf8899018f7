// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/rigid_motions.h>
#include <perideal/scene/scene.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

namespace PeriDeal
{
  namespace
  {
    using Maker =
      std::function<std::unique_ptr<StaticSolver>(ElasticOperator &, const StaticOptions &)>;

    const std::vector<std::pair<std::string, Maker>> &makers()
    {
      static const std::vector<std::pair<std::string, Maker>> list = {
        {"linear", make_linear_statics},
        {"newton", make_newton},
        {"conjugate gradients", make_conjugate_gradients},
        {"dynamic relaxation", make_dynamic_relaxation},
        {"adaptive dynamic relaxation", make_adaptive_dynamic_relaxation}};
      return list;
    }
  } // namespace


  template <int dim>
  void require_equilibrium(const Scene<dim> &scene)
  {
    const InitialAndSource        &loads      = scene.initial_and_source;
    const BoundaryConditions<dim> &conditions = scene.boundary_conditions;
    const std::string              solver     = "'Solver' in section 'Elasticity' is '" +
                               scene.elasticity.solver_name() +
                               "', which finds an equilibrium. Use 'dynamics', or ";
    loads.refuse(!loads.initial_displacement.empty(),
                 "Initial displacement",
                 "has no effect: " + solver + "leave the entry out.");
    loads.refuse(!loads.initial_velocity.empty(),
                 "Initial velocity",
                 "has no effect: " + solver + "leave the entry out.");
    for (const VectorCondition &condition : conditions.displacement)
      conditions.refuse(condition.rate,
                        "Velocity",
                        "is for motion, but " + solver + "'Displacement' with t in its formula.");
    // With a computed temperature it is the heat problem that is steady.
    scene.time.refuse(
      scene.is_loaded_slowly() && scene.time.steady && !scene.elasticity.computes_temperature,
      "Steady",
      scene.material.law.kind == SolidLaw::viscoelastic ?
        "is true, but 'Law = viscoelastic' in section 'Material' relaxes in time." :
      scene.cracks.tips.empty() ?
        "is true, but there are loads that depend on t." :
        "is true, but there are cracks that grow ('Growth' or 'Paths' in section 'Cracks').");
    const std::vector<std::string> motions = free_rigid_motions(scene);
    conditions.refuse(!motions.empty(),
                      "Displacement",
                      "nothing holds the body against: " + join_names(motions) +
                        ". Give displacements, or 'Symmetry', on sides that do.");
  }


  const std::vector<std::string> &static_solver_names()
  {
    static const std::vector<std::string> names = [] {
      std::vector<std::string> list;
      for (const auto &entry : makers())
        list.push_back(entry.first);
      return list;
    }();
    return names;
  }


  std::unique_ptr<StaticSolver> make_static_solver(const std::string   &name,
                                                   ElasticOperator     &op,
                                                   const StaticOptions &options)
  {
    for (const auto &[known, make] : makers())
      if (known == name)
        return make(op, options);
    AssertThrow(false,
                UserError("'Solver' in section 'Elasticity' is '" + name +
                          "', which is unknown. Known: " + join_names(static_solver_names()) +
                          "."));
    return nullptr;
  }


  double undeformed_residual(ElasticOperator &op,
                             Vector          &u,
                             Vector          &residual,
                             Vector          &image,
                             const double     t,
                             const bool       remembers)
  {
    u = 0.;
    if (remembers)
      op.mechanical_loads(residual, t);
    else
      op.unbalanced(residual, u, t);
    op.distribute(u, t);
    op.multiply(image, u);
    residual -= image;
    return size_of_unbalanced(op, residual);
  }


  double size_of_unbalanced(const ElasticOperator &op, Vector &forces)
  {
    constexpr double least  = 1e-3;
    const double     of_all = op.nonlinear() ? least * forces.l2_norm() : 0.;
    op.clear_constrained(forces);
    return std::max(of_all, forces.l2_norm());
  }


  double start_statics(ElasticOperator &op, Vector &u, const double t, const StaticOptions &options)
  {
    constexpr double rough = 1e-3;
    Vector           rhs, image;
    for (Vector *v : {&u, &rhs, &image})
      op.initialize_vector(*v);
    const double size = undeformed_residual(op, u, rhs, image, t, options.remembers);
    if (op.nonlinear() && size > 0.)
      {
        image = 0.;
        LinearSolver(op, rough, options.max_iterations, options.direct_up_to)
          .solve(0., 1., image, rhs);
        u += image;
      }
    return size;
  }


  void continue_statics(ElasticOperator     &op,
                        Vector              &u,
                        const double         t,
                        const StaticOptions &options)
  {
    constexpr double rough = 1e-3;
    Vector           rhs, image, change;
    for (Vector *v : {&rhs, &image, &change})
      op.initialize_vector(*v);
    op.unbalanced(rhs, u, t);
    change = u;
    op.distribute(u, t);
    change.sadd(-1., 1., u);
    op.multiply(image, change); // what supports move, and what follows from that alone
    rhs -= image;
    op.clear_constrained(rhs);
    change = 0.;
    LinearSolver(op, rough, options.max_iterations, options.direct_up_to)
      .solve(0., 1., change, rhs);
    u += change;
    op.distribute(u, t);
  }


  ResidualGoal::ResidualGoal(const std::string   &solver,
                             const StaticOptions &options,
                             const double         size)
    : solver(solver)
    , tolerance(options.tolerance)
    , most(options.max_iterations)
    , size(size)
  {}


  bool ResidualGoal::reached(const Vector &r, const unsigned int n)
  {
    const double       now = r.l2_norm();
    std::ostringstream message;
    if (!std::isfinite(now))
      message
        << "'Solver = " << solver << "' in section 'Elasticity': after " << n
        << " iterations the forces are not finite. Check the material and the loads; with 'Kinematics = full' the load may be more than the body "
           "bears: try a smaller one.";
    if (!message.str().empty())
      throw Diverged(message.str(), "solver", now, tolerance * size);
    if (n == 0 && !(size > 0.))
      size = now;
    if (now <= tolerance * size)
      return true;
    if (n >= most)
      message
        << "'Solver = " << solver << "' in section 'Elasticity' stopped after " << n
        << " iterations at a relative residual of " << now / size
        << ", above 'Tolerance' = " << tolerance
        << " in section 'Solver'. Raise 'Tolerance' or 'Maximum iterations' there, or use 'linear' or 'conjugate gradients'.";
    if (!message.str().empty())
      throw Diverged(message.str(), "solver", now / size, tolerance);
    return false;
  }


  namespace
  {
    double largest_accepted = 0.;
  }


  double round_off_of_forces(const ElasticOperator &op, const Vector &u, const double size)
  {
    constexpr double several = 16., least_digits = 1e-4;
    Vector           sizes(u);
    sizes.scale(op.diagonal());
    op.clear_constrained(sizes);
    return std::min(several * std::numeric_limits<double>::epsilon() * sizes.l2_norm(),
                    least_digits * size);
  }


  void accept_residual(const double relative)
  {
    largest_accepted = std::max(largest_accepted, relative);
  }


  double take_accepted_residual()
  {
    const double taken = largest_accepted;
    largest_accepted   = 0.;
    return taken;
  }


  RoundOffGoal::RoundOffGoal(const ElasticOperator &op,
                             const StaticOptions   &options,
                             const double           size)
    : op(op)
    , options(options)
    , size(size)
  {}


  bool RoundOffGoal::reached(const Vector &r, const Vector &u, const unsigned int n)
  {
    constexpr unsigned int seldom = 10, shortest = 100; // iterations
    const bool             is_last = n >= options.max_iterations;
    if (n % seldom != 0 && !is_last)
      return false;
    const double now = r.l2_norm();
    if (n == 0 && !(size > 0.))
      size = now;
    lowest = std::min(lowest, now);
    if (n < next && !is_last)
      return false;
    const bool no_longer_falls = lowest > 0.5 * before;
    before                     = lowest;
    lowest                     = std::numeric_limits<double>::max();
    next                       = n + std::max(shortest, n / 4);
    if (!(now > options.tolerance * size) || !(no_longer_falls || is_last) ||
        now > round_off_of_forces(op, u, size))
      return false;
    accept_residual(now / size);
    return true;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(require_equilibrium);
} // namespace PeriDeal
