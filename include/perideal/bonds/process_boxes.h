// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <mpi.h>

#include <vector>

namespace PeriDeal
{
  /** Where each process has its points: a few boxes around them, known to all. */
  template <int dim>
  class ProcessBoxes
  {
  public:
    /**
     * @param own_points of this process; consecutive ones should be near each other. Collective.
     */
    ProcessBoxes(const std::vector<dealii::Point<dim>> &own_points, const MPI_Comm communicator);

    unsigned int n_processes() const
    {
      return corners.size();
    }

    /** Whether p lies within a distance of some box of that process. Not collective. */
    bool reach(const unsigned int rank, const dealii::Point<dim> &p, const double distance) const;

  private:
    std::vector<std::vector<double>>
      corners; // of each process: lowest and highest coordinate, direction by direction, box by box
  };
} // namespace PeriDeal
