// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/base/step_break.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/stepper.h>

#include <functional>
#include <limits>
#include <map>
#include <sstream>

namespace PeriDeal
{
  namespace
  {
    struct Method
    {
      std::string                                                                          name;
      std::function<std::unique_ptr<Stepper>(DiffusionOperator &, const StepperOptions &)> make;
      bool is_explicit;
    };

    const std::vector<Method> &methods()
    {
      static const std::vector<Method> list = {
        {"euler", make_euler, true},
        {"rk4", make_rk4, true},
        {"rkc2",
         [](DiffusionOperator &op, const StepperOptions &options) {
           return make_rkc2(op, options);
         },
         true},
        {"chebyshev", make_chebyshev, true},
        {"crank nicolson", make_crank_nicolson, false},
        {"bdf2", make_bdf2, false},
        {"sdirk2", make_sdirk2, false}};
      return list;
    }
  } // namespace


  void Stepper::advance(Vector &u, const double t, const double t_end, const AfterStep &after_step)
  {
    span = StepSpan::between(t, t_end);
    begin_span(u);
    go_on(u, after_step);
  }


  void Stepper::go_on(Vector &u, const AfterStep &after_step)
  {
    Assert(span.is_open, dealii::ExcMessage("There is no rest of a span."));
    const auto is_over = [&] {
      return span.n_steps > 0 ? span.n_done == span.n_steps : span.now >= span.end;
    };
    while (!is_over())
      {
        const StepperCost spent_before   = spent;
        const double      entered_before = heat_entered;
        try
          {
            const LeavableStep leavable(after_step && steps_can_be_left());
            take_step(u);
          }
        catch (const StepLeft &)
          {
            spent        = spent_before;
            heat_entered = entered_before;
            after_step(span.now); // keeps the state, and stops
            continue;
          }
        ++span.n_done;
        if (after_step && !is_over())
          after_step(span.now);
      }
    span.is_open = false;
    span.now     = span.end;
    end_span(u);
  }


  void Stepper::exchange(Archive &archive, const NodeKeys &keys)
  {
    span.exchange(archive);
    spent.exchange(archive);
    archive.exchange_share("heat entered", heat_entered);
    exchange_own(archive, keys);
  }


  void refuse_unstable_step(const std::string &name, const DiffusionOperator &op, const double dt)
  {
    if (dt <= 0. || stable_step(name, 1.) == std::numeric_limits<double>::infinity())
      return;
    const Spectrum spectrum = op.spectrum();
    const double sharp = stable_step(name, spectrum.sharp), safe = stable_step(name, spectrum.safe);
    if (dt <= sharp)
      return;
    std::ostringstream message;
    message << "'Time step' in section 'Time' is " << dt << ", above the stability bound of '"
            << name << "' for this scene: steps up to ";
    if (op.depends_on_solution())
      message << safe << " are stable for sure at these temperatures (Gershgorin)";
    else
      message << sharp << " are stable (largest eigenvalue, Lanczos), up to " << safe
              << " for sure (Gershgorin)";
    message << ". Choose a smaller step, 'Time step = auto', or 'Stepper = auto'.";
    throw Diverged(message.str(), "time step", dt, sharp);
  }


  const std::vector<std::string> &stepper_names()
  {
    static const std::vector<std::string> names = []() {
      std::vector<std::string> list{"auto"};
      for (const Method &method : methods())
        list.push_back(method.name);
      return list;
    }();
    return names;
  }


  std::vector<std::string> explicit_stepper_names()
  {
    std::vector<std::string> list;
    for (const Method &method : methods())
      if (method.is_explicit)
        list.push_back(method.name);
    return list;
  }


  std::string choose_stepper(const DiffusionOperator &op)
  {
    if (!op.capacity_is_diagonal())
      return "sdirk2";
    return op.symmetric() && !op.depends_on_time() && !op.depends_on_solution() ? "chebyshev" :
                                                                                  "rkc2";
  }


  double stable_step(const std::string &name, const double largest_eigenvalue)
  {
    return stability_limit(name) / largest_eigenvalue;
  }


  std::unique_ptr<Stepper> make_stepper(const std::string    &name,
                                        DiffusionOperator    &op,
                                        const StepperOptions &options)
  {
    const std::string wanted = name == "auto" ? choose_stepper(op) : name;
    for (const Method &method : methods())
      if (method.name == wanted)
        {
          AssertThrow(
            !method.is_explicit || op.capacity_is_diagonal(),
            UserError(
              "'Stepper = " + wanted +
              "' in section 'Time' needs 'Capacity = lumped' in section "
              "'Finite elements'. With 'consistent' choose sdirk2, bdf2 or crank nicolson."));
          refuse_unstable_step(wanted, op, options.time_step);
          return method.make(op, options);
        }
    AssertThrow(false,
                UserError("'Stepper' in section 'Time' is '" + name +
                          "', which is unknown. Known: " + join_names(stepper_names()) +
                          ". Did you mean '" + nearest_name(name, stepper_names()) + "'?"));
    return nullptr;
  }
} // namespace PeriDeal
