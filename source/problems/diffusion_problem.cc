// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/exact_solution.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/node_keys.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/expression.h>
#include <perideal/solvers/linear_solver.h>

#include <algorithm>
#include <sstream>

#include "diffusion_guards.h"
#include "diffusion_notes.h"
#include "diffusion_parts.h"
#include "diffusion_summary.h"
#include "diffusion_totals.h"
#include "step_forecast.h"
#include "steps_with_formulas.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
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
  } // namespace


  template <int dim>
  void set_start(DiffusionProblem<dim> &run)
  {
    run.op().initialize_vector(run.solution);
    run.set_initial_value(run.solution);
    run.op().distribute(run.solution, 0.);
    run.op().take_material_at(run.solution); // with the prescribed values
    run.op().distribute(run.solution, 0.);
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
      for (OutputField &field : derived_fields(solution, t))
        list.push_back(std::move(field));
    });
    solution.set_ghost_state(false);
    return list;
  }


  template <int dim>
  DiffusionProblem<dim>::DiffusionProblem(const Scene<dim> &scene)
    : scene(scene)
    , guards(std::make_unique<DiffusionGuards<dim>>(*this))
  {}


  template <int dim>
  DiffusionProblem<dim>::~DiffusionProblem() = default;


  template <int dim>
  void DiffusionProblem<dim>::make_stepper()
  {
    StepperOptions options;
    options.time_step        = scene.time.time_step;
    options.tolerance        = scene.time.tolerance;
    options.solver_tolerance = scene.solver.tolerance;
    options.max_iterations   = scene.solver.max_iterations;
    options.direct_up_to     = scene.solver.direct_up_to;
    Timings::Scope scope(this->timings, "stepper");
    with_formulas(this->dofs().get_communicator(),
                  [&] { stepper = PeriDeal::make_stepper(scene.time.stepper, op(), options); });
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
      follow(damage);
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
  void DiffusionProblem<dim>::start_anew()
  {
    set_start(*this);
  }


  template <int dim>
  std::vector<std::string> DiffusionProblem<dim>::notes() const
  {
    std::vector<std::string> list;
    for (const std::string &note : own_notes())
      list.push_back(this->name() + ": " + note);
    return list;
  }


  template <int dim>
  Difference DiffusionProblem<dim>::error(const ExactSolution &exact, const double t) const
  {
    solution.update_ghost_values();
    const Difference result =
      difference_to(solution, [&](const Point<dim> &p) { return exact_row(exact, p, t)[0]; });
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
                  if (update(reached))
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
    if (archive.loads())
      repeat_changes();
    op().exchange(archive, keys);
  }


  template <int dim>
  void DiffusionProblem<dim>::repeat_changes()
  {
    // One after the other, as they have been made: sums of changes keep their digits.
    if (scene.cracks.change() && stepper)
      with_formulas(this->dofs().get_communicator(), [&] {
        for (double t = time_of_start; t < reached || (t == reached && stepper->is_inside_span());
             t        = op().next_event(t))
          update(t);
      });
    if (op().depends_on_solution())
      with_formulas(this->dofs().get_communicator(), [&] { op().take_material_at(solution); });
  }


  template <int dim>
  nlohmann::ordered_json DiffusionProblem<dim>::describe_solving() const
  {
    if (!stepper)
      return {{"stepper", "steady"}, {"steps", 0}, {"iterations", steady_iterations}};
    return describe_stepping(*stepper, op().spectrum());
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
  void DiffusionProblem<dim>::add_totals(const double t, const RunContext &context)
  {
    add_diffusion_totals(*this, t, context);
  }


  template <int dim>
  void DiffusionProblem<dim>::describe_scene(nlohmann::ordered_json &summary, const bool) const
  {
    describe_diffusion_scene(scene, summary);
  }


  template <int dim>
  unsigned int DiffusionProblem<dim>::steps_between_looks() const
  {
    return guards->steps_between_looks();
  }


  template <int dim>
  Trip DiffusionProblem<dim>::take_finding()
  {
    return stepper ? stepper->findings().take() : Trip();
  }


  template <int dim>
  Trip DiffusionProblem<dim>::watch(const double t)
  {
    return guards->watch(t);
  }


  template <int dim>
  Trip DiffusionProblem<dim>::watch_totals(const double t) const
  {
    return guards->watch_totals(t);
  }


  template <int dim>
  void DiffusionProblem<dim>::explain(Trip &trip)
  {
    guards->explain(trip);
  }


  template <int dim>
  std::unique_ptr<DiffusionProblem<dim>> make_diffusion_problem(Model<dim>       &model,
                                                                const Scene<dim> &scene)
  {
    std::unique_ptr<DiffusionProblem<dim>> run;
    if (model.kind == ModelKind::peridynamics &&
        scene.peridynamics.treatment != BoundaryTreatment::exchange)
      run = make_bond_diffusion(model, scene);
    else
      run = make_element_diffusion(model, scene);
    set_start(*run);
    return run;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                      \
  template class DiffusionProblem<dim>;                                                \
  template void                                   set_start(DiffusionProblem<dim> &);  \
  template std::unique_ptr<DiffusionProblem<dim>> make_diffusion_problem(Model<dim> &, \
                                                                         const Scene<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
