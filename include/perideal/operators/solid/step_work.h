// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/base/tensor.h>

#include <perideal/base/archive.h>
#include <perideal/base/types.h>

namespace PeriDeal
{
  /** What steps dissipate, by the work of the mean of the forces before and now. */
  struct StepWork
  {
    /**
     * Go on from u, where the forces are minus @p now, to which this process has @p stored, and
     * where it has so many nodes that yield. Returns the work less what of it is stored; 0 where
     * nothing yields, and of the first state, to which no step leads. Where the temperature has
     * changed (`warms`), which stores by itself, what the law says of the step counts. Collective.
     *
     * @param by_law what the law says it has dissipated, of all processes
     * @param yields set to whether any node of any process does
     */
    double take(const Vector  &u,
                const Vector  &now,
                const double   stored_here,
                const double   n_yield,
                const double   by_law,
                const MPI_Comm communicator,
                bool          &yields)
    {
      dealii::Tensor<1, 3> sums;
      for (unsigned int k = 0; k < u.locally_owned_size(); ++k)
        {
          double      &force = forces.local_element(k), &before = displacement.local_element(k);
          const double f = now.local_element(k), at = u.local_element(k);
          sums[0] += 0.5 * (force + f) * (at - before);
          force  = f;
          before = at;
        }
      sums[1]                 = stored_here;
      sums[2]                 = n_yield;
      sums                    = dealii::Utilities::MPI::sum(sums, communicator);
      yields                  = sums[2] > 0.;
      const double work       = sums[0] - (sums[1] - stored);
      const double dissipated = !yields || !begun ? 0. : warms ? by_law : work;
      warms                   = false;
      stored                  = sums[1];
      begun                   = true;
      return dissipated;
    }

    /** Temperatures have been computed. Those after loading are those of the loaded state. */
    void take_warming(const bool computed)
    {
      warms  = computed && !loaded;
      loaded = false;
    }

    /** Collective. */
    void exchange(Archive &archive, const NodeKeys &keys)
    {
      loaded = archive.loads();
      archive.exchange("accepted displacement", displacement, keys);
      archive.exchange("accepted forces", forces, keys);
      archive.exchange("stored", stored);
      archive.exchange("begun", begun);
    }

    bool   begun  = false;
    bool   warms  = false; // temperatures have changed since the last step
    bool   loaded = false; // no temperatures have come since then
    double stored = 0.;
    Vector displacement, forces; // to be given their layout
  };
} // namespace PeriDeal
