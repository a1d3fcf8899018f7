// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::string number(const double x)
    {
      std::ostringstream text;
      text << x;
      return text.str();
    }
  } // namespace


  MotionStepper::MotionStepper(ElasticOperator &op, const double dt)
    : op(op)
    , inverse_mass(inverse_capacity(op))
    , held(held_unknowns(op))
    , longest(dt)
    , shortest(dt)
    , work_of_forces(op)
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
    for (unsigned int i = 0; i < held.size(); ++i)
      if (held[i])
        v.local_element(i) = (u.local_element(i) - last.local_element(i)) / dt;
  }


  double MotionStepper::kinetic_energy(const Vector &v, const bool supports_only) const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < held.size(); ++i)
      if (held[i] || !supports_only)
        sum += v.local_element(i) * v.local_element(i) / inverse_mass[i];
    return 0.5 * Utilities::MPI::sum(sum, v.get_mpi_communicator());
  }


  MotionEnergy MotionStepper::energy(const Vector &u, const Vector &v) const
  {
    MotionEnergy result;
    result.kinetic  = kinetic_energy(v, false);
    result.strain   = op.energy(u);
    result.released = op.released_energy();
    result.start    = started ? start : result.kinetic + result.strain;
    // What supports give to the nodes that they hold themselves.
    result.work      = started ? work + kinetic_energy(v, true) - support_start : 0.;
    result.exchanged = std::max(exchanged, result.start + std::abs(result.work));
    if (started)
      result.drift = result.imbalance() - (kept_back(step_now) - jumps);
    return result;
  }


  double MotionStepper::kept_back(const double dt) const
  {
    const double factor = kept_with_accelerations() * dt * dt;
    if (factor == 0.)
      return 0.;
    double sum = 0.;
    for (unsigned int i = 0; i < held.size(); ++i)
      if (!held[i])
        sum += unbalanced.local_element(i) * unbalanced.local_element(i) * inverse_mass[i];
    return factor * Utilities::MPI::sum(sum, unbalanced.get_mpi_communicator());
  }


  void MotionStepper::begin(const Vector &u, const Vector &v, const double t)
  {
    // What is kept back at the end of the steps so far, or of none.
    const double before = started ? kept_back(step_now) : 0.;
    op.unbalanced(unbalanced, u, t);
    work_of_forces.begin(unbalanced, t);
    jumps += kept_back(step_now) - before;
    fresh = false;
    if (started)
      return;
    started       = true;
    start         = kinetic_energy(v, false) + op.energy(u);
    support_start = kinetic_energy(v, true);
  }


  void MotionStepper::check(const Vector &v, const double t)
  {
    constexpr double too_much = 30.; // steps near the stable one exchange some energy with nothing
    // A force that sets in gives a velocity before it has done any work, which it has a step later.
    constexpr unsigned int later   = 10;
    const double           kinetic = kinetic_energy(v, false) - kinetic_energy(v, true);
    if (!(kinetic > too_much * (start + effort)))
      suspected_at = never;
    else if (suspected_at == never)
      suspected_at = spent.steps;
    std::ostringstream message;
    if (!std::isfinite(kinetic))
      message << "produced values that are not finite";
    else if (suspected_at != never && spent.steps >= suspected_at + later)
      message << "made a kinetic energy of " << kinetic << " where start and loads had brought in "
              << start + effort;
    AssertThrow(
      message.str().empty(),
      UserError("The run became unstable: stepper '" + name() + "' " + message.str() +
                " before t = " + number(t) +
                ". Choose a smaller 'Time step', or 'Stepper = newmark', in section 'Time'."));
  }


  void MotionStepper::check_drift(const Vector &u, const Vector &v, const double t)
  {
    const MotionEnergy found = energy(u, v);
    std::ostringstream message;
    // Of the energies some may be differences of larger numbers (thermal strain).
    constexpr double round_off = 1e-10;
    const double     sizes     = found.kinetic + std::abs(found.strain) + effort;
    if (!(std::abs(found.drift) <= allowed_drift * found.exchanged + round_off * sizes))
      message << "The energy of the motion is not kept: before t = " << t << " stepper '" << name()
              << "' has " << (found.drift < 0. ? "lost " : "made ") << std::abs(found.drift)
              << " of it, more than " << 100. * allowed_drift
              << " % of what start and loads have brought in, " << found.exchanged
              << ". The body deforms too much within a step of " << step_now
              << ": choose a 'Time step' of " << 0.5 * step_now
              << " or less in section 'Time', or a smaller load.";
    AssertThrow(message.str().empty(), UserError(message.str()));
  }


  void MotionStepper::check_inversion(const Vector &u, const double t) const
  {
    if (!op.nonlinear())
      return;
    const Inversion found = op.inverted(u);
    AssertThrow(found.n_nodes == 0,
                UserError("Before t = " + number(t) + " " + inverted_text(found)));
  }


  bool MotionStepper::follow_body(const Vector &u, const double t)
  {
    const double before = longest;
    if (limit)
      longest = limit->follow(u, t, spent.steps);
    shortest = std::min(shortest, longest);
    return longest != before;
  }


  void MotionStepper::set_limit(std::unique_ptr<StepLimit> new_limit)
  {
    limit = std::move(new_limit);
  }


  void MotionStepper::examine(const Vector &u, const Vector &v, const double t)
  {
    if (!started)
      return;
    check(v, t);
    check_inversion(u, t);
    check_drift(u, v, t);
  }


  void MotionStepper::break_bonds(const Vector &u, const double t)
  {
    // Between two steps: within one, half a step of their force would be lost and with it energy of
    // order dt.
    if (op.break_bonds(u, t) == 0)
      return;
    jumps -= kept_back(step_now);
    operator_changed();
    op.unbalanced(unbalanced, u, t);
    work_of_forces.begin(unbalanced, t);
    jumps += kept_back(step_now);
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
    constexpr double same = 1e-6; // not another step, but round-off of the times
    const double     next = span.n_done + 1 == span.n_steps ?
                              span.end :
                              span.start + (span.n_done + 1) * ((span.end - span.start) / span.n_steps);
    if (std::abs(next - span.now - step_now) > same * step_now)
      jumps += kept_back(next - span.now) - kept_back(step_now);
    step_now      = next - span.now;
    last          = u;
    last_velocity = v;
    step(u, v, span.now, step_now);
    ++spent.steps;
    change = u;
    change -= last;
    const double gain = work_of_forces.step(change, unbalanced, next);
    work += gain;
    effort += std::abs(gain);
    exchanged = std::max(exchanged, start + std::abs(work));
    break_bonds(u, next);
    span.now = next;
    ++span.n_done;
    tell_step(next);
  }


  void MotionStepper::look_after(const Vector &u, const Vector &v)
  {
    constexpr unsigned int between_checks = 20, between_examinations = 50;
    const bool             is_last = span.n_done == span.n_steps;
    // Of linear bodies there is nothing to be found: what their steps keep they keep to round-off.
    if (op.nonlinear() && spent.steps % between_examinations == 0)
      examine(u, v, span.now);
    else if (spent.steps % between_checks == 0 || is_last)
      check(v, span.now);
    if (spent.steps % StepLimit::between_looks != 0 || !follow_body(u, span.now) || is_last)
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
    archive.exchange("started", started);
    archive.exchange("fresh", fresh);
    archive.exchange("suspected at", suspected_at);
    archive.exchange("longest step", longest);
    archive.exchange("shortest step", shortest);
    archive.exchange("last step", step_now);
    archive.exchange("start", start);
    archive.exchange("work", work);
    archive.exchange("effort", effort);
    archive.exchange("start of supports", support_start);
    archive.exchange("jumps", jumps);
    archive.exchange("exchanged", exchanged);
    work_of_forces.exchange(archive, keys);
    if (limit)
      limit->exchange(archive);
  }


  const std::vector<std::string> &motion_stepper_names()
  {
    static const std::vector<std::string> names{"auto", "verlet", "newmark"};
    return names;
  }


  double stable_motion_step(const Operator &op)
  {
    return 2. / std::sqrt(op.spectrum().sharp);
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
    if (op.nonlinear() || op.brittle())
      stepper->set_limit(std::make_unique<StepLimit>(op, chosen.time_step, options.time_step < 0.));
    return stepper;
  }
} // namespace PeriDeal
