// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/operator.h>

#include <mpi.h>

#include <functional>
#include <string>
#include <tuple>
#include <vector>

namespace PeriDeal
{
  /**
   * How many steps a run takes and how long they take, from its first ones: where steps adapt to a
   * solution that nobody knows yet, and the material has to be found anew in each.
   */
  class StepForecast
  {
  public:
    /**
     * Let a run go from 0 towards its end for about a second of processor time. @param advance to
     * the end, calling what it is given after each step but the last. @param op of the steps.
     * @param stabilized explicit steps whose stages go with the length (rkc2). Collective.
     */
    StepForecast(const double                                                            end,
                 const std::function<void(const std::function<void(const double t)> &)> &advance,
                 const Operator                                                         &op,
                 const bool                                                              stabilized,
                 const MPI_Comm communicator);

    /**
     * Steps, applications of the operator, and seconds of processor time. Steps that were not tried
     * grow as the later half of those that were, dt ~ t^p; where these ended before what comes in
     * at a side had passed a cell, they stay until then and go as t from there on.
     */
    std::tuple<double, double, double> all() const;

  private:
    /** How often a step applies the operator, relatively: more often the longer it is. */
    double stages(const double dt) const;

    const double        end;
    const bool          stabilized;
    const double        largest, layer; // eigenvalue; time until a layer has passed a cell
    std::vector<double> times;          // after each step that was tried
    double              spent = 0., applications = 0.;
    bool                is_complete = false;
  };

  /** A number of what; nothing of none. */
  std::string counted(const double n, const std::string &what);

  /** Bounds of the spectrum, and what explicit steps are stable with them. */
  std::string describe_stable_steps(const Spectrum &spectrum);
} // namespace PeriDeal
