// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** The stress of a peridynamic node, or the mean stress of a cell. */
  struct StressSample
  {
    int                           phase; // as Regions::at(), -1 elsewhere
    double                        volume;
    dealii::SymmetricTensor<2, 3> stress;
  };


  /** What a phase carries. Means are over its volume. */
  struct PhaseStatistics
  {
    std::string                   name;
    double                        volume_fraction; // of the body
    dealii::SymmetricTensor<2, 3> mean_stress;
    double mean_von_mises, highest_percentile, // exceeded in 1 % of its volume
      largest_von_mises;
  };


  /**
   * The statistics of all phases that have some volume, in the order of their names; those of
   * samples of no phase come last as `elsewhere`. No phases have no statistics. Collective.
   */
  std::vector<PhaseStatistics> phase_statistics(const std::vector<StressSample> &samples,
                                                const std::vector<std::string>  &names,
                                                const MPI_Comm                   communicator);
} // namespace PeriDeal
