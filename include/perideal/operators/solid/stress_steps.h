// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/diverged.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/stress_law.h>
#include <perideal/operators/solid/law_fault.h>
#include <perideal/scene/body_parameters.h>

#include <string>
#include <utility>

namespace PeriDeal
{
  /**
   * A law of stresses is asked about the step from the last accepted time to that of now. What it
   * throws is kept until throw_faults(); until then it is not asked again, and stresses are zero.
   */
  struct StressSteps
  {
    template <int dim>
    static StressSteps of_scene(const BodyParameters<dim> &body)
    {
      const double end = body.cracks.end_time;
      StressSteps  steps;
      steps.instant = end > 0. ? 1e-9 * end : 1.;
      return steps;
    }

    /** Of a trial without times. @param at_start as if no step had been taken */
    StressLaw::Response update(const StressLaw    &law,
                               StressLaw::Trial    trial,
                               double             *next,
                               StressLaw::Tangent *tangent,
                               const bool          at_start = false) const
    {
      trial.instant = instant;
      if (!at_start)
        {
          trial.time      = now;
          trial.step      = now - accepted;
          trial.increment = n + 1;
        }
      try
        {
          if (fault.empty()) // it may have words of its own for each
            return law.update(trial, next, tangent);
        }
      catch (const UserError &error)
        {
          fault    = error.message();
          too_long = dynamic_cast<const Diverged *>(&error) != nullptr;
        }
      if (tangent != nullptr)
        *tangent = 0.;
      return {};
    }

    /**
     * Throw what the law has thrown on any process: Diverged where all that it asks for is a
     * shorter step. Collective.
     */
    void throw_faults(const StressLaw &law, const MPI_Comm communicator) const
    {
      if (!law.may_fail())
        return;
      const std::string of_this = std::move(fault);
      fault.clear();
      throw_law_fault(of_this, too_long, now, communicator);
    }

    /** @param changes a state has changed, on any process */
    void accept(const double t, const bool changes)
    {
      n += changes || t > accepted ? 1 : 0;
      accepted = now = t;
    }

    void exchange(Archive &archive)
    {
      archive.exchange("time", accepted);
      archive.exchange("steps", n);
      now = accepted;
    }

    double              instant  = 1.; // a time that is as good as none
    double              accepted = 0.;
    mutable double      now      = 0.;
    unsigned int        n = 0; // accepted ones in which something has happened, or time has passed
    mutable std::string fault; // of this process
    mutable bool        too_long = false; // it is that the step is
  };


  /** A point of the body whose volume large deformations have made so many times what it was. */
  template <int dim>
  Trip turned_inside_out(const dealii::Point<dim> &place, const double ratio, const double time)
  {
    Trip found;
    found.monitor = "inversion";
    found.value   = ratio;
    found.bound   = 0.;
    found.time    = time;
    found.found =
      "The displacements turn the body inside out at " + place_text(place) +
      ". The loads change by too much at once, or are more than the body bears: choose a smaller 'Time step' in section 'Time', "
      "let loads that jump begin at 0 (formulas of t), or use finer 'Cells' in section 'Domain'.";
    for (unsigned int d = 0; d < dim; ++d)
      found.place.push_back(place[d]);
    return found;
  }
} // namespace PeriDeal
