// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/operator.h>

#include <mpi.h>

#include <functional>
#include <string>

namespace PeriDeal
{
  struct StepForecast
  {
    double n_steps, applications; // of the operator
    double time;                  // of processors, in seconds
  };

  /**
   * How many steps a run takes and how long they take, from its first ones: where steps adapt to a
   * solution that nobody knows yet, and the material has to be found anew in each. The run goes
   * from 0 towards its end until twice the time forecasts nearly the same, for half a second of
   * processor time at least and some eight at most.
   * @param advance to the end, calling what it is given after each step but the last
   * @param op of the steps
   * @param stabilized explicit steps whose stages go with the length (rkc2)
   * Collective.
   */
  StepForecast forecast_steps(
    const double                                                            end,
    const std::function<void(const std::function<void(const double t)> &)> &advance,
    const Operator                                                         &op,
    const bool                                                              stabilized,
    const MPI_Comm                                                          communicator);

  /** Bounds of the spectrum, and what explicit steps are stable with them. */
  std::string describe_stable_steps(const Spectrum &spectrum);
} // namespace PeriDeal
