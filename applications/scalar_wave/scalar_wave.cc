// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

/*
 * A program with a physics of its own, the scalar wave equation: it makes it known to PeriDeal and
 * then runs scene files, `Physics = wave` among the others.
 *
 *     scalar_wave SCENE.prm [--resume] [Section/Entry=value ...]
 */

#include <deal.II/base/mpi.h>

#include <perideal/base/process_end.h>
#include <perideal/base/user_error.h>
#include <perideal/output/field_writer.h>
#include <perideal/simulation/simulation.h>

#include <iostream>

#include "wave_problem.h"

namespace
{
  using namespace PeriDeal;

  /** All that PeriDeal has to be told. */
  void add_waves()
  {
    const Physics wave = add_physics(
      {"wave", "displacement", "tension", "momentum", "force", "momentum", "stiffness"});
    set_problem_factory<1>(wave, std::make_unique<ScalarWave::WaveFactory<1>>());
    set_problem_factory<2>(wave, std::make_unique<ScalarWave::WaveFactory<2>>());
    set_problem_factory<3>(wave, std::make_unique<ScalarWave::WaveFactory<3>>());
  }


  template <int dim>
  void run(const SceneText &text, const RunMode mode)
  {
    Scene<dim> scene;
    parse_scene(text, scene);
    Simulation<dim> simulation(scene, text, text.communicator, false);
    simulation.run(mode);
  }


  void execute(const std::vector<std::string> &arguments)
  {
    std::vector<std::string> overrides;
    std::string              file;
    RunMode                  mode = RunMode::overwrite;
    for (const std::string &argument : arguments)
      if (argument == "--resume")
        mode = RunMode::resume;
      else if (file.empty())
        file = argument;
      else
        overrides.push_back(argument);
    AssertThrow(!file.empty(), UserError("Which scene? scalar_wave SCENE.prm"));
    const SceneText text = read_scene(file, overrides, MPI_COMM_WORLD);
    switch (dimension_of(text))
      {
        case 1:
          return run<1>(text, mode);
        case 2:
          return run<2>(text, mode);
        default:
          return run<3>(text, mode);
      }
  }
} // namespace


int main(int argc, char **argv)
{
  prepare_mpi_environment();
  start_hdf5();
  int n_words = 1; // the others are not for the libraries: PETSc would complain of them
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_words, argv, 1);
  const bool first_rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  handle_signals(first_rank, dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1);
  const auto end = [&](const std::string &message, const ExitStatus status) {
    if (first_rank)
      std::cerr << "\nscalar_wave: " << message << std::endl;
    return static_cast<int>(status);
  };
  try
    {
      add_waves();
      execute({argv + 1, argv + argc});
      return 0;
    }
  catch (const UserError &error)
    {
      return end("error: " + error.message(), ExitStatus::error);
    }
  catch (const Stopped &stopped)
    {
      return end(stopped.what(), ExitStatus::stopped);
    }
}
