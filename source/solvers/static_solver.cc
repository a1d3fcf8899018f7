// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
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
        {"conjugate gradients", make_conjugate_gradients},
        {"dynamic relaxation", make_dynamic_relaxation},
        {"adaptive dynamic relaxation", make_adaptive_dynamic_relaxation}};
      return list;
    }
  } // namespace


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
                             const double     t)
  {
    u = 0.;
    op.unbalanced(residual, u, t); // the loads
    op.distribute(u, t);
    op.multiply(image, u);
    residual -= image;
    op.clear_constrained(residual);
    return residual.l2_norm();
  }


  double start_statics(ElasticOperator &op, Vector &u, const double t, const StaticOptions &options)
  {
    constexpr double rough = 1e-3;
    Vector           rhs, image;
    for (Vector *v : {&u, &rhs, &image})
      op.initialize_vector(*v);
    const double size = undeformed_residual(op, u, rhs, image, t);
    if (op.nonlinear() && size > 0.)
      {
        image = 0.;
        LinearSolver(op, rough, options.max_iterations, options.direct_up_to)
          .solve(0., 1., image, rhs);
        u += image;
      }
    return size;
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
    AssertThrow(message.str().empty(), UserError(message.str()));
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
    AssertThrow(message.str().empty(), UserError(message.str()));
    return false;
  }
} // namespace PeriDeal
