// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What changes in a run besides its solutions: the mesh, how far it is; and keeping all of it, or
// looking at it before it is written.

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>
#include <perideal/base/process_end.h>
#include <perideal/base/user_error.h>
#include <perideal/problems/computable.h>
#include <perideal/problems/result_record.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/with_formulas.h>
#include <perideal/simulation/estimate.h>
#include <perideal/simulation/simulation.h>

#include <algorithm>

#include "checkpoint_clock.h"
#include "closing.h"
#include "model_comparison.h"
#include "run_guards.h"
#include "run_output.h"

namespace PeriDeal
{
  using namespace dealii;

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
        problem->start_anew();
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
    const RecoveryIndicators found = (*guide)->indicators();
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
        problem->before_remesh();
      adaptation.history.record(*mesh);
      adaptation.last_time = t;
      mesh->execute_coarsening_and_refinement();
    }
    with_formulas(communicator, [&] {
      for (auto &problem : problems)
        problem->after_remesh(t, scene.time.steady);
    });
    for (auto &problem : problems)
      problem->renew_stepper();
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
        problem->rebuild(adaptation.last_time);
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
    wall_time_before = saved.header().wall_time;
    progress.line("resumed at t = " + number_text(saved.header().time) + ", after " +
                  readable_duration(wall_time_before));
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
    const CheckpointClock::Need need = clock->need(t);
    if (need == CheckpointClock::Need::none)
      return;
    const List all = all_problems();
    if (place.problem < all.size()) // the others have been looked at where they got to
      guards->look(*all[place.problem], t);
    const double      before = clock->elapsed();
    const std::string failure =
      output->files().write_checkpoint(t, wall_time_before + before, [this](Archive &archive) {
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
    if (!scene.time.steady)
      settle();
    for (const double t : output_times())
      {
        advance_to(t);
        if (see)
          see(t);
      }
  }


  template <int dim>
  const Problem<dim> &Simulation<dim>::problem() const
  {
    return *problems[0];
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
      if (!scene.time.steady)
        summary = compute(more, tell);
      else
        {
          write_output(0.);
          summary = finish(more, tell);
        }
    });
    output->close();
    tell.end();
    say_what_was_found(tell, summary, scene.general.output_directory);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                   \
  template std::vector<Problem<dim> *> Simulation<dim>::companions() const;                         \
  template std::vector<Problem<dim> *> Simulation<dim>::all_problems() const;                       \
  template double              Simulation<dim>::share_done(const unsigned int, const double) const; \
  template Problem<dim>       &Simulation<dim>::problem_under_way() const;                          \
  template void                Simulation<dim>::after_step(const double);                           \
  template void                Simulation<dim>::dry_run();                                          \
  template void                Simulation<dim>::prepare_adaptation();                               \
  template bool                Simulation<dim>::adapt(const double);                                \
  template void                Simulation<dim>::resume();                                           \
  template void                Simulation<dim>::solve(const std::function<void(const double)> &);   \
  template const Problem<dim> &Simulation<dim>::problem() const;                                    \
  template nlohmann::ordered_json Simulation<dim>::found();                                         \
  template void                   Simulation<dim>::write(std::unique_ptr<RunFiles>,                 \
                                       const nlohmann::ordered_json &,            \
                                       const Progress &);                         \
  template void                   Simulation<dim>::find_steady_state();                             \
  template void                   Simulation<dim>::offer_checkpoint(const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
