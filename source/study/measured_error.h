// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/accuracy.h>
#include <perideal/simulation/simulation.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** A flow, or the size of each stress intensity, by name. */
  using MeasuredNumbers = std::map<std::string, double>;


  /** A solution and, where numbers are measured, those of it. */
  template <int dim>
  struct MeasuredSolution
  {
    Simulation<dim> &simulation;
    MeasuredNumbers  numbers;
  };


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

    /** Numbers of a solution, none where fields are measured or its mesh is too coarse for them. */
    MeasuredNumbers numbers(Simulation<dim> &simulation) const;

    /**
     * How much a solution, the finer one, differs from another one, relative as section `Accuracy`
     * has it; nothing where the mesh of one of them is too coarse for what is measured. Throws
     * UserError where a solution has not what is measured.
     */
    std::optional<double> difference(const MeasuredSolution<dim> &fine,
                                     const MeasuredSolution<dim> &coarse) const;

  private:
    double of_values(const Problem<dim>                     &fine,
                     const Problem<dim>                     &coarse,
                     const std::vector<std::vector<double>> &points,
                     const std::vector<double>              &weights) const;

    const Scene<dim> &scene;
  };
} // namespace PeriDeal
