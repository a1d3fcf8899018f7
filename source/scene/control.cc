// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/control.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace PeriDeal
{
  namespace
  {
    constexpr double       time_slack   = 1e-12;
    constexpr unsigned int max_n_writes = 100000, max_n_rows = 1000000; // of fields, of tables
    constexpr unsigned int max_n_points = 1000000;
  } // namespace


  TimeControl::TimeControl()
    : SceneSection("Time")
  {
    declare(end_time, "End time", "1", "time", Bounds::positive) =
      "The run goes from time 0 to this time.";
    declare(steady, "Steady", "false") =
      "Solve for the steady state; all other entries of this section are ignored then. So they are in elastic equilibrium, by any "
      "`Solver` in section `Elasticity` but `dynamics`, unless a load depends on t: then it is found at one time after the other. With `Temperature change = "
      "computed` in that section all entries tell of the heat problem.";
    declare(stepper,
            "Stepper",
            "auto",
            {"auto",
             "euler",
             "rk4",
             "rkc2",
             "chebyshev",
             "crank nicolson",
             "bdf2",
             "sdirk2",
             "verlet",
             "newmark"}) =
      "Time integration: `auto` picks chebyshev (constant loads, symmetric operator; crank nicolson for finite elements that are very stiff), else rkc2, and "
      "sdirk2 for a consistent capacity. Of these and bdf2 the steps "
      "adapt to Tolerance; euler and rk4 have a fixed step. Motion (elasticity with `Solver = dynamics`): verlet (explicit; `auto`) and newmark "
      "(implicit, average acceleration), both with a fixed step.";
    declare_if_given(time_step, "Time step", "auto", "time", Bounds::positive) =
      "`auto` or a number; euler takes that very step. A step above the stability limit is "
      "refused; one of an implicit method whose iterations for T in `Material` do not converge is divided. Motion: `auto` is 0.8 of the limit of verlet, and 5 times that limit with newmark. Elastic equilibria under loads that depend on t: "
      "the step between two of them, `auto` is a hundredth of End time.";
    declare(tolerance, "Tolerance", "1e-4", "1", Bounds::fraction) =
      "Relative accuracy in time of adaptive steppers, between 0 and 1. Not given: 1e-8 with `Heat of deformation` in section `Elasticity`.";
  }


  SolverControlParameters::SolverControlParameters()
    : SceneSection("Solver")
  {
    declare(tolerance, "Tolerance", "1e-10", "1", Bounds::fraction) =
      "Relative residual at which solvers stop, between 0 and 1: the l2 norm of the residual over that of the start.";
    declare(max_iterations, "Maximum iterations", "1000", Bounds::one_or_more) =
      "A solver that needs more iterations ends the run with an error. Not given: 100000 with `Solver = conjugate gradients` in section `Elasticity`, "
      "10000000 with dynamic relaxation.";
    declare(direct_up_to, "Direct solver up to", "2000", Bounds::one_or_more) =
      "Multigrid solves a level of at most so many unknowns directly. Smaller systems need one iteration, whose cost is that of a "
      "factorization.";
  }


  unsigned int SolverControlParameters::most_iterations(const ElasticSolver elastic_solver) const
  {
    if (is_given("Maximum iterations") || elastic_solver == ElasticSolver::linear ||
        elastic_solver == ElasticSolver::newton)
      return max_iterations;
    return elastic_solver == ElasticSolver::conjugate_gradients ? 100000 : 10000000;
  }


  template <int dim>
  OutputControl<dim>::OutputControl()
    : SceneSection("Output")
  {
    declare("Fields", EntryType::choices, "vtu, hdf5", "", {"vtu", "hdf5", "none"}) =
      "File formats of the fields; `none` writes no fields.";
    declare("Write at", EntryType::list, "", "time") =
      "Times of output, separated by commas; steps land on them. The end time is always written.";
    declare("Write every", EntryType::text, "", "time") =
      "Time between two outputs, instead of Write at. Fields are written at t = 0, too, for films.";
    declare("Totals every", EntryType::text, "", "time") =
      "Time between two rows of totals.csv and probes.csv, which then are written more often than fields; steps land on these times, too.";
    declare("Quantities", EntryType::list) =
      "Rows of totals.csv: `name: max FIELD`, or min, mean or sum (the integral), several separated by `;`. Of the whole body, or `on SIDE` (or a part), `over region FORMULA` (where it is > 0), `over PHASE`: `tip: max uy on right ; zone: mean von_mises over region x - 0.9`. "
      "Fields are those of the files; of vectors the magnitude, with _x, _y, _z a component (ux, uy, uz of displacements). `max` and `min` tell their place, too.";
    declare("Probes", EntryType::list, "", "length") =
      "Points whose values go to probes.csv, separated by `;`.";
    declare("Line", EntryType::list, "", "length, length, 1") =
      "`start ; end ; number of points`: evenly spaced points whose values go to line.csv; those that lie in holes or otherwise outside the body are gaps (nan).";
    declare("Grid", EntryType::list, "", "1") =
      "Numbers of cells, one per direction: the values at the vertices of such a lattice over the box go to grid.csv. Several "
      "lattices are separated by `;`.";
  }


  template <int dim>
  void OutputControl<dim>::parse_write_times(const double end_time, const bool steady)
  {
    write_times.clear();
    times_beyond_end.clear();
    const std::string &at = text("Write at"), &every = text("Write every");
    if (!at.empty() && !every.empty())
      error("Write every", "'Write at' is given, too: give one of the two.");
    if (steady && !(at.empty() && every.empty()))
      error(
        at.empty() ? "Write every" : "Write at",
        "is given, but the scene is steady ('Steady' in section 'Time', or an elastic equilibrium): there are no times to write at.");
    for (const std::string &piece : split_list(at, ','))
      {
        const double time = parse_number(piece, where("Write at"));
        refuse(time < 0., "Write at", "the time " + piece + " is negative.");
        if (time > end_time * (1. + time_slack))
          {
            times_beyond_end.push_back(time);
            continue;
          }
        write_times.push_back(std::min(time, end_time));
      }
    if (!every.empty())
      write_times = times_of("Write every", max_n_writes, end_time);
    std::sort(times_beyond_end.begin(), times_beyond_end.end());
    std::sort(write_times.begin(), write_times.end());
    write_times.erase(std::unique(write_times.begin(), write_times.end()), write_times.end());
  }


  template <int dim>
  void OutputControl<dim>::parse_times_of_tables(const double end_time, const bool steady)
  {
    times_of_tables.clear();
    if (text("Totals every").empty())
      return;
    refuse(
      steady,
      "Totals every",
      "is given, but the scene is steady ('Steady' in section 'Time', or an elastic equilibrium): there are no times to write at.");
    const double same = 1e-9 * end_time; // times that are one but for round-off
    for (const double t : times_of("Totals every", max_n_rows, end_time))
      {
        const auto next       = std::lower_bound(write_times.begin(), write_times.end(), t);
        const bool is_written = (next != write_times.end() && *next - t < same) ||
                                (next != write_times.begin() && t - *(next - 1) < same);
        if (!is_written)
          times_of_tables.push_back(t);
      }
  }


  template <int dim>
  std::vector<double> OutputControl<dim>::times_of(const std::string &entry,
                                                   const unsigned int most,
                                                   const double       end_time) const
  {
    const std::string &every = text(entry);
    const double       step  = parse_number(every, where(entry));
    refuse(!(step > 0.), entry, "found " + every + ", needs a number greater than 0.");
    if (end_time / step > most)
      error(entry,
            "found " + every + ", which gives more than " + std::to_string(most) +
              " outputs until 'End time' (" + number_text(end_time) + ").");
    std::vector<double> times;
    // the end time itself is written anyway
    for (unsigned int k = 1; k * step < end_time * (1. - 1e-9); ++k)
      times.push_back(k * step);
    return times;
  }


  template <int dim>
  std::vector<double> OutputControl<dim>::all_times(const double end_time) const
  {
    std::vector<double> times;
    std::merge(write_times.begin(),
               write_times.end(),
               times_of_tables.begin(),
               times_of_tables.end(),
               std::back_inserter(times));
    if (times.empty() || times.back() < end_time)
      times.push_back(end_time);
    return times;
  }


  template <int dim>
  bool OutputControl<dim>::starts_at_zero() const
  {
    return !text("Write every").empty();
  }


  template <int dim>
  void OutputControl<dim>::parse_points_of_output()
  {
    probes.clear();
    for (const dealii::Point<dim> &p : parse_points<dim>(text("Probes"), where("Probes")))
      probes.emplace_back(p.begin_raw(), p.end_raw());

    line.clear();
    const std::vector<std::string> pieces = split_list(text("Line"), ';');
    if (pieces.empty())
      return;
    if (pieces.size() != 3)
      error("Line", "found '" + text("Line") + "', needs 'start ; end ; number of points'.");
    const dealii::Point<dim> start = parse_point<dim>(pieces[0], where("Line"));
    const dealii::Point<dim> end   = parse_point<dim>(pieces[1], where("Line"));
    const unsigned int       n     = parse_whole_number(pieces[2], where("Line"), max_n_points);
    refuse(n < 2, "Line", "found " + pieces[2] + " points, needs 2 or more.");
    refuse(start == end, "Line", "start and end are the same point.");
    for (unsigned int i = 0; i < n; ++i)
      {
        // the ends exactly as given
        dealii::Point<dim> p;
        for (unsigned int d = 0; d < dim; ++d)
          p[d] = i + 1 == n ? end[d] : start[d] + (end[d] - start[d]) * i / (n - 1.);
        line.emplace_back(p.begin_raw(), p.end_raw());
      }
  }


  template <int dim>
  void OutputControl<dim>::parse(const double end_time, const bool steady)
  {
    SceneSection::parse();
    const std::vector<unsigned int> formats = choice_indices("Fields");
    vtu                                     = false;
    hdf5                                    = false;
    for (const unsigned int format : formats)
      {
        vtu  = vtu || format == 0;
        hdf5 = hdf5 || format == 1;
        refuse(format == 2 && formats.size() > 1, "Fields", "'none' stands alone.");
      }
    parse_write_times(end_time, steady);
    parse_times_of_tables(end_time, steady);
    parse_points_of_output();
  }


  template <int dim>
  void OutputControl<dim>::make_grid(const bool                box,
                                     const dealii::Point<dim> &lower,
                                     const dealii::Point<dim> &upper)
  {
    grid.clear();
    const std::vector<std::string> lattices = split_list(text("Grid"), ';');
    if (!lattices.empty() && !box)
      error("Grid", "needs a body that is a box ('Shape' in section 'Domain').");
    for (const std::string &lattice : lattices)
      {
        const std::vector<std::string> pieces = split_list(lattice, ',');
        if (pieces.size() != dim)
          error("Grid",
                "found '" + lattice + "', needs " + std::to_string(dim) + " numbers of cells.");
        std::vector<unsigned int> n_cells;
        double                    n_points = static_cast<double>(grid.size());
        double                    n        = 1.;
        for (const std::string &piece : pieces)
          {
            n_cells.push_back(parse_whole_number(piece, where("Grid"), max_n_points));
            if (n_cells.back() == 0)
              error("Grid", "found 0, needs at least one cell in each direction.");
            n *= n_cells.back() + 1.;
          }
        if (n_points + n > max_n_points)
          error("Grid", "has more than " + std::to_string(max_n_points) + " points.");
        for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k)
          {
            std::vector<double> p(dim);
            std::size_t         rest = k;
            for (unsigned int d = 0; d < dim; ++d)
              {
                // the corners of the body exactly
                const double s = static_cast<double>(rest % (n_cells[d] + 1)) / n_cells[d];
                p[d]           = lower[d] * (1. - s) + upper[d] * s;
                rest /= n_cells[d] + 1;
              }
            grid.push_back(p);
          }
      }
  }


  double seconds_of(const std::string &text)
  {
    const double seconds = number_with_unit(text, {{"s", 1.}, {"min", 60.}, {"h", 3600.}});
    return number_with_unit(text, {{"", 1.}}) == 0. ? 0. : seconds;
  }


  CheckpointControl::CheckpointControl()
    : SceneSection("Checkpoint")
  {
    declare("Every", EntryType::text, "10 min") =
      "Wall time between two checkpoints: a number and its unit, s, min or h. 0: none but those of `Times` and where the run is stopped. "
      "`perideal run SCENE.prm --resume` goes on from the newest; a run that is complete removes its own.";
    declare("Times", EntryType::list, "", "time") =
      "Simulated times, separated by commas: a checkpoint is written, too, after the first step that reaches one. Steps do not land on them.";
    declare(n_kept, "Keep", "2", Bounds::one_or_more) =
      "So many of the newest checkpoints are kept, 1 or more. Each has the size of the vectors of "
      "the run.";
    declare("Wall time limit", EntryType::text) =
      "The run stops with a checkpoint and exit status 3 before it has taken this much wall time, a number and its unit, s, min or h. Empty: no limit. "
      "A run that is resumed has the whole of it again.";
  }


  double CheckpointControl::duration(const std::string &entry) const
  {
    const double seconds = seconds_of(text(entry));
    if (seconds < 0.)
      error(
        entry,
        "found '" + text(entry) +
          "', needs a time of the clock with its unit, s, min or h, such as '90 s', '10 min' or '8 h'" +
          (entry == "Every" ? ", or 0 for none." : "."));
    return seconds;
  }


  void CheckpointControl::parse(const double end_time, const bool steady)
  {
    SceneSection::parse();
    every           = duration("Every");
    wall_time_limit = text("Wall time limit").empty() ? 0. : duration("Wall time limit");
    if (!text("Wall time limit").empty() && !(wall_time_limit > 0.))
      error("Wall time limit",
            "found '" + text("Wall time limit") + "', needs more than 0, or nothing.");
    times.clear();
    const std::vector<std::string> pieces = split_list(text("Times"), ',');
    if (steady && !pieces.empty())
      error(
        "Times",
        "is given, but the scene is steady ('Steady' in section 'Time', or an elastic equilibrium): there are no times to reach.");
    for (const std::string &piece : pieces)
      {
        const double time = parse_number(piece, where("Times"));
        if (!(time > 0.) || time > end_time)
          error("Times",
                "the time " + piece +
                  " is not between 0 and 'End time' in section 'Time', which is " +
                  number_text(end_time) + ".");
        times.push_back(time);
      }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
  }


  GuardControl::GuardControl()
    : SceneSection("Guards")
  {
    declare(action, "Action", "stop", {"stop", "warn", "off"}) =
      "What a run does when its state becomes none (values that are not finite or grow without a cause, parts that have flown off): `stop` ends it there with the "
      "place and the cause, exit status 1 and the status `diverged`; `warn` says so in a note, once for each kind, and goes on, also where a solver finds energy "
      "from nowhere, a step above its limit or a body inside out; `off` goes on, too, and says nothing. "
      "Values that are not finite, a `Time step` above its limit from the start and what solvers cannot compute are errors in any case.";
  }


  double bytes_of(const std::string &text)
  {
    const double size =
      number_with_unit(text, {{"kB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}});
    return size > 0. ? size : -1.;
  }


  AccuracyControl::AccuracyControl()
    : SceneSection("Accuracy")
  {
    declare(tolerance, "Tolerance", "1e-2", "1", Bounds::positive) =
      "With `Models = auto`: the error that the result may have, estimated. Of values relative to their range over the body (largest minus smallest; "
      "of a vector the component with the largest range), of a flow or a stress intensity relative to itself.";
    declare("Measure", EntryType::text, "field") =
      "In what the error is measured: `field`, the root mean square over the body; `probes`, the largest at the points of `Probes`; `flow: SIDE`, what "
      "enters through a side; `stress intensity`, the largest at the ends of cracks (elasticity in 2D); of bodies whose bonds break `strength`, the largest force on a side in the run, "
      "and `path`, the farthest distance between the crack at the end of the run and the converged one, over the longest edge.";
    declare_if_given(budget, "Budget", "", "s", Bounds::positive.saying("seconds, more than 0")) =
      "Wall time in seconds within which a result has to be there, the best until then. Empty: "
      "no limit.";
    declare("Memory", EntryType::text) =
      "Memory that may be taken, with its unit (4 GB). Empty: what the machine has free.";
    declare("Guaranteed energy", EntryType::boolean, "false") =
      "Bound the error in the energy norm besides, with any `Measure`: of elastic bodies at rest in the plane, by finite elements (`guaranteed` in `summary.json`). "
      "It takes several times as long as the solution.";
    parse();
  }


  void AccuracyControl::parse()
  {
    SceneSection::parse();
    refuse(tolerance > 0.5,
           "Tolerance",
           "found " + text("Tolerance") + ", needs a number between 1e-8 and 0.5.");
    refuse(
      tolerance < 1e-8,
      "Tolerance",
      "found " + text("Tolerance") +
        ", which rounding and the linear solver do not allow; needs a number between 1e-8 and 0.5.");
    const std::string given = trimmed(text("Measure")), flow = "flow:";
    side.clear();
    if (given == "field")
      measure = AccuracyMeasure::field;
    else if (given == "probes")
      measure = AccuracyMeasure::probes;
    else if (given == "stress intensity")
      measure = AccuracyMeasure::stress_intensity;
    else if (given == "strength")
      measure = AccuracyMeasure::strength;
    else if (given == "path")
      measure = AccuracyMeasure::path;
    else if (given.compare(0, flow.size(), flow) == 0)
      {
        measure = AccuracyMeasure::flow;
        side    = trimmed(given.substr(flow.size()));
        refuse(side.empty(), "Measure", "found '" + given + "', needs a side behind 'flow:'.");
      }
    else
      error(
        "Measure",
        "found '" + given +
          "', needs field, probes, flow: SIDE, stress intensity, strength or path." +
          did_you_mean(given,
                       {"field", "probes", "flow: SIDE", "stress intensity", "strength", "path"}));
    memory = -1.;
    if (!text("Memory").empty())
      {
        memory = bytes_of(text("Memory"));
        refuse(memory < 0.,
               "Memory",
               "found '" + text("Memory") +
                 "', needs a size with its unit: kB, MB, GB or TB, as in '4 GB'.");
      }
  }


  Reference::Reference()
    : SceneSection("Reference")
  {
    declare(solution, "Solution", "", {}, "temperature") =
      "Exact solution to compare with: a formula of x, y, z, t, or a name (doc/theory.md lists them) "
      "such as `bobaru 2012 example 1` or `lattice harmonic(1, 1)`. For elastic bodies a formula for each component of the displacement, "
      "separated by commas, or a name such as `kirsch(1)` or `cantilever(1)`.";
  }


  Units::Units()
    : SceneSection("Units")
  {
    const std::string label =
      " Labels for reports only: values are in any consistent set of units.";
    declare(length, "Length", "m")           = "Name of the unit of length." + label;
    declare(time, "Time", "s")               = "Name of the unit of time." + label;
    declare(temperature, "Temperature", "K") = "Name of the unit of temperature." + label;
    declare("Absolute zero", EntryType::text, "", "temperature") =
      "Of `Radiation` and `Heat of deformation`, a number: absolute zero on the scale of the temperatures of the scene, 0 in kelvins, -273.15 in degrees Celsius. "
      "Empty: -273.15 where `Temperature` is `C`, `degC` or `°C`, else 0.";
    declare(potential, "Potential", "V") = "Name of the unit of the electric potential." + label;
    declare(force, "Force", "N") =
      "Name of the unit of force, from which those of stresses, energies and stress intensities follow." +
      label;
    declare(energy, "Energy", "") =
      "Name of the unit of energy. Empty: in elasticity the product of force and length; of heat none is shown, "
      "since diffusivities may have been given in place of conductivities." +
      label;
    declare(mass, "Mass", "kg")      = "Name of the unit of the mass of moisture." + label;
    declare(current, "Current", "A") = "Name of the unit of electric current." + label;
  }


  bool Units::counts_in_celsius() const
  {
    return temperature == "C" || temperature == "degC" || temperature == "°C";
  }


  bool Units::knows_absolute_zero() const
  {
    return is_given("Absolute zero") || counts_in_celsius();
  }


  double Units::absolute_zero() const
  {
    constexpr double in_celsius = -273.15;
    if (is_given("Absolute zero"))
      return parse_number(text("Absolute zero"), where("Absolute zero"));
    return counts_in_celsius() ? in_celsius : 0.;
  }


  std::string Units::of_field(const Physics physics) const
  {
    return physics == Physics::heat        ? temperature :
           physics == Physics::electricity ? potential :
           physics == Physics::elasticity  ? length :
                                             "";
  }


  PERIDEAL_INSTANTIATE_CLASS(class OutputControl);
} // namespace PeriDeal
