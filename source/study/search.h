// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/observed_error.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "attempts.h"
#include "measured_error.h"

namespace PeriDeal
{
  /** An attempt that has been computed. */
  template <int dim>
  struct Tried
  {
    Attempt                          attempt;
    std::shared_ptr<Scene<dim>>      scene;
    std::unique_ptr<Simulation<dim>> simulation;
    MeasuredNumbers                  numbers;
    std::vector<SeenValues>          seen; // at each time of the output, unless steady
    double                           wall_time = 0., cells = 0.;
    double                           estimate_time = 0.; // of a richer solution that was asked
    double                           memory        = 0.; // bytes on all processes

    MeasuredSolution<dim> solution() const
    {
      return {*simulation, scene->cracks, numbers, seen};
    }
  };


  /**
   * Attempts of one family, each finer than the one before, and what their differences say of the
   * error of the last one. All functions are collective.
   */
  template <int dim>
  class Search
  {
  public:
    Search(const BodyOfChoice<dim>  &body,
           const SceneText          &text,
           const MPI_Comm            communicator,
           const MeasuredError<dim> &measure,
           const LimitOfAttempts     limit);

    /** What all attempts have besides, from now on. */
    void set(const std::vector<Setting> &settings);

    const Attempts<dim> &attempts() const
    {
      return family;
    }

    Attempt first() const;

    /** What is worth a try after the last one, to get to an error. */
    Attempt next(const double tolerance) const;

    /** Solve, and compare with nothing. Throws UserError. */
    Tried<dim> solve(const Attempt &attempt) const;

    /** The first() one has been solved. */
    void know_first(Tried<dim> &&one)
    {
      known = std::move(one);
    }

    /**
     * Solve unless that one is known, and compare with the last one, of which only its numbers are
     * kept.
     */
    void compute(const Attempt &attempt);

    /** Whether cubic elements would tell the error of the first or the second solution. */
    bool asks_richer() const;

    /**
     * Solve with them. Of the first one only an error is taken that is half of what is allowed, as
     * twice that: no other mesh has been compared with.
     */
    void ask_richer();

    double time_of_richer() const;   // seconds
    double memory_of_richer() const; // bytes on all processes

    const Tried<dim> &last() const
    {
      return latest;
    }

    /** After it nothing may be asked of the last one's solution. */
    Tried<dim> release();

    /** Of the last one; negative if nothing is known yet. */
    const ObservedError &error() const
    {
      return now;
    }

    /**
     * Whether the error may be called smaller than a tolerance. An order is seen in three solutions
     * at least; a low one is not trusted as long as all are coarse, since it says more of the first
     * than of the last. Two are enough for a field where an order of 1.25 leaves their difference
     * within the tolerance: at so many points it is not small by accident; where the order is known
     * beforehand, since errors come unevenly, where half of it leaves half of the tolerance. For
     * what cubic_attempt() is for one or two are where that has been solved on the mesh of the
     * last, and two that agree within half of the tolerance, or about within it, where the second
     * agrees with that on the mesh of the first, too.
     */
    bool is_within(const double tolerance) const;

    /**
     * The order with which the error gets smaller if that is so low that the tolerance is out of
     * reach, else 0.
     */
    double hopeless_order(const double tolerance) const;

    unsigned int n_tried() const
    {
      return n;
    }
    unsigned int n_compared() const
    {
      return steps.size();
    } // with something known of the one before

    /** Seconds, and bytes on all processes. */
    double expected_time(const Attempt &attempt) const;
    double expected_memory(const Attempt &attempt) const;

  private:
    /** What cubic elements, or two that agree, say. */
    struct OfFew
    {
      bool                  are_enough = false;
      std::optional<double> predicted; // error of the first one, where that is too large
      MeasuredNumbers       of_cubic;  // on its mesh
    };

    Attempt with_settings(const double fineness) const;
    double  growth(const Attempt &attempt) const;
    double  smallest_error() const; // of the second one

    const Scene<dim>             &scene;
    const SceneText              &text;
    const MPI_Comm                communicator;
    const MeasuredError<dim>     &measure;
    const Attempts<dim>           family;
    std::vector<Setting>          settings; // of all
    std::optional<Tried<dim>>     known;    // the first one
    Tried<dim>                    latest;
    unsigned int                  n = 0;
    std::vector<ComparedSolution> steps;
    ObservedError                 now;
    OfFew                         few;
  };
} // namespace PeriDeal
