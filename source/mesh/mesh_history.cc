// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/mesh_history.h>

#include <set>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void MeshHistory::record(const Triangulation<dim> &mesh)
  {
    std::string refined, coarsened, all;
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          if (cell->refine_flag_set())
            refined += cell->id().to_string() + " ";
          if (cell->coarsen_flag_set())
            coarsened += cell->id().to_string() + " ";
        }
    for (const std::string &part : Utilities::MPI::all_gather(mesh.get_communicator(), refined))
      all += part;
    all += "; ";
    for (const std::string &part : Utilities::MPI::all_gather(mesh.get_communicator(), coarsened))
      all += part;
    marks.push_back(all);
  }


  template <int dim>
  void MeshHistory::repeat(Triangulation<dim> &mesh) const
  {
    for (const std::string &of_one : marks)
      {
        std::set<std::string> refined, coarsened, *list = &refined;
        std::istringstream    words(of_one);
        for (std::string word; words >> word;)
          if (word == ";")
            list = &coarsened;
          else
            list->insert(word);
        for (const auto &cell : mesh.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              const std::string id = cell->id().to_string();
              if (refined.count(id) > 0)
                cell->set_refine_flag();
              if (coarsened.count(id) > 0)
                cell->set_coarsen_flag();
            }
        mesh.execute_coarsening_and_refinement();
      }
  }


  void MeshHistory::exchange(Archive &archive)
  {
    unsigned int n = marks.size();
    archive.exchange("adaptations", n);
    marks.resize(n);
    for (unsigned int k = 0; k < n; ++k)
      archive.exchange("marks " + std::to_string(k), marks[k]);
  }


#define PERIDEAL_TEMPLATES(dim)                                  \
  template void MeshHistory::record(const Triangulation<dim> &); \
  template void MeshHistory::repeat(Triangulation<dim> &) const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
