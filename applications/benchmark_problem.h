// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/fe/fe_q.h>

#include <perideal/mesh/mesh_builder.h>
#include <perideal/operators/diffusion/extended_bond_term.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <sstream>

#if defined(__GLIBC__)
#  include <malloc.h>
#endif
#include <unistd.h>

namespace PeriDeal
{
  inline double seconds_since(const std::chrono::steady_clock::time_point start)
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }


  /**
   * Processor time of this process, which other work on the machine lengthens less than the time
   * that passes.
   */
  inline double processor_seconds()
  {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }


  /** Resident memory of this process in bytes. */
  inline double resident_memory()
  {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
    std::ifstream file("/proc/self/statm");
    double        all = 0., resident = 0.;
    file >> all >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
  }


  template <int dim>
  std::string scene_text(const unsigned int n_cells, const double m, const std::string &form)
  {
    std::ostringstream text;
    const char        *corner[3] = {"1", "1,1", "1,1,1"}, *origin[3] = {"0", "0,0", "0,0,0"};
    text << "set Dimension = " << dim << "\nset Models = peridynamics\nsubsection Domain\n"
         << "set Lower corner = " << origin[dim - 1] << "\nset Upper corner = " << corner[dim - 1]
         << "\nset Cells = " << n_cells;
    for (int d = 1; d < dim; ++d)
      text << ", " << n_cells;
    text << "\nend\nsubsection Material\nset Conductivity = 1.14\nend\n"
         << "subsection Initial and source\nset Initial value = 40\nend\n"
         << "subsection Boundary conditions\nset Dirichlet = left: 0; right: 0"
         << (dim > 1 ? "; bottom: 0; top: 0" : "") << (dim > 2 ? "; back: 0; front: 0" : "")
         << "\nend\nsubsection Peridynamics\nset Horizon ratio = " << m
         << "\nset Operator form = " << form << "\nend\n";
    return text.str();
  }


  /** A square or cube, hot at first, with cold sides. */
  template <int dim>
  struct Problem
  {
    Problem(const unsigned int n_cells,
            const double       m,
            const std::string &form,
            const double       size = 1.)
    {
      SceneText text{"benchmark", scene_text<dim>(n_cells, m, form)};
      parse_scene(text, scene);
      for (unsigned int d = 0; d < dim; ++d)
        scene.domain.upper[d] = size;
      memory_before = resident_memory();
      std::vector<std::string> notes;
      mesh        = build_mesh(scene, MPI_COMM_WORLD, notes);
      memory_mesh = resident_memory();
      handler     = std::make_unique<dealii::DoFHandler<dim>>(*mesh);
      handler->distribute_dofs(dealii::FE_Q<dim>(1));
      number_along_lattice(*handler, scene.domain);
      memory_handler = resident_memory();
      nodes          = std::make_unique<Nodes<dim>>(*handler,
                                           scene.domain,
                                           scene.cracks,
                                           scene.peridynamics.sampling.nodal_volume);
      bonds          = field_of_bonds(*nodes, scene);
    }

    Vector initial_value() const
    {
      Vector u;
      bonds->initialize_vector(u);
      u = 40.;
      bonds->distribute(u, 0.);
      return u;
    }

    double n_bonds() const // seen from both ends: one multiply-add each
    {
      return 2. * static_cast<double>(bonds->size().bonds);
    }

    Scene<dim>                                  scene;
    std::unique_ptr<dealii::Triangulation<dim>> mesh;
    std::unique_ptr<dealii::DoFHandler<dim>>    handler;
    std::unique_ptr<Nodes<dim>>                 nodes;
    std::unique_ptr<FieldOperator<dim>>         bonds;
    double                                      memory_before, memory_mesh, memory_handler;
  };
} // namespace PeriDeal
