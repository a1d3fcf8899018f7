// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/output/result_folder.h>
#include <perideal/scene/lists.h>
#include <perideal/study/stability.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "stability_map.h"
#include "stability_scene.h"
#include "stability_tables.h"
#include "study_rows.h"

namespace PeriDeal
{
  namespace
  {
    /** The maps of --maps, or all. Throws UserError. */
    std::vector<StabilityMapKind> wanted_maps(const std::string &text)
    {
      const std::vector<StabilityMapKind> &all = stability_maps();
      if (text.empty())
        return all;
      std::vector<std::string> known;
      for (const StabilityMapKind &kind : all)
        known.push_back(kind.name);
      std::vector<StabilityMapKind> list;
      for (const std::string &name : split_list(text, ','))
        {
          const auto found = std::find(known.begin(), known.end(), name);
          AssertThrow(found != known.end(),
                      UserError("--maps names '" + name + "', which is no map." +
                                did_you_mean(name, known) + " Known: " + join_names(known) + "."));
          list.push_back(all[found - known.begin()]);
        }
      AssertThrow(!list.empty(), UserError("--maps names none. Known: " + join_names(known) + "."));
      return list;
    }


    /** Points that lie anywhere in and outside of the safe region. Collective. */
    void take_random_points(StabilityMap           &map,
                            const StabilityOptions &options,
                            StabilityResult        &result)
    {
      std::mt19937 random(options.seed);
      for (const bool inside : {true, false})
        for (unsigned int k = 0; k < options.n_random; ++k)
          {
            std::optional<StabilityPoint> point;
            // What a scene cannot have, for instance a horizon wider than the body, is no point.
            for (unsigned int n_trials = 0; n_trials < 20 && !point; ++n_trials)
              try
                {
                  point = map.random_point(inside, random);
                }
              catch (const UserError &error)
                {
                  result.left_out.push_back("random point: " + mistake_in_overrides(error));
                }
            if (point)
              result.random.push_back({inside, *point});
          }
    }


    /** Collective. */
    StabilityResult compute(const StabilityMapKind &kind,
                            const StabilityScene   &scene,
                            const StabilityOptions &options)
    {
      const auto      map = kind.make(scene);
      StabilityResult result;
      result.name      = kind.name;
      result.predicted = map->meaning_of_predicted();
      result.observed  = map->meaning_of_observed();
      result.bound     = map->bound();
      result.obstacle  = map->obstacle();
      if (!result.obstacle.empty())
        return result;
      const auto start = std::chrono::steady_clock::now();
      result.points    = map->points(options.quick);
      result.left_out  = map->left_out;
      take_random_points(*map, options, result);
      std::vector<std::string> &left_out = result.left_out; // each reason once
      std::sort(left_out.begin(), left_out.end());
      left_out.erase(std::unique(left_out.begin(), left_out.end()), left_out.end());
      result.wall_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      return result;
    }


    /** Collective. */
    void make_folder(const std::string &folder, const MPI_Comm communicator)
    {
      std::string message;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        {
          std::error_code error;
          std::filesystem::create_directories(folder, error);
          if (error)
            message = "--output: cannot use '" + folder + "': " + error.message() +
                      ". Choose a directory that you may write to.";
        }
      throw_on_all_if_any(communicator, message);
    }


    /** On rank 0; an error becomes everybody's. Collective. */
    void write_results(const std::string                  &folder,
                       const std::string                  &scene,
                       const StabilityFacts               &facts,
                       const StabilityOptions             &options,
                       const std::vector<StabilityResult> &results,
                       const MPI_Comm                      communicator)
    {
      std::string message;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            write_file(folder + "/stability.csv", stability_csv(results));
            write_file(folder + "/stability.json", stability_json(scene, facts, options, results));
          }
        catch (const UserError &error)
          {
            message = error.message();
          }
      throw_on_all_if_any(communicator, message);
    }


    /** That what was wanted can be had. */
    void require_a_map(const std::vector<StabilityResult> &results)
    {
      std::string reasons;
      for (const StabilityResult &result : results)
        {
          if (result.obstacle.empty())
            return;
          reasons += "\n  " + result.name + ": " + result.obstacle;
        }
      AssertThrow(false, UserError("The scene has none of the maps of stability:" + reasons));
    }


    /** That each map has points: one without says nothing. */
    void require_points(const std::vector<StabilityResult> &results)
    {
      std::string reasons;
      for (const StabilityResult &result : results)
        if (result.obstacle.empty() && result.points.empty())
          reasons +=
            "\n  " + result.name + (result.left_out.empty() ? "" : ": " + result.left_out.front());
      AssertThrow(reasons.empty(),
                  UserError("No point of these maps could be computed:" + reasons));
    }
  } // namespace


  const std::vector<StabilityMapKind> &stability_maps()
  {
    static const std::vector<StabilityMapKind> list = {{"step limit", make_step_limit_map},
                                                       {"growth", make_growth_map},
                                                       {"error", make_conduction_map},
                                                       {"surface error", make_surface_map},
                                                       {"lowest eigenvalue", make_eigenvalue_map},
                                                       {"iterations", make_iterations_map},
                                                       {"heat lost by splice", make_heat_map}};
    return list;
  }


  void run_stability(const StabilityOptions &options, const MPI_Comm communicator)
  {
    const auto           wanted = wanted_maps(options.maps);
    const Study          study  = sweep_of_scenes({options.scene}, {}, communicator);
    const std::string    file   = study.rows.front().scene;
    const std::string    folder = options.output.empty() ? study.output + "_stability" :
                                                           options.output;
    const StabilityScene scene(file, options.overrides, folder, communicator);
    const auto           say = [&](const std::string &text) {
      print_line(communicator, options.quiet, text);
    };
    say(scene.facts.title + ": stability" +
        (scene.facts.coarse == scene.facts.cells ?
           std::string() :
           ", on a lattice of " + lattice_name(scene.facts.coarse) + " cells"));
    make_folder(folder, communicator);
    std::vector<StabilityResult> results;
    for (const StabilityMapKind &kind : wanted)
      {
        results.push_back(compute(kind, scene, options));
        for (const std::string &line : describe(results.back()))
          say(line);
        if (results.back().obstacle.empty())
          write_results(folder, file, scene.facts, options, results, communicator);
      }
    require_a_map(results);
    write_results(folder, file, scene.facts, options, results, communicator);
    say("Results: " + folder);
    require_points(results);
  }
} // namespace PeriDeal
