// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/memory.h>
#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/output/tables.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>
#include <perideal/simulation/estimate.h>
#include <perideal/simulation/run_files.h>
#include <perideal/simulation/simulation.h>
#include <perideal/study/model_choice.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>
#include <sstream>

#include "growth_choice.h"
#include "guaranteed.h"
#include "search.h"
#include "spending.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Json = nlohmann::ordered_json;

    std::string short_name(const Attempt &attempt)
    {
      std::string text = to_string(attempt.model);
      for (const auto &[entry, value] : attempt.settings)
        for (const char *const shown :
             {"Domain/Cells", "Domain/Refinements", "Domain/Coarsening", "Finite elements/Degree"})
          if (entry == shown && !(entry != "Domain/Cells" && value == "0"))
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
      Choice(const BodyOfChoice<dim> &body,
             const SceneText         &text,
             const MPI_Comm           communicator,
             const bool               quiet)
        : scene(*body.scene)
        , text(text)
        , communicator(communicator)
        , quiet(quiet)
        , progress(communicator, quiet)
        , measure(scene)
        , classical(body, text, communicator, measure, LimitOfAttempts::classical)
        , nonlocal(body, text, communicator, measure, LimitOfAttempts::nonlocal)
        , is_nonlocal(scene.peridynamics.horizon > 0.)
        , moves(scene.deforms && !scene.elasticity.is_static()) // with steps as long as cells allow
        , spending(scene.accuracy, communicator)
      {}

      /** Compute, and write all files. */
      void run(const RunMode mode)
      {
        auto           files = std::make_unique<RunFiles>(scene, text, communicator, mode);
        const Progress silent(communicator, true);
        with_orderly_end(*files, silent, [this] { search(); });
        write(std::move(files));
      }

    private:
      /** Until the estimate is good enough, or nothing more may be spent. */
      void search()
      {
        // Finite elements show how much a horizon matters if their own error does not.
        constexpr double share_of_elements = 0.3;
        const double     tolerance         = scene.accuracy.tolerance;
        progress.line(scene.general.title + "  (" + text.file_name + ")");
        if (!scene.time.steady && !scene.deforms)
          choose_time_tolerance();
        if (!scene.time.steady && scene.deforms &&
            !moves) // a linear body: from time to time at once
          classical.set({{"Time/Time step", full_precision(scene.time.end_time)}});
        // What steps in time leave may be too much; the mesh need not be made for nothing then.
        const double in_space = std::max(0.5 * tolerance, tolerance - time_error);
        refine(classical, (is_nonlocal ? share_of_elements : 1.) * in_space);
        if (!is_nonlocal)
          return;
        limit.clear();
        chosen = &nonlocal;
        refine(nonlocal, in_space);
      }

      void write(std::unique_ptr<RunFiles> files)
      {
        std::ostringstream line;
        line.precision(3);
        line << "estimated error: " << 100. * estimate() << " % (" << scene.accuracy.measure_text()
             << "), asked for " << 100. * scene.accuracy.tolerance << " %"
             << (is_met() ? "" : ": not reached " + reason_of_miss());
        progress.line(line.str());
        say_horizon();
        say_constant();
        const Json more = {{"accuracy", describe()}};
        if (more["accuracy"].contains("guaranteed"))
          progress.line(guaranteed_text(more["accuracy"]["guaranteed"], scene.accuracy.side));
        if (chosen->last().simulation->has_kept())
          return chosen->last().simulation->write(std::move(files), more, progress);
        progress.line("computing it again, with results on the way");
        const Tried<dim> last = chosen->release();
        Simulation<dim>(*last.scene, text, communicator, quiet)
          .write(std::move(files), more, progress);
      }

      std::string reason_of_miss() const
      {
        if (!limit.empty())
          return "within " + limit;
        return "by the smallest steps in time ('Tolerance' in section 'Time'), which leave about " +
               rounded_text(100. * time_error) +
               " %: something jumps in time, or linear systems are not solved well enough";
      }

      /** Of the chosen solution, all in all; negative if it is not known. */
      double estimate() const
      {
        const double space = chosen->error().error;
        if (space < 0.)
          return space;
        return time_error + space +
               (is_nonlocal && chosen == &classical ? horizon_effect + nonlocal.error().error : 0.);
      }

      bool is_met() const
      {
        const double tolerance = scene.accuracy.tolerance;
        return ((chosen == &classical && is_nonlocal) ||
                chosen->is_within(tolerance - time_error)) &&
               estimate() <= tolerance;
      }

      /** One family, until its error is within a tolerance, or what is found will do. */
      void refine(Search<dim> &family, const double tolerance)
      {
        progress.line("Models = auto: " + family.attempts().reason());
        compute(family, family.first());
        measure.refuse_forces_at_points(*family.last().simulation);
        for (;;)
          {
            next = family.next(tolerance);
            if (&family == &nonlocal && elements_will_do())
              return;
            if (family.is_within(tolerance))
              return;
            limit = limit_before(family, next);
            if (!limit.empty())
              return require_estimate(family);
            if (!compute_if_possible(family))
              return;
          }
      }

      /**
       * What the horizon changes is within the tolerance: finite elements are chosen. Where they
       * are not, @p chosen is what it was.
       */
      bool elements_will_do()
      {
        horizon_effect =
          *measure.difference(nonlocal.last().solution(), classical.last().solution());
        if (nonlocal.error().error < 0. ||
            !classical.is_within(scene.accuracy.tolerance - time_error))
          return false;
        chosen = &classical;
        if (is_met())
          return true;
        chosen = &nonlocal;
        return false;
      }

      /** So that steps in time add a small part of the tolerance, seen on the coarsest mesh. */
      void choose_time_tolerance()
      {
        constexpr double share = 0.2, finer = 0.1, finest = 1e-10;
        const auto       solution = [&](const double tolerance) {
          classical.set(settings_in_time(tolerance));
          return classical.solve(classical.first());
        };
        double             tolerance = std::min(1e-2, scene.accuracy.tolerance);
        Tried<dim>         loose     = solution(tolerance);
        std::ostringstream what;
        what.precision(2);
        what
          << "is too small for an estimate of the error, which needs some solutions: one on the coarsest mesh takes "
          << loose.wall_time << " s.";
        scene.accuracy.refuse(scene.accuracy.budget > 0. &&
                                spending.elapsed() + 2. * loose.wall_time > scene.accuracy.budget,
                              "Budget",
                              what.str());
        Tried<dim> strict     = solution(finer * tolerance);
        const auto difference = [&] {
          return *measure.difference(strict.solution(), loose.solution());
        };
        for (time_error = difference();
             time_error > share * scene.accuracy.tolerance && finer * tolerance > finest &&
             spending.may_take(2. * strict.wall_time);
             time_error = difference())
          {
            tolerance *= finer;
            loose  = std::move(strict);
            strict = solution(finer * tolerance);
          }
        for (Search<dim> *const family : {&classical, &nonlocal})
          family->set(settings_in_time(tolerance));
        classical.know_first(std::move(loose));
        progress.line("in time: Tolerance = " + number_text(tolerance) +
                      " in section 'Time', error about " + rounded_text(100. * time_error) + " %");
      }

      static std::vector<Setting> settings_in_time(const double tolerance)
      {
        return {{"Time/Stepper", "auto"},
                {"Time/Time step", "auto"},
                {"Time/Tolerance", number_text(tolerance)}};
      }

      /** What keeps one more attempt from being made, in words, or nothing. Collective. */
      std::string limit_before(const Search<dim> &family, const Attempt &attempt) const
      {
        constexpr unsigned int most = 14, most_unknown = 5;
        scene.accuracy.refuse(
          family.n_tried() >= most_unknown && family.n_compared() < 2,
          "Measure",
          "is 'stress intensity', but there is none: it needs a box with the same moduli everywhere, and "
          "room around the ends of cracks for some cells.");
        if (family.n_tried() >= most)
          return std::to_string(most) + " tries";
        if (const double order = family.hopeless_order(scene.accuracy.tolerance); order > 0.)
          return "reach: the error gets smaller as slowly as cells to the power " +
                 rounded_text(order);
        if (attempt.fineness <= family.last().attempt.fineness)
          return "the number of halvings of a mesh ('Refinements' in section 'Domain')";
        // Where cracks grow it is computed again for the results on the way.
        const double runs = family.last().simulation->has_kept() ? 1. : 2.;
        return spending.limit_of(runs * family.expected_time(attempt),
                                 family.expected_memory(attempt));
      }

      /** Throws UserError if nothing can be said of an error yet. */
      void require_estimate(const Search<dim> &family) const
      {
        if (family.error().error >= 0.)
          return;
        std::ostringstream what;
        what.precision(2);
        what << "is too small for an estimate of the error, which needs two solutions at least: ";
        if (limit == "'Memory'")
          what << "the next one would take more.";
        else
          what << "after " << spending.elapsed() << " s the next one would take some "
               << family.expected_time(next) << " s.";
        scene.accuracy.refuse(limit == "'Budget'", "Budget", what.str());
        scene.accuracy.refuse(limit == "'Memory'", "Memory", what.str());
        throw UserError("Entry 'Tolerance' in section 'Accuracy': " + limit +
                        " did not allow two solutions, which an estimate of the error needs.");
      }

      /** False where `next` fails, but something is known of the one before. Throws UserError. */
      bool compute_if_possible(Search<dim> &family)
      {
        if (family.error().error < 0.)
          compute(family, next);
        else
          try
            {
              compute(family, next);
            }
          catch (const UserError &error)
            {
              limit = "what can be solved";
              progress.line("  " + short_name(next) + " cannot be solved: " + error.message());
            }
        return limit.empty();
      }

      void compute(Search<dim> &family, const Attempt &attempt)
      {
        family.compute(attempt);
        if (family.asks_richer() &&
            spending.limit_of(family.time_of_richer(), family.memory_of_richer()).empty())
          family.ask_richer();
        const Tried<dim>  &last  = family.last();
        const double       error = family.error().error;
        std::ostringstream line;
        line.precision(3);
        line << "  " << short_name(attempt) << ": "
             << readable_count(static_cast<unsigned long long>(last.cells)) << " cells, ";
        if (error >= 0.)
          line << "estimated error " << 100. * error << " %, ";
        line << last.wall_time + last.estimate_time << " s";
        progress.line(line.str());
        history.push_back({{"model", to_string(attempt.model)},
                           {"settings", settings_of(attempt)},
                           {"estimate", error >= 0. ? Json(error) : Json()},
                           {"wall time", last.wall_time + last.estimate_time}});
      }

      void say_horizon() const
      {
        if (is_nonlocal)
          progress.line("the horizon changes the solution by about " +
                        rounded_text(100. * horizon_effect) + " %: " +
                        (chosen == &classical ? "finite elements are right within the tolerance" :
                                                "finite elements would be wrong by that"));
      }

      void say_constant()
      {
        const Tried<dim> &last = chosen->last();
        constant = measure.constant_directions(last.simulation->problem(), last.scene->cracks);
        std::string axes;
        for (const unsigned int d : constant)
          axes += std::string(axes.empty() ? "" : ", ") + "xyz"[d];
        if (!constant.empty() && constant.size() < dim)
          progress.line("the solution does not vary in " + axes + ": a scene of " +
                        std::to_string(dim - constant.size()) + " dimension" +
                        (dim - constant.size() == 1 ? "" : "s") +
                        " ('Dimension') without it gives the same for less.");
      }

      Json left() const
      {
        const bool   cracked = !scene.cracks.cracks.empty();
        const double space   = chosen->error().error;
        return {{"mesh", cracked ? 0. : space},
                {"crack", cracked ? space : 0.},
                {"horizon", chosen == &classical && is_nonlocal ? horizon_effect : 0.},
                {"zone", 0.},
                {"time", time_error},
                {"solver", scene.solver.tolerance}};
      }

      Json describe() const
      {
        const Attempt &attempt = chosen->last().attempt;
        Json           all     = {
                        {"measure", scene.accuracy.measure_text()},
                        {"tolerance", scene.accuracy.tolerance},
                        {"estimate", estimate()},
                        {"met", is_met()},
                        {"budget exhausted", limit == "'Budget'" || limit == "'Memory'"},
                        {"model", to_string(attempt.model)},
                        {"settings", settings_of(attempt)},
                        {"reason", chosen->attempts().reason()},
                        {"observed order", chosen->error().order},
                        {"left", left()},
                        {"steps", history},
                        {"next",
                         {{"settings", settings_of(next)},
                          {"estimated wall time",
                           (next.model == ModelKind::peridynamics ? nonlocal : classical).expected_time(next)}}}};
        if (is_nonlocal)
          all["horizon effect"] = horizon_effect;
        for (const auto &tell : {&guaranteed_flow<dim>, &guaranteed_energy<dim>})
          if (const Json told = tell(*chosen->last().scene, *chosen->last().simulation);
              !told.is_null())
            all["guaranteed"] = told;
        for (const unsigned int d : constant)
          all["constant along"].push_back(std::string(1, "xyz"[d]));
        return all;
      }

      const Scene<dim>         &scene;
      const SceneText          &text;
      const MPI_Comm            communicator;
      const bool                quiet;
      Progress                  progress;
      const MeasuredError<dim>  measure;
      Search<dim>               classical, nonlocal;
      Search<dim>              *chosen = &classical;
      const bool                is_nonlocal, moves;
      const Spending            spending;
      double                    time_error = 0., horizon_effect = 0.;
      Json                      history = Json::array();
      Attempt                   next;
      std::vector<unsigned int> constant; // directions
      std::string               limit;    // that ended the search, in words
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
    refuse_choice(scene);
    if (scene.accuracy.measures_growth())
      return run_growth(scene, text, communicator, mode, quiet);
    const BodyOfChoice<dim> body(scene, communicator);
    Choice<dim>(body, text, communicator, quiet).run(mode);
  }


  template <int dim>
  void describe_choice(const Scene<dim> &scene,
                       const SceneText  &text,
                       const MPI_Comm    communicator,
                       const bool        quiet)
  {
    const Progress progress(communicator, quiet);
    refuse_choice(scene);
    if (scene.accuracy.measures_growth())
      return describe_growth(scene, text, communicator, quiet);
    const bool               is_nonlocal = scene.peridynamics.horizon > 0.;
    const BodyOfChoice<dim>  body(scene, communicator);
    const Attempts<dim>      attempts(body,
                                 is_nonlocal ? LimitOfAttempts::nonlocal :
                                                    LimitOfAttempts::classical);
    const MeasuredError<dim> measure(scene);
    progress.line(scene.general.title + "  (" + text.file_name + ")");
    progress.line("Models = auto would try, until the estimated error is at most " +
                  number_text(100. * scene.accuracy.tolerance) + " %:");
    double fineness = attempts.coarsest();
    for (unsigned int k = 0; k < 5; ++k, fineness *= attempts.first_ratio())
      {
        const Attempt attempt = attempts.at(fineness);
        const auto    variant = body.given ? nullptr : scene_variant(scene, attempt.settings);
        if (!variant || !variant->domain.has_lattice())
          {
            progress.line("  " + short_name(attempt));
            continue;
          }
        const RunEstimate estimate = estimate_run(*variant, communicator);
        progress.line("  " + short_name(attempt) + ": " +
                      readable_count(static_cast<unsigned long long>(estimate.cells)) + " cells, " +
                      readable_bytes(estimate.memory));
      }
    progress.line("and finer ones where that is needed. " + attempts.reason());
    progress.line("The entries of the scene are valid. Nothing was computed.");
  }


  PERIDEAL_INSTANTIATE_FUNCTION(run_scene);
  PERIDEAL_INSTANTIATE_FUNCTION(describe_choice);
} // namespace PeriDeal
