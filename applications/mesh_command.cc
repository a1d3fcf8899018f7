// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "mesh_command.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/msh_file.h>

#include <CLI/CLI.hpp>

#include <fstream>

namespace PeriDeal
{
  void describe_mesh(CLI::App &app, MeshRequest &request)
  {
    CLI::App *const mesh = app.add_subcommand(
      "mesh",
      "Read a mesh file of any format, check and divide it as a run would, say what it has, and write it as a Gmsh file");
    mesh->add_option("file", request.file, "mesh file (.msh, .inp, .e, .unv, .vtu, ...)")
      ->required();
    mesh->add_option("out", request.out, "Gmsh file (.msh) to write: quadrilaterals or hexahedra");
    mesh->add_option("--dimension", request.dimension, "of its cells (the highest it has)")
      ->check(CLI::Range(1, 3));
    mesh->add_flag("-q,--quiet", request.quiet, "print nothing but errors");
  }


  void convert_mesh(const MeshRequest &request)
  {
    const MPI_Comm communicator = MPI_COMM_WORLD;
    const Progress progress(communicator, request.quiet);
    std::string    message;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          const auto mesh = read_msh(request.file, "", request.dimension);
          for (const std::string &line : describe_msh(*mesh, request.file))
            progress.line(line);
          for (const std::string &note : mesh->notes)
            progress.note(note);
          if (!request.out.empty())
            {
              std::ofstream out(request.out);
              out << text_of_msh(*mesh, mesh->dim);
              out.close();
              AssertThrow(out,
                          UserError("'" + request.out +
                                    "' cannot be written: is the disk full, or "
                                    "is there no such folder?"));
              progress.line("Written: " + request.out);
            }
        }
      catch (const UserError &error)
        {
          message = error.message();
        }
    throw_on_all_if_any(communicator, message);
  }
} // namespace PeriDeal
