// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "growth_choice.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/output/tables.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>
#include <perideal/simulation/estimate.h>
#include <perideal/simulation/run_files.h>
#include <perideal/study/lattice_fit.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>

#include "goal_estimate.h"
#include "growth_lattices.h"
#include "growth_trace.h"
#include "spending.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Json = nlohmann::ordered_json;

    /** What is written, and what is said of it. */
    struct Chosen
    {
      std::vector<Setting> settings;
      ModelKind            model    = ModelKind::finite_elements;
      double               estimate = -1.;
      bool                 met      = false;
      std::string          reason;
      Json                 left, more = Json::object();
    };


    Json json_of(const std::vector<Setting> &settings)
    {
      Json all = Json::object();
      for (const auto &[entry, value] : settings)
        all[entry] = value;
      return all;
    }


    Json json_of(const std::vector<GrowingCracks::Path> &paths)
    {
      Json all = Json::array();
      for (const GrowingCracks::Path &path : paths)
        {
          all.push_back(Json::array());
          for (const Point<2> &p : path)
            all.back().push_back({p[0], p[1]});
        }
      return all;
    }


    std::string cells_of(const std::vector<Setting> &settings)
    {
      for (const std::string name : {"Domain/Cells", "Domain/Refinements"})
        for (const auto &[entry, value] : settings)
          if (entry == name && !value.empty())
            return name == "Domain/Cells" ? value : "between lines, halved " + value + " times";
      return "";
    }


    template <int dim>
    double longest_edge(const Scene<dim> &scene)
    {
      double longest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        longest = std::max(longest, scene.domain.upper[d] - scene.domain.lower[d]);
      return longest;
    }


    std::string percent(const double share)
    {
      std::ostringstream text;
      text.precision(3);
      text << 100. * share << " %";
      return text.str();
    }


    /** What all choices of bodies that break have in common. All functions are collective. */
    template <int dim>
    class GrowthSearch
    {
    public:
      GrowthSearch(const Scene<dim> &scene,
                   const SceneText  &text,
                   const MPI_Comm    communicator,
                   const bool        quiet)
        : scene(scene)
        , text(text)
        , communicator(communicator)
        , progress(communicator, quiet)
        , measure(scene)
        , spending(scene.accuracy, communicator)
        , longest(longest_edge(scene))
      {}

      virtual ~GrowthSearch() = default;

      void run(const RunMode mode)
      {
        auto           files = std::make_unique<RunFiles>(scene, text, communicator, mode);
        const Progress silent(communicator, true);
        progress.line(scene.general.title + "  (" + text.file_name + ")");
        with_orderly_end(*files, silent, [this] { search(); });
        write(std::move(files));
      }

    protected:
      virtual void search() = 0;

      bool measures_path() const
      {
        return scene.accuracy.measure == AccuracyMeasure::path;
      }

      /** One more step of the search: a line on the console, and in the summary. */
      void tell(const ModelKind             model,
                const std::vector<Setting> &settings,
                const std::string          &what,
                const double                found,
                const double                estimate,
                const double                seconds)
      {
        std::ostringstream line;
        line.precision(4);
        line << "  " << to_string(model) << ", Cells = " << cells_of(settings) << ": " << what;
        if (estimate >= 0.)
          line << ", estimated error " << percent(estimate);
        line.precision(3);
        line << ", " << seconds << " s";
        progress.line(line.str());
        history.push_back({{"model", to_string(model)},
                           {"settings", json_of(settings)},
                           {scene.accuracy.measure_text(), found},
                           {"estimate", estimate >= 0. ? Json(estimate) : Json()},
                           {"wall time", seconds}});
      }

      void refuse_without_estimate(const double estimate, const double seconds) const
      {
        if (estimate >= 0.)
          return;
        std::ostringstream what;
        what.precision(2);
        what << "is too small for an estimate of the error, which needs some solutions: after "
             << spending.elapsed() << " s the next one would take some " << seconds << " s.";
        scene.accuracy.refuse(limit == "'Budget'", "Budget", what.str());
        scene.accuracy.refuse(limit == "'Memory'", "Memory", what.str());
        throw UserError("Entry 'Tolerance' in section 'Accuracy': " + limit +
                        " did not allow the solutions that an estimate of the error needs.");
      }

      const Scene<dim>        &scene;
      const SceneText         &text;
      const MPI_Comm           communicator;
      Progress                 progress;
      const MeasuredError<dim> measure;
      const Spending           spending;
      const double             longest;
      Json                     history = Json::array();
      Chosen                   chosen;
      std::string              limit; // that ended the search, in words

    private:
      void write(std::unique_ptr<RunFiles> files)
      {
        progress.line("estimated error: " + percent(chosen.estimate) + " (" +
                      scene.accuracy.measure_text() + "), asked for " +
                      percent(scene.accuracy.tolerance) +
                      (chosen.met ? "" : ": not reached within " + limit));
        Json accuracy = {{"measure", scene.accuracy.measure_text()},
                         {"tolerance", scene.accuracy.tolerance},
                         {"estimate", chosen.estimate},
                         {"met", chosen.met},
                         {"budget exhausted", limit == "'Budget'" || limit == "'Memory'"},
                         {"model", to_string(chosen.model)},
                         {"settings", json_of(chosen.settings)},
                         {"reason", chosen.reason},
                         {"left", chosen.left},
                         {"steps", history}};
        accuracy.update(chosen.more);
        progress.line("computing it again, for the results");
        const auto variant         = scene_variant(scene, chosen.settings);
        variant->general.automatic = true;
        Simulation<dim>(*variant, text, communicator, true)
          .write(std::move(files), {{"accuracy", accuracy}}, progress);
      }
    };


    /** The limit of ever smaller horizons: whole bodies, whose cracks are followed. */
    class Griffith : public GrowthSearch<2>
    {
    public:
      Griffith(const Scene<2>  &scene,
               const SceneText &text,
               const MPI_Comm   communicator,
               const bool       quiet)
        : GrowthSearch<2>(scene, text, communicator, quiet)
        , tracer(scene, text, communicator, measure)
        , cracks(cracked_box(
            *scene_variant(scene,
                           {{"Cracks/Mesh", "removed"}, {"Cracks/Nodes on cracks", "left"}})))
      {}

    private:
      void search() override
      {
        measures_path() ? search_path() : search_strength();
      }

      /** So long that some steps lead through the body; for the strength some along the crack. */
      double first_step() const
      {
        constexpr double share    = 1. / 16.;
        double           shortest = longest, crack = longest;
        for (unsigned int d = 0; d < 2; ++d)
          shortest = std::min(shortest, scene.domain.upper[d] - scene.domain.lower[d]);
        for (const GrowingCracks::End &end : cracks.ends())
          crack = std::min(crack, cracks.last_stretch(end));
        if (measures_path())
          return on_lattice(std::min(share * longest, shortest / 6.));
        return on_lattice(std::max(0.25 * share * longest,
                                   std::min({share * longest, 0.25 * shortest, 0.25 * crack})));
      }

      /** About this, so that cracks along the axes come to lines of a coarse lattice. */
      double on_lattice(const double step) const
      {
        constexpr unsigned int most = 48;
        const CrackedBox       box  = cracked_box(scene);
        if (!along_axes(box))
          return step;
        const auto        &crack = box.cracks[0];
        const unsigned int d =
          std::abs(crack[1][0] - crack[0][0]) > std::abs(crack[1][1] - crack[0][1]) ? 0 : 1;
        for (unsigned int n = 1; n <= most; ++n)
          if (corners_on_planes(box, d, n))
            {
              const double unit = (box.upper[d] - box.lower[d]) / n;
              return step > unit ? std::round(step / unit) * unit : unit / std::round(unit / step);
            }
        return step;
      }

      void search_strength()
      {
        progress.line("Models = auto: the body without a horizon of its own is Griffith's: where "
                      "it bears most as its cracks grow");
        const GrowthTrace trace = follow(first_step(), false);
        if (trace.is_stopped)
          refuse_without_estimate(-1., trace.seconds);
        const TracedState &most  = trace.states[trace.strongest()];
        const double       steps = trace.between_states();
        tell_trace(trace);
        const std::vector<Setting> common  = tracer.settings(most.cracks, scene.time.end_time);
        const auto                 variant = tracer.body_with(most.cracks, scene.time.end_time);
        const BodyOfChoice<2>      body(*variant, communicator);
        Search<2> family(body, text, communicator, measure, LimitOfAttempts::classical);
        family.set(common);
        progress.line("Models = auto: " + family.attempts().reason());
        const double error = refine(family, most, common, scene.accuracy.tolerance - steps);
        keep(family, most, error, steps);
      }

      /** As long as the budget allows it; else `limit` says so. */
      GrowthTrace follow(const double                      step,
                         const bool                        to_end,
                         const std::optional<TracedState> &first = {})
      {
        return tracer.follow(cracks,
                             {step,
                              to_end,
                              1.,
                              [this](const double seconds) {
                                limit = spending.limit_of(seconds, 0.);
                                return limit.empty();
                              },
                              first});
      }

      void tell_trace(const GrowthTrace &trace)
      {
        const TracedState &most = trace.states[trace.strongest()];
        const double       load = most.state.load();
        std::ostringstream line;
        line.precision(3);
        line << "  " << trace.states.size() << " states of its cracks, " << trace.seconds
             << " s: it bears most ";
        if (load >= 1.)
          line << "at the end";
        else
          line << "at t = " << load * scene.time.end_time;
        if (most.cracks.grown() > 0.)
          line << ", when they have grown by " << most.cracks.grown();
        else
          line << (load >= 1. ? ", before any crack grows" :
                                ", when the first crack begins to grow");
        progress.line(line.str());
      }

      /**
       * Ever finer, until the estimate is within the tolerance; the first as the cracks were
       * followed by. Returns the estimate.
       */
      double refine(Search<2>                  &family,
                    const TracedState          &state,
                    const std::vector<Setting> &common,
                    const double                tolerance)
      {
        constexpr unsigned int most = 14, most_unknown = 5;
        Attempt                next = family.attempts().at(state.fineness);
        next.settings.insert(next.settings.end(), common.begin(), common.end());
        for (;;)
          {
            family.compute(next);
            double error = family.error().error, more = 0.;
            if (const auto cubic = by_cubic(family, more); cubic)
              error = *cubic;
            else if (family.asks_richer() &&
                     spending.limit_of(family.time_of_richer(), family.memory_of_richer()).empty())
              {
                family.ask_richer();
                error = family.error().error;
              }
            tell_strength(family.last(), error, more);
            if (family.n_compared() == 1 ? error >= 0. && error <= careful * tolerance :
                                           family.is_within(tolerance))
              return error;
            scene.accuracy.refuse(
              family.n_tried() >= most_unknown && family.n_compared() < 2,
              "Measure",
              "is 'strength', but there are no stress intensities: they need room around the ends of cracks for some cells.");
            next  = family.next(tolerance);
            limit = family.n_tried() >= most ? std::to_string(most) + " tries" :
                                               spending.limit_of(2. * family.expected_time(next),
                                                                 family.expected_memory(next));
            if (!limit.empty())
              {
                refuse_without_estimate(error, family.expected_time(next));
                return error;
              }
          }
      }

      /** What cubic elements say of the first solution, which may be good enough. */
      std::optional<double> by_cubic(const Search<2> &family, double &seconds) const
      {
        const Tried<2> &last  = family.last();
        const auto      cubic = cubic_attempt(scene, last.attempt);
        if (family.n_compared() != 1 || strength_of(last) <= 0. || !cubic ||
            family.attempts().best_order() < 2. ||
            !spending.limit_of(family.time_of_richer(), family.memory_of_richer()).empty())
          return {};
        const Tried<2> richer = family.solve(*cubic);
        seconds               = richer.wall_time;
        const auto difference = measure.difference(richer.solution(), last.solution());
        return difference ? std::optional<double>(factor_of_cubic(scene) * *difference) :
                            std::nullopt;
      }

      void tell_strength(const Tried<2> &last, const double error, const double more)
      {
        const double found = strength_of(last);
        tell(last.attempt.model,
             last.attempt.settings,
             found > 0. ? "strength " + number_text(found) : "no room around the ends of cracks",
             found,
             error,
             last.wall_time + last.estimate_time + more);
      }

      static double strength_of(const Tried<2> &one)
      {
        const auto found = one.numbers.values.find("strength");
        return found == one.numbers.values.end() ? 0. : found->second;
      }

      /** What is written: the body when it bears most. */
      void keep(const Search<2>   &family,
                const TracedState &most,
                const double       error,
                const double       steps)
      {
        const Tried<2>     &last      = family.last();
        const double        tolerance = scene.accuracy.tolerance;
        const GriffithState state =
          griffith_state(scene, last.scene->cracks, last.simulation->found()["models"]["auto"]);
        const double end = std::min(1., state.load()) * scene.time.end_time;
        chosen.settings  = last.attempt.settings;
        for (Setting &setting : chosen.settings)
          if (setting.first == "Time/End time" || setting.first == "Time/Time step")
            setting.second = full_precision(end);
        chosen.model                  = last.attempt.model;
        chosen.estimate               = error + steps;
        chosen.met                    = limit.empty() && chosen.estimate <= tolerance;
        chosen.reason                 = family.attempts().reason();
        const bool bonds              = chosen.model == ModelKind::coupled;
        chosen.left                   = {{"mesh", bonds ? 0. : error},
                                         {"zone", bonds ? error : 0.},
                                         {"trapping", 0.},
                                         {"steps", steps}};
        chosen.more["observed order"] = family.error().order;
        chosen.more["strength"]       = {{"value", state.strength()},
                                         {"time", end},
                                         {"grown", most.cracks.grown()},
                                         {"by the largest hoop stress", state.strength_by_hoop_stress()}};
      }

      void search_path()
      {
        constexpr unsigned int most      = 5;
        constexpr double       more      = 4.; // times as long with half the steps
        const double           tolerance = scene.accuracy.tolerance;
        progress.line("Models = auto: the body without a horizon of its own is Griffith's: its "
                      "cracks are followed in ever smaller steps");
        GrowthTrace                before;
        std::optional<TracedState> first;
        double                     step = first_step(), error = -1.;
        for (unsigned int n = 0;; ++n, step *= 0.5)
          {
            GrowthTrace now = follow(step, true, first);
            if (now.is_stopped)
              {
                refuse_without_estimate(error, now.seconds);
                break;
              }
            const double grew = now.grown;
            scene.accuracy.refuse(
              now.paths.empty(),
              "Measure",
              "is 'path', but no crack grows: loads are too small for its fracture energy.");
            first = now.states.front();
            // Smaller steps turn no more if none does; where cracks come to rest depends on them.
            if (n > 0)
              error = distance_of_paths(now.paths, before.paths) / longest;
            else if (now.turned <= GrowingCracks::straight && !now.rests)
              error = 2. * GrowingCracks::straight * grew / longest;
            const Attempt &attempt = now.states.back().attempt;
            tell(attempt.model,
                 attempt.settings,
                 "steps of " + number_text(step) + ", grown by " + number_text(grew),
                 grew,
                 error,
                 now.seconds);
            before = std::move(now);
            if (error >= 0. && error <= tolerance)
              break;
            limit = n + 1 == most ? std::to_string(most) + " sizes of steps" :
                                    spending.limit_of(more * before.seconds, 0.);
            if (!limit.empty())
              {
                refuse_without_estimate(error, more * before.seconds);
                break;
              }
          }
        keep(before, error);
      }

      void keep(const GrowthTrace &trace, const double error)
      {
        const TracedState &last = trace.states.back();
        chosen.settings         = last.attempt.settings;
        for (const Setting &setting : tracer.settings(last.cracks, scene.time.end_time))
          chosen.settings.push_back(setting);
        chosen.model    = last.attempt.model;
        chosen.estimate = error;
        chosen.met      = error <= scene.accuracy.tolerance;
        chosen.reason   = "Cracks grow in the direction that releases most energy: finite elements "
                          "where they run along the axes, bonds around them elsewhere.";
        chosen.left     = {{"mesh", 0.}, {"zone", 0.}, {"trapping", 0.}, {"steps", error}};
        chosen.more["path"] = {{"lines", json_of(trace.paths)}, {"step", trace.step}};
      }

      static constexpr double careful =
        0.5; // of the tolerance, after one solution and cubic elements

      const CrackTracer<2> tracer;
      const GrowingCracks  cracks;
    };


    /** Of a horizon that is a length: bonds that break, ever more of them in it. */
    template <int dim>
    class Bonds : public GrowthSearch<dim>
    {
    public:
      Bonds(const Scene<dim> &scene,
            const SceneText  &text,
            const MPI_Comm    communicator,
            const bool        quiet)
        : GrowthSearch<dim>(scene, text, communicator, quiet)
        , lattices(scene)
      {}

    private:
      using Base   = GrowthSearch<dim>;
      using Points = std::vector<std::array<double, 3>>;

      /** One run, and what it says. */
      struct Ran
      {
        Attempt attempt;
        double  strength = 0., when = 0., seconds = 0.;
        Points  points;
      };

      Ran run_on(const unsigned int m) const
      {
        using Clock      = std::chrono::steady_clock;
        const auto start = Clock::now();
        Ran        ran;
        ran.attempt                = lattices.at(m);
        const auto variant         = scene_variant(Base::scene, ran.attempt.settings);
        variant->general.automatic = true;
        Simulation<dim> simulation(*variant, Base::text, Base::communicator, true);
        simulation.solve();
        const Json model = simulation.found()["models"]["auto"];
        if (model.contains("largest force"))
          {
            ran.strength = std::abs(model["largest force"]["value"].template get<double>());
            ran.when     = model["largest force"]["time"].template get<double>();
          }
        if (Base::measures_path())
          ran.points = points_of_new_cracks(simulation.problem());
        ran.seconds =
          Utilities::MPI::max(std::chrono::duration<double>(Clock::now() - start).count(),
                              Base::communicator);
        return ran;
      }

      void search() override
      {
        static const std::vector<unsigned int> sizes = {3, 4, 5, 6, 8, 10, 12};
        Base::progress.line("Models = auto: the horizon is a length: " + reason());
        for (std::size_t k = 0;; ++k)
          {
            ran = run_on(sizes[k]);
            Base::scene.accuracy.refuse(
              !Base::measures_path() && !(ran.strength > 0.),
              "Measure",
              "is 'strength', but no side that is held or loaded bears a force.");
            add(sizes[k]);
            keep();
            const double found = Base::measures_path() ? 0. : ran.strength;
            Base::tell(ran.attempt.model,
                       ran.attempt.settings,
                       "m = " + std::to_string(sizes[k]) +
                         (Base::measures_path() ? "" : ", strength " + number_text(found)),
                       found,
                       Base::chosen.estimate,
                       ran.seconds);
            if (Base::chosen.met)
              return;
            const double next =
              k + 1 < sizes.size() ?
                2. * ran.seconds *
                  std::pow(static_cast<double>(sizes[k + 1]) / sizes[k], dim + 1.) :
                0.;
            Base::limit = k + 1 == sizes.size() ? std::to_string(sizes.size()) + " lattices" :
                                                  Base::spending.limit_of(next, 0.);
            if (!Base::limit.empty())
              return Base::refuse_without_estimate(Base::chosen.estimate, 0.5 * next);
          }
      }

      std::string reason() const
      {
        return lattices.follows() ?
                 "bonds where the body is about to break, finite elements elsewhere, with ever "
                 "more nodes in the horizon." :
                 "peridynamics, with ever more nodes in the horizon.";
      }

      void add(const unsigned int m)
      {
        strengths.push_back({lattices.spacing(m), ran.strength});
        if (!before.empty() && !ran.points.empty())
          apart.push_back(distance_of_points(ran.points, before) / Base::longest);
        before = ran.points;
      }

      /** The run on the finest lattice, and what it may be wrong by. */
      void keep()
      {
        // Load steps are divided where a bond would be stretched by more beyond its limit.
        constexpr double      divided = 0.02, share_of_step = 0.25;
        constexpr std::size_t least = 4; // lattices, whose strengths come unevenly
        Chosen               &kept  = Base::chosen;
        const double tolerance = Base::scene.accuracy.tolerance, end = Base::scene.time.end_time;
        const LatticeFit fit  = fit_of_lattices(strengths);
        double           mesh = -1., trapping = 0., steps = 0.;
        if (Base::measures_path())
          {
            const std::size_t n = apart.size();
            if (n > 0)
              mesh = n > 1 ? std::max(apart[n - 1], apart[n - 2]) : apart[0];
          }
        else if (fit.is_known)
          {
            trapping = std::abs(ran.strength - fit.limit) / ran.strength;
            mesh     = 2. * fit.uncertainty / ran.strength;
            steps = ran.when > 0. ? std::min(divided, share_of_step * tolerance * end / ran.when) :
                                    0.;
          }
        kept.settings = ran.attempt.settings;
        kept.model    = ran.attempt.model;
        kept.estimate = mesh < 0. ? -1. : mesh + trapping + steps;
        kept.met      = mesh >= 0. && kept.estimate <= tolerance && strengths.size() >= least;
        kept.reason   = "The horizon is a length: " + reason();
        kept.left     = {{"mesh", std::max(0., mesh)},
                         {"zone", 0.},
                         {"trapping", trapping},
                         {"steps", steps}};
        if (!Base::measures_path())
          kept.more["strength"] = {{"value", ran.strength},
                                   {"time", ran.when},
                                   {"limit", fit.limit}};
      }

      const GrowthLattices<dim> lattices;
      Ran                       ran;
      std::vector<OnLattice>    strengths;
      Points                    before;
      std::vector<double>       apart; // each run from the one before, over the longest edge
    };
  } // namespace


  template <int dim>
  void run_growth(const Scene<dim> &scene,
                  const SceneText  &text,
                  const MPI_Comm    communicator,
                  const RunMode     mode,
                  const bool        quiet)
  {
    if constexpr (dim == 2)
      if (!(scene.peridynamics.horizon > 0.))
        return Griffith(scene, text, communicator, quiet).run(mode);
    Bonds<dim>(scene, text, communicator, quiet).run(mode);
  }


  template <int dim>
  void describe_growth(const Scene<dim> &scene,
                       const SceneText  &text,
                       const MPI_Comm    communicator,
                       const bool        quiet)
  {
    const Progress progress(communicator, quiet);
    progress.line(scene.general.title + "  (" + text.file_name + ")");
    if (scene.peridynamics.horizon > 0.)
      {
        progress.line(
          "Models = auto would let bonds break with ever more nodes in the horizon, until the estimated error is at most " +
          percent(scene.accuracy.tolerance) + ":");
        const GrowthLattices<dim> lattices(scene);
        for (const unsigned int m : {3u, 4u, 5u, 6u, 8u})
          progress.line("  m = " + std::to_string(m) +
                        ", Cells = " + cells_of(lattices.at(m).settings));
      }
    else
      progress.line(
        "Models = auto would follow the cracks of the whole body as Griffith has it, until the estimated error is at most " +
        percent(scene.accuracy.tolerance) + ".");
    progress.line("The entries of the scene are valid. Nothing was computed.");
  }


  PERIDEAL_INSTANTIATE_FUNCTION(run_growth);
  PERIDEAL_INSTANTIATE_FUNCTION(describe_growth);
} // namespace PeriDeal
