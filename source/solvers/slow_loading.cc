// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/solvers/slow_loading.h>

#include <sstream>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  SlowLoading::SlowLoading(ElasticOperator              &op,
                           std::unique_ptr<StaticSolver> solver,
                           const StaticOptions          &options)
    : op(op)
    , solver(std::move(solver))
    , options(options)
  {
    for (Vector *v : {&last, &older, &forces, &last_forces, &loads, &scratch})
      op.initialize_vector(*v);
    scratch = 1.;
    op.clear_constrained(scratch);
    held.resize(scratch.locally_owned_size());
    for (unsigned int i = 0; i < held.size(); ++i)
      held[i] = scratch.local_element(i) == 0.;
  }


  void SlowLoading::solve(Vector &u, const double t, const double size)
  {
    const unsigned long long n_broken = op.n_broken_bonds();
    try
      {
        iterations += solver->solve(u, t, size);
      }
    catch (const UserError &failure)
      {
        if (n_broken == 0)
          throw;
        std::ostringstream message;
        message
          << "No equilibrium was found at t = " << t << ", after " << n_broken
          << " bonds had broken; nothing may bear the loads any more. Pull by 'Displacement' in section 'Boundary conditions' in place of 'Traction', or use "
             "'Solver = dynamics' in section 'Elasticity'. What the solver said: "
          << failure.message();
        throw UserError(message.str());
      }
    op.linearize(u);
  }


  void SlowLoading::find_work_forces(Vector &f, const Vector &u, const double t)
  {
    op.mechanical_loads(loads, t);
    op.unbalanced(f, u, t);
    for (unsigned int i = 0; i < held.size(); ++i)
      f.local_element(i) = loads.local_element(i) - (held[i] ? f.local_element(i) : 0.);
  }


  double SlowLoading::power(const Vector &change, const Vector &a, const Vector &b) const
  {
    return 0.5 * (change * a + change * b);
  }


  void SlowLoading::break_bonds(Vector &u, const double t, const double size)
  {
    constexpr double share =
      0.9; // of the largest stretch: what breaks before the others are asked again
    if (!op.brittle())
      return;
    for (double before = op.energy(u); op.break_bonds(u) > 0;)
      {
        solver->operator_changed();
        scratch = u;
        solve(u, t, size);
        scratch.sadd(-1., 1., u);
        // Supports are at rest.
        const double gain = scratch * loads, after = op.energy(u);
        so_far.work += gain;
        so_far.dissipated += before + gain - after;
        before = after;
      }
  }


  void SlowLoading::begin(Vector &u, const double t)
  {
    const double size = start_statics(op, u, t, options);
    solve(u, t, size);
    so_far.start = op.energy(u);
    op.mechanical_loads(loads, t);
    break_bonds(u, t, size);
    find_work_forces(last_forces, u, t);
    now = t;
  }


  void SlowLoading::step(Vector &u, const double t)
  {
    const double dt = t - now;
    last            = u;
    double size     = 0.;
    if (has_older)
      {
        size = undeformed_residual(op, u, scratch, loads, t);
        // Where forces are linear and loads change in proportion this is the solution.
        const double ratio = dt / (now - last_time);
        u                  = last;
        u.sadd(1. + ratio, -ratio, older);
        op.distribute(u, t);
      }
    else
      size = start_statics(op, u, t, options);
    solve(u, t, size);
    find_work_forces(forces, u, t);
    scratch = u;
    scratch -= last;
    so_far.work += power(scratch, forces, last_forces);
    break_bonds(u, t, size);
    find_work_forces(last_forces, u, t);
    older.swap(last);
    has_older = true;
    last_time = now;
    now       = t;
  }


  LoadingEnergy SlowLoading::energy(const Vector &u) const
  {
    LoadingEnergy result = so_far;
    result.strain        = op.energy(u);
    return result;
  }
} // namespace PeriDeal
