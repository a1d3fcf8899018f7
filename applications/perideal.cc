// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/command_line.h>
#include <perideal/base/process_end.h>
#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/output/field_writer.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/msh_file.h>
#include <perideal/simulation/estimate.h>
#include <perideal/simulation/simulation.h>
#include <perideal/study/model_choice.h>
#include <perideal/study/model_questions.h>
#include <perideal/study/scene_facts.h>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <iostream>

#include "mesh_command.h"
#include "serve_command.h"
#include "study_command.h"

namespace
{
  using namespace PeriDeal;

  /** What `perideal check` says of a scene that is not built. */
  template <int dim>
  void print_estimate(const Scene<dim> &scene, const MPI_Comm communicator, const bool quiet)
  {
    const Progress progress(communicator, quiet);
    progress.line(scene.general.title);
    for (const std::string &line :
         describe_estimate(estimate_run(scene, communicator), communicator))
      progress.line(line);
    for (const std::string &note : scene.domain.notes)
      progress.note(note);
    progress.line("The entries of the scene are valid. Nothing was computed.");
  }


  /** What the mesh of a scene has, if it is from a file. Collective. */
  template <int dim>
  void print_mesh(const Scene<dim> &scene, const MPI_Comm communicator, const bool quiet)
  {
    const std::string &file = scene.domain.files.mesh;
    if (quiet || file.empty() || dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
      return;
    const Progress progress(communicator, quiet);
    for (const std::string &line :
         describe_msh(*read_msh(file, scene.domain.files.folder, dim), file))
      progress.line(line);
  }


  /** What is asked of a scene. */
  enum class Action
  {
    run,
    check,
    estimate,
    facts
  };


  template <int dim>
  void compute(const SceneText &text,
               const MPI_Comm   communicator,
               const Action     action,
               const RunMode    mode,
               const bool       quiet)
  {
    Scene<dim> scene;
    parse_computable(text, scene);
    if (action == Action::run)
      return run_scene(scene, text, communicator, mode, quiet);
    if (action == Action::facts)
      {
        if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
          std::cout << scene_facts(scene);
        return;
      }
    print_mesh(scene, communicator, quiet);
    if (scene.general.automatic)
      return describe_choice(scene, text, communicator, quiet);
    if (action == Action::estimate || is_large(scene, communicator))
      return print_estimate(scene, communicator, quiet);
    Simulation<dim>(scene, text, communicator, quiet).dry_run();
  }


  void compute(const std::string              &file,
               const std::vector<std::string> &overrides,
               const Action                    action,
               const RunMode                   mode,
               const bool                      quiet)
  {
    const MPI_Comm  communicator = MPI_COMM_WORLD;
    const SceneText text         = read_scene(file, overrides, communicator);
    switch (dimension_of(text))
      {
        case 1:
          return compute<1>(text, communicator, action, mode, quiet);
        case 2:
          return compute<2>(text, communicator, action, mode, quiet);
        default:
          return compute<3>(text, communicator, action, mode, quiet);
      }
  }


  /** What the command line asks for. */
  struct Request
  {
    std::string              scene, format = "prm", question;
    std::vector<std::string> overrides;
    bool quiet = false, estimate = false, facts = false, resume = false, overwrite = false;

    StudyRequest study;
    MeshRequest  mesh;
  };


  void describe_serve(CLI::App &app)
  {
    app.add_subcommand(
      "serve",
      "Execute commands that lines of standard input give as JSON, {\"arguments\": [\"run\", \"scene.prm\"]}, and answer each "
      "with a line, {\"status\": 0, \"message\": \"\"}: many runs for one start (doc/python.md)");
  }


  void describe_commands(CLI::App &app, Request &request)
  {
    app.set_version_flag("--version", "PeriDeal " PERIDEAL_VERSION);
    app.require_subcommand(1);
    app.footer(
      "Examples:\n"
      "  perideal run prm/quick_start.prm\n"
      "  perideal run prm/quick_start.prm -s \"Domain/Cells=120, 120\" -s \"Time/Stepper=rkc2\"\n"
      "  mpirun -np 4 perideal run prm/quick_start.prm\n"
      "  perideal mesh part.inp part.msh\n"
      "  perideal study prm/studies/delta_convergence.json\n"
      "  perideal study prm/quick_start.prm --vary \"Domain/Cells=30, 30 | 60, 60\" --vary \"Peridynamics/Horizon ratio=2 | 3\"\n"
      "  perideal parameters \"Horizon ratio\"\n"
      "  perideal parameters markdown\n"
      "Scenes to start from are in prm/; the format is explained in doc/scene_format.md, that of studies in doc/study.md.");

    CLI::App *run =
      app.add_subcommand("run",
                         "Compute a scene and write its results into its 'Output directory'");
    CLI::App *check = app.add_subcommand(
      "check",
      "Parse a scene and say what a run of it needs: unknowns, bonds, memory, stable steps, time. Computes nothing");
    for (CLI::App *command : {run, check})
      {
        command->add_option("scene", request.scene, "scene file (.prm)")->required();
        command
          ->add_option(
            "-s,--set",
            request.overrides,
            "override an entry: \"Section/Entry=value\", outside all sections \"Entry=value\"; may be given several times")
          ->allow_extra_args(false);
        command->add_flag("-q,--quiet", request.quiet, "print nothing but errors");
      }
    CLI::Option *resume = run->add_flag(
      "--resume",
      request.resume,
      "go on with the run in the output directory, from its newest checkpoint; its end time, output, processes and solver tolerance may be others");
    run
      ->add_flag("--overwrite",
                 request.overwrite,
                 "begin anew where a run lies that could be resumed, and replace its results")
      ->excludes(resume);
    check->add_flag(
      "--estimate",
      request.estimate,
      "build two coarse lattices in place of the scene and estimate from them; scenes of more than some 500,000 unknowns are always estimated");
    check->add_flag("--json",
                    request.facts,
                    "print what the scene is as JSON, for programs; nothing is built");
    check->add_option("--ask",
                      request.question,
                      "answer a question about the first model, for programs (doc/python.md)");
    describe_study(app, request.study);
    describe_mesh(app, request.mesh);
    describe_serve(app);
    CLI::App *parameters = app.add_subcommand(
      "parameters",
      "Print every entry of a scene file with type, default, unit and explanation, or explain one entry or section");
    parameters
      ->add_option(
        "what",
        request.format,
        "the name of an entry (Cells), of a section (Domain), both (\"Domain/Cells\"), or a format of the whole manual: prm, markdown, JSON or XML")
      ->capture_default_str();
  }


  /** A word that is no command, or no command at all. Throws UserError. */
  void require_command(const int argc, char **argv)
  {
    const std::vector<std::string> commands =
      {"run", "check", "study", "mesh", "parameters", "serve"};
    const std::string help =
      " Commands: " + join_names(commands) + ". `perideal --help` explains them.";
    AssertThrow(argc > 1, UserError("A command is missing." + help));
    const std::string word = argv[1];
    if (word.empty() || word[0] != '-')
      AssertThrow(
        std::find(commands.begin(), commands.end(), word) != commands.end(),
        UserError("Unknown command '" + word + "'." + did_you_mean(word, commands) + help));
  }


  /** What CLI11 has to say about the arguments, with the nearest option and where to read on. */
  std::string explain(const CLI::ParseError &problem, const CLI::App &app)
  {
    std::string              message = problem.what();
    std::vector<std::string> options = {"--set", "--quiet", "--help", "--version"};
    if (app.got_subcommand("run"))
      options.insert(options.end(), {"--resume", "--overwrite"});
    if (app.got_subcommand("study"))
      {
        const std::vector<std::string> own = names_of_study_options();
        options.insert(options.end(), own.begin(), own.end());
      }
    const std::vector<std::string> remaining = app.remaining(true);
    if (!remaining.empty() && remaining.front().compare(0, 2, "--") == 0)
      message +=
        "." + did_you_mean(remaining.front().substr(0, remaining.front().find('=')), options);
    return message + (message.back() == '.' || message.back() == '?' ? "" : ".") +
           " `perideal --help` and `perideal " + (app.got_subcommand("study") ? "study" : "run") +
           " --help` explain the arguments.";
  }


  void execute(int argc, char **argv, const bool first_rank)
  {
    CLI::App app(
      "PeriDeal solves diffusion, elasticity and fracture with peridynamics and with finite elements on one mesh, from one "
      "scene file (.prm), and compares the two.");
    Request request;
    describe_commands(app, request);
    require_command(argc, argv);
    try
      {
        app.parse(argc, argv);
      }
    catch (const CLI::ParseError &problem)
      {
        AssertThrow(problem.get_exit_code() == 0, UserError(explain(problem, app)));
        if (first_rank)
          app.exit(problem); // --help or --version
        return;
      }
    AssertThrow(!app.got_subcommand("serve"), // main() has not come here
                UserError("serve: a command of a server cannot be a server."));
    if (app.got_subcommand("parameters"))
      {
        const std::string manual = parameter_manual(request.format);
        if (first_rank)
          std::cout << manual;
      }
    else if (app.got_subcommand("study"))
      compute_study(request.study);
    else if (app.got_subcommand("mesh"))
      convert_mesh(request.mesh);
    else if (!request.question.empty())
      {
        const std::string answer =
          answer_about_model(read_scene(request.scene, request.overrides, MPI_COMM_WORLD),
                             request.question);
        if (first_rank)
          std::cout << answer;
      }
    else
      compute(request.scene,
              request.overrides,
              request.facts               ? Action::facts :
              request.estimate            ? Action::estimate :
              app.got_subcommand("check") ? Action::check :
                                            Action::run,
              request.resume    ? RunMode::resume :
              request.overwrite ? RunMode::overwrite :
                                  RunMode::begin,
              request.quiet);
  }


  /** Do what the words ask for. */
  Ending perform(const std::vector<std::string> &words, const bool first_rank)
  {
    std::vector<char *> argv;
    for (const std::string &word : words)
      argv.push_back(const_cast<char *>(word.c_str()));
    const int  argc  = static_cast<int>(argv.size());
    const auto fault = [](const std::string &what) {
      return Ending{ExitStatus::fault,
                    "internal error, please report it with the scene file:\n" + what};
    };
    try
      {
        with_memory_errors([&] { execute(argc, argv.data(), first_rank); });
        return {};
      }
    catch (const UserError &error)
      {
        return {ExitStatus::error, "error: " + error.message()};
      }
    catch (const Stopped &stopped)
      {
        const unsigned int n_proc = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
        return {ExitStatus::stopped,
                std::string(stopped.what()) +
                  "\nTo go on:  " + command_that_resumes(argc, argv.data(), n_proc)};
      }
    catch (const std::exception &error)
      {
        return fault(error.what());
      }
    catch (...) // Trilinos throws numbers
      {
        return fault("an exception without a text");
      }
  }


  /**
   * Say how it has ended: one message, from rank 0 if everybody has it. The others must not wait
   * forever for a process that failed alone.
   */
  void report(const Ending &ending, const bool first_rank)
  {
    if (ending.status == ExitStatus::complete)
      return;
    const bool all = all_processes_arrive(MPI_COMM_WORLD);
    if (first_rank || !all)
      std::cerr << "\nperideal: " << ending.message << std::endl;
    if (all)
      return;
    std::signal(SIGTERM, SIG_DFL);
    PMPI_Abort(MPI_COMM_WORLD, static_cast<int>(ending.status));
  }
} // namespace


/**
 * Trilinos and p4est end the program this way, above all where memory runs out; MPI leaves its
 * names to programs that want to know of it.
 */
extern "C" int MPI_Abort(MPI_Comm communicator, int)
{
  const int status = PeriDeal::leave_after_abort();
  int       n_proc = 1;
  PMPI_Comm_size(MPI_COMM_WORLD, &n_proc);
  if (n_proc == 1)
    _exit(status); // without Open MPI's words
  return PMPI_Abort(communicator, status);
}


/**
 * While it lives, exit() is not ours: parts of Trilinos call it without a word where memory runs
 * out.
 */
struct ExitGuard
{
  ExitGuard()
  {
    alive() = true;
    std::atexit([] {
      if (alive())
        _exit(PeriDeal::leave_after_abort());
    });
  }

  ~ExitGuard()
  {
    alive() = false;
  }

  static bool &alive()
  {
    static bool value = false;
    return value;
  }
};


int main(int argc, char **argv)
{
  using namespace PeriDeal;
  prepare_mpi_environment();
  start_hdf5();
  int n_words = 1; // the others are not for the libraries: PETSc would complain of them
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_words, argv, 1);
  const bool first_rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  handle_signals(first_rank, dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1);
  const ExitGuard guard;

  std::vector<std::string> words(argv, argv + argc);
  const auto               perform_and_report = [&](const std::vector<std::string> &all) {
    const Ending ending = perform(all, first_rank);
    report(ending, first_rank);
    return ending;
  };
  if (words.size() == 2 && words[1] == "serve")
    return static_cast<int>(serve([&](std::vector<std::string> arguments) {
      arguments.insert(arguments.begin(), words[0]);
      return perform_and_report(arguments);
    }));
  const Ending ending = perform_and_report(words);
  if (ending.status != ExitStatus::complete)
    std::signal(SIGTERM, SIG_DFL); // mpirun ends those who are left, which need not be said
  return static_cast<int>(ending.status);
}
