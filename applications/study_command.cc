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


    /** A study that a driver in Python plans, and its own options, as a sentence has them. */
    struct Driver
    {
      std::string              name;
      std::vector<std::string> options;
      std::string              words;
    };

    const std::vector<Driver> drivers = {
      {"work_precision",
       {"--cells", "--reference", "--budget", "--measure"},
       "--cells, --reference, --budget, --measure and --no-auto"},
      {"stability", {"--maps", "--random", "--seed"}, "--maps, --random and --seed"}};


    /** That such a study is asked of its driver. Throws UserError. */
    void refuse_drivers(const StudyRequest &request)
    {
      const std::string       &first = request.files.front();
      std::vector<std::string> names;
      for (const Driver &driver : drivers)
        {
          AssertThrow(first != driver.name,
                      UserError(first + " is a driver of this program in Python: `./run study " +
                                first + " SCENE.prm`, or `python3 -m perideal study " + first +
                                " SCENE.prm` (doc/python.md)."));
          names.push_back(driver.name);
        }
      const std::string hint = did_you_mean(first, names);
      AssertThrow(hint.empty() || std::filesystem::exists(first),
                  UserError("perideal study: there is no scene '" + first + "'." + hint));
      for (const Driver &driver : drivers)
        AssertThrow(
          request.of_drivers.count(driver.name) == 0,
          UserError(driver.words + " are for `./run study " + driver.name + " SCENE.prm`."));
    }
  } // namespace


  void compute_study(const StudyRequest &request)
  {
    refuse_drivers(request);
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
    study->add_option("files", request.files, "study file (.json), or scenes (.prm)")->required();
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
    study->add_flag("--quick", request.study.quick, "compute the rows marked \"quick\" only");
    study->add_flag("--redo", request.study.redo, "compute finished rows again");
    study
      ->add_option("--repeat",
                   request.study.repeats,
                   "run every row so often and keep the smallest times")
      ->check(CLI::Range(1u, 1000u));
    for (const Driver &driver : drivers)
      for (const std::string &name : driver.options)
        study
          ->add_option_function<std::string>(
            name,
            [&](const std::string &) { request.of_drivers.insert(driver.name); })
          ->group("");
    study->add_flag_callback("--no-auto", [&] { request.of_drivers.insert(drivers.front().name); })
      ->group("");
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
