// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/control.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    constexpr double       time_slack   = 1e-12;
    constexpr unsigned int max_n_writes = 100000;
    constexpr unsigned int max_n_points = 1000000;
  } // namespace


  TimeControl::TimeControl()
    : SceneSection("Time")
  {
    declare("End time", EntryType::number, "1", "time", "The run goes from time 0 to this time.");
    declare(
      "Steady",
      EntryType::boolean,
      "false",
      "",
      "Solve for the steady state; all other entries of this section are ignored then. So they are in elastic equilibrium, by any "
      "`Solver` in section `Elasticity` but `dynamics`, unless a load depends on t: then it is found at one time after the other. With `Temperature change = "
      "computed` in that section all entries tell of the heat problem.");
    declare(
      "Stepper",
      EntryType::choice,
      "auto",
      "",
      "Time integration: `auto` picks chebyshev (constant loads, symmetric operator), else rkc2, and "
      "sdirk2 for a consistent capacity. Of these three and bdf2 and crank nicolson the steps "
      "adapt to Tolerance; euler and rk4 have a fixed step. Motion (elasticity with `Solver = dynamics`): verlet (explicit; `auto`) and newmark "
      "(implicit, average acceleration), both with a fixed step.",
      {"auto",
       "euler",
       "rk4",
       "rkc2",
       "chebyshev",
       "crank nicolson",
       "bdf2",
       "sdirk2",
       "verlet",
       "newmark"});
    declare(
      "Time step",
      EntryType::text,
      "auto",
      "time",
      "`auto` or a number; euler takes that very step. A step above the stability limit is "
      "refused; one of an implicit method whose iterations for T in `Material` do not converge is divided. Motion: `auto` is 0.8 of the limit of verlet, and 5 times that limit with newmark. Elastic equilibria under loads that depend on t: "
      "the step between two of them, `auto` is a hundredth of End time.");
    declare(
      "Tolerance",
      EntryType::number,
      "1e-4",
      "1",
      "Relative accuracy in time of adaptive steppers, between 0 and 1. Not given: 1e-8 with `Heat of deformation` in section `Elasticity`.");
  }


  void TimeControl::parse()
  {
    steady    = boolean("Steady");
    end_time  = positive_number("End time");
    stepper   = choice_name("Stepper");
    time_step = -1.;
    if (text("Time step") != "auto")
      {
        if (text("Time step").find_first_of("0123456789") == std::string::npos)
          error("Time step", "found '" + text("Time step") + "', needs 'auto' or a number.");
        time_step = parse_number(text("Time step"), where("Time step"));
        if (!(time_step > 0.))
          error("Time step",
                "found " + text("Time step") + ", needs 'auto' or a number greater than 0.");
      }
    tolerance = fraction("Tolerance");
  }


  SolverControlParameters::SolverControlParameters()
    : SceneSection("Solver")
  {
    declare(
      "Tolerance",
      EntryType::number,
      "1e-10",
      "1",
      "Relative residual at which solvers stop, between 0 and 1: the l2 norm of the residual over that of the start.");
    declare(
      "Maximum iterations",
      EntryType::whole_number,
      "1000",
      "1",
      "A solver that needs more iterations ends the run with an error. Not given: 100000 with `Solver = conjugate gradients` in section `Elasticity`, "
      "10000000 with dynamic relaxation.");
    declare(
      "Direct solver up to",
      EntryType::whole_number,
      "2000",
      "1",
      "Multigrid solves a level of at most so many unknowns directly. Smaller systems need one iteration, whose cost is that of a "
      "factorization.");
  }


  void SolverControlParameters::parse()
  {
    tolerance      = fraction("Tolerance");
    max_iterations = whole_number("Maximum iterations");
    limit_given    = is_given("Maximum iterations");
    refuse(max_iterations == 0, "Maximum iterations", "found 0, needs 1 or more.");
    direct_up_to = whole_number("Direct solver up to");
    refuse(direct_up_to == 0, "Direct solver up to", "found 0, needs 1 or more.");
  }


  unsigned int SolverControlParameters::most_iterations(const ElasticSolver elastic_solver) const
  {
    if (limit_given || elastic_solver == ElasticSolver::linear)
      return max_iterations;
    return elastic_solver == ElasticSolver::conjugate_gradients ? 100000 : 10000000;
  }


  template <int dim>
  OutputControl<dim>::OutputControl()
    : SceneSection("Output")
  {
    declare("Fields",
            EntryType::choices,
            "vtu, hdf5",
            "",
            "File formats of the fields; `none` writes no fields.",
            {"vtu", "hdf5", "none"});
    declare(
      "Write at",
      EntryType::list,
      "",
      "time",
      "Times of output, separated by commas; steps land on them. The end time is always written.");
    declare(
      "Write every",
      EntryType::text,
      "",
      "time",
      "Time between two outputs, instead of Write at. Fields are written at t = 0, too, for films.");
    declare("Probes",
            EntryType::list,
            "",
            "length",
            "Points whose values go to probes.csv, separated by `;`.");
    declare(
      "Line",
      EntryType::list,
      "",
      "length, length, 1",
      "`start ; end ; number of points`: evenly spaced points whose values go to line.csv; those that lie in holes or otherwise outside the body are gaps (nan).");
    declare(
      "Grid",
      EntryType::list,
      "",
      "1",
      "Numbers of cells, one per direction: the values at the vertices of such a lattice over the box go to grid.csv. Several "
      "lattices are separated by `;`.");
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
      {
        const double step = parse_number(every, where("Write every"));
        refuse(!(step > 0.), "Write every", "found " + every + ", needs a number greater than 0.");
        if (end_time / step > max_n_writes)
          error("Write every",
                "found " + every + ", which gives more than " + std::to_string(max_n_writes) +
                  " outputs until 'End time' (" + number_text(end_time) + ").");
        // the end time itself is written anyway
        for (unsigned int k = 1; k * step < end_time * (1. - 1e-9); ++k)
          write_times.push_back(k * step);
      }
    std::sort(times_beyond_end.begin(), times_beyond_end.end());
    std::sort(write_times.begin(), write_times.end());
    write_times.erase(std::unique(write_times.begin(), write_times.end()), write_times.end());
  }


  template <int dim>
  bool OutputControl<dim>::starts_at_zero() const
  {
    return !text("Write every").empty();
  }


  template <int dim>
  void OutputControl<dim>::parse_points_of_output()
  {
    const auto coordinates = [](const dealii::Point<dim> &p) {
      std::vector<double> x(dim);
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = p[d];
      return x;
    };

    probes.clear();
    for (const dealii::Point<dim> &p : parse_points<dim>(text("Probes"), where("Probes")))
      probes.push_back(coordinates(p));

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
        line.push_back(coordinates(p));
      }
  }


  template <int dim>
  void OutputControl<dim>::parse(const double end_time, const bool steady)
  {
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


  Reference::Reference()
    : SceneSection("Reference")
  {
    declare(
      "Solution",
      EntryType::text,
      "",
      "temperature",
      "Exact solution to compare with: a formula of x, y, z, t, or a name (doc/theory.md lists them) "
      "such as `bobaru 2012 example 1` or `lattice harmonic(1, 1)`. For elastic bodies a formula for each component of the displacement, "
      "separated by commas, or a name such as `kirsch(1)` or `cantilever(1)`.");
  }


  void Reference::parse()
  {
    solution = text("Solution");
  }


  Units::Units()
    : SceneSection("Units")
  {
    const std::string label =
      " Labels for reports only: values are in any consistent set of units.";
    declare("Length", EntryType::text, "m", "", "Name of the unit of length." + label);
    declare("Time", EntryType::text, "s", "", "Name of the unit of time." + label);
    declare("Temperature", EntryType::text, "K", "", "Name of the unit of temperature." + label);
    declare("Potential",
            EntryType::text,
            "V",
            "",
            "Name of the unit of the electric potential." + label);
    declare(
      "Force",
      EntryType::text,
      "N",
      "",
      "Name of the unit of force, from which those of stresses, energies and stress intensities follow." +
        label);
    declare(
      "Energy",
      EntryType::text,
      "",
      "",
      "Name of the unit of energy. Empty: in elasticity the product of force and length; of heat none is shown, "
      "since diffusivities may have been given in place of conductivities." +
        label);
    declare("Mass", EntryType::text, "kg", "", "Name of the unit of the mass of moisture." + label);
    declare("Current", EntryType::text, "A", "", "Name of the unit of electric current." + label);
  }


  void Units::parse()
  {
    length      = text("Length");
    time        = text("Time");
    temperature = text("Temperature");
    potential   = text("Potential");
    force       = text("Force");
    energy      = text("Energy");
    mass        = text("Mass");
    current     = text("Current");
  }


  std::string Units::of_field(const Physics physics) const
  {
    return physics == Physics::heat        ? temperature :
           physics == Physics::electricity ? potential :
           physics == Physics::elasticity  ? length :
                                             "";
  }


  template class OutputControl<1>;
  template class OutputControl<2>;
  template class OutputControl<3>;
} // namespace PeriDeal
