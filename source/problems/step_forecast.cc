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


    /** How often a step applies the operator, relatively: more often the longer it is. */
    double stages(const double dt, const double largest, const bool stabilized)
    {
      constexpr double least = 2.;
      return stabilized ? std::max(least, std::sqrt(1. + 1.54 * dt * largest)) : 1.;
    }


    /** After a step: where it ends, and what the run has taken until then. */
    struct Tried
    {
      double t, applications, spent;
    };


    /**
     * What a run takes, from the steps that were tried. They grow as the later half of those, dt ~
     * t^p; where these ended before what comes in at a side had passed two cells, they stay until
     * then and go as t from there on. Each costs as those of the last quarter.
     * @param largest eigenvalue
     */
    StepForecast steps_to(const double              end,
                          const std::vector<Tried> &tried,
                          const double              largest,
                          const bool                stabilized)
    {
      constexpr unsigned int n_spans = 400;
      const std::size_t      last = tried.size() - 1, half = last / 2;
      const std::size_t      width = std::max<std::size_t>(1, last / 4);
      const auto begin_of          = [&](const std::size_t k) { return k > width ? k - width : 0; };
      // Mean steps of the last quarter, and of the one before the middle.
      const auto step = [&](const std::size_t k) {
        const std::size_t first = begin_of(k);
        return k > first ? (tried[k].t - tried[first].t) / static_cast<double>(k - first) :
                           tried[k].t;
      };
      const double layer = largest > 0. ? 11. / largest : 0.; // time until it has passed two cells
      const double t = tried[last].t, dt = step(last), from = std::max(t, layer);
      // What has come in at a side changes at the rate 1/t, once it has passed two cells.
      const double p =
        t < 3. * layer ?
          1. :
        tried.size() < 4 ?
          0. :
          std::clamp(std::log(dt / step(half)) / std::log(t / tried[half].t), 0., 1.);
      const double first = stages(dt, largest, stabilized), ratio = std::pow(end / t, 1. / n_spans);
      double       n = 0., cost = 0., s = t; // of the rest
      for (unsigned int k = 0; k < n_spans; ++k, s *= ratio)
        {
          const double of_span = dt * std::pow(std::max(s * std::sqrt(ratio), layer) / from, p),
                       count   = s * (ratio - 1.) / of_span;
          n += count;
          cost += count * stages(of_span, largest, stabilized) / first;
        }
      const Tried &now = tried[last], &before = tried[begin_of(last)];
      const double quarter = last > begin_of(last) ? static_cast<double>(last - begin_of(last)) :
                                                     1.;
      const auto   all     = [&](double Tried::*const what) {
        const double of_quarter = now.*what - (last > begin_of(last) ? before.*what : 0.);
        return now.*what + cost * of_quarter / quarter;
      };
      return {static_cast<double>(tried.size()) + n, all(&Tried::applications), all(&Tried::spent)};
    }
  } // namespace


  StepForecast forecast_steps(
    const double                                                            end,
    const std::function<void(const std::function<void(const double t)> &)> &advance,
    const Operator                                                         &op,
    const bool                                                              stabilized,
    const MPI_Comm                                                          communicator)
  {
    constexpr double      enough = 0.5, most = 8.; // seconds
    constexpr double      settled = 1.2;           // from one forecast to that of twice the time
    constexpr std::size_t least   = 8;             // steps, unless they take ten times as long
    const double          start   = processor_seconds();
    const auto            passed  = [&] {
      return dealii::Utilities::MPI::max(processor_seconds() - start, communicator);
    };
    const unsigned long long before = op.n_applications();
    const auto         n_of = [&] { return static_cast<double>(op.n_applications() - before); };
    std::vector<Tried> tried;
    StepForecast       forecast{};
    double             next = enough;
    try
      {
        advance([&](const double t) {
          if (t <= (tried.empty() ? 0. : tried.back().t)) // a step that was rejected
            return;
          tried.push_back({t, n_of(), passed()});
          const double spent = tried.back().spent;
          if (spent < next || (tried.size() < least && spent < 10. * enough))
            return;
          const StepForecast last = forecast;
          forecast                = steps_to(end, tried, op.spectrum().sharp, stabilized);
          const double ratio = last.applications > 0. ? forecast.applications / last.applications :
                                                        0.;
          if ((ratio < settled && ratio > 1. / settled) || spent >= most)
            throw Enough();
          next = std::min(2. * spent, most);
        });
        forecast = {static_cast<double>(tried.size() + 1), n_of(), passed()};
      }
    catch (const Enough &)
      {}
    return forecast;
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
