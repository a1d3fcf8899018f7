// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <perideal/base/archive.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace PeriDeal
{
  /**
   * What has come into a body (heat, moisture, charge) since the start, against what it holds more
   * than then.
   */
  struct CumulativeBalance
  {
    double entered = 0.; // through sides and from sources
    double stored  = 0.; // the change of the content

    double imbalance() const
    {
      return entered - stored;
    }
  };


  /**
   * Keeps the cumulative balance of one transient model, and how much heat there was to be kept.
   * The stepper knows what entered while it advanced (Stepper::entered()); here stands what else
   * came, and what the body held at the start. Costs a sum over all processes between two times of
   * output, where it is asked to see().
   */
  class HeatLedger
  {
  public:
    /** The run begins with this content, of the whole body. */
    void begin(const double content)
    {
      *this            = HeatLedger();
      content_at_start = content;
    }

    /** What the body held then. */
    double at_start() const
    {
      return content_at_start;
    }

    /**
     * Came in between two advances, of the whole body: heat of deformation, and what nodes that an
     * adapted mesh has more on sides with given values need.
     */
    void add(const double heat)
    {
      came_otherwise += heat;
    }

    /**
     * @param entered by the stepper, this process's share; @param content now, of the whole body.
     *                Collective.
     */
    CumulativeBalance balance(const double   entered,
                              const double   content,
                              const MPI_Comm communicator) const
    {
      return {dealii::Utilities::MPI::sum(entered, communicator) + came_otherwise,
              content - content_at_start};
    }

    /**
     * Between two times of output: what has entered so far, as for balance(). What comes in and
     * leaves again counts, as long as somebody looks in between. Collective.
     */
    void see(const double entered, const MPI_Comm communicator)
    {
      turn_over(dealii::Utilities::MPI::sum(entered, communicator) + came_otherwise);
    }

    /**
     * A balance has been found at time t.
     * @param apart   heat that lies elsewhere than where it would be if spread evenly
     * @param through what enters per time; of two times of output the smaller one counts for the
     *                time between, so that a moment counts for nothing
     * Not collective.
     */
    void keep(const CumulativeBalance &found,
              const double             apart,
              const double             through,
              const double             t)
    {
      turn_over(found.entered);
      passed += std::min(through_then, through) * (t - then);
      most         = std::max({most, std::abs(found.entered), std::abs(found.stored), apart});
      through_then = through;
      then         = t;
      last         = found;
    }

    /** What keep() has had last; not kept by exchange(). Not collective. */
    const CumulativeBalance &last_found() const
    {
      return last;
    }

    /**
     * The most heat that the body has held besides that of the start, or that has moved through its
     * sides or from sources: against which an imbalance is small or not. Not collective.
     */
    double most_moved() const
    {
      return std::max({most, turned_over, passed});
    }

    /** Collective. */
    void exchange(Archive &archive)
    {
      archive.exchange("content at start", content_at_start);
      // The rest stands behind one that has always been there: checkpoints without it still do.
      std::vector<double>
        values{came_otherwise, most, turned_over, entered_then, passed, through_then, then};
      archive.exchange("came otherwise", values);
      double *const members[] =
        {&came_otherwise, &most, &turned_over, &entered_then, &passed, &through_then, &then};
      for (unsigned int k = 0; archive.loads() && k < values.size(); ++k)
        *members[k] = values[k];
    }

  private:
    void turn_over(const double entered)
    {
      turned_over += std::abs(entered - entered_then);
      entered_then = entered;
    }

    double content_at_start = 0., came_otherwise = 0.;

    double most        = 0.;                          // at any keep()
    double turned_over = 0., entered_then = 0.;       // in and out, seen from time to time
    double passed = 0., through_then = 0., then = 0.; // through the body

    CumulativeBalance last;
  };
} // namespace PeriDeal
