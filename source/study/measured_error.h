// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/accuracy.h>
#include <perideal/simulation/simulation.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * What section `Accuracy` measures of a solution, so that two can be compared. All functions are
   * collective.
   */
  template <int dim>
  class MeasuredError
  {
  public:
    /** Throws UserError where the scene has not what is measured. */
    explicit MeasuredError(const Scene<dim> &scene);

    /**
     * How much a solution, the finer one, differs from another one, relative as section `Accuracy`
     * has it; nothing where the mesh of one of them is too coarse for what is measured. Throws
     * UserError where a solution has not what is measured.
     */
    std::optional<double> difference(Simulation<dim> &fine, Simulation<dim> &coarse) const;

  private:
    double                of_values(const Problem<dim>                     &fine,
                                    const Problem<dim>                     &coarse,
                                    const std::vector<std::vector<double>> &points,
                                    const std::vector<double>              &weights) const;
    std::optional<double> of_numbers(Simulation<dim> &fine, Simulation<dim> &coarse) const;

    const Scene<dim> &scene;
  };
} // namespace PeriDeal
