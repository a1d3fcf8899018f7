// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/scene.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>


namespace PeriDeal
{
  using namespace dealii;

  StepLimit::StepLimit(ElasticOperator &op, const double step, const bool may_change)
    : op(op)
    , first(step)
    , may_change(may_change)
    , step(step)
    , n_broken(op.n_broken_bonds())
    , next_growth(op.next_event(0.))
  {}


  double StepLimit::estimate(const Vector &u)
  {
    const unsigned long long before = op.n_applications();
    op.linearize(u);
    const double limit = stable_motion_step(op);
    spent += op.n_applications() - before + 1;
    return limit;
  }


  double StepLimit::follow(const Vector &u, const double t, const unsigned long long n_steps)
  {
    // Stretches that differ by a tenth change the limit by a few percent; 0.8 of it leaves room
    // for 25. A step that is not ours has less room, and is looked after more closely.
    constexpr double alarming = 0.25, near = 0.9, at_first = 15.;
    const double     much = may_change ? 0.1 : 0.03, cost = may_change              ? 0.03 :
                                                            op.has_growing_cracks() ? 0.25 :
                                                                                      0.1;
    const double     now     = op.largest_stretch(u);
    const bool       grown   = now > stretch + std::max(much, much * stretch);
    const bool       relaxed = step < first && now < 0.5 * stretch;
    const bool       broken  = op.n_broken_bonds() > n_broken || t >= next_growth;
    if (!grown && !relaxed && !broken)
      return step;
    if (spent > at_first + cost * n_steps && now < (1. + alarming) * (stretch + alarming))
      return step;
    const double limit = estimate(u);
    stretch            = now;
    n_broken           = op.n_broken_bonds();
    next_growth        = op.next_event(t);
    std::ostringstream message;
    if (!may_change && !(step <= limit))
      message << "'Time step' in section 'Time' is " << step << ", but at t = " << t
              << " 'verlet' is stable up to " << limit
              << (op.nonlinear() ?
                    " only: the deformed body is stiffer than the body at rest. " :
                    " only: beside cracks that have grown the body is stiffer than at the start. ")
              << "Choose a smaller step, 'Time step = auto', which follows the deformation, or "
                 "'Stepper = newmark'.";
    if (!message.str().empty())
      throw Diverged(message.str(), "time step", step, limit, t);
    if (may_change && (step > near * limit || relaxed))
      step = std::min(first, share * limit);
    return step;
  }


  void StepLimit::exchange(Archive &archive)
  {
    archive.exchange("limited step", step);
    archive.exchange("stretch at limit", stretch);
    archive.exchange("broken bonds at limit", n_broken);
    archive.exchange("next growth after limit", next_growth);
    archive.exchange("applications for limits", spent);
  }


  namespace
  {
    std::string number(const double x)
    {
      std::ostringstream text;
      text << x;
      return text.str();
    }


    /**
     * Supports move in a step much farther than in the one before, in which they had the velocity
     * @p before: they jump, or begin to move. Collective.
     */
    bool supports_jump(const Vector            &change,
                       const Vector            &before,
                       const double             dt,
                       const std::vector<bool> &held)
    {
      constexpr double much     = 10.;
      double           moves[2] = {0., 0.};
      for (unsigned int i = 0; i < held.size(); ++i)
        if (held[i])
          {
            moves[0] = std::max(moves[0], std::abs(change.local_element(i)));
            moves[1] = std::max(moves[1], std::abs(dt * before.local_element(i)));
          }
      Utilities::MPI::max(moves, change.get_mpi_communicator(), moves);
      return moves[0] > much * moves[1];
    }


    std::vector<double> zero_where(std::vector<double> values, const std::vector<bool> &where)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        if (where[i])
          values[i] = 0.;
      return values;
    }


    std::vector<unsigned int> list_of(const std::vector<bool> &which)
    {
      std::vector<unsigned int> list;
      for (unsigned int i = 0; i < which.size(); ++i)
        if (which[i])
          list.push_back(i);
      return list;
    }
  } // namespace


  MotionStepper::MotionStepper(ElasticOperator &op, const double dt, const double c)
    : op(op)
    , inverse_mass(inverse_capacity(op))
    , held(held_unknowns(op))
    , free_inverse_mass(zero_where(inverse_mass, held))
    , supports(list_of(held))
    , longest(dt)
    , shortest(dt)
    , account(op, inverse_mass, free_inverse_mass, held, c)
  {
    for (Vector *v : {&unbalanced, &last, &last_velocity, &change})
      op.initialize_vector(*v);
  }


  void MotionStepper::restart()
  {
    fresh = true;
  }


  void MotionStepper::accelerate(Vector &y, const Vector &r) const
  {
    for (unsigned int i = 0; i < held.size(); ++i)
      y.local_element(i) = held[i] ? 0. : inverse_mass[i] * r.local_element(i);
  }


  void MotionStepper::follow_supports(Vector &v, const Vector &u, const double dt) const
  {
    for (const unsigned int i : supports)
      v.local_element(i) = (u.local_element(i) - last.local_element(i)) / dt;
  }


  MotionEnergy MotionStepper::energy(const Vector &u, const Vector &v) const
  {
    return account.energy(u, v, unbalanced);
  }


  void MotionStepper::begin(const Vector &u, const Vector &v, const double t)
  {
    const double before = account.kept_back(unbalanced);
    find_touching(u);
    op.unbalanced(unbalanced, u, t);
    account.begin(u, v, unbalanced, t, before);
    op.accept(u, t);
    fresh = false;
  }


  void MotionStepper::check(const Vector &v, const double t)
  {
    const Trip fault = account.fault(v, spent.steps);
    if (fault && !found.has(fault.monitor))
      found.add(
        Diverged("The run became unstable: stepper '" + name() + "' " + fault.found +
                   " before t = " + number(t) +
                   ". Choose a smaller 'Time step', or 'Stepper = newmark', in section 'Time'.",
                 fault.monitor,
                 fault.value,
                 fault.bound,
                 t),
        spent.steps);
  }


  void MotionStepper::check_drift(const Vector &u, const Vector &v, const double t)
  {
    if (has_touched || found.has("energy"))
      return;
    const MotionEnergy now   = energy(u, v);
    const std::string  fault = account.drift_fault(now, allowed_drift);
    if (!fault.empty())
      found.add(
        Diverged("The energy of the motion is not kept: before t = " + number(t) + " stepper '" +
                   name() + "' has " + fault + ". The body deforms too much within a step of " +
                   number(account.step()) + ": choose a 'Time step' of " +
                   number(0.5 * account.step()) + " or less in section 'Time', or a smaller load.",
                 "energy",
                 now.drift,
                 allowed_drift * now.exchanged,
                 t),
        spent.steps);
  }


  void MotionStepper::check_inversion(const Vector &u, const double t)
  {
    if (!op.nonlinear() || found.has("inversion"))
      return;
    const Inversion now = op.inverted(u);
    if (now.n_nodes > 0)
      found.add(inversion_error("Before t = " + number(t) + " " + inverted_text(now), now, t),
                spent.steps);
  }


  bool MotionStepper::follow_body(const Vector &u, const double t)
  {
    const std::string what   = "time step"; // all that is gone on from here
    const double      before = longest;
    if (limit && !found.has(what))
      try
        {
          longest = limit->follow(u, t, spent.steps);
        }
      catch (const Diverged &diverged)
        {
          if (diverged.trip.monitor != what)
            throw;
          found.add(diverged, spent.steps);
        }
    shortest = std::min(shortest, longest);
    return longest != before;
  }


  void MotionStepper::set_limit(std::unique_ptr<StepLimit> new_limit)
  {
    limit = std::move(new_limit);
  }


  void MotionStepper::examine(const Vector &u, const Vector &v, const double t)
  {
    if (!account.has_begun())
      return;
    check(v, t);
    check_inversion(u, t);
    check_drift(u, v, t);
  }


  void MotionStepper::change_bonds(const Vector &u, const double t)
  {
    if (leaves_bonds)
      return;
    // Between two steps: within one, half a step of their force would be lost and with it energy of
    // order dt.
    const bool grown   = op.grow_cracks(u, t);
    const bool widened = op.widen_zone(u);
    if (op.break_bonds(u, t) == 0 && !grown && !widened)
      return;
    const double before = account.kept_back(unbalanced);
    operator_changed();
    if (grown)
      op.unbalanced(unbalanced, u, t);
    else
      op.mend_unbalanced(unbalanced, u, t);
    account.add_jump(unbalanced, t, before);
  }


  void MotionStepper::advance(Vector          &u,
                              Vector          &v,
                              const double     t,
                              const double     t_end,
                              const AfterStep &after_step)
  {
    span         = StepSpan::between(t, t_end);
    span.n_steps = n_equal_steps(t_end - t, longest);
    if (fresh)
      begin(u, v, t);
    go_on(u, v, after_step);
  }


  void MotionStepper::go_on(Vector &u, Vector &v, const AfterStep &after_step)
  {
    while (span.n_done < span.n_steps)
      {
        take_step(u, v);
        look_after(u, v);
        if (after_step && span.n_done < span.n_steps)
          after_step(span.now);
      }
    span.is_open = false;
  }


  void MotionStepper::take_step(Vector &u, Vector &v)
  {
    const double next = span.n_done + 1 == span.n_steps ?
                          span.end :
                          span.start + (span.n_done + 1) * ((span.end - span.start) / span.n_steps);
    account.set_step(next - span.now, unbalanced);
    step(u, v, span.now, account.step());
    ++spent.steps;
    // What supports do that jump is not defined where forces are not linear: it depends on what the
    // body does meanwhile. So that step does not conserve the energy, however short it is.
    bool   jumps = false;
    double drift = 0.;
    if (op.nonlinear() && op.depends_on_time() && !found.has("energy"))
      {
        change = u;
        change -= last;
        jumps = supports_jump(change, last_velocity, account.step(), held);
      }
    if (jumps)
      {
        op.unbalanced(change, last, span.now);
        drift = account.energy(last, last_velocity, change).drift;
        op.unbalanced(change, u, next); // mend_unbalanced() goes on from the latest forces
      }
    account.add_step(last, u, unbalanced, next);
    if (jumps)
      account.add_jump(unbalanced,
                       next,
                       account.kept_back(unbalanced) + energy(u, v).drift - drift);
    op.accept(u, next); // what breaks has dissipated, too
    change_bonds(u, next);
    span.now = next;
    ++span.n_done;
    tell_step(next);
  }


  void MotionStepper::look_after(const Vector &u, const Vector &v)
  {
    constexpr unsigned int between_checks = 5, between_examinations = 50;
    const bool             is_last = span.n_done == span.n_steps;
    // Of linear bodies there is nothing to be found: what their steps keep they keep to round-off.
    if (op.nonlinear() && spent.steps % between_examinations == 0)
      examine(u, v, span.now);
    else if (spent.steps % between_checks == 0 || is_last)
      check(v, span.now);
    if (spent.steps % op.stepping.between_looks != 0 || !follow_body(u, span.now) || is_last)
      return;
    span.start   = span.now;
    span.n_steps = n_equal_steps(span.end - span.now, longest);
    span.n_done  = 0;
  }


  void MotionStepper::exchange(Archive &archive, const NodeKeys &keys)
  {
    span.exchange(archive);
    spent.exchange(archive);
    archive.exchange("unbalanced", unbalanced, keys);
    archive.exchange("fresh", fresh);
    archive.exchange("has touched", has_touched);
    archive.exchange("longest step", longest);
    archive.exchange("shortest step", shortest);
    account.exchange(archive, keys);
    if (limit)
      limit->exchange(archive);
    exchange_own(archive);
  }


  template <int dim>
  void require_stepper(const Scene<dim> &scene)
  {
    const TimeControl       &time    = scene.time;
    const ElasticityControl &solid   = scene.elasticity;
    const auto              &names   = motion_stepper_names();
    const bool               is_auto = time.stepper == "auto", moves = !solid.is_static();
    const bool for_motion = !is_auto && std::count(names.begin(), names.end(), time.stepper) > 0;
    time.refuse(for_motion && !scene.deforms,
                "Stepper",
                "'" + time.stepper + "' is for motion ('Physics = elasticity'); 'Physics' is '" +
                  names_of(scene.general.physics).physics + "'. Use 'auto'.");
    time.refuse(
      !is_auto && !for_motion && scene.deforms && !solid.computes_temperature,
      "Stepper",
      "'" + time.stepper +
        "' is for diffusion; with 'Physics = elasticity' the 'Solver' in section 'Elasticity' decides. Use 'auto', with "
        "'dynamics' also 'verlet' or 'newmark', and with 'Temperature change = computed' those of heat.");
    time.refuse(for_motion && !moves,
                "Stepper",
                "'" + time.stepper + "' is for motion, but 'Solver' in section 'Elasticity' is '" +
                  solid.solver_name() + "'. Use 'Solver = dynamics'.");
    time.refuse(
      moves && time.steady,
      "Steady",
      "is true, but 'Solver' in section 'Elasticity' is 'dynamics'. Use another solver for the equilibrium.");
  }


  const std::vector<std::string> &motion_stepper_names()
  {
    static const std::vector<std::string> names{"auto", "verlet", "newmark"};
    return names;
  }


  double stable_motion_step(const Operator &op)
  {
    return stability_limit("verlet") / std::sqrt(op.spectrum().sharp);
  }


  std::unique_ptr<MotionStepper> make_motion_stepper(const std::string    &name,
                                                     ElasticOperator      &op,
                                                     const StepperOptions &options)
  {
    constexpr double many          = 5.;
    const bool       explicit_step = name == "auto" || name == "verlet";
    AssertThrow(
      explicit_step || name == "newmark",
      UserError("'Stepper' in section 'Time' is '" + name +
                "', which is not for motion. Known: " + join_names(motion_stepper_names()) + "."));
    require_mass(op);
    op.stepping.follow    = explicit_step; // from the first product on
    StepperOptions chosen = options;
    const double   limit  = explicit_step || options.time_step < 0. ? stable_motion_step(op) : 0.;
    if (options.time_step < 0.)
      chosen.time_step = (explicit_step ? StepLimit::share : many) * limit;
    else if (explicit_step)
      {
        std::ostringstream message;
        message
          << "'Time step' in section 'Time' is " << options.time_step
          << ", but 'verlet' is stable up to " << limit
          << " only (2/omega of the fastest motion). Choose a smaller step, 'Time step = auto', or 'Stepper = newmark'.";
        AssertThrow(options.time_step <= limit, UserError(message.str()));
      }
    if (!explicit_step)
      return make_newmark(op, chosen);
    auto stepper = make_verlet(op, chosen);
    if (op.nonlinear() || op.may_release_energy())
      stepper->set_limit(std::make_unique<StepLimit>(op, chosen.time_step, options.time_step < 0.));
    return stepper;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(require_stepper);
} // namespace PeriDeal
