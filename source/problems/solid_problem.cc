// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/node_keys.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/run_context.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/elasticity_control.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/floating_part.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/static_solver.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "problem_parts.h"
#include "solid_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Processor seconds of one equilibrium; -1 where the solver does not get there: the run will
     * say why. Throws UserError, where it must be held, for a body with a part that nothing holds.
     * Collective.
     */
    double time_of_linear_equilibrium(const SolverControlParameters &control,
                                      ElasticOperator               &op,
                                      const double                   t,
                                      const bool                     must_be_held)
    {
      const double start = processor_seconds();
      Vector       u, r, change;
      for (Vector *const v : {&u, &r, &change})
        op.initialize_vector(*v);
      op.distribute(u, t);
      op.residual(r, u, t);
      LinearSolver solver(op, control.tolerance, control.max_iterations, control.direct_up_to);
      if (must_be_held && r.l2_norm() > 0.)
        check_no_loose_part(op, solver.surrogate(), r);
      try
        {
          solver.solve(0., 1., change, r);
        }
      catch (const UserError &) // on all processes
        {
          return -1.;
        }
      return processor_seconds() - start;
    }
  } // namespace


  template <int dim>
  SolidProblem<dim>::SolidProblem(std::unique_ptr<SolidField<dim>> of)
    : Problem<dim>(std::move(of))
    , body(static_cast<SolidField<dim> &>(*this->field))
    , displacement(this->field->solution)
    , velocity(static_cast<SolidField<dim> &>(*this->field).velocity)
    , cracks(std::make_unique<CrackGrowth<dim>>())
    , told(std::make_unique<DamageOfSolid<dim>>())
  {}


  template <int dim>
  SolidProblem<dim>::~SolidProblem() = default;


  template <int dim>
  std::string SolidProblem<dim>::steady_name() const
  {
    return "the equilibrium";
  }


  template <int dim>
  typename SolidProblem<dim>::MotionParts SolidProblem<dim>::MotionParts::between(const double from,
                                                                                  const double to,
                                                                                  const double step)
  {
    constexpr double most = 50.;
    MotionParts      parts;
    parts.n_steps      = std::max(1., std::ceil((to - from) / step * (1. - 1e-10)));
    parts.span         = StepSpan::between(from, to);
    parts.span.n_steps = static_cast<unsigned long long>(std::min(parts.n_steps, most));
    return parts;
  }


  template <int dim>
  double SolidProblem<dim>::MotionParts::next() const
  {
    const unsigned long long part = span.n_done + 1;
    if (part == span.n_steps)
      return span.end;
    return span.start +
           (span.end - span.start) * std::floor(n_steps * part / span.n_steps) / n_steps;
  }


  template <int dim>
  typename FieldWriter<dim>::Choice SolidProblem<dim>::shown() const
  {
    return [this](const Point<dim> &p) { return scene.domain.shows(p); };
  }


  template <int dim>
  void SolidProblem<dim>::take_temperature()
  {
    if (heat == nullptr)
      return;
    Timings::Scope scope(this->timings, "thermal loads");
    with_formulas(this->dofs().get_communicator(),
                  [&] { op().set_temperature_change(computed_temperature_change(*this)); });
    if (loading && scene.moduli_change())
      loading->stiffness_changed();
  }


  template <int dim>
  void SolidProblem<dim>::set_start()
  {
    const InitialAndSource &given = scene.initial_and_source;
    const auto              fill  = [&](Vector &vector, const std::vector<Expression> &formulas) {
      op().initialize_vector(vector);
      for (unsigned int i = 0; i < vector.locally_owned_size() && !formulas.empty(); ++i)
        vector.local_element(i) = formulas[i % dim].value(this->position(i / dim));
    };
    fill(displacement, given.initial_displacement);
    fill(velocity, given.initial_velocity);
    op().distribute(displacement, 0.);
    // Supports have the velocity of their first step; what follows from others has theirs.
    op().clear_constrained(velocity);
    Vector moved(displacement);
    moved += velocity;
    op().distribute(moved, 0.);
    const std::vector<bool> held = held_unknowns(op());
    for (unsigned int i = 0; i < held.size(); ++i)
      if (held[i])
        velocity.local_element(i) = moved.local_element(i) - displacement.local_element(i);
    AssertThrow(
      std::isfinite(displacement.l1_norm()) && std::isfinite(velocity.l1_norm()),
      UserError(
        "'Initial displacement' or 'Initial velocity' in section 'Initial and source' is not finite everywhere."));
  }


  template <int dim>
  void SolidProblem<dim>::begin_motion(const RunContext &context)
  {
    Timings::Scope scope(this->timings, "stepper");
    with_formulas(this->dofs().get_communicator(), [&] { set_start(); });
    op().linearize(displacement);
    stepper     = make_motion_stepper(scene.time.stepper, op(), this->stepper_options());
    stable_step = stable_motion_step(op());
    if (scene.guards.goes_on())
      stepper->findings().let_wait();
    std::ostringstream line;
    line << this->name() << ": stepper " << stepper->name() << ", step " << stepper->current_step()
         << ", "
         << readable_count(static_cast<unsigned long long>(
              std::ceil(scene.time.end_time / stepper->current_step() * (1. - 1e-10))))
         << " steps or a few more";
    context.progress.line(line.str());
  }


  template <int dim>
  void SolidProblem<dim>::begin(const RunContext &context)
  {
    op().initialize_vector(displacement);
    if (scene.elasticity.is_static())
      make_loading();
    else
      begin_motion(context);
  }


  template <int dim>
  void SolidProblem<dim>::settle(const RunContext &context)
  {
    if (!scene.elasticity.is_static())
      return;
    take_temperature();
    context.progress.doing("solving " + this->name());
    begin_loading(context);
    if (heat != nullptr && !scene.boundary_conditions.dirichlet.empty() && op().brittle() &&
        op().n_broken_bonds() > 0)
      context.record.notes.push_back(
        this->name() + ": " + readable_count(op().n_broken_bonds()) +
        " bonds broke at t = 0 already. 'Dirichlet' in section 'Boundary conditions' gives its sides their temperature at once, so that the outermost nodes "
        "are stretched against the next ones by all of the jump, however fine the lattice. 'Convection', or a 'Dirichlet' value that begins at the initial one, lets the heat in gradually.");
    if (scene.time.steady)
      context.progress.line(this->name() + ": " + std::to_string(n_iterations) + " iterations");
  }


  template <int dim>
  double SolidProblem<dim>::load_step() const
  {
    constexpr double share = 0.01; // of the end time, if no step is given
    if (scene.warms_slowly())      // `Time step` is that of the heat problem
      {
        const bool of_both = scene.elasticity.absolute_reference.has_value();
        const bool of_law  = scene.material.law.kind != SolidLaw::linear;
        if ((of_both || of_law) && scene.time.time_step > 0.)
          return scene.time.time_step;
        const bool in_steps = of_both || of_law || scene.material.breaks() ||
                              scene.elasticity.has_full_kinematics() || !scene.cracks.tips.empty();
        return (in_steps ? share : 1.) * scene.time.end_time;
      }
    return scene.time.time_step > 0. ? scene.time.time_step : share * scene.time.end_time;
  }


  template <int dim>
  std::vector<double> SolidProblem<dim>::stops(const double from, const double to) const
  {
    if (!loading)
      return {to};
    const unsigned long long n = n_equal_steps(to - from, load_step());
    std::vector<double>      times;
    for (unsigned long long k = 1; k < n; ++k)
      times.push_back(from + k * (to - from) / n);
    times.push_back(to);
    return times;
  }


  template <int dim>
  bool SolidProblem<dim>::tells_at_stops() const
  {
    return loading && !scene.time.steady;
  }


  template <int dim>
  std::string SolidProblem<dim>::doing(const unsigned int k,
                                       const unsigned int n,
                                       const double       t) const
  {
    if (!loading)
      return Problem<dim>::doing(k, n, t);
    return "solving " + this->name() + ", load step " + std::to_string(k) + " of " +
           std::to_string(n) + " until t = " + number_text(t);
  }


  template <int dim>
  void SolidProblem<dim>::advance(const double                             from,
                                  const double                             to,
                                  const std::function<void(const double)> &report,
                                  const RunContext                        &context)
  {
    if (!loading)
      return move(from, to, report, context);
    if (scene.warms_slowly() && !loading->is_inside_step())
      take_temperature();
    const AfterStep after_round = [&](const double t) {
      tell_first_break(*this, t, context);
      if (context.after_step)
        context.after_step(t);
    };
    // Steps of bodies that warm are not divided: formulas of their totals have to be asked apart.
    const AfterStep before_breaks = [&](const double t) { add_totals(t, context); };
    solve_loading([&] {
      loading->is_inside_step() ? loading->go_on(displacement, after_round, before_breaks) :
                                  loading->step(displacement, to, after_round, before_breaks);
    });
    if (warming)
      warming->add(*this, to, [&] {
        take_temperature();
        solve_loading([&] { loading->renew(displacement); });
      });
    n_iterations = loading->n_iterations();
    note_equilibrium(*this, to, context);
    tell_first_break(*this, to, context);
    told->tell(*this);
  }


  template <int dim>
  void SolidProblem<dim>::move(const double                             from,
                               const double                             to,
                               const std::function<void(const double)> &report,
                               const RunContext                        &context)
  {
    Timings::Scope scope(this->timings, "time stepping");
    if (!moving.span.is_open)
      moving = MotionParts::between(from, to, stepper->current_step());
    StepSpan &span = moving.span;
    while (span.n_done < span.n_steps)
      {
        const double next  = moving.next();
        const auto   steps = [&](const AfterStep &after_step) {
          stepper->is_inside_span() ?
            stepper->go_on(displacement, velocity, after_step) :
            stepper->advance(displacement, velocity, span.now, next, after_step);
        };
        steps_with_formulas(this->dofs().get_communicator(), span.now, context.after_step, steps);
        span.now = next;
        ++span.n_done;
        if (op().brittle())
          {
            tell_broken_bonds(op().n_broken_bonds());
            tell_first_break(*this, next, context);
          }
        report(static_cast<double>(span.n_done) / span.n_steps);
        if (context.after_step && span.n_done < span.n_steps)
          context.after_step(next);
      }
    span.is_open = false;
    if (!(scene.elasticity.has_full_kinematics() && scene.elasticity.contact))
      note_overlap(*this, to, context);
  }


  template <int dim>
  void SolidProblem<dim>::exchange(Archive &archive)
  {
    const NodeKeys keys = node_keys(this->dofs());
    archive.exchange("displacement", displacement, keys);
    archive.exchange("force scale", force_scale);
    archive.exchange("iterations", n_iterations);
    this->timings.exchange(archive);
    op().exchange(archive, keys);
    if (warming)
      warming->exchange(archive, *this, keys);
    if (loading)
      loading->exchange(archive, keys);
    if (stepper)
      {
        archive.exchange("velocity", velocity, keys);
        {
          const Archive::Part part(archive, "parts");
          moving.span.exchange(archive);
          archive.exchange("planned steps", moving.n_steps);
        }
        stepper->exchange(archive, keys);
      }
    if (archive.loads())
      op().linearize(displacement);
    told->exchange(archive, *this);
  }


  template <int dim>
  double SolidProblem<dim>::work_of(const double span) const
  {
    if (!stepper)
      return 1.;
    const OperatorSize size = op().size();
    // A step costs about as much as the product with what is stored.
    return std::max(1., span / stepper->current_step()) *
           static_cast<double>(size.unknowns + size.nonzeros + size.bonds);
  }


  template <int dim>
  void SolidProblem<dim>::take_sample(const RunContext &, ModelEstimate &estimate)
  {
    op().initialize_vector(displacement);
    if (scene.elasticity.is_static())
      {
        if (scene.elasticity.solver == ElasticSolver::linear)
          estimate.time_of_solution =
            time_of_linear_equilibrium(scene.solver,
                                       op(),
                                       scene.time.steady ? 0. : scene.time.end_time,
                                       false);
        return;
      }
    // About as many steps as a run takes, whose first step is this one.
    const double step =
      make_motion_stepper(scene.time.stepper, op(), this->stepper_options())->current_step();
    estimate.applications = step > 0. ? scene.time.end_time / step : 0.;
  }


  template <int dim>
  double SolidProblem<dim>::time_of_equilibria(const double      n_steps,
                                               const RunContext &context,
                                               double           &memory) const
  {
    ElasticOperator &op = body.op();
    // Larger ones take longer than one likes to wait for a check; where there is no coarse lattice
    // one waits some more.
    constexpr double few_unknowns = 5e4, many_unknowns = 3e5;
    // Iterations of other solvers over those of the linear one, where these are alike.
    constexpr double of_full_kinematics = 3.;
    if (scene.elasticity.solver == ElasticSolver::dynamic_relaxation ||
        scene.elasticity.solver == ElasticSolver::adaptive_dynamic_relaxation)
      return -1.;
    const double n_unknowns = static_cast<double>(op.size().unknowns);
    double       first      = 0.;
    if (n_unknowns > few_unknowns)
      first = context.estimate(this->name(), memory).time_of_solution;
    if (first <= 0. && n_unknowns <= many_unknowns)
      first =
        Utilities::MPI::max(time_of_linear_equilibrium(scene.solver,
                                                       op,
                                                       scene.time.steady ? 0. : scene.time.end_time,
                                                       !op.nonlinear()),
                            this->dofs().get_communicator());
    if (first <= 0.)
      return -1.;
    if (op.nonlinear())
      first *= of_full_kinematics;
    // A step whose loads grow in proportion starts from its solution, and looks at every bond.
    constexpr double applications_of_step = 5.;
    if (scene.time.steady)
      return first;
    const bool alike = !op.nonlinear() && !scene.warms_slowly() && scene.cracks.tips.empty();
    return first + n_steps * (alike ? applications_of_step * time_of_application(op) : first);
  }


  namespace
  {
    /** What an evaluation of the forces takes of each node. Collective. */
    std::string price_of_forces(const ElasticOperator &op,
                                const double           time,
                                const double           nodes,
                                const MPI_Comm         all)
    {
      constexpr unsigned int n_trials = 5, period = 101;
      constexpr double       micro = 1e6, small = 1e-12;
      Vector                 u, forces;
      op.initialize_vector(u);
      op.initialize_vector(forces);
      double start = 0.;
      for (unsigned int k = 0; k <= n_trials; ++k) // each another state, or nothing is computed
        {
          for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
            u.local_element(i) = small * ((i * (k + 2)) % period);
          op.clear_constrained(u);
          op.unbalanced(forces, u, time);
          if (k == 0)
            start = processor_seconds();
        }
      const double seconds = Utilities::MPI::sum((processor_seconds() - start) / n_trials, all),
                   memory  = Utilities::MPI::sum(1. * op.size().memory, all);
      return "  price of the law: " + rounded_text(micro * seconds / nodes, 2) +
             " microseconds of a processor for the forces of a node while it is elastic, " +
             readable_bytes(memory / nodes) + " a node";
    }
  } // namespace


  template <int dim>
  double SolidProblem<dim>::time_of_run(const std::vector<double> &times,
                                        const bool                 says,
                                        const RunContext          &context,
                                        double                    &memory)
  {
    const ChosenSettings chosen = this->settings();
    if (says && std::any_of(chosen.begin(), chosen.end(), [](const auto &setting) {
          return setting.first == "law";
        }))
      context.progress.line(price_of_forces(op(),
                                            1e-3 * scene.time.end_time,
                                            this->dofs().n_dofs(),
                                            this->dofs().get_communicator()));
    if (!stepper)
      {
        const double n_steps =
          scene.time.steady ? 1. : std::max(scene.time.end_time / load_step(), 1. * times.size());
        return time_of_equilibria(n_steps, context, memory);
      }
    // By its first steps.
    const double step = stepper->current_step(), end = scene.time.end_time;
    const double from = std::min(step, end), to = std::min(4. * step, end);
    stepper->advance(displacement, velocity, 0., from);
    if (!(to > from))
      return 0.;
    const double before = context.progress.elapsed();
    stepper->advance(displacement, velocity, from, to);
    return (context.progress.elapsed() - before) * end / (to - from);
  }


  template <int dim>
  void SolidProblem<dim>::examine(const double t)
  {
    if (stepper)
      stepper->examine(displacement, velocity, t);
  }


  template <int dim>
  void SolidProblem<dim>::note_end(const RunContext &context) const
  {
    if (loading && !scene.time.steady)
      {
        const unsigned int n_halved = loading->n_divisions();
        const double       least    = loading->least_load_factor();
        context.progress.line(
          this->name() + ": " + std::to_string(n_iterations) + " iterations" +
          (n_halved > 0 ? ", load steps were halved " + std::to_string(n_halved) +
                            (n_halved > 1 ? " times" : " time") :
                          "") +
          (least < 1. ? ", at least " + rounded_text(least) + " of the loads were borne" : ""));
      }
    note_end_of_solid(*this, context);
  }


  template <int dim>
  void SolidProblem<dim>::make_loading()
  {
    StaticOptions options;
    options.tolerance      = scene.solver.tolerance;
    options.max_iterations = scene.solver.most_iterations(scene.elasticity.solver);
    options.direct_up_to   = scene.solver.direct_up_to;
    options.multigrid      = scene.elasticity.multigrid();
    // Where stretches are known; what softens waits for no motion.
    options.breaks_in_motion = scene.elasticity.breaks_in_motion() && !scene.material.law.softens();
    if (scene.elasticity.controls_loads())
      options.control_share = scene.elasticity.dissipation_step;
    options.remembers     = !scene.material.law.user.library.empty();
    options.divides_steps = // temperatures are those of their ends
      !scene.warms_slowly() && !scene.material.law.softens() && options.control_share == 0.;
    auto solver = make_static_solver(scene.elasticity.solver_name(), op(), options);
    loading     = std::make_unique<SlowLoading>(op(), std::move(solver), options);
    if (scene.guards.goes_on())
      loading->findings().let_wait();
    if (heat == nullptr || !scene.elasticity.absolute_reference)
      return;
    warming               = std::make_unique<HeatOfDeformation<dim>>();
    heat->heated_by_solid = true;
  }


  template <int dim>
  void SolidProblem<dim>::solve_loading(const std::function<void()> &action)
  {
    Timings::Scope scope(this->timings, "solving");
    with_formulas(this->dofs().get_communicator(), action);
  }


  template <int dim>
  void SolidProblem<dim>::begin_loading(const RunContext &context)
  {
    solve_loading([&] { loading->begin(displacement, 0.); });
    if (warming)
      warming->begin(*this);
    n_iterations = loading->n_iterations();
    note_equilibrium(*this, 0., context);
    tell_first_break(*this, 0., context);
    told->tell(*this);
  }


  namespace
  {
    /** A part that has broken off and is many times as far from the rest as the body is wide. */
    Trip flown_off(const ElasticOperator &op,
                   const Vector          &u,
                   const unsigned int     dim,
                   const double           size,
                   const PlaceOfNode     &place_of,
                   const double           t)
    {
      // Against supports, or the mean of a body that has none.
      const unsigned int      n    = u.locally_owned_size() / dim;
      const std::vector<bool> held = held_unknowns(op);
      std::vector<double>     sums(4 * dim, 0.); // of all and of held nodes: displacements, numbers
      for (unsigned int i = 0; i < n * dim; ++i)
        for (const unsigned int k : {0u, 2u})
          if (k == 0 || held[i])
            {
              sums[k * dim + i % dim] += u.local_element(i);
              sums[(k + 1) * dim + i % dim] += 1.;
            }
      Utilities::MPI::sum(sums, u.get_mpi_communicator(), sums);
      std::vector<double> rest(dim);
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int k = sums[3 * dim + d] > 0. ? 2 : 0;
          rest[d]              = sums[k * dim + d] / sums[(k + 1) * dim + d];
        }
      double moved = 0.; // by supports
      for (unsigned int i = 0; i < n * dim; ++i)
        if (held[i])
          moved = std::max(moved, std::abs(u.local_element(i) - rest[i % dim]));
      moved               = Utilities::MPI::max(moved, u.get_mpi_communicator());
      const auto distance = [&](const unsigned int i) {
        double sum = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          sum += std::pow(u.local_element(i / dim * dim + d) - rest[d], 2);
        return std::sqrt(sum);
      };
      const Worst      worst = find_worst(u, dim, place_of, distance);
      Trip             trip;
      constexpr double far = 10.;
      if (!(worst.size > far * (size + moved)))
        return trip;
      trip.monitor = "parts flying off";
      trip.value   = worst.size;
      trip.bound   = far * (size + moved);
      trip.place   = worst.place;
      trip.time    = t;
      trip.found   = "what was at " + text_of_place(worst.place) + " has flown off by " +
                   rounded_text(worst.size) +
                   " against the rest, more than ten times the size of the body (" +
                   rounded_text(trip.bound) + ")";
      trip.cause =
        "The bonds that held it have broken. 'Kinematics = linear' in section 'Elasticity' is for small displacements, and lets what spins grow as it flies: "
        "'Kinematics = full' turns it as it is, or an earlier 'End time' (section 'Time') ends the run before.";
      return trip;
    }
  } // namespace


  template <int dim>
  double SolidProblem<dim>::body_size()
  {
    if (size_of_body > 0.)
      return size_of_body;
    constexpr double far = std::numeric_limits<double>::max();
    double           ends[2 * dim];
    std::fill(ends, ends + 2 * dim, -far);
    for (unsigned int i = 0; i < displacement.locally_owned_size() / dim; ++i)
      for (unsigned int d = 0; d < dim; ++d)
        {
          ends[2 * d]     = std::max(ends[2 * d], this->position(i)[d]);
          ends[2 * d + 1] = std::max(ends[2 * d + 1], -this->position(i)[d]);
        }
    Utilities::MPI::max(ends, this->dofs().get_communicator(), ends);
    double sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      sum += std::pow(ends[2 * d] + ends[2 * d + 1], 2);
    return size_of_body = std::sqrt(sum);
  }


  template <int dim>
  unsigned int SolidProblem<dim>::steps_between_looks() const
  {
    return stepper && stepper->name() == "verlet" ? 10 : 1;
  }


  template <int dim>
  Trip SolidProblem<dim>::take_finding()
  {
    return stepper ? stepper->findings().take() : loading ? loading->findings().take() : Trip();
  }


  template <int dim>
  Trip SolidProblem<dim>::watch(const double t)
  {
    const Extent now = extent_of(displacement);
    if (!now.finite)
      return Problem<dim>::watch(t);
    if (!stepper || scene.elasticity.has_full_kinematics() || !op().brittle() ||
        op().n_broken_bonds() == 0)
      return {};
    return now.size() > body_size() ?
             flown_off(op(), displacement, dim, body_size(), place_of_nodes(this->dofs()), t) :
             Trip();
  }


  template <int dim>
  Trip SolidProblem<dim>::watch_totals(const double t) const
  {
    if (stepper || (!op().symmetric() && op().stepping.symmetric_law)) // a coupling that is not
      return {};
    return balance_broken("the forces on the body at rest do not balance: their sum is " +
                            rounded_text(force_lost),
                          force_lost,
                          "the largest force in it",
                          force_scale,
                          t);
  }


  template <int dim>
  void SolidProblem<dim>::explain(Trip &trip)
  {
    if (trip.place.empty() && stepper)
      trip.place =
        find_worst(velocity, dim, place_of_nodes(this->dofs()), [&](const unsigned int i) {
          return std::abs(velocity.local_element(i));
        }).place;
    Problem<dim>::explain(trip);
  }


  template <int dim>
  std::string SolidProblem<dim>::own_cause(const Trip &trip)
  {
    const std::string cause = stepper ? cause_in_motion(*stepper, op(), displacement) : "";
    return !cause.empty() ? cause :
                            cause_in_contrast<dim>(
                              this->dofs().get_triangulation(),
                              "The Young modulus",
                              [&](const Point<dim> &p) { return scene.moduli(p).young(); },
                              trip.monitor);
  }


  template <int dim>
  std::unique_ptr<SolidField<dim>> make_solid_field(Model<dim> &model, const Scene<dim> &scene)
  {
    return model.kind == ModelKind::peridynamics ? make_bond_solid(model, scene) :
                                                   make_element_solid(model, scene);
  }


  PERIDEAL_INSTANTIATE_CLASS(class SolidProblem);
  PERIDEAL_INSTANTIATE_FUNCTION(make_solid_field);
} // namespace PeriDeal
