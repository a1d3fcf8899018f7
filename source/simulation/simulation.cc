// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/memory.h>
#include <perideal/base/process_end.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/problems/check_sides.h>
#include <perideal/problems/computable.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/problems/quantities.h>
#include <perideal/problems/result_record.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/estimate.h>
#include <perideal/simulation/simulation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "checkpoint_clock.h"
#include "closing.h"
#include "model_comparison.h"
#include "run_guards.h"
#include "run_output.h"
#include "summary_parts.h"

// The mesh, how far a run is; keeping that, or looking before it is written.
namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The times at which problems meet on their way from one to another. */
    template <int dim>
    std::vector<double> stops_between(const std::vector<Problem<dim> *> &problems,
                                      const double                       from,
                                      const double                       to)
    {
      std::vector<double> stops;
      for (const auto &problem : problems)
        for (const double stop : problem->stops(from, to))
          stops.push_back(stop);
      std::sort(stops.begin(), stops.end());
      stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
      return stops;
    }


    template <int dim>
    AdaptiveProblem &adaptive(Problem<dim> &problem)
    {
      return dynamic_cast<AdaptiveProblem &>(problem);
    }
  } // namespace


  template <int dim>
  Simulation<dim>::Simulation(const Scene<dim> &scene,
                              const SceneText  &text,
                              const MPI_Comm    communicator,
                              const bool        quiet)
    : scene(scene)
    , text(text)
    , communicator(communicator)
    , progress(communicator, quiet)
    , record(std::make_unique<ResultRecord>())
    , output(std::make_unique<RunOutput<dim>>(scene, *record))
    , guards(std::make_unique<RunGuards<dim>>(scene.guards,
                                              scene.time.steady,
                                              progress,
                                              *record,
                                              timings))
  {}


  template <int dim>
  Simulation<dim>::~Simulation() = default;


  template <int dim>
  std::vector<double> Simulation<dim>::output_times() const
  {
    if (scene.time.steady)
      return {0.};
    return scene.output.all_times(scene.time.end_time);
  }


  template <int dim>
  RunContext Simulation<dim>::context()
  {
    return {progress,
            *record,
            [this](const std::string &model, double &memory) {
              return estimate_model(scene, model, communicator, memory);
            },
            clock ? AfterStep([this](const double t) { after_step(t); }) : AfterStep()};
  }


  template <int dim>
  void Simulation<dim>::build()
  {
    const unsigned int n_proc = Utilities::MPI::n_mpi_processes(communicator);
    progress.line(scene.general.title + "  (" + text.file_name + ", " + std::to_string(n_proc) +
                  (n_proc == 1 ? " process)" : " processes)"));
    {
      progress.doing("building the mesh");
      Timings::Scope scope(timings, "mesh");
      mesh = build_mesh(scene, communicator, record->notes);
      set_material_ids(*mesh, scene.material.phases.all());
    }
    check_mesh();
    progress.line("mesh: " + readable_count(mesh->n_global_active_cells()) + " cells");
    for (const ModelKind model : scene.general.models)
      {
        progress.doing("building " + to_string(model));
        models.push_back(std::make_unique<Model<dim>>(model, *mesh));
        models.back()->problem = problem_factory(scene).make_problem(*models.back(), scene);
        problems.push_back(models.back()->problem.get());
        say_size(*problems.back(), progress);
        for (const std::string &note : problems.back()->notes())
          record->notes.push_back(note);
      }
    problem_factory(scene).add_companions(models, scene, record->notes);
    for (const Problem<dim> *const companion : companions())
      {
        progress.line("to find the " + companion->field_name() + " in it:");
        say_size(*companion, progress);
      }
    prepare_adaptation();
    exact = make_reference(scene);
    Timings::Scope scope(timings, "output");
    output->find_points(reported());
    for (const std::string &note : output->gaps_in_line())
      record->notes.push_back(note);
  }


  template <int dim>
  void Simulation<dim>::check_mesh()
  {
    require_cells_everywhere(*mesh);
    with_formulas(communicator, [&] { check_sides(scene, *mesh); });
    check_points_of_parts(scene, *mesh, record->notes);
    problem_factory(scene).note_scene(scene, *mesh, record->notes);
    if (const std::vector<double> &beyond = scene.output.times_beyond_end; !beyond.empty())
      record->notes.push_back(
        "'Write at' in section 'Output' has times beyond 'End time' in section 'Time', which is " +
        number_text(scene.time.end_time) + ": nothing is written at t = " +
        number_text(beyond.front()) + (beyond.size() == 1 ? "." : " and later."));
  }


  template <int dim>
  std::vector<const Problem<dim> *> Simulation<dim>::reported() const
  {
    return {problems.begin(), problems.end()};
  }


  template <int dim>
  void Simulation<dim>::run(const RunMode mode)
  {
    Assert(!scene.general.automatic, ExcMessage("Models are chosen by run_scene()."));
    require_computable(scene, text);
    require_memory(scene, communicator);
    output->open(text, communicator, mode);
    nlohmann::ordered_json summary;
    with_orderly_end(output->files(), progress, [&] {
      summary = compute(nlohmann::ordered_json::object(), progress);
    });
    output->close();
    progress.end();
    say_what_was_found(progress, summary, scene.general.output_directory);
  }


  template <int dim>
  nlohmann::ordered_json Simulation<dim>::compute(const nlohmann::ordered_json &more,
                                                  const Progress               &tell)
  {
    build();
    if (!scene.time.steady)
      clock = std::make_unique<CheckpointClock>(scene.checkpoint, communicator);
    if (resumes())
      {
        resume();
        progress.begin("time");
      }
    else
      {
        begin();
        progress.begin("time");
        start();
      }
    pass_output_times();
    progress.end();
    return finish(more, tell);
  }


  template <int dim>
  nlohmann::ordered_json Simulation<dim>::finish(const nlohmann::ordered_json &more,
                                                 const Progress               &tell)
  {
    if (const unsigned int n = adaptation.history.n_adaptations(); n > 0)
      record->notes.push_back("the mesh was adapted " + std::to_string(n) +
                              (n == 1 ? " time" : " times") + "; it has " +
                              readable_count(mesh->n_global_active_cells()) +
                              " cells at the end ('Zone = adaptive' in section 'Coupling').");
    for (const Problem<dim> *const problem : all_problems())
      problem->note_end(context());
    for (const std::string &note : record->notes)
      tell.note(note);
    nlohmann::ordered_json summary = summary_now(true);
    summary.update(more);
    output->complete(summary);
    return summary;
  }


  template <int dim>
  void Simulation<dim>::begin()
  {
    for (const List &list : {companions(), problems})
      for (Problem<dim> *const problem : list)
        problem->begin(context());
  }


  template <int dim>
  bool Simulation<dim>::resumes() const
  {
    return output->is_open() && output->files().checkpoint() != nullptr;
  }


  template <int dim>
  void Simulation<dim>::pass_output_times()
  {
    const StoppableWhile stoppable(!scene.time.steady);
    for (const std::vector<double> times = output_times(); place.output < times.size();)
      {
        const double t = times[place.output];
        advance_to(t);
        progress.update(scene.time.steady ? 1. : t / scene.time.end_time);
        write_output(t);
        if (++place.output < times.size())
          offer_checkpoint(t);
      }
  }


  template <int dim>
  void Simulation<dim>::start()
  {
    if (scene.time.steady)
      return;
    settle();
    for (Problem<dim> *const problem : all_problems())
      guards->over(*problem, 0., [&] { guards->look(*problem, 0.); });
    const bool at_stops = tells_at_stops();
    at_stops ? add_totals(0.) : check_quantities(reported());
    if (scene.output.starts_at_zero())
      write_fields(0.);
    if (at_stops)
      end_output(0.);
  }


  template <int dim>
  void Simulation<dim>::settle()
  {
    for (Problem<dim> *const companion : companions())
      {
        Timings::Scope scope(timings, companion->field_name());
        guards->over(*companion, 0., [&] { companion->settle(context()); });
      }
    for (Problem<dim> *const problem : problems)
      {
        progress.doing("solving " + problem->name());
        guards->over(*problem, 0., [&] { problem->settle(context()); });
      }
  }


  template <int dim>
  bool Simulation<dim>::tells_at_stops() const
  {
    return std::any_of(problems.begin(), problems.end(), [](const auto &problem) {
      return problem->tells_at_stops();
    });
  }


  template <int dim>
  void Simulation<dim>::add_totals(const double t)
  {
    for (const auto &problem : problems)
      {
        problem->add_totals(t, context());
        guards->look_at_totals(*problem, t);
      }
    add_quantities(reported(), t, *record);
  }


  template <int dim>
  void Simulation<dim>::end_output(const double t)
  {
    output->end_time([&] { return summary_now(false); },
                     scene.time.steady ? problems[0]->steady_name() :
                                         "until t = " + full_precision(t));
  }


  template <int dim>
  void Simulation<dim>::add_errors(const double t)
  {
    if (!exact)
      return;
    for (const auto &problem : problems)
      with_formulas(communicator, [&] {
        const Difference error = problem->error(*exact, t);
        record->errors[problem->name()]["relative l2"].push_back({t, error.relative_l2});
        record->errors[problem->name()]["maximum"].push_back({t, error.maximum});
      });
  }


  template <int dim>
  void Simulation<dim>::write_output(const double t)
  {
    for (Problem<dim> *const problem : problems)
      guards->over(*problem, t, [&] { guards->examine(*problem, t); });
    progress.doing("writing results");
    Timings::Scope scope(timings, "output");
    if (!adaptation.readers_fit)
      output->find_points(reported());
    adaptation.readers_fit = true;
    if (!tells_at_stops()) // refuses what is not finite before it is written
      add_totals(t);
    const bool shows = scene.output.writes_fields_at(t);
    with_formulas(communicator, [&] { output->write_points(t, exact.get(), shows); });
    if (!shows)
      return end_output(t);
    add_errors(t);
    compare_models(reported(), scene.domain, t, *record);
    write_fields(t);
    end_output(t);
  }


  template <int dim>
  void Simulation<dim>::write_fields(const double t)
  {
    std::map<std::string, OutputField> more;
    if (shows_difference(*problems[0]))
      for (Vector &difference : difference_of_models(reported()))
        more.emplace(to_string(ModelKind::peridynamics),
                     OutputField{"peridynamics_minus_finite_elements", {std::move(difference)}});
    output->write_fields(t, more);
  }


  template <int dim>
  nlohmann::ordered_json Simulation<dim>::summary_now(const bool at_the_end) const
  {
    nlohmann::ordered_json summary = PeriDeal::describe_scene(scene, text, *mesh, communicator);
    if (scene.domain.coarsening.times > 0)
      summary["mesh"] = {{"coarsening", scene.domain.coarsening.times},
                         {"adaptations", adaptation.history.n_adaptations()}};
    describe_run(scene, *mesh, *record, timings, summary);
    summary["write times"] = output_times();
    for (const auto &problem : problems)
      {
        auto &entry = summary["models"][problem->name()];
        entry       = describe_problem<dim>(*problem, problem->describe_solving(), *record);
        if (at_the_end)
          problem->describe_end(entry, *record);
      }
    problems[0]->describe_scene(summary, at_the_end);
    return summary;
  }


  template <int dim>
  void Simulation<dim>::advance_to(const double t)
  {
    if (scene.time.steady)
      return find_steady_state();
    while (place.now < t)
      {
        if (place.stop == place.stops.size())
          {
            place.stops = stops_between<dim>(problems, place.now, t);
            place.stop  = 0;
          }
        for (const double stop = place.stops[place.stop]; place.now < stop;)
          {
            const double next = adaptation.grading ?
                                  adaptation.grading->next_adaptation(place.now) :
                                  std::numeric_limits<double>::infinity();
            const double to   = std::min(stop, next);
            advance_all(to);
            if (to == next)
              adapt(to);
          }
        ++place.stop;
        if (!tells_at_stops() || !output->is_open()) // solve() writes nothing
          continue;
        {
          Timings::Scope scope(timings, "output");
          add_totals(place.now);
          end_output(place.now);
        }
        progress.update(place.now / scene.time.end_time);
        if (place.now < t)
          offer_checkpoint(place.now);
      }
  }


  template <int dim>
  std::pair<unsigned int, unsigned int> Simulation<dim>::count_stops() const
  {
    std::pair<unsigned int, unsigned int> counts = {place.stop, 0};
    if (!tells_at_stops()) // of which there may be very many
      return counts;
    const std::vector<double> times = output_times();
    for (unsigned int k = 0; k < times.size(); ++k)
      {
        const unsigned int n =
          stops_between<dim>(problems, k > 0 ? times[k - 1] : 0., times[k]).size();
        counts.first += k < place.output ? n : 0;
        counts.second += n;
      }
    return counts;
  }


  template <int dim>
  void Simulation<dim>::advance_all(const double to)
  {
    const List before_all      = companions();
    const auto [passed, n_all] = count_stops();
    const auto says_nothing    = [](const double) {};
    for (; place.problem < before_all.size(); ++place.problem)
      {
        Problem<dim>  &companion = *before_all[place.problem];
        Timings::Scope scope(timings, companion.field_name());
        guards->over(companion, to, [&] {
          companion.advance(place.now, to, says_nothing, context());
          guards->look(companion, to);
        });
      }
    for (; place.problem < before_all.size() + problems.size(); ++place.problem)
      {
        const unsigned int k       = place.problem - before_all.size();
        Problem<dim>      &problem = *problems[k];
        const double       before = share_done(k, to), after = share_done(k + 1, to);
        progress.doing(problem.doing(passed + 1, n_all, scene.time.end_time));
        if (!problem.tells_at_stops())
          progress.advancing(place.now, to, before, after);
        guards->over(problem, to, [&] {
          problem.advance(
            place.now,
            to,
            [&](const double share) { progress.update(before + share * (after - before)); },
            context());
          guards->look(problem, to);
        });
      }
    place.problem = 0;
    place.now     = to;
  }


  template <int dim>
  typename Simulation<dim>::List Simulation<dim>::companions() const
  {
    List list;
    for (const auto &model : models)
      for (const auto &companion : model->companions)
        list.push_back(companion.get());
    return list;
  }


  template <int dim>
  typename Simulation<dim>::List Simulation<dim>::all_problems() const
  {
    List all = companions();
    all.insert(all.end(), problems.begin(), problems.end());
    return all;
  }


  template <int dim>
  double Simulation<dim>::share_done(const unsigned int n, const double to) const
  {
    double some = 0., all = 0.;
    for (unsigned int k = 0; k < problems.size(); ++k)
      {
        const double work = problems[k]->work_of(to - place.now);
        all += work;
        if (k < n)
          some += work;
      }
    return (place.now + some / all * (to - place.now)) / scene.time.end_time;
  }


  template <int dim>
  void Simulation<dim>::prepare_adaptation()
  {
    if (!scene.coupling.is_adaptive())
      return;
    adaptation.grading = std::make_unique<Grading<dim>>(scene, *mesh);
    if (scene.time.steady || resumes())
      return;
    for (unsigned int round = 0; round < scene.domain.coarsening.times && adapt(0.); ++round)
      for (auto &problem : problems)
        adaptive(*problem).start_anew();
  }


  template <int dim>
  bool Simulation<dim>::adapt(const double t)
  {
    if (!adaptation.grading)
      return false;
    adaptation.grading->set_time(t);
    const auto guide = std::find_if(problems.begin(), problems.end(), [](const auto &problem) {
      return problem->name() == to_string(ModelKind::coupled);
    });
    const RecoveryIndicators found = adaptive(**guide).indicators();
    // A uniform field has fluxes of round-off only.
    constexpr double round_off = 1e-20;
    const double     least     = round_off * found.size / scene.domain.spacing().norm_square();
    const double     goal      = scene.coupling.adaptive_tolerance;
    const double     target =
      goal * goal * std::max(found.energy, least) / mesh->n_global_active_cells();
    {
      Timings::Scope scope(timings, "mesh adaptation");
      if (!adaptation.grading->mark(*mesh, found.squares, target))
        return false;
      for (auto &problem : problems)
        adaptive(*problem).before_remesh();
      adaptation.history.record(*mesh);
      adaptation.last_time = t;
      mesh->execute_coarsening_and_refinement();
    }
    with_formulas(communicator, [&] {
      for (auto &problem : problems)
        adaptive(*problem).after_remesh(t, scene.time.steady);
    });
    for (auto &problem : problems)
      adaptive(*problem).renew_stepper();
    adaptation.readers_fit = false;
    return true;
  }


  template <int dim>
  void Simulation<dim>::find_steady_state()
  {
    progress.line(problems[0]->steady_name());
    settle();
    constexpr double settled = 0.05; // share of cells more or fewer
    for (unsigned int round = 0; round < 2 * scene.domain.coarsening.times; ++round)
      {
        const double n_before = mesh->n_global_active_cells();
        if (!adapt(0.))
          break;
        settle();
        if (std::abs(mesh->n_global_active_cells() - n_before) < settled * n_before)
          break;
      }
  }


  template <int dim>
  void Simulation<dim>::Place::exchange(Archive &archive)
  {
    archive.exchange("now", now);
    archive.exchange("stops", stops);
    archive.exchange("next stop", stop);
    archive.exchange("problem", problem);
  }


  template <int dim>
  void Simulation<dim>::exchange(Archive &archive)
  {
    place.exchange(archive);
    timings.exchange(archive);
    const auto exchange_all = [&](const List &list, const std::string &name) {
      for (std::size_t k = 0; k < list.size(); ++k)
        {
          const Archive::Part part(archive, name + std::to_string(k));
          list[k]->exchange(archive);
        }
    };
    exchange_all(companions(), "companion ");
    exchange_all(problems, "problem ");
    output->exchange(archive);
  }


  template <int dim>
  void Simulation<dim>::exchange_mesh(Archive &archive)
  {
    const Archive::Part part(archive, "mesh");
    adaptation.history.exchange(archive);
    archive.exchange("time", adaptation.last_time);
    if (!archive.loads() || adaptation.history.n_adaptations() == 0)
      return;
    adaptation.history.repeat(*mesh);
    adaptation.grading->set_time(adaptation.last_time);
    with_formulas(communicator, [&] {
      for (auto &problem : problems)
        adaptive(*problem).rebuild(adaptation.last_time);
    });
    output->find_points(reported());
  }


  template <int dim>
  void Simulation<dim>::resume()
  {
    CheckpointReader &saved = *output->files().checkpoint();
    exchange_mesh(saved);
    begin();
    exchange(saved);
    find_next_output();
    place.wall_time_before = saved.header().wall_time;
    progress.line("resumed at t = " + number_text(saved.header().time) + ", after " +
                  readable_duration(place.wall_time_before));
    for (const std::string &note : output->files().notes) // also at the end, with all others
      {
        progress.note(note);
        record->notes.push_back(note);
      }
    output->files().has_resumed();
  }


  template <int dim>
  void Simulation<dim>::find_next_output()
  {
    // What is on its way to a time goes there, whatever times of output there are now.
    const bool   is_on_its_way = place.stop < place.stops.size();
    const double next          = is_on_its_way ? place.stops.back() : place.now;
    AssertThrow(
      next <= scene.time.end_time && place.now < scene.time.end_time,
      UserError("'End time' in section 'Time' is " + number_text(scene.time.end_time) +
                ", but the run that is to be resumed is on its way to t = " + number_text(next) +
                ". Choose a later one, or begin anew with --overwrite."));
    const std::vector<double> times = output_times();
    const auto first = is_on_its_way ? std::lower_bound(times.begin(), times.end(), next) :
                                       std::upper_bound(times.begin(), times.end(), next);
    place.output     = first - times.begin();
    if (first != times.begin() && *(first - 1) > place.now)
      record->notes.push_back("no results are written at t = " + number_text(*(first - 1)) +
                              ": the run that was resumed at t = " + number_text(place.now) +
                              " was on its way to t = " + number_text(next) + ".");
  }


  template <int dim>
  Problem<dim> &Simulation<dim>::problem_under_way() const
  {
    unsigned int k = place.problem; // companions come first
    for (const auto &model : models)
      for (const auto &companion : model->companions)
        if (k-- == 0)
          return *companion;
    return *problems[k];
  }


  template <int dim>
  void Simulation<dim>::after_step(const double t)
  {
    if (guards->are_on())
      guards->after_step(problem_under_way(), t);
    offer_checkpoint(t);
  }


  template <int dim>
  void Simulation<dim>::offer_checkpoint(const double t)
  {
    if (!output->is_open()) // solved alone, without results
      return;
    const CheckpointClock::Need need = clock->need(t);
    if (need == CheckpointClock::Need::none)
      return;
    const List all = all_problems();
    if (place.problem < all.size()) // the others have been looked at where they got to
      guards->look(*all[place.problem], t);
    const double      before  = clock->elapsed();
    const std::string failure = output->files().write_checkpoint(t,
                                                                 place.wall_time_before + before,
                                                                 [this](Archive &archive) {
                                                                   exchange_mesh(archive);
                                                                   exchange(archive);
                                                                 });
    clock->kept(clock->elapsed() - before);
    if (need == CheckpointClock::Need::stop)
      stop(t, failure);
    if (failure.empty())
      progress.line("checkpoint at t = " + number_text(t));
    else
      progress.note(failure);
  }


  template <int dim>
  void Simulation<dim>::stop(const double t, const std::string &failure) const
  {
    const std::string last = output->files().last_checkpoint(),
                      why  = "stopped at t = " + number_text(t) + " by " + clock->reason() + ". ";
    AssertThrow(!last.empty(), UserError("The run was " + why + failure));
    throw Stopped(why + (failure.empty() ? "Its state is kept in " + last + "." :
                                           failure + " The last one kept is " + last + "."));
  }


  template <int dim>
  void Simulation<dim>::dry_run()
  {
    require_computable(scene, text);
    const double before = Utilities::MPI::sum(resident_memory(), communicator);
    build();
    begin();
    double     computing = 0., memory = 0.; // negative if it is not known
    const List all = all_problems();
    for (std::size_t k = 0; k < all.size(); ++k)
      {
        const bool   says = k + problems.size() >= all.size();
        const double own  = all[k]->time_of_run(output_times(), says, context(), memory);
        computing         = own >= 0. && computing >= 0. ? computing + own : -1.;
      }
    if (adaptation.grading)
      progress.line("With 'Zone = adaptive' all figures are those of the mesh at the start.");
    for (const std::string &note : record->notes)
      progress.note(note);
    std::vector<double> components;
    for (const auto &problem : problems)
      components.push_back(components_written(*problem, problems.size()));
    for (const std::string &line : describe_costs(scene,
                                                  computing,
                                                  before + memory,
                                                  mesh->n_global_active_cells(),
                                                  components,
                                                  communicator))
      progress.line(line);
    progress.line("The scene is valid. Nothing was computed.");
  }


  template <int dim>
  void Simulation<dim>::solve(const std::function<void(const double)> &see)
  {
    require_computable(scene, text);
    require_memory(scene, communicator);
    build();
    begin();
    const bool keeps = !scene.time.steady && !scene.cracks.change() && !adaptation.grading &&
                       companions().empty() && problems.size() == 1 &&
                       (!tells_at_stops() || count_stops().second == output_times().size());
    const auto keep = [&] {
      if (!keeps)
        return;
      kept.emplace_back();
      problems[0]->exchange(kept.back());
      kept.back().load();
    };
    if (!scene.time.steady)
      settle();
    keep();
    for (const double t : output_times())
      {
        advance_to(t);
        keep();
        if (see)
          see(t);
      }
  }


  template <int dim>
  nlohmann::ordered_json Simulation<dim>::found()
  {
    for (const auto &problem : problems)
      problem->examine(place.now);
    add_totals(place.now);
    record->totals.clear(); // rows are added when they are written
    return summary_now(true);
  }

  template <int dim>
  void Simulation<dim>::write(std::unique_ptr<RunFiles>     files,
                              const nlohmann::ordered_json &more,
                              const Progress               &tell)
  {
    output->adopt(std::move(files));
    nlohmann::ordered_json summary;
    with_orderly_end(output->files(), progress, [&] {
      if (!has_kept())
        return void(summary = compute(more, tell));
      auto       state   = kept.begin();
      const auto go_back = [&](const double t) {
        place.now = t;
        if (scene.time.steady)
          return;
        problems[0]->exchange(*state++);
        if (tells_at_stops())
          add_totals(t);
      };
      go_back(0.);
      if (!scene.time.steady && scene.output.starts_at_zero())
        write_fields(0.);
      for (const double t : output_times())
        {
          go_back(t);
          write_output(t);
        }
      summary = finish(more, tell);
    });
    output->close();
    tell.end();
    say_what_was_found(tell, summary, scene.general.output_directory);
  }


  PERIDEAL_INSTANTIATE_CLASS(class Simulation);
} // namespace PeriDeal
