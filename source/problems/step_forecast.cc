// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "step_forecast.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/progress.h>
#include <perideal/problems/problem_cost.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace PeriDeal
{
  namespace
  {
    /** Has been seen, thrown out of the steps. */
    struct Enough
    {};


    /** Steps that were not tried grow as the later half of those that were, dt ~ t^p. */
    double n_steps_to(const double end, const std::vector<double> &times)
    {
      const double n = static_cast<double>(times.size());
      if (times.size() < 4)
        return n * end / times.back();
      const std::size_t last = times.size() - 1, half = last / 2;
      // Mean steps of the last quarter, and of the one before the middle.
      const auto step = [&](const std::size_t k) {
        const std::size_t width = std::max<std::size_t>(1, last / 4);
        const std::size_t first = k > width ? k - width : 0;
        return (times[k] - times[first]) / static_cast<double>(k - first);
      };
      const double t = times[last], dt = step(last);
      const double p =
        std::clamp(std::log(dt / step(half)) / std::log(t / times[half]), 0., 1. - 1e-6);
      return n + t / (dt * (1. - p)) * (std::pow(end / t, 1. - p) - 1.);
    }
  } // namespace


  StepForecast forecast_steps(
    const double                                                            end,
    const std::function<void(const std::function<void(const double t)> &)> &advance,
    const Operator                                                         &op,
    const MPI_Comm                                                          communicator)
  {
    constexpr double      enough = 1.; // second
    constexpr std::size_t least  = 8;  // steps, unless they take ten times as long
    const double          start  = processor_seconds();
    const auto            passed = [&] {
      return dealii::Utilities::MPI::max(processor_seconds() - start, communicator);
    };
    const unsigned long long before = op.n_applications();
    std::vector<double>      times; // after each step that was tried
    double                   spent = 0., n = 0.;
    try
      {
        advance([&](const double t) {
          times.push_back(t);
          spent = passed();
          if (spent > (times.size() < least ? 10. : 1.) * enough)
            throw Enough();
        });
        spent = passed();
        times.push_back(end);
        n = static_cast<double>(times.size());
      }
    catch (const Enough &)
      {
        n = n_steps_to(end, times);
      }
    const double part = n / static_cast<double>(times.size());
    return {n, static_cast<double>(op.n_applications() - before) * part, spent * part};
  }


  std::string describe_stable_steps(const Spectrum &spectrum)
  {
    std::ostringstream out;
    out << "  largest eigenvalue: sharp bound " << spectrum.sharp << ", safe bound "
        << spectrum.safe << "\n  stable steps (sharp / safe): ";
    for (const std::string name : {"euler", "rk4"})
      out << (name == "rk4" ? ", " : "") << name << " " << stable_step(name, spectrum.sharp)
          << " / " << stable_step(name, spectrum.safe);
    return out.str();
  }
} // namespace PeriDeal
