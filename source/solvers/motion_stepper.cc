// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  MotionStepper::MotionStepper(ElasticOperator &op, const double dt)
    : op(op)
    , inverse_mass(inverse_capacity(op))
    , held(held_unknowns(op))
    , longest(dt)
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
    result.work = started ? work + kinetic_energy(v, true) - support_start : 0.;
    return result;
  }


  void MotionStepper::begin(const Vector &u, const Vector &v, const double t)
  {
    op.unbalanced(unbalanced, u, t);
    work_of_forces.begin(unbalanced, t);
    fresh = false;
    if (started)
      return;
    started       = true;
    start         = kinetic_energy(v, false) + op.energy(u);
    support_start = kinetic_energy(v, true);
  }


  void MotionStepper::check(const Vector &v, const double t) const
  {
    constexpr double too_much = 30.; // steps near the stable one exchange some energy with nothing
    const double     kinetic  = kinetic_energy(v, false) - kinetic_energy(v, true);
    std::ostringstream message;
    if (!std::isfinite(kinetic))
      message << "produced values that are not finite";
    else if (kinetic > too_much * (start + effort))
      message << "made a kinetic energy of " << kinetic << " where start and loads had brought in "
              << start + effort;
    AssertThrow(
      message.str().empty(),
      UserError("The run became unstable: stepper '" + name() + "' " + message.str() +
                " before t = " +
                [&] {
                  std::ostringstream time;
                  time << t;
                  return time.str();
                }() +
                ". Choose a smaller 'Time step', or 'Stepper = newmark', in section 'Time'."));
  }


  void MotionStepper::advance(Vector &u, Vector &v, const double t, const double t_end)
  {
    constexpr unsigned int between_checks = 20;
    if (fresh)
      begin(u, v, t);
    const unsigned long long n  = n_equal_steps(t_end - t, longest);
    const double             dt = (t_end - t) / n;
    for (unsigned long long k = 0; k < n; ++k)
      {
        const double now = t + k * dt, next = k + 1 == n ? t_end : t + (k + 1) * dt;
        last          = u;
        last_velocity = v;
        step(u, v, now, next - now);
        ++spent.steps;
        change = u;
        change -= last;
        const double gain = work_of_forces.step(change, unbalanced, next);
        work += gain;
        effort += std::abs(gain);
        // Bonds break between two steps: within one, half a step of their force would be lost and with it energy of order dt.
        if (op.break_bonds(u) > 0)
          {
            operator_changed();
            op.unbalanced(unbalanced, u, next);
            work_of_forces.begin(unbalanced, next);
          }
        if (k % between_checks == between_checks - 1 || k + 1 == n)
          check(v, next);
      }
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
    constexpr double share = 0.8, many = 5.;
    const bool       explicit_step = name == "auto" || name == "verlet";
    AssertThrow(
      explicit_step || name == "newmark",
      UserError("'Stepper' in section 'Time' is '" + name +
                "', which is not for motion. Known: " + join_names(motion_stepper_names()) + "."));
    StepperOptions chosen = options;
    const double   limit  = explicit_step || options.time_step < 0. ? stable_motion_step(op) : 0.;
    if (options.time_step < 0.)
      chosen.time_step = (explicit_step ? share : many) * limit;
    else if (explicit_step)
      {
        std::ostringstream message;
        message
          << "'Time step' in section 'Time' is " << options.time_step
          << ", but 'verlet' is stable up to " << limit
          << " only (2/omega of the fastest motion). Choose a smaller step, 'Time step = auto', or 'Stepper = newmark'.";
        AssertThrow(options.time_step <= limit, UserError(message.str()));
      }
    return explicit_step ? make_verlet(op, chosen) : make_newmark(op, chosen);
  }
} // namespace PeriDeal
