// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>
#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/estimate.h>
#include <perideal/simulation/run_files.h>
#include <perideal/simulation/simulation.h>
#include <perideal/study/model_choice.h>
#include <perideal/study/observed_error.h>

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <sstream>

#include "attempts.h"
#include "measured_error.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Json = nlohmann::ordered_json;

    /** An attempt that has been computed. */
    template <int dim>
    struct Tried
    {
      Attempt                          attempt;
      std::shared_ptr<Scene<dim>>      scene;
      std::unique_ptr<Simulation<dim>> simulation;
      MeasuredNumbers                  numbers;
      double                           wall_time = 0., cells = 0.;
    };


    std::string short_name(const Attempt &attempt)
    {
      std::string text = to_string(attempt.model);
      for (const auto &[entry, value] : attempt.settings)
        for (const char *const shown :
             {"Domain/Cells", "Domain/Coarsening", "Finite elements/Degree"})
          if (entry == shown && !(entry == "Domain/Coarsening" && value == "0"))
            text += ", " + entry.substr(entry.find('/') + 1) + " = " + value;
      return text;
    }


    Json settings_of(const Attempt &attempt)
    {
      Json settings = Json::object();
      for (const auto &[entry, value] : attempt.settings)
        settings[entry] = value;
      return settings;
    }


    /** Tries one attempt after the other. All functions are collective. */
    template <int dim>
    class Choice
    {
    public:
      Choice(const Scene<dim> &scene,
             const SceneText  &text,
             const MPI_Comm    communicator,
             const bool        quiet)
        : scene(scene)
        , text(text)
        , communicator(communicator)
        , progress(communicator, quiet)
        , attempts(scene)
        , measure(scene)
        , start(Clock::now())
      {}

      /** Until the estimate is good enough, or nothing more may be spent. */
      void search()
      {
        progress.line(scene.general.title + "  (" + text.file_name + ")");
        progress.line("Models = auto: " + attempts.reason());
        compute(attempts.at(attempts.coarsest()));
        for (;;)
          {
            next = finer(next_fineness());
            if (is_met())
              return;
            limit = limit_before(next);
            if (!limit.empty())
              return require_estimate();
            compute(next);
          }
      }

      void write(std::unique_ptr<RunFiles> files)
      {
        std::ostringstream line;
        line.precision(3);
        line << "estimated error: " << 100. * now.error << " % (" << scene.accuracy.measure_text()
             << "), asked for " << 100. * scene.accuracy.tolerance << " %"
             << (is_met() ? "" : ": not reached within " + limit);
        progress.line(line.str());
        last().simulation->write(std::move(files), {{"accuracy", describe()}}, progress);
      }

    private:
      using Clock = std::chrono::steady_clock;

      double elapsed() const
      {
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        return Utilities::MPI::max(seconds, communicator);
      }

      Tried<dim> &last()
      {
        return tried.back();
      }

      const Tried<dim> &last() const
      {
        return tried.back();
      }

      /**
       * An order is seen in three solutions at least; a low one is not trusted as long as all are
       * coarse, since it says more of the first than of the last.
       */
      bool is_met() const
      {
        const bool settled = steps.size() > 3 ||
                             (steps.size() == 3 && now.order > 0.5 * attempts.best_order());
        return settled && now.error <= scene.accuracy.tolerance;
      }

      /** An attempt with about this fineness, but with more than the last one. */
      Attempt finer(const double fineness) const
      {
        const double least   = 1.1 * last().attempt.fineness;
        Attempt      attempt = attempts.at(fineness);
        for (double wanted = least; attempt.fineness < least; wanted *= 1.1)
          attempt = attempts.at(wanted);
        return attempt;
      }

      double next_fineness() const
      {
        constexpr double aim      = 0.7; // of the tolerance: an estimate is no bound
        const double     farthest = dim == 3 ? 2. : 3.;
        if (steps.size() < 3 || now.error <= scene.accuracy.tolerance)
          return 2. * last().attempt.fineness;
        return fineness_for(now, last().attempt.fineness, aim * scene.accuracy.tolerance, farthest);
      }

      double expected_time(const Attempt &attempt) const
      {
        return last().wall_time *
               std::pow(attempt.fineness / last().attempt.fineness, attempts.growth_of_cost());
      }

      /** What keeps one more attempt from being made, in words, or nothing. Collective. */
      std::string limit_before(const Attempt &attempt) const
      {
        constexpr std::size_t most = 14, most_unknown = 5;
        scene.accuracy.refuse(
          tried.size() >= most_unknown && steps.size() < 2,
          "Measure",
          "is 'stress intensity', but there is none: it needs a box of one material without heating, and "
          "room around the ends of cracks for some cells.");
        if (tried.size() >= most)
          return std::to_string(most) + " tries";
        if (scene.accuracy.budget > 0. &&
            elapsed() + expected_time(attempt) > scene.accuracy.budget)
          return "'Budget'";
        const double growth =
          std::pow(attempt.fineness / last().attempt.fineness, attempts.growth_of_cost());
        const double taken = Utilities::MPI::sum(resident_memory(), communicator);
        const bool   given = scene.accuracy.memory > 0.;
        const double left  = given ? scene.accuracy.memory - taken : available_memory(communicator);
        return last_memory * growth < left ? "" : given ? "'Memory'" : "the memory of the machine";
      }

      /** Throws UserError if nothing can be said of an error yet. */
      void require_estimate() const
      {
        if (now.error >= 0.)
          return;
        std::ostringstream what;
        what.precision(2);
        what << "is too small for an estimate of the error, which needs two solutions at least: ";
        if (limit == "'Memory'")
          what << "the next one would take more.";
        else
          what << "after " << elapsed() << " s the next one would take some " << expected_time(next)
               << " s.";
        scene.accuracy.refuse(limit == "'Budget'", "Budget", what.str());
        scene.accuracy.refuse(limit == "'Memory'", "Memory", what.str());
        throw UserError("Entry 'Tolerance' in section 'Accuracy': " + limit +
                        " did not allow two solutions, which an estimate of the error needs.");
      }

      void compute(const Attempt &attempt)
      {
        const double begin = elapsed(), before = resident_memory();
        Tried<dim>   one;
        one.attempt                  = attempt;
        one.scene                    = scene_variant(scene, attempt.settings);
        one.scene->general.automatic = true;
        one.simulation = std::make_unique<Simulation<dim>>(*one.scene, text, communicator, true);
        one.simulation->solve();
        one.numbers = measure.numbers(*one.simulation);
        one.cells   = one.simulation->problem().dofs().get_triangulation().n_global_active_cells();
        std::optional<double> difference;
        if (!tried.empty())
          {
            difference = measure.difference({*one.simulation, one.numbers},
                                            {*last().simulation, last().numbers});
            last().simulation.reset();
          }
        if (!difference) // the first of which anything is known
          steps.clear();
        last_memory = Utilities::MPI::sum(std::max(1e6, resident_memory() - before), communicator);
        tried.push_back(std::move(one));
        steps.push_back({attempt.fineness, difference ? *difference : 0.});
        now              = observed_error(steps, attempts.best_order());
        last().wall_time = elapsed() - begin;
        say();
        history.push_back({{"model", to_string(attempt.model)},
                           {"settings", settings_of(attempt)},
                           {"estimate", now.error >= 0. ? Json(now.error) : Json()},
                           {"wall time", last().wall_time}});
      }

      void say() const
      {
        std::ostringstream line;
        line.precision(3);
        line << "  " << short_name(last().attempt) << ": "
             << readable_count(static_cast<unsigned long long>(last().cells)) << " cells, ";
        if (now.error >= 0.)
          line << "estimated error " << 100. * now.error << " %, ";
        line << last().wall_time << " s";
        progress.line(line.str());
      }

      Json describe() const
      {
        const bool cracked = !scene.cracks.cracks.empty();
        return {{"measure", scene.accuracy.measure_text()},
                {"tolerance", scene.accuracy.tolerance},
                {"estimate", now.error},
                {"met", is_met()},
                {"budget exhausted", !limit.empty()},
                {"model", to_string(last().attempt.model)},
                {"settings", settings_of(last().attempt)},
                {"reason", attempts.reason()},
                {"observed order", now.order},
                {"left",
                 {{cracked ? "crack" : "mesh", now.error},
                  {cracked ? "mesh" : "crack", 0.},
                  {"horizon", 0.},
                  {"zone", 0.},
                  {"time", 0.},
                  {"solver", scene.solver.tolerance}}},
                {"steps", history},
                {"next",
                 {{"settings", settings_of(next)}, {"estimated wall time", expected_time(next)}}}};
      }

      const Scene<dim>             &scene;
      const SceneText              &text;
      const MPI_Comm                communicator;
      Progress                      progress;
      const Attempts<dim>           attempts;
      const MeasuredError<dim>      measure;
      const Clock::time_point       start;
      std::vector<Tried<dim>>       tried;
      std::vector<ComparedSolution> steps;
      Json                          history = Json::array();
      ObservedError                 now;
      Attempt                       next;
      double                        last_memory = 0.;
      std::string                   limit; // that ended the search, in words
    };
  } // namespace


  template <int dim>
  void run_scene(const Scene<dim> &scene,
                 const SceneText  &text,
                 const MPI_Comm    communicator,
                 const RunMode     mode,
                 const bool        quiet)
  {
    if (!scene.general.automatic)
      return Simulation<dim>(scene, text, communicator, quiet).run(mode);
    AssertThrow(mode != RunMode::resume,
                UserError("--resume: 'Models = auto' keeps no checkpoints; run the scene again."));
    Choice<dim>                 choice(scene, text, communicator, quiet);
    auto                        files = std::make_unique<RunFiles>(scene, text, communicator, mode);
    const Progress              progress(communicator, true);
    const std::function<void()> search = [&choice] { choice.search(); };
    with_orderly_end(*files, progress, search);
    choice.write(std::move(files));
  }


  template <int dim>
  void describe_choice(const Scene<dim> &scene,
                       const SceneText  &text,
                       const MPI_Comm    communicator,
                       const bool        quiet)
  {
    const Progress           progress(communicator, quiet);
    const Attempts<dim>      attempts(scene);
    const MeasuredError<dim> measure(scene);
    progress.line(scene.general.title + "  (" + text.file_name + ")");
    progress.line("Models = auto would try, until the estimated error is at most " +
                  number_text(100. * scene.accuracy.tolerance) + " %:");
    double fineness = attempts.coarsest();
    for (unsigned int k = 0; k < 5; ++k, fineness *= 2.)
      {
        const Attempt     attempt  = attempts.at(fineness);
        const auto        variant  = scene_variant(scene, attempt.settings);
        const RunEstimate estimate = estimate_run(*variant, communicator);
        progress.line("  " + short_name(attempt) + ": " +
                      readable_count(static_cast<unsigned long long>(estimate.cells)) + " cells, " +
                      readable_bytes(estimate.memory));
      }
    progress.line("and finer ones where that is needed. " + attempts.reason());
    progress.line("The entries of the scene are valid. Nothing was computed.");
  }


#define PERIDEAL_INSTANTIATE(dim)             \
  template void run_scene(const Scene<dim> &, \
                          const SceneText &,  \
                          const MPI_Comm,     \
                          const RunMode,      \
                          const bool);        \
  template void describe_choice(const Scene<dim> &, const SceneText &, const MPI_Comm, const bool);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
