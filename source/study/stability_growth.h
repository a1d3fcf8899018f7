// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/problem.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/stepper.h>

#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** An explicit method with fixed steps. */
  struct ExplicitMethod
  {
    std::string  name;         // as in scenes
    unsigned int n_stages = 0; // of rkc2; 0: as many as a step needs
  };


  /** What steps have made of a disturbance. */
  struct Growth
  {
    double per_step = 1.; // factor of its size, at the end
    bool   grows    = false;
  };


  /**
   * A field of the free unknowns of size 1 in which what is fast prevails: noise by position, to
   * which C^{-1} K has been applied some 60 times. Collective.
   */
  template <int dim>
  Vector fast_field(const Problem<dim> &problem);

  /**
   * What some hundred steps of the program's own stepper make of a small disturbance of a start:
   * the difference of two runs, one with it and one without, so that loads and values at sides do
   * not count. Collective.
   */
  Growth growth_of_diffusion(DiffusionOperator    &op,
                             const Vector         &start,
                             const Vector         &disturbance,
                             const ExplicitMethod &method,
                             const double          step);

  /**
   * The same of the steps of `verlet` from rest, by the change of the difference in a step: parts
   * that have come loose drift apart at a constant rate. Both runs have the bonds that the
   * undisturbed one leaves, since one bond more that breaks changes more than any disturbance.
   * Breaks bonds of @p op. Collective.
   */
  Growth growth_of_motion(ElasticOperator &op, const Vector &disturbance, const double step);

  /** So long a run from rest without a disturbance: breaks the bonds that the load breaks. */
  void load_body(ElasticOperator &op, const double step);

  /**
   * The step at which growth begins, by bisection in logarithms around @p predicted, to 1/1000.
   * Infinity if steps do not grow up to 1000 times that. Collective.
   */
  double observed_limit(const double                                    predicted,
                        const std::function<Growth(const double step)> &run);
} // namespace PeriDeal
