// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/scene/choices.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/section.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** Section `Time`. */
  class TimeControl : public SceneSection
  {
  public:
    TimeControl();

    bool   steady   = false;
    double end_time = 1.;
    // auto | euler | rk4 | rkc2 | chebyshev | crank nicolson | bdf2 | sdirk2 | verlet | newmark
    std::string stepper   = "auto";
    double      time_step = -1.; // negative: auto
    double      tolerance = 1e-4;

    void parse();
  };


  /** Section `Solver`. */
  class SolverControlParameters : public SceneSection
  {
  public:
    SolverControlParameters();

    double       tolerance      = 1e-10;
    unsigned int max_iterations = 1000;
    unsigned int direct_up_to   = 2000;  // unknowns of a level of multigrid
    bool         limit_given    = false; // max_iterations

    /** Of an equilibrium: max_iterations, or what the methods with cheap iterations need. */
    unsigned int most_iterations(const ElasticSolver elastic_solver) const;

    void parse();
  };


  /** Section `Output`: points are stored as text-free coordinates, dim numbers each. */
  template <int dim>
  class OutputControl : public SceneSection
  {
  public:
    OutputControl();

    bool vtu = true, hdf5 = true;
    std::vector<double>
      write_times; // sorted, without the end time unless given; from `Write at` and `Write every`
    std::vector<double>              times_beyond_end; // of `Write at`, which are not written
    std::vector<std::vector<double>> probes;
    std::vector<std::vector<double>> line; // the points of the line, evenly spaced, ends included
    std::vector<std::vector<double>> grid; // from make_grid()

    /**
     * Throws UserError. @param end_time last time written; those of `Write at` beyond it are set
     * aside.
     */
    void parse(const double end_time, const bool steady);

    /** Fields are written at t = 0, too, as the first frame of a film: with `Write every`. */
    bool starts_at_zero() const;

    /**
     * The vertices of the lattices of `Grid` in the box with these corners, one lattice after the
     * other, x fastest. Throws UserError, also if the body is no @p box.
     */
    void make_grid(const bool                box,
                   const dealii::Point<dim> &lower,
                   const dealii::Point<dim> &upper);

  private:
    void parse_write_times(const double end_time, const bool steady);

    void parse_points_of_output();
  };


  /** Section `Reference`: the exact solution to compare with. */
  class Reference : public SceneSection
  {
  public:
    Reference();

    std::string solution; // expression of x, y, z, t or the name of an exact solution; empty: none

    void parse();
  };


  /** Section `Units`: labels for reports only. */
  class Units : public SceneSection
  {
  public:
    Units();

    std::string length = "m", time = "s", temperature = "K", potential = "V", force = "N", energy,
                mass = "kg", current = "A";

    /** Of the unknown field. */
    std::string of_field(const Physics physics) const;

    void parse();
  };
} // namespace PeriDeal
