// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "step_forecast.h"

#include <deal.II/base/mpi.h>

#include <perideal/problems/problem_cost.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    /** Has been seen, thrown out of the steps. */
    struct Enough
    {};
  } // namespace


  StepForecast::StepForecast(
    const double                                                            end,
    const std::function<void(const std::function<void(const double t)> &)> &advance,
    const MPI_Comm                                                          communicator)
    : end(end)
  {
    constexpr double      enough = 1.; // second
    constexpr std::size_t least  = 8;  // steps, unless they take ten times as long
    const double          start  = processor_seconds();
    const auto            passed = [&] {
      return dealii::Utilities::MPI::max(processor_seconds() - start, communicator);
    };
    try
      {
        advance([&](const double t) {
          times.push_back(t);
          spent = passed();
          if (spent > (times.size() < least ? 10. : 1.) * enough)
            throw Enough();
        });
        is_complete = true;
        spent       = passed();
        times.push_back(end);
      }
    catch (const Enough &)
      {}
  }


  double StepForecast::n_steps() const
  {
    const double n = static_cast<double>(times.size());
    if (is_complete || times.size() < 4)
      return is_complete ? n : n * end / times.back();
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

} // namespace PeriDeal
