// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/exact_solution.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/node_keys.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/linear_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

#include "diffusion_parts.h"
#include "problem_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    struct StepForecast
    {
      double n_steps, applications; // of the operator
      double time;                  // of processors, in seconds
    };


    /** Has been seen, thrown out of the steps. */
    struct Enough
    {};


    /** How often a step applies the operator, relatively: more often the longer it is. */
    double stages(const double dt, const double largest, const bool stabilized)
    {
      constexpr double least = 2.;
      return stabilized ? std::max(least, std::sqrt(1. + 1.54 * dt * largest)) : 1.;
    }


    /** After a step: where it ends, and what the run has taken until then. */
    struct Tried
    {
      double t, applications, spent;
    };


    /**
     * What a run takes, from the steps that were tried. They grow as the later half of those, dt ~
     * t^p; where these ended before what comes in at a side had passed two cells, they stay until
     * then and go as t from there on. Each costs as those of the last quarter.
     * @param largest eigenvalue
     */
    StepForecast steps_to(const double              end,
                          const std::vector<Tried> &tried,
                          const double              largest,
                          const bool                stabilized)
    {
      constexpr unsigned int n_spans = 400;
      const std::size_t      last = tried.size() - 1, half = last / 2;
      const std::size_t      width = std::max<std::size_t>(1, last / 4);
      const auto begin_of          = [&](const std::size_t k) { return k > width ? k - width : 0; };
      // Mean steps of the last quarter, and of the one before the middle.
      const auto step = [&](const std::size_t k) {
        const std::size_t first = begin_of(k);
        return k > first ? (tried[k].t - tried[first].t) / static_cast<double>(k - first) :
                           tried[k].t;
      };
      const double layer = largest > 0. ? 11. / largest : 0.; // time until it has passed two cells
      const double t = tried[last].t, dt = step(last), from = std::max(t, layer);
      // What has come in at a side changes at the rate 1/t, once it has passed two cells.
      const double p =
        t < 3. * layer ?
          1. :
        tried.size() < 4 ?
          0. :
          std::clamp(std::log(dt / step(half)) / std::log(t / tried[half].t), 0., 1.);
      const double first = stages(dt, largest, stabilized), ratio = std::pow(end / t, 1. / n_spans);
      double       n = 0., cost = 0., s = t; // of the rest
      for (unsigned int k = 0; k < n_spans; ++k, s *= ratio)
        {
          const double of_span = dt * std::pow(std::max(s * std::sqrt(ratio), layer) / from, p),
                       count   = s * (ratio - 1.) / of_span;
          n += count;
          cost += count * stages(of_span, largest, stabilized) / first;
        }
      const Tried &now = tried[last], &before = tried[begin_of(last)];
      const double quarter = last > begin_of(last) ? static_cast<double>(last - begin_of(last)) :
                                                     1.;
      const auto   all     = [&](double Tried::*const what) {
        const double of_quarter = now.*what - (last > begin_of(last) ? before.*what : 0.);
        return now.*what + cost * of_quarter / quarter;
      };
      return {static_cast<double>(tried.size()) + n, all(&Tried::applications), all(&Tried::spent)};
    }

    /**
     * How many steps a run takes and how long they take, from its first ones: where steps adapt to
     * a solution that nobody knows yet, and the material has to be found anew in each. The run goes
     * from 0 towards its end until twice the time forecasts nearly the same, for half a second of
     * processor time at least and some eight at most.
     * @param advance to the end, calling what it is given after each step but the last
     * @param op of the steps
     * @param stabilized explicit steps whose stages go with the length (rkc2)
     * Collective.
     */
    StepForecast forecast_steps(
      const double                                                            end,
      const std::function<void(const std::function<void(const double t)> &)> &advance,
      const Operator                                                         &op,
      const bool                                                              stabilized,
      const MPI_Comm                                                          communicator)
    {
      constexpr double      enough = 0.5, most = 8.; // seconds
      constexpr double      settled = 1.2;           // from one forecast to that of twice the time
      constexpr std::size_t least   = 8;             // steps, unless they take ten times as long
      const double          start   = processor_seconds();
      const auto            passed  = [&] {
        return dealii::Utilities::MPI::max(processor_seconds() - start, communicator);
      };
      const unsigned long long before = op.n_applications();
      const auto         n_of = [&] { return static_cast<double>(op.n_applications() - before); };
      std::vector<Tried> tried;
      StepForecast       forecast{};
      double             next = enough;
      try
        {
          advance([&](const double t) {
            if (t <= (tried.empty() ? 0. : tried.back().t)) // a step that was rejected
              return;
            tried.push_back({t, n_of(), passed()});
            const double spent = tried.back().spent;
            if (spent < next || (tried.size() < least && spent < 10. * enough))
              return;
            const StepForecast last = forecast;
            forecast                = steps_to(end, tried, op.spectrum().sharp, stabilized);
            const double ratio =
              last.applications > 0. ? forecast.applications / last.applications : 0.;
            if ((ratio < settled && ratio > 1. / settled) || spent >= most)
              throw Enough();
            next = std::min(2. * spent, most);
          });
          forecast = {static_cast<double>(tried.size() + 1), n_of(), passed()};
        }
      catch (const Enough &)
        {}
      return forecast;
    }


    /** Applications of K by an expansion over each span, to round-off where it begins roughly. */
    double stages_of_chebyshev(const double largest_eigenvalue, const std::vector<double> &ends)
    {
      constexpr double of_root = 5.4;
      double           sum = 0., before = 0.;
      for (const double end : ends)
        {
          sum += of_root * std::sqrt(largest_eigenvalue * (end - before));
          before = end;
        }
      return sum;
    }


    /**
     * What adaptive implicit steps cost where the start is rough, in applications of K: so many
     * steps, each with some 15 iterations of 15 applications (measured with quadratic elements on
     * graded meshes, crank nicolson).
     */
    double cost_of_implicit_steps(const double tolerance)
    {
      constexpr double of_step = 220., n_steps = 2.1;
      return of_step * n_steps / std::sqrt(tolerance);
    }


    /**
     * The stepper of a run: `auto` is choose_stepper()'s, and implicit steps for finite elements so
     * stiff that the stages of an expansion over the spans between outputs cost clearly more.
     * Collective.
     */
    template <int dim>
    std::string stepper_of_run(const Scene<dim>          &scene,
                               const DiffusionOperator   &op,
                               const std::vector<double> &write_times)
    {
      constexpr double   clearly = 1.5;
      const TimeControl &time    = scene.time;
      if (time.stepper != "auto" || time.time_step > 0. || choose_stepper(op) != "chebyshev" ||
          !op.surrogate_is_exact() || scene.cracks.change())
        return time.stepper;
      std::vector<double> ends;
      for (const double t : write_times)
        if (t > 0. && t < time.end_time)
          ends.push_back(t);
      ends.push_back(time.end_time);
      return stages_of_chebyshev(op.spectrum().sharp, ends) >
                 clearly * cost_of_implicit_steps(time.tolerance) ?
               "crank nicolson" :
               time.stepper;
    }


    /** Bounds of the spectrum, and what explicit steps are stable with them. */
    std::string describe_stable_steps(const Spectrum &spectrum)
    {
      std::ostringstream out;
      out << "  largest eigenvalue: sharp bound " << spectrum.sharp << ", safe bound "
          << spectrum.safe << "\n  stable steps (sharp / safe): ";
      for (const std::string name : {"euler", "rk4"})
        out << (name == "rk4" ? ", " : "") << name << " " << stable_step(name, spectrum.sharp)
            << " / " << stable_step(name, spectrum.safe);
      return out.str();
    }


    /**
     * Refuse what a stepper would never finish. @p stiffness is the end time times the largest
     * eigenvalue.
     */
    void check_stepper(const std::string &name, const TimeControl &time, const double stiffness)
    {
      constexpr double   longest = 1e12, finest = 1e-11;
      const bool         implicit = name == "sdirk2" || name == "bdf2" || name == "crank nicolson";
      std::ostringstream message;
      if (!implicit && stiffness > longest)
        message
          << "'End time' in section 'Time' is " << time.end_time << ", " << stiffness
          << " times the shortest decay time of this mesh: too long for the explicit stepper '"
          << name << "'. Choose 'Steady = true' or 'Stepper = sdirk2'.";
      if (name == "rkc2" && time.time_step < 0. && time.tolerance < finest)
        message << "'Tolerance' in section 'Time' is " << time.tolerance
                << ", which round-off does not allow 'rkc2' to reach; it needs " << finest
                << " or more. 'chebyshev' and a fixed 'Time step' reach more.";
      AssertThrow(message.str().empty(), UserError(message.str()));
    }


    /** Fixed steps that do not damp what they do not resolve; empty: there is nothing to say. */
    std::string note_on_fast_waves(const Stepper &stepper, const double end_time)
    {
      constexpr double tolerable = 0.02;
      const double     left      = stepper.left_of_fast_waves();
      if (!(left > 0.))
        return {};
      const double n = std::max(1., std::round(end_time / stepper.current_step()));
      if (std::pow(left, n) < tolerable)
        return {};
      return "a step of '" + stepper.name() + "' leaves up to " + rounded_text(left) +
             " of waves that it does not resolve, the " + rounded_text(n) + " steps of this run " +
             rounded_text(std::pow(left, n)) +
             ": what jumps, at the start or at a side, stays and rings. 'Time step = auto' in section 'Time' begins with steps that damp it, and 'Stepper = sdirk2' damps it in steps of any size.";
    }


    /** Fixed steps that were divided, and into how many parts; or empty. */
    std::string note_on_divided_steps(const Stepper &stepper)
    {
      const StepperCost &cost = stepper.cost();
      if (cost.divided == 0)
        return {};
      return (cost.divided == 1 ?
                "one 'Time step' was divided, into " :
                std::to_string(cost.divided) +
                  " steps of 'Time step' (section 'Time') were divided, into up to ") +
             std::to_string(cost.most_parts) +
             " parts, since the iterations for the material's dependence on the temperature did not converge in longer ones.";
    }


    /** Of given values, where nothing enters but through them and they are constant numbers. */
    template <int dim>
    std::optional<Extent> range_of_given(const Scene<dim> &scene, const Operator &op)
    {
      const Expression &source    = scene.initial_and_source.source;
      const auto       &transfers = scene.boundary_conditions.transfers;
      const auto       &given     = scene.boundary_conditions.dirichlet;
      if (given.empty() || !source.is_constant() || source.value(Point<dim>()) != 0. ||
          op.depends_on_time() ||
          !std::all_of(transfers.begin(), transfers.end(), [](const SurfaceTransfer &transfer) {
            return transfer.insulates();
          }))
        return {};
      Extent range{std::numeric_limits<double>::max(), -std::numeric_limits<double>::max(), true};
      for (const SideCondition &condition : given)
        {
          if (!condition.value.is_constant())
            return {};
          const double value = condition.value.value(Point<dim>());
          range.least        = std::min(range.least, value);
          range.most         = std::max(range.most, value);
        }
      return range;
    }


    /** Give the solution the initial value of the scene, with the prescribed values of time 0. */
    template <int dim>
    void set_start(DiffusionField<dim> &field)
    {
      field.op().initialize_vector(field.solution);
      field.set_initial_value(field.solution);
      field.op().distribute(field.solution, 0.);
      field.op().take_material_at(field.solution, 0.); // with the prescribed values
      field.op().distribute(field.solution, 0.);
    }
  } // namespace


  template <int dim>
  DiffusionProblem<dim>::DiffusionProblem(std::unique_ptr<DiffusionField<dim>> of)
    : Problem<dim>(std::move(of))
    , solution(this->field->solution)
    , body(static_cast<DiffusionField<dim> &>(*this->field))
  {}


  template <int dim>
  void DiffusionProblem<dim>::make_stepper()
  {
    Timings::Scope scope(this->timings, "stepper");
    with_formulas(this->dofs().get_communicator(), [&] {
      stepper = PeriDeal::make_stepper(
        stepper_of_run(scene, op(), scene.output.all_times(scene.time.end_time)),
        op(),
        this->stepper_options());
    });
    check_stepper(stepper->name(), scene.time, op().spectrum().sharp * scene.time.end_time);
    if (scene.guards.goes_on())
      stepper->findings().let_wait();
  }


  template <int dim>
  void DiffusionProblem<dim>::begin_stepping()
  {
    make_stepper();
    with_formulas(this->dofs().get_communicator(),
                  [&] { ledger.begin(op().balance(solution, 0., false).content); });
  }


  template <int dim>
  void DiffusionProblem<dim>::renew_stepper()
  {
    if (!stepper) // before begin(), or steady
      return;
    const StepperCost before  = stepper->cost();
    const double      entered = stepper->entered();
    const Findings    found   = stepper->findings();
    make_stepper();
    stepper->carry_over(before, entered);
    stepper->findings().carry_over(found);
  }


  template <int dim>
  void DiffusionProblem<dim>::apply_change(const ChangeSet<dim> &damage)
  {
    Timings::Scope scope(this->timings, "following damage");
    with_formulas(this->dofs().get_communicator(), [&] {
      op().follow(damage);
      stepper->restart();
    });
  }


  template <int dim>
  void DiffusionProblem<dim>::begin(const RunContext &context)
  {
    if (scene.time.steady)
      return;
    begin_stepping();
    std::ostringstream line;
    line << this->name() << ": stepper " << stepper->name();
    if (stepper->current_step() > 0.)
      line << ", step " << stepper->current_step();
    context.progress.line(line.str());
    if (const std::string note = note_on_fast_waves(*stepper, scene.time.end_time); !note.empty())
      context.record.notes.push_back(this->name() + ": " + note);
  }


  template <int dim>
  void DiffusionProblem<dim>::settle(const RunContext &)
  {
    if (scene.time.steady)
      solve();
  }


  template <int dim>
  void DiffusionProblem<dim>::advance(const double,
                                      const double to,
                                      const std::function<void(const double)> &,
                                      const RunContext &context)
  {
    if (!scene.time.steady)
      advance_through_events(to, context.after_step);
  }


  template <int dim>
  double DiffusionProblem<dim>::work_of(const double span) const
  {
    const OperatorSize size = op().size();
    return std::max(1., stepper->expected_applications(span)) *
           static_cast<double>(size.unknowns + size.nonzeros + size.bonds);
  }


  template <int dim>
  RecoveryIndicators DiffusionProblem<dim>::indicators() const
  {
    return body.indicators();
  }


  template <int dim>
  void DiffusionProblem<dim>::start_anew()
  {
    set_start(body);
  }


  template <int dim>
  void DiffusionProblem<dim>::before_remesh()
  {
    body.before_remesh();
  }


  template <int dim>
  void DiffusionProblem<dim>::rebuild(const double t)
  {
    body.rebuild(t);
    time_of_start = t;
  }


  template <int dim>
  void DiffusionProblem<dim>::after_remesh(const double t, const bool steady)
  {
    rebuild(t);
    ledger.add(body.move_solution(t, steady));
    with_formulas(this->dofs().get_communicator(), [&] { op().take_material_at(solution, t); });
  }


  template <int dim>
  std::vector<std::string> DiffusionProblem<dim>::notes() const
  {
    std::vector<std::string> list;
    for (const std::string &note : body.notes())
      list.push_back(this->name() + ": " + note);
    return list;
  }


  template <int dim>
  void DiffusionProblem<dim>::take_sample(const RunContext &context, ModelEstimate &estimate)
  {
    begin(context);
    const double start = processor_seconds();
    settle(context);
    if (scene.time.steady)
      estimate.time_of_solution = processor_seconds() - start;
    else
      estimate.applications = stepper->expected_applications(scene.time.end_time);
  }


  template <int dim>
  double DiffusionProblem<dim>::time_of_run(const std::vector<double> &times,
                                            const bool                 says,
                                            const RunContext          &context,
                                            double &)
  {
    if (says)
      context.progress.line(this->name() + ":");
    if (scene.time.steady)
      {
        const unsigned int n_solves = op().depends_on_solution() ? 10 : 1;
        if (says)
          context.progress.line("  steady, linear solves: " + std::to_string(n_solves));
        // Of about 20 iterations; each with its preconditioner takes some 6 applications.
        return n_solves * 20. * 6. * time_of_application(op());
      }
    const std::string bounds = describe_stable_steps(op().spectrum());
    StepForecast      run{0., expected_applications(times), -1.};
    if (op().depends_on_solution())
      run = forecast_steps(
        scene.time.end_time,
        [&](const AfterStep &then) { advance_through_events(scene.time.end_time, then); },
        op(),
        stepper->name() == "rkc2",
        this->dofs().get_communicator());
    else if (run.applications > 0.)
      run.time = run.applications * time_of_application(op());
    if (!says)
      return run.time;
    context.progress.line(bounds + "\n  stepper: " + stepper->name());
    if (run.applications > 0.)
      context.progress.line(
        "  estimated: " +
        (run.n_steps > 0. ? readable_count(std::llround(run.n_steps)) + " steps, " : "") +
        readable_count(std::llround(run.applications)) + " operator applications, " +
        readable_duration(run.time));
    return run.time;
  }


  template <int dim>
  void DiffusionProblem<dim>::solve()
  {
    Timings::Scope scope(this->timings, "solve");
    with_formulas(this->dofs().get_communicator(), [&] {
      steady_iterations += solve_steady(op(),
                                        solution,
                                        0.,
                                        scene.solver.tolerance,
                                        scene.solver.max_iterations,
                                        scene.solver.direct_up_to);
    });
  }


  template <int dim>
  void DiffusionProblem<dim>::advance_through_events(const double t_end, const AfterStep &then)
  {
    const auto steps = [&](const AfterStep &after_step) {
      while (reached < t_end)
        {
          double to = stepper->end_of_span();
          if (stepper->is_inside_span())
            {
              Timings::Scope scope(this->timings, "time stepping");
              stepper->go_on(solution, after_step);
            }
          else
            {
              if (scene.cracks.change())
                {
                  Timings::Scope scope(this->timings, "changing cracks");
                  if (op().update(reached))
                    stepper->restart();
                }
              Timings::Scope scope(this->timings, "time stepping");
              to = std::min(t_end, op().next_event(reached));
              stepper->advance(solution, reached, to, after_step);
            }
          reached = to;
          if (reached < t_end)
            after_step(reached);
        }
    };
    steps_with_formulas(this->dofs().get_communicator(), reached, then, steps);
  }


  template <int dim>
  void DiffusionProblem<dim>::exchange(Archive &archive)
  {
    const NodeKeys keys = node_keys(this->dofs());
    archive.exchange("solution", solution, keys);
    archive.exchange("reached", reached);
    archive.exchange("steady iterations", steady_iterations);
    ledger.exchange(archive);
    this->timings.exchange(archive);
    if (stepper)
      stepper->exchange(archive, keys);
    // One after the other, as they have been made: sums of changes keep their digits.
    if (archive.loads() && scene.cracks.change() && stepper)
      with_formulas(this->dofs().get_communicator(), [&] {
        for (double t = time_of_start; t < reached || (t == reached && stepper->is_inside_span());
             t        = op().next_event(t))
          op().update(t);
      });
    if (archive.loads() && op().depends_on_solution())
      with_formulas(this->dofs().get_communicator(),
                    [&] { op().take_material_at(solution, reached); });
    op().exchange(archive, keys);
  }


  template <int dim>
  void DiffusionProblem<dim>::note_end(const RunContext &context) const
  {
    if (const std::string note = stepper ? note_on_divided_steps(*stepper) : ""; !note.empty())
      context.record.notes.push_back(this->name() + ": " + note);
  }


  template <int dim>
  double DiffusionProblem<dim>::expected_applications(const std::vector<double> &times) const
  {
    double n = 0., t = 0.;
    for (const double next : times)
      while (t < next)
        {
          const double to = std::min(next, op().next_event(t));
          n += stepper->expected_applications(to - t);
          t = to;
        }
    return n;
  }


  template <int dim>
  unsigned int DiffusionProblem<dim>::steps_between_looks() const
  {
    if (!stepper || growth.suspects())
      return 1;
    // A look reads the values once, a step of one application all of K.
    const std::string name = stepper->name();
    return name == "euler" ? 10 : name == "rk4" || name == "rkc2" ? 3 : 1;
  }


  template <int dim>
  Trip DiffusionProblem<dim>::take_finding()
  {
    return stepper ? stepper->findings().take() : Trip();
  }


  template <int dim>
  Trip DiffusionProblem<dim>::watch(const double t)
  {
    if (scene.time.steady)
      return Problem<dim>::watch(t);
    ledger.see(stepper->entered(), this->dofs().get_communicator());
    const auto before = op().n_applications();
    const auto given  = range_of_given(scene, op());
    // What a solid releases beside bonds that break is as uneven as noise of the mesh, and grows
    // from load step to load step, though the steps of the heat problem are sound.
    const Trip trip = heated_by_solid ? Problem<dim>::watch(t) :
                                        growth.look(op(),
                                                    solution,
                                                    t,
                                                    given ? &*given : nullptr,
                                                    place_of_nodes(this->dofs()),
                                                    this->field_name());
    op().carry_over_applications(before - op().n_applications()); // a look is none of the run's
    const Trip of_step = steps.look(*stepper, scene.time.end_time, t);
    return trip ? trip : of_step;
  }


  template <int dim>
  Trip DiffusionProblem<dim>::watch_totals(const double t) const
  {
    const std::string &quantity = names_of(scene.general.physics).quantity;
    return stepper ? heat_lost(op(), ledger, quantity, t) : Trip();
  }


  template <int dim>
  std::string DiffusionProblem<dim>::own_cause(const Trip &trip)
  {
    const std::string       cause = stepper ? cause_in_step(*stepper, op(), solution, trip) : "";
    const MaterialProperty &conductivity = scene.material.conductivity;
    if (!cause.empty() || conductivity.depends_on_temperature())
      return cause;
    return cause_in_contrast<dim>(
      this->dofs().get_triangulation(),
      "'Conductivity'",
      [&](const Point<dim> &p) { return conductivity.value(p); },
      trip.monitor);
  }


  template <int dim>
  std::vector<std::string> DiffusionProblem<dim>::columns() const
  {
    return {"value"};
  }


  template <int dim>
  std::vector<double> DiffusionProblem<dim>::at_points(
    const PointEvaluator<dim> &reader,
    const std::vector<std::vector<double>> &) const
  {
    solution.update_ghost_values();
    std::vector<double> values = reader.evaluate(solution);
    solution.set_ghost_state(false);
    return values;
  }


  template <int dim>
  std::vector<OutputField> DiffusionProblem<dim>::fields(const double t) const
  {
    std::vector<OutputField> list{{this->field_name(), {solution}}};
    list[0].components[0].update_ghost_values();
    solution.update_ghost_values();
    with_formulas(this->dofs().get_communicator(), [&] {
      for (OutputField &field : body.derived_fields(solution, t))
        list.push_back(std::move(field));
    });
    solution.set_ghost_state(false);
    return list;
  }


  template <int dim>
  Difference DiffusionProblem<dim>::error(const ExactSolution &exact, const double t) const
  {
    solution.update_ghost_values();
    const Difference result =
      body.difference_to(solution, [&](const Point<dim> &p) { return exact_row(exact, p, t)[0]; });
    solution.set_ghost_state(false);
    return result;
  }


  template <int dim>
  std::vector<double> DiffusionProblem<dim>::exact_row(const ExactSolution &exact,
                                                       const Point<dim>    &point,
                                                       const double         t) const
  {
    double x[dim];
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = point[d];
    return {exact.value(x, t)};
  }


  template <int dim>
  std::unique_ptr<DiffusionField<dim>> make_diffusion_field(Model<dim>       &model,
                                                            const Scene<dim> &scene)
  {
    const bool of_bonds = model.kind == ModelKind::peridynamics &&
                          scene.peridynamics.treatment != BoundaryTreatment::exchange;
    auto field = of_bonds ? make_bond_diffusion(model, scene) :
                            make_element_diffusion(model, scene);
    set_start(*field);
    return field;
  }


  PERIDEAL_INSTANTIATE_CLASS(class DiffusionProblem);
  PERIDEAL_INSTANTIATE_FUNCTION(make_diffusion_field);
} // namespace PeriDeal
