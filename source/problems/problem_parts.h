// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/scene/expression.h>
#include <perideal/solvers/step_span.h>
#include <perideal/solvers/step_tools.h>

#include <cmath>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** Of heat, moisture and electricity. */
  template <int dim>
  std::unique_ptr<ProblemFactory<dim>> make_diffusion_factory();

  /** Of elastic bodies. */
  template <int dim>
  std::unique_ptr<ProblemFactory<dim>> make_solid_factory();

  /** Of cracks that grow, and entries that have no effect, in diffusion. */
  template <int dim>
  void note_diffusion(const Scene<dim> &scene, std::vector<std::string> &notes);

  /** Tell in how many events cracks grow, if they do. */
  template <int dim>
  void note_growth(const Scene<dim> &scene, std::vector<std::string> &notes);


  /**
   * with_formulas() of steps from a time on, which hand on the AfterStep that they are given. What
   * they throw as Diverged without a time has that of the last step before. Collective.
   */
  inline void steps_with_formulas(const MPI_Comm                                communicator,
                                  const double                                  from,
                                  const AfterStep                              &after_step,
                                  const std::function<void(const AfterStep &)> &steps)
  {
    double          now  = from;
    const AfterStep keep = [&](const double t) {
      now = t;
      if (after_step)
        after_step(t);
    };
    try
      {
        with_formulas(communicator, [&] { steps(keep); });
      }
    catch (Diverged &diverged)
      {
        if (diverged.trip.time < 0.)
          diverged.trip.time = now;
        throw;
      }
  }


  /**
   * Throws the UserError of the first of these values that is not finite: a result with infinities
   * or NaN must not pass for one.
   *
   * @param values name and value, causes before what follows from them; the same on all processes
   * @param remedy the entries whose sizes decide, as a sentence
   */
  inline void require_finite(const std::vector<std::pair<std::string, double>> &values,
                             const std::string                                 &model,
                             const double                                       t,
                             const std::string                                 &remedy)
  {
    for (const auto &[name, value] : values)
      {
        if (std::isfinite(value))
          continue;
        std::ostringstream message;
        message << "The run ends since a result of model '" << model << "' is not finite: the "
                << name << " at t = " << t << " is " << value << ". " << remedy;
        throw not_finite(message.str(), t); // which summary.json has as a guard
      }
  }
} // namespace PeriDeal
