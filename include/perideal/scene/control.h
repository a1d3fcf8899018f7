// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/scene/choices.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/quantities.h>
#include <perideal/scene/section.h>

#include <algorithm>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Section `Time`. */
  class TimeControl : public SceneSection
  {
  public:
    TimeControl();

    bool        steady;
    double      end_time;
    std::string stepper;
    double      time_step; // negative: auto
    double      tolerance;
  };


  /** Section `Solver`. */
  class SolverControlParameters : public SceneSection
  {
  public:
    SolverControlParameters();

    double       tolerance;
    unsigned int max_iterations;
    unsigned int direct_up_to; // unknowns of a level of multigrid

    /** Of an equilibrium: max_iterations, or what the methods with cheap iterations need. */
    unsigned int most_iterations(const ElasticSolver elastic_solver) const;
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
    std::vector<double> times_beyond_end; // of `Write at`, which are not written
    std::vector<double> times_of_tables; // rows alone: of `Totals every`, no write_times among them
    std::vector<Quantity>            quantities; // set by Scene, which knows sides and phases
    std::vector<std::vector<double>> probes;
    std::vector<std::vector<double>> line; // the points of the line, evenly spaced, ends included
    std::vector<std::vector<double>> grid; // from make_grid()

    /**
     * Throws UserError. @param end_time last time written; those of `Write at` beyond it are set
     * aside.
     */
    void parse(const double end_time, const bool steady);

    /** Sorted: all at which something is written, with the end time. */
    std::vector<double> all_times(const double end_time) const;

    /** Of those: fields are written, and not totals and probes alone. */
    bool writes_fields_at(const double t) const
    {
      return !std::binary_search(times_of_tables.begin(), times_of_tables.end(), t);
    }

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
    void parse_times_of_tables(const double end_time, const bool steady);

    /** The multiples of an entry below the end time. Throws UserError where they are too many. */
    std::vector<double> times_of(const std::string &entry,
                                 const unsigned int most,
                                 const double       end_time) const;

    void parse_points_of_output();
  };


  /** Section `Checkpoint`: when the state of a run is kept, and how many such states are. */
  class CheckpointControl : public SceneSection
  {
  public:
    CheckpointControl();

    double              every           = 600.; // seconds of wall time; 0: none
    double              wall_time_limit = 0.;   // seconds; 0: none
    std::vector<double> times;                  // simulated, sorted
    unsigned int        n_kept;

    /** Throws UserError. @param end_time the last of `Times` at most; a steady scene has none. */
    void parse(const double end_time, const bool steady);

  private:
    double duration(const std::string &entry) const;
  };


  /**
   * Seconds of a duration with its unit, `90 s`, `1.5 min` or `8 h`, or `0`; negative if the text
   * is none.
   */
  double seconds_of(const std::string &text);


  /** What a run does when its state is found to be none. */
  enum class GuardAction
  {
    stop,
    warn,
    off // nothing is looked for
  };


  /** Section `Guards`. */
  class GuardControl : public SceneSection
  {
  public:
    GuardControl();

    GuardAction action;

    /** What solvers find wrong, and could go on from, does not end the run. */
    bool goes_on() const
    {
      return action != GuardAction::stop;
    }
  };


  /** In what the accuracy that section `Accuracy` asks for is measured. */
  enum class AccuracyMeasure
  {
    field,            // root mean square of the error over the body
    probes,           // largest error at the points of `Probes`
    flow,             // of what enters through a side
    stress_intensity, // largest of all ends of cracks
    strength,         // of the largest force on a side
    path              // farthest distance between the cracks that have grown
  };


  /** Section `Accuracy`: what `Models = auto` has to reach, and what it may take. */
  class AccuracyControl : public SceneSection
  {
  public:
    AccuracyControl();

    double          tolerance; // relative to the range of the values, or to the value
    AccuracyMeasure measure = AccuracyMeasure::field;
    std::string     side;         // of a flow
    double          budget;       // seconds of wall time; negative: none
    double          memory = -1.; // bytes; negative: what the machine has free

    /** Throws UserError. */
    void parse();

    /** What bonds that break lead to is measured. */
    bool measures_growth() const
    {
      return measure == AccuracyMeasure::strength || measure == AccuracyMeasure::path;
    }

    /** As the entry has it. */
    std::string measure_text() const
    {
      return text("Measure");
    }
  };


  /**
   * Bytes of a size with its unit, `500 MB` or `4 GB` (powers of 1000); negative if the text is
   * none.
   */
  double bytes_of(const std::string &text);


  /** Section `Reference`: the exact solution to compare with. */
  class Reference : public SceneSection
  {
  public:
    Reference();

    std::string solution; // expression of x, y, z, t or the name of an exact solution; empty: none
  };


  /** Section `Units`: labels for reports only. */
  class Units : public SceneSection
  {
  public:
    Units();

    std::string length, time, temperature, potential, force, energy, mass, current;

    /** Of the unknown field. */
    std::string of_field(const Physics physics) const;

    /** The absolute zero on the scale of the temperatures. Throws UserError. */
    double absolute_zero() const;

    /** `Absolute zero` is given, or follows from `Temperature`. */
    bool knows_absolute_zero() const;

  private:
    bool counts_in_celsius() const;
  };
} // namespace PeriDeal
