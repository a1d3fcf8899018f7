// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

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
   * Keeps the cumulative balance of one transient model. The stepper knows what entered while it
   * advanced (Stepper::entered()); here stands what else came, and what the body held at the start.
   * Costs nothing between two times of output.
   */
  class HeatLedger
  {
  public:
    /** The run begins with this content, of the whole body. */
    void begin(const double content)
    {
      content_at_start = content;
      came_otherwise   = 0.;
    }

    /**
     * Came in between two advances, of the whole body: what nodes that an adapted mesh has more on
     * sides with given values need.
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

  private:
    double content_at_start = 0., came_otherwise = 0.;
  };
} // namespace PeriDeal
