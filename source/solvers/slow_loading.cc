// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/diverged.h>
#include <perideal/base/progress.h>
#include <perideal/base/step_break.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/slow_loading.h>
#include <perideal/solvers/static_solver.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>


namespace PeriDeal
{
  using namespace dealii;

  BreakingMotion::BreakingMotion(ElasticOperator &op, const double share)
    : op(op)
    , share(share)
    , inverse_mass(inverse_capacity(op))
  {
    op.initialize_vector(velocity);
    op.initialize_vector(residual);
  }


  void BreakingMotion::choose_step()
  {
    const double largest = op.spectrum().sharp;
    if (!(largest > 0.)) // nothing is bonded any more
      return;
    step = share * 2. / std::sqrt(largest);
    // Bonds shall break at the same step on any number of processes.
    const double unit = std::pow(10., std::floor(std::log10(step)) - 3.);
    step              = std::floor(step / unit) * unit;
  }


  double BreakingMotion::kinetic_energy() const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < inverse_mass.size(); ++i)
      if (const double v = velocity.local_element(i); v != 0.)
        sum += 0.5 * v * v / inverse_mass[i];
    return sum;
  }


  double BreakingMotion::lost() const
  {
    return dealii::Utilities::MPI::sum(damped + kinetic_energy(), velocity.get_mpi_communicator());
  }


  unsigned int BreakingMotion::run(Vector &u, const double t)
  {
    constexpr double damping    = 0.011; // rate times stable step: a wave passes a horizon in two
    constexpr unsigned int wait = 54;    // stable steps without a break
    velocity                    = 0.;
    damped                      = 0.;
    if (step == 0.)
      choose_step();
    if (step == 0.)
      return 0;
    const double       half = 0.5 * step, slows = 0.5 * damping * share; // rate times half a step
    const unsigned int n_own   = velocity.locally_owned_size();
    const unsigned int n_quiet = std::lround(wait / share);
    unsigned int       n       = 0;
    unsigned long long broken  = op.n_broken_bonds();
    op.update_contact(u);
    op.residual(residual, u, t);
    for (unsigned int quiet = 0; quiet < n_quiet; ++n)
      {
        for (unsigned int i = 0; i < n_own; ++i)
          velocity.local_element(i) = (1. - slows) * velocity.local_element(i) +
                                      half * inverse_mass[i] * residual.local_element(i);
        u.add(step, velocity);
        op.distribute(u, t);
        op.update_contact(u);
        op.residual(residual, u, t);
        for (unsigned int i = 0; i < n_own; ++i)
          velocity.local_element(i) =
            (velocity.local_element(i) + half * inverse_mass[i] * residual.local_element(i)) /
            (1. + slows);
        damped += 4. * slows * kinetic_energy();
        const bool               widened = op.widen_zone(u);
        const unsigned long long breaks  = op.break_bonds(u, t);
        quiet                            = breaks > 0 ? 0 : quiet + 1;
        if (breaks > 0)
          tell_broken_bonds(broken += breaks);
        if (quiet == 0 || widened)
          op.residual(residual, u, t);
      }
    return n;
  }


  namespace
  {
    // Stretch over critical stretch: more shortens a step, where the others break in a motion and
    // where at rest; more would shatter a body in motion. At rest the load of a break follows from
    // two equilibria, and what breaks next depends on it.
    constexpr double begins_in_motion = 1.02, begins_at_rest = 1.001, shatters = 1.05;


    /** `, the first at (0, 1), beside the side 'top', which is loaded: ...`. */
    std::string where_bonds_broke(const BreakPlaces &places)
    {
      if (places.first.empty())
        return "";
      std::ostringstream text;
      text << ", the first at (";
      for (std::size_t d = 0; d < places.first.size(); ++d)
        text << (d > 0 ? ", " : "") << places.first[d];
      text << ")";
      if (!places.beside_loads.empty())
        text << ", beside the loaded side '" << places.beside_loads.begin()->first << "'";
      return text.str();
    }


    /**
     * The equilibrium, with the faces of cracks that touch in it: roughly solved as long as these
     * change, the first one in a run, where none does yet, too. @p residual is overwritten.
     */
    template <typename Solve>
    void find_touching(ElasticOperator &op,
                       StaticSolver    &solver,
                       const double     tolerance,
                       Vector          &u,
                       const double     t,
                       const double     size,
                       Vector          &residual,
                       const bool       is_first,
                       const Solve     &solve_to)
    {
      constexpr unsigned int most    = 40;  // nodes that go on to touch by turns hardly matter
      constexpr double       rough   = 0.1; // of the residual at which a round starts
      bool                   changes = is_first && op.may_touch(), has_changed = false;
      for (unsigned int round = 0;; ++round)
        {
          double goal = size;
          // (Energies of bodies that break are balanced to the tolerance of whole solutions.)
          if (changes && size > 0. && round + 1 < most && !op.may_release_energy())
            {
              op.distribute(u, t); // unknowns that follow from others
              op.residual(residual, u, t);
              goal = std::max(size, rough * residual.l2_norm() / tolerance);
            }
          solve_to(goal, !has_changed);
          op.distribute(u, t);
          changes     = op.update_contact(u);
          has_changed = has_changed || changes;
          if ((!changes && goal <= size) || round >= most)
            return;
          if (changes)
            solver.operator_changed();
        }
    }
  } // namespace


  namespace
  {
    /** Steps go on from u. */
    void accept(ElasticOperator &op, const Vector &u, const double t, LoadingEnergy &energies)
    {
      const double before = op.released().by_law;
      op.accept(u, t);
      energies.dissipated += op.released().by_law - before;
    }
  } // namespace


  SlowLoading::SlowLoading(ElasticOperator              &op,
                           std::unique_ptr<StaticSolver> solver,
                           const StaticOptions          &options)
    : op(op)
    , solver(std::move(solver))
    , options(options)
    , work_of_forces(op)
  {
    for (Vector *v : {&before.state, &before.change, &memory.unbalanced, &memory.scratch})
      op.initialize_vector(*v);
    if (options.breaks_in_motion && op.brittle())
      breaks.motion.emplace(op);
    if (options.control_share > 0. && op.brittle())
      breaks.control.emplace(op, options.control_share);
  }


  void SlowLoading::solve(Vector &u, const double t, const bool may_be_left)
  {
    const unsigned long long n_broken = op.n_broken_bonds();
    tell_broken_bonds(op.brittle() ? n_broken : std::numeric_limits<unsigned long long>::max());
    tell_equilibrium();
    if (breaks.control)
      breaks.control->take_forward(u);
    try
      {
        // What contact has changed by then cannot be undone.
        const auto solve_to = [&](const double goal, const bool is_as_before) {
          const LeavableStep leavable(may_be_left && is_as_before);
          counts.iterations += solver->solve(u, t, goal);
        };
        find_touching(op,
                      *solver,
                      options.tolerance,
                      u,
                      t,
                      reached.size,
                      memory.unbalanced,
                      !before.any,
                      solve_to);
      }
    catch (const UserError &failure)
      {
        const auto *const diverged = dynamic_cast<const Diverged *>(&failure);
        if (n_broken == 0 || (diverged && diverged->trip.monitor == "law")) // which says it all
          throw;
        op.mechanical_loads(memory.scratch, t);
        const bool         loaded = memory.scratch.linfty_norm() > 0.;
        std::ostringstream message;
        message
          << "No equilibrium was found at t = " << t << ", after " << n_broken
          << " bonds had broken" << where_bonds_broke(op.break_places()) << ". "
          << (loaded ?
                "Nothing may bear the loads any more: pull by 'Displacement' in section 'Boundary conditions' in place of 'Traction', or use 'Solver = dynamics' in section 'Elasticity'. " :
                "Try a smaller 'Time step' in section 'Time', or another 'Solver' or 'Preconditioner' in section 'Elasticity'. ")
          << "What the solver said: " << failure.message();
        u                     = before.state;
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        throw Diverged(message.str(),
                       "solver",
                       diverged ? diverged->trip.value : none,
                       diverged ? diverged->trip.bound : none,
                       t);
      }
    check_inversion(u, t);
    op.linearize(u);
    if (breaks.control)
      breaks.control->take_back(u, t);
  }


  void SlowLoading::check_inversion(Vector &u, const double t)
  {
    if (!op.nonlinear() || found.has("inversion"))
      return;
    const Inversion inverted = op.inverted(u);
    if (inverted.n_nodes == 0)
      return;
    if (!found.may_wait())
      u = before.state;
    std::ostringstream message;
    message << "In the equilibrium that '" << solver->name() << "' has found at t = " << t << ' '
            << inverted_text(inverted);
    found.add(inversion_error(message.str(), inverted, t), counts.steps);
  }


  bool SlowLoading::break_bonds(Vector &u, const double t)
  {
    constexpr double share = 0.9; // of the largest stretch: what breaks at once
    if (breaks.control)
      return breaks.control->break_bonds(u, t, op.energy(u), so_far.dissipated);
    // What is stretched much too far would break all at once in a motion.
    const double most  = breaks.motion ? op.stretch_over_critical(u, t) : 0.;
    const bool   moves = most > 0. && most < shatters;
    if (op.break_bonds(u, t, share) == 0)
      return false;
    if (moves)
      counts.iterations += breaks.motion->run(u, t);
    return true;
  }


  void SlowLoading::change_bonds(Vector &u, const double t, const AfterStep &after_round)
  {
    if (!op.may_release_energy())
      return;
    if (!breaking.is_open)
      breaking = {t, op.energy(u), false, true, breaking.goal, breaking.most, breaking.division};
    bool grown = op.grow_cracks(u, t);
    if (grown && breaks.motion)
      breaks.motion->operator_changed();
    // Nodes join a zone until none does; only then bonds break.
    for (memory.scratch = u; grown || op.widen_zone(u) || break_bonds(u, t); grown = false)
      {
        breaking.any = true;
        solver->operator_changed();
        solve(u, t);
        const double gain = work_since(memory.scratch, u, t), left = op.energy(u);
        memory.scratch = u;
        so_far.work += gain;
        so_far.dissipated += breaking.energy + gain - left;
        breaking.energy = left;
        if (after_round)
          after_round(t);
      }
    breaking.is_open = false;
    if (options.divides_steps && op.brittle())
      breaking.most = op.stretch_over_critical(u, t);
    if (!breaking.any)
      return;
    op.unbalanced(memory.unbalanced, u, t);
    if (options.softens && !breaks.control)
      {
        const double too_much = work_of_forces.counted_too_much(before.state, u, memory.unbalanced);
        so_far.work -= too_much;
        so_far.dissipated -= too_much;
      }
    work_of_forces.begin(memory.unbalanced, t);
  }


  double SlowLoading::work_since(Vector &last, const Vector &u, const double t)
  {
    if (breaks.control)
      {
        op.unbalanced(memory.unbalanced, u, t);
        return work_of_forces.step(last, u, memory.unbalanced, t);
      }
    last.sadd(-1., 1., u);
    return last * work_of_forces.loads(); // supports and loads are at rest
  }


  void SlowLoading::begin(Vector &u, const double t)
  {
    take_accepted_residual(); // of a run that ended in between
    reached.size = start_statics(op, u, t, options);
    if (reached.size == 0.) // loads there are none, a law may do something at no strain
      {
        op.unbalanced(memory.scratch, u, t);
        reached.size = size_of_unbalanced(op, memory.scratch);
      }
    before.state = u;
    solve(u, t);
    accept(op, u, t, so_far);
    so_far.start = op.energy(u);
    op.unbalanced(memory.unbalanced, u, t);
    work_of_forces.begin(memory.unbalanced, t);
    change_bonds(u, t, {});
    accept(op, u, reached.time = t, so_far);
  }


  std::pair<double, double> SlowLoading::shorten(Vector &u, const double t)
  {
    constexpr double shortest = 1e-3; // of what is left of the step
    double           end      = t;
    if (!options.divides_steps || !op.brittle())
      return {end, 0.};
    const double begins = breaks.motion ? begins_in_motion : begins_at_rest;
    double       most   = op.stretch_over_critical(u, t);
    while (most > begins && end - reached.time > shortest * (breaking.goal - reached.time))
      {
        // Were it linear in t. It is convex where u is: at most this, then.
        const double target = 0.5 * (1. + begins);
        const double part   = (target - breaking.most) / (most - breaking.most);
        end                 = reached.time + part * (end - reached.time);
        u.sadd(part, 1. - part, before.state);
        solve(u, end);
        most = op.stretch_over_critical(u, end);
      }
    return {end, most};
  }


  void SlowLoading::step(Vector          &u,
                         const double     t,
                         const AfterStep &after_round,
                         const AfterStep &before_breaks)
  {
    const double   size_before = reached.size, goal_before = breaking.goal;
    const unsigned divisions_before = counts.divisions;
    breaking.division.whole         = t - reached.time;
    for (bool is_there = false; !is_there;)
      try
        {
          breaking.goal = t;
          reach(u, before_breaks, after_round != nullptr);
          is_there = true;
        }
      catch (const StepLeft &)
        {
          u = before.state;
          if (breaks.control)
            breaks.control->leave_step();
          reached.size     = size_before;
          breaking.goal    = goal_before;
          counts.divisions = divisions_before;
          after_round(reached.time); // keeps the state, and stops
        }
    go_on(u, after_round, before_breaks);
  }


  double SlowLoading::find_next_equilibrium(Vector &u, const bool may_be_left)
  {
    // Loads of temperatures are those of the goal; what faces of cracks have done stays. What has
    // broken may bear nothing any more.
    const bool may_divide = options.divides_steps && op.nonlinear() && !op.may_touch() &&
                            op.n_broken_bonds() == 0;
    const double before_it  = reached.size;
    bool         is_divided = breaking.division.last > 0., has_failed = false;
    // Twice as far as the last part, but no sliver is left.
    double t = is_divided && reached.time + 2.5 * breaking.division.last < breaking.goal ?
                 reached.time + 2. * breaking.division.last :
                 breaking.goal;
    for (;;)
      try
        {
          if (has_failed)
            {
              op.residual(memory.scratch, u, t); // laws know the time, too
              op.linearize(u);
              solver->operator_changed();
            }
          find_equilibrium(u, t, may_be_left);
          is_divided = is_divided && t - reached.time < (1. - 1e-9) * breaking.division.whole;
          breaking.division.last = is_divided ? t - reached.time : 0.;
          return t;
        }
      catch (const Diverged &) // on all processes
        {
          const double half = 0.5 * (t - reached.time);
          u                 = before.state;
          if (!may_divide ||
              half * breaking.division.most_parts < (1. - 1e-9) * breaking.division.whole)
            throw;
          is_divided = has_failed = true;
          t                       = reached.time + half;
          reached.size            = before_it;
          ++counts.divisions;
        }
  }


  void SlowLoading::find_equilibrium(Vector &u, const double t, const bool may_be_left)
  {
    const double of_loads =
      before.any ?
        undeformed_residual(op, u, memory.scratch, memory.unbalanced, t, options.remembers) :
        start_statics(op, u, t, options);
    reached.size = std::max(reached.size, of_loads);
    if (of_loads == 0. && (options.remembers || reached.size == 0.)) // what its law does is all
      {
        op.unbalanced(memory.scratch, before.state, t);
        reached.size = std::max(reached.size, size_of_unbalanced(op, memory.scratch));
      }
    if (before.any)
      {
        // Where forces are linear and loads change in proportion this is the solution.
        const double ratio = (t - reached.time) / (reached.time - before.start);
        u                  = before.state;
        u.sadd(1. + ratio, -ratio, before.change);
        op.distribute(u, t);
      }
    try
      {
        solve(u, t, may_be_left);
      }
    catch (const Diverged &failure) // on all processes
      {
        // Of forces, which have no value there (bonds have one).
        if (failure.trip.monitor != "inversion" || failure.trip.value > 0.)
          throw;
        op.linearize(before.state);
        continue_statics(op, u = before.state, t, options);
        solve(u, t, may_be_left);
      }
  }


  void SlowLoading::reach(Vector &u, const AfterStep &before_breaks, const bool may_be_left)
  {
    if (breaks.control)
      breaks.control->begin_step();
    before.state           = u;
    const auto [end, most] = shorten(u, find_next_equilibrium(u, may_be_left));
    op.unbalanced(memory.unbalanced, u, end);
    accept(op, u, end, so_far); // what breaks then does so at once
    before.change = u;
    before.change -= before.state;
    so_far.work += work_of_forces.step(before.state, u, memory.unbalanced, end);
    so_far.exchanged = std::max(so_far.exchanged, so_far.start + std::abs(so_far.work));
    breaking         = {end, 0., false, false, breaking.goal, breaking.most, breaking.division};
    if (before_breaks && (most > 1. || (breaks.control && breaks.control->turns_back())))
      before_breaks(end);
  }


  void SlowLoading::go_on(Vector &u, const AfterStep &after_round, const AfterStep &before_breaks)
  {
    for (;;)
      {
        change_bonds(u, breaking.time, after_round);
        before.change.sadd(-1., 1., u);
        before.any   = true;
        before.start = reached.time;
        accept(op, u, reached.time = breaking.time, so_far);
        if (reached.time >= breaking.goal)
          break;
        reach(u, before_breaks);
      }
    ++counts.steps;
    tell_step(reached.time);
  }


  void SlowLoading::renew(Vector &u)
  {
    before.state = u;
    solve(u, reached.time);
    op.unbalanced(memory.unbalanced, u, reached.time);
    so_far.work += work_of_forces.step(before.state, u, memory.unbalanced, reached.time);
    breaking = {reached.time, 0., false, false, reached.time, breaking.most, {}};
    change_bonds(u, reached.time, {});
    accept(op, u, reached.time, so_far);
  }


  void SlowLoading::exchange(Archive &archive, const NodeKeys &keys)
  {
    archive.exchange("last equilibrium", before.state, keys);
    archive.exchange("before", before.change, keys);
    archive.exchange("has before", before.any);
    archive.exchange("size of residuals", reached.size);
    archive.exchange("now", reached.time);
    archive.exchange("time before", before.start);
    archive.exchange("iterations", counts.iterations);
    archive.exchange("steps", counts.steps);
    archive.exchange("start", so_far.start);
    archive.exchange("work", so_far.work);
    archive.exchange("exchanged", so_far.exchanged);
    archive.exchange("dissipated", so_far.dissipated);
    archive.exchange("time of breaking", breaking.time);
    archive.exchange("energy of breaking", breaking.energy);
    archive.exchange("any broken", breaking.any);
    archive.exchange("breaking", breaking.is_open);
    archive.exchange("goal of the step", breaking.goal);
    archive.exchange("stretch over the critical one", breaking.most);
    archive.exchange("length of the step", breaking.division.whole);
    archive.exchange("last part of a step", breaking.division.last);
    archive.exchange("divisions", counts.divisions);
    if (breaks.motion)
      breaks.motion->exchange(archive);
    if (breaks.control)
      breaks.control->exchange(archive);
    work_of_forces.exchange(archive, keys);
    solver->exchange(archive);
  }


  LoadingEnergy SlowLoading::energy(const Vector &u) const
  {
    LoadingEnergy result = so_far;
    result.strain        = op.energy(u);
    result.exchanged     = std::max(result.exchanged, so_far.start + std::abs(so_far.work));
    return result;
  }
} // namespace PeriDeal
