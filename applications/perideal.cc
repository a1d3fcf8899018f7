// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/simulation/simulation.h>

#include <CLI/CLI.hpp>

#include <iostream>

namespace
{
  using namespace PeriDeal;

  template <int dim>
  void compute(const SceneText &text, const MPI_Comm communicator, const bool dry, const bool quiet)
  {
    Scene<dim> scene;
    parse_scene(text, scene);
    Simulation<dim> simulation(scene, text, communicator, quiet);
    if (dry)
      simulation.dry_run();
    else
      simulation.run();
  }


  void compute(const std::string              &file,
               const std::vector<std::string> &overrides,
               const bool                      dry,
               const bool                      quiet)
  {
    const MPI_Comm  communicator = MPI_COMM_WORLD;
    const SceneText text         = read_scene(file, overrides, communicator);
    switch (dimension_of(text))
      {
        case 1:
          return compute<1>(text, communicator, dry, quiet);
        case 2:
          return compute<2>(text, communicator, dry, quiet);
        default:
          return compute<3>(text, communicator, dry, quiet);
      }
  }


  /** What the command line asks for. */
  struct Request
  {
    std::string              scene, format = "prm";
    std::vector<std::string> overrides;
    bool                     quiet = false;
  };


  void describe_commands(CLI::App &app, Request &request)
  {
    app.set_version_flag("--version", "PeriDeal " PERIDEAL_VERSION);
    app.require_subcommand(1);
    app.footer("Parallel: mpirun -np N perideal run SCENE.prm\n"
               "Scenes with explanations are in prm/, the format is explained in doc/.");

    CLI::App *run   = app.add_subcommand("run", "Compute a scene and write its results");
    CLI::App *check = app.add_subcommand(
      "check",
      "Parse a scene, say what a run of it needs (unknowns, bonds, memory, stable steps, time), run nothing");
    for (CLI::App *command : {run, check})
      {
        command->add_option("scene", request.scene, "scene file (.prm)")->required();
        command
          ->add_option("-s,--set", request.overrides, "override an entry: \"Section/Entry=value\"")
          ->allow_extra_args(false);
        command->add_flag("-q,--quiet", request.quiet, "print errors only");
      }
    CLI::App *parameters =
      app.add_subcommand("parameters",
                         "Print every entry of a scene with type, default, unit and explanation");
    parameters->add_option("format", request.format, "prm, markdown, JSON or XML")
      ->capture_default_str();
  }


  int execute(int argc, char **argv, const bool first_rank)
  {
    CLI::App app(
      "PeriDeal solves heat conduction with peridynamics and finite elements on one mesh, from one scene file.");
    Request request;
    describe_commands(app, request);
    try
      {
        app.parse(argc, argv);
      }
    catch (const CLI::ParseError &problem)
      {
        if (!first_rank)
          return problem.get_exit_code() == 0 ? 0 : 1;
        return app.exit(problem) == 0 ? 0 : 1;
      }
    if (app.got_subcommand("parameters"))
      {
        const std::string manual = parameter_manual(request.format);
        if (first_rank)
          std::cout << manual;
      }
    else
      compute(request.scene, request.overrides, app.got_subcommand("check"), request.quiet);
    return 0;
  }


  /** One message, from rank 0 if everybody has it. */
  int report(const std::string &message, const bool first_rank)
  {
    if (first_rank)
      std::cerr << "\nperideal: error: " << message << std::endl;
    return 1;
  }
} // namespace


int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const bool first_rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  try
    {
      return execute(argc, argv, first_rank);
    }
  catch (const PeriDeal::UserError &error)
    {
      return report(error.message(), first_rank);
    }
  catch (const std::bad_alloc &)
    {
      std::cerr << "\nperideal: error: out of memory. `perideal check` tells what a scene needs."
                << std::endl;
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
  catch (const std::exception &error)
    {
      std::cerr << "\nperideal: internal error, please report it with the scene file:\n"
                << error.what() << std::endl;
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
  return 1;
}
