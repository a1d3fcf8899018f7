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
#include <utility>
#include <vector>

namespace PeriDeal
{
  namespace
  {
    /** Has been seen, thrown out of the steps. */
    struct Enough
    {};


    /** How often a step applies the operator, relatively: more often the longer it is. */
    double stages(const double dt, const double largest, const bool stabilized)
    {
      constexpr double least = 2.;
      return stabilized ? std::max(least, std::sqrt(1. + 1.54 * dt * largest)) : 1.;
    }


    /**
     * The number of steps to an end, and what they cost in steps like those that were tried. They
     * grow as the later half of those, dt ~ t^p; where these ended before what comes in at a side
     * had passed a cell, they stay until then and go as t from there on.
     * @param times after each step that was tried
     * @param largest eigenvalue
     */
    std::pair<double, double> steps_to(const double               end,
                                       const std::vector<double> &times,
                                       const double               largest,
                                       const bool                 stabilized)
    {
      constexpr unsigned int n_spans = 400;
      const std::size_t      last = times.size() - 1, half = last / 2;
      // Mean steps of the last quarter, and of the one before the middle.
      const auto step = [&](const std::size_t k) {
        const std::size_t width = std::max<std::size_t>(1, last / 4);
        const std::size_t first = k > width ? k - width : 0;
        return k > first ? (times[k] - times[first]) / static_cast<double>(k - first) : times[k];
      };
      const double layer = largest > 0. ? 2.8 / largest : 0.; // time until it has passed a cell
      const double t = times[last], dt = step(last), from = std::max(t, layer);
      // What has come in at a side changes at the rate 1/t, once it has passed a cell.
      const double p     = t < 4. * layer ?
                             1. :
                           times.size() < 4 ?
                             0. :
                             std::clamp(std::log(dt / step(half)) / std::log(t / times[half]), 0., 1.);
      const double first = stages(dt, largest, stabilized), ratio = std::pow(end / t, 1. / n_spans);
      double       n = static_cast<double>(times.size()), cost = n, s = t;
      for (unsigned int k = 0; k < n_spans; ++k, s *= ratio)
        {
          const double of_span = dt * std::pow(std::max(s * std::sqrt(ratio), layer) / from, p),
                       count   = s * (ratio - 1.) / of_span;
          n += count;
          cost += count * stages(of_span, largest, stabilized) / first;
        }
      return {n, cost};
    }
  } // namespace


  StepForecast forecast_steps(
    const double                                                            end,
    const std::function<void(const std::function<void(const double t)> &)> &advance,
    const Operator                                                         &op,
    const bool                                                              stabilized,
    const MPI_Comm                                                          communicator)
  {
    constexpr double      enough = 1.; // second
    constexpr std::size_t least  = 8;  // steps, unless they take ten times as long
    const double          start  = processor_seconds();
    const auto            passed = [&] {
      return dealii::Utilities::MPI::max(processor_seconds() - start, communicator);
    };
    const unsigned long long  before = op.n_applications();
    std::vector<double>       times; // after each step that was tried
    double                    spent = 0.;
    std::pair<double, double> all; // steps, and what they cost
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
        all = {times.size(), times.size()};
      }
    catch (const Enough &)
      {
        all = steps_to(end, times, op.spectrum().sharp, stabilized);
      }
    const double part = all.second / static_cast<double>(times.size());
    return {all.first, static_cast<double>(op.n_applications() - before) * part, spent * part};
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
