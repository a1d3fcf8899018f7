// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/control.h>
#include <perideal/simulation/simulation.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** A flow, a strength, or the size of each stress intensity, by name. */
  struct MeasuredNumbers
  {
    std::map<std::string, double> values;
    double least = 0.; // differences of smaller ones are relative to this: they may be zero

    /** Others, whose names get something behind them. */
    void add(const MeasuredNumbers &others, const std::string &behind)
    {
      for (const auto &[name, value] : others.values)
        values[name + behind] = value;
      least = std::max(least, others.least);
    }
  };


  /** Of a solution that changes with time, at a time of the output. */
  struct SeenValues
  {
    std::vector<std::vector<double>>
           values;     // of each component, at the points; gaps are no numbers
    double range = 0.; // as section `Accuracy` has it
  };


  /** A solution and, where numbers are measured or it changes with time, what was seen of it. */
  template <int dim>
  struct MeasuredSolution
  {
    Simulation<dim>               &simulation;
    const Cracks<dim>             &cracks; // of its own scene: on faces or across cells
    const MeasuredNumbers         &numbers;
    const std::vector<SeenValues> &seen;
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

    /** What difference() needs of a solution that changes with time, as it is now. */
    SeenValues see(const Problem<dim> &problem, const Cracks<dim> &cracks) const;

    /**
     * Throws UserError where a force or a flow acts at a point, by its reaction in a solution, and
     * fields are measured: near it the classical solution is infinite.
     */
    void refuse_forces_at_points(Simulation<dim> &simulation) const;

    /** Numbers of a solution, none where fields are measured or its mesh is too coarse for them. */
    MeasuredNumbers numbers(Simulation<dim> &simulation, const Cracks<dim> &cracks) const;

    /**
     * How much a solution, the finer one, differs from another one, relative as section `Accuracy`
     * has it; nothing where the mesh of one of them is too coarse for what is measured. Throws
     * UserError where a solution has not what is measured.
     */
    std::optional<double> difference(const MeasuredSolution<dim> &fine,
                                     const MeasuredSolution<dim> &coarse) const;

    /**
     * The directions in which a solution does not vary, to a millionth of its range, seen along
     * lines through some points. None of what has more components than one.
     */
    std::vector<unsigned int> constant_directions(const Problem<dim> &problem,
                                                  const Cracks<dim>  &cracks) const;

  private:
    double of_values(const MeasuredSolution<dim>            &finer,
                     const MeasuredSolution<dim>            &coarser,
                     const std::vector<std::vector<double>> &points,
                     const std::vector<double>              &weights) const;

    const Scene<dim> &scene;
  };
} // namespace PeriDeal
