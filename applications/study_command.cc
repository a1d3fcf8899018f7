// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "study_command.h"

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>

namespace PeriDeal
{
  namespace
  {
    bool is_study_file(const std::string &file)
    {
      const std::string ending = ".json";
      return file.size() > ending.size() &&
             file.compare(file.size() - ending.size(), ending.size(), ending) == 0;
    }


    // In place of a study file.
    const std::string work_precision = "work_precision", stability = "stability";


    /** The scene of `perideal study KIND SCENE.prm`. Throws UserError. */
    const std::string &scene_of_kind(const StudyRequest &request)
    {
      AssertThrow(
        request.files.size() == 2 && !is_study_file(request.files[1]),
        UserError(
          "perideal study " + request.files[0] + " needs one scene (.prm), found " +
          (request.files.size() == 1 ?
             "none" :
             join_names(std::vector<std::string>(request.files.begin() + 1, request.files.end()))) +
          "."));
      return request.files[1];
    }


    bool has_options_of_stability(const StudyRequest &request)
    {
      const StabilityOptions &options = request.stability, none;
      return !options.maps.empty() || options.n_random != none.n_random ||
             options.seed != none.seed;
    }


    void refuse_options_of_stability(const StudyRequest &request)
    {
      AssertThrow(
        !has_options_of_stability(request),
        UserError("--maps, --random and --seed are for `perideal study stability SCENE.prm`."));
    }


    void refuse_options_of_work_precision(const StudyRequest &request)
    {
      AssertThrow(
        !request.of_work_precision,
        UserError(
          "--cells, --reference, --budget, --measure and --no-auto are for `perideal study work_precision SCENE.prm`."));
    }


    /** `perideal study stability SCENE.prm`. */
    void compute_stability(const StudyRequest &request)
    {
      StabilityOptions options = request.stability;
      options.scene            = scene_of_kind(request);
      AssertThrow(
        request.variations.empty(),
        UserError("--vary is not for stability, whose maps say what they vary; --maps chooses "
                  "them."));
      AssertThrow(request.study.only.empty() && !request.study.redo && request.study.repeats == 1,
                  UserError("--only, --redo and --repeat are not for stability, which has no rows; "
                            "--maps chooses maps."));
      refuse_options_of_work_precision(request);
      options.overrides = request.overrides;
      options.output    = request.output;
      options.quick     = request.study.quick;
      options.quiet     = request.quiet;
      run_stability(options, MPI_COMM_WORLD);
    }
  } // namespace


  void compute_study(const StudyRequest &request)
  {
    AssertThrow(request.files.front() != work_precision,
                UserError("work_precision is a driver of this program in Python: `./run study "
                          "work_precision SCENE.prm`, or `python3 -m perideal study work_precision "
                          "SCENE.prm` (doc/python.md)."));
    if (request.files.front() == stability)
      return compute_stability(request);
    const std::string &first = request.files.front();
    const std::string  hint  = did_you_mean(first, {work_precision, stability});
    AssertThrow(hint.empty() || std::filesystem::exists(first),
                UserError("perideal study: there is no scene '" + first + "'." + hint));
    refuse_options_of_work_precision(request);
    refuse_options_of_stability(request);
    const MPI_Comm communicator = MPI_COMM_WORLD;
    Study          study;
    if (std::any_of(request.files.begin(), request.files.end(), is_study_file))
      {
        AssertThrow(request.files.size() == 1,
                    UserError("A study is one file (.json), or one or more scenes (.prm); found " +
                              join_names(request.files) + "."));
        AssertThrow(request.variations.empty(),
                    UserError("--vary is for scenes; in the study file '" + request.files[0] +
                              "' a row says \"vary\"."));
        study = read_study(request.files[0], communicator);
      }
    else
      {
        std::vector<Variation> variations;
        for (const std::string &text : request.variations)
          variations.push_back(parse_variation(text));
        study = sweep_of_scenes(request.files, variations, communicator);
      }
    override_rows(study, request.overrides);
    if (!request.output.empty())
      study.output = request.output;
    StudyOptions options = request.study;
    options.quiet        = request.quiet;
    run_study(study, options, communicator);
  }


  void describe_study(CLI::App &app, StudyRequest &request)
  {
    CLI::App *study = app.add_subcommand(
      "study",
      "Compute many runs: the rows of a study file (.json), or all combinations of what --vary names; "
      "finished rows are kept, so an interrupted study goes on where it was");
    study
      ->add_option(
        "files",
        request.files,
        "study file (.json), or scenes (.prm), or: stability SCENE.prm, which maps where the scene "
        "is computed well and where not")
      ->required();
    study
      ->add_option(
        "--vary",
        request.variations,
        "vary an entry of the scenes: \"Section/Entry=value | value | value\"; may be given "
        "several times, the first varies slowest")
      ->allow_extra_args(false);
    study
      ->add_option(
        "-s,--set",
        request.overrides,
        "override an entry in all rows: \"Section/Entry=value\"; may be given several times")
      ->allow_extra_args(false);
    study->add_option("--output", request.output, "directory of the results");
    study->add_option("--only",
                      request.study.only,
                      "compute the rows or groups of these names only");
    study->add_flag("--quick",
                    request.study.quick,
                    "compute the rows marked \"quick\" only; stability: few points of each map");
    study->add_flag("--redo", request.study.redo, "compute finished rows again");
    study
      ->add_option("--repeat",
                   request.study.repeats,
                   "run every row so often and keep the smallest times")
      ->check(CLI::Range(1u, 1000u));
    for (const char *const name : {"--cells", "--reference", "--budget", "--measure"})
      study
        ->add_option_function<std::string>(
          name,
          [&](const std::string &) { request.of_work_precision = true; })
        ->group("");
    study->add_flag("--no-auto", request.of_work_precision)->group("");
    study->add_option(
      "--maps",
      request.stability.maps,
      "stability: the maps wanted, with commas between them: \"step limit, growth\"");
    study
      ->add_option("--random",
                   request.stability.n_random,
                   "stability: so many random points inside each safe region, and outside")
      ->check(CLI::Range(0u, 10000u));
    study->add_option("--seed", request.stability.seed, "stability: of the random points (1)");
    study->add_flag("-q,--quiet", request.quiet, "print nothing but errors");
  }


  std::vector<std::string> names_of_study_options()
  {
    return {"--vary",
            "--output",
            "--only",
            "--quick",
            "--redo",
            "--repeat",
            "--cells",
            "--reference",
            "--budget",
            "--measure",
            "--no-auto",
            "--maps",
            "--random",
            "--seed"};
  }
} // namespace PeriDeal
