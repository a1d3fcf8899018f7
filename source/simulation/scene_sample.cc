// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "scene_sample.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/scene.h>

#include <algorithm>
#include <cmath>

#include "model_comparison.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  double number_of(const std::array<unsigned int, dim> &cells, const unsigned int more)
  {
    double result = 1.;
    for (const unsigned int k : cells)
      result *= static_cast<double>(k) + more;
    return result;
  }


  template <int dim>
  std::array<unsigned int, dim> coarse_cells(const std::array<unsigned int, dim> &cells,
                                             const double                         nodes)
  {
    const auto divide = [&](const unsigned int q) {
      std::array<unsigned int, dim> n = cells;
      for (unsigned int &k : n)
        k = std::max(2u, (k + q / 2) / q);
      return n;
    };
    const auto ideal =
      static_cast<unsigned int>(std::ceil(std::pow(number_of<dim>(cells, 1) / nodes, 1. / dim)));
    // Not so far from the ideal that lattices of a quarter of the nodes have the same divisor.
    for (unsigned int q = std::max(2u, ideal); 2 * q < 3 * ideal; ++q)
      if (std::all_of(cells.begin(), cells.end(), [q](const unsigned int k) { return k % q == 0; }))
        return divide(q);
    return divide(std::max(2u, ideal));
  }


  template <int dim>
  std::shared_ptr<Scene<dim>> coarse_scene(const Scene<dim>                    &scene,
                                           const std::array<unsigned int, dim> &cells)
  {
    std::string text;
    double      smallest = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        text += (d > 0 ? ", " : "") + std::to_string(cells[d]);
        const double h = (scene.domain.upper[d] - scene.domain.lower[d]) / cells[d];
        smallest       = d == 0 ? h : std::min(smallest, h);
      }
    std::vector<Setting> settings{{"Domain/Node spacing", ""},
                                  {"Domain/Cells", text},
                                  {"Cracks/Nodes on cracks", "left"}, // these very cells
                                  {"Output/Probes", ""},
                                  {"Output/Line", ""},
                                  {"Output/Grid", ""}};
    if (scene.peridynamics.horizon > 0.)
      {
        const Tensor<1, dim> h   = scene.domain.spacing();
        double               own = h[0];
        for (unsigned int d = 1; d < dim; ++d)
          own = std::min(own, h[d]);
        settings.emplace_back("Peridynamics/Horizon",
                              number_text(scene.horizon() / own * smallest));
      }
    const std::shared_ptr<Scene<dim>> coarse = scene_variant(scene, settings);
    problem_factory(*coarse).require_computable(*coarse);
    return coarse;
  }


  namespace
  {
    template <int dim>
    void take_problems(const Scene<dim>                          &scene,
                       const std::shared_ptr<Triangulation<dim>> &mesh,
                       Sample                                    &sample)
    {
      ResultRecord     record;
      Progress         quiet(mesh->get_communicator(), true);
      const RunContext context{quiet, record, {}};
      Models<dim>      models;
      for (unsigned int k = 0; k < sample.models.size(); ++k)
        {
          const double start = processor_seconds();
          models.push_back(std::make_unique<Model<dim>>(scene.general.models[k], *mesh));
          models.back()->problem      = problem_factory(scene).make_problem(*models.back(), scene);
          const Problem<dim> &problem = *models.back()->problem;
          ModelEstimate      &model   = sample.models[k];
          const OperatorSize  size    = problem.op().size();
          model.unknowns              = static_cast<double>(size.unknowns);
          model.bonds                 = static_cast<double>(size.bonds);
          sample.time_to_build += processor_seconds() - start;
          model.time_of_application = time_of_application(problem.op());
        }
      for (unsigned int k = 0; k < models.size(); ++k)
        {
          models[k]->problem->take_sample(context, sample.models[k]);
          sample.models[k].components = components_written(*models[k]->problem, models.size());
        }
    }
  } // namespace


  template <int dim>
  Sample take_sample(const Scene<dim> &scene, const MPI_Comm communicator)
  {
    Sample sample;
    sample.nodes        = number_of<dim>(scene.domain.cells, 1);
    const bool   known  = forget_peak_memory();
    const double before = resident_memory();
    for (const ModelKind model : scene.general.models)
      sample.models.push_back({to_string(model)});
    std::vector<std::string>                  notes;
    const double                              start = processor_seconds();
    const std::shared_ptr<Triangulation<dim>> mesh  = build_mesh(scene, communicator, notes);
    sample.cells         = static_cast<double>(mesh->n_global_active_cells());
    sample.time_to_build = processor_seconds() - start;
    take_problems(scene, mesh, sample);
    const double own = known ? peak_memory() - before : 0.;
    sample.memory    = Utilities::MPI::sum(own, communicator);
    for (ModelEstimate &model : sample.models) // to be the same on all processes
      for (double *const time : {&model.time_of_application, &model.time_of_solution})
        *time = Utilities::MPI::max(*time, communicator);
    sample.time_to_build = Utilities::MPI::max(sample.time_to_build, communicator);
    return sample;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template double number_of<dim>(const std::array<unsigned int, dim> &, const unsigned int);       \
  template std::array<unsigned int, dim> coarse_cells<dim>(const std::array<unsigned int, dim> &,  \
                                                           const double);                          \
  template std::shared_ptr<Scene<dim>>   coarse_scene<dim>(const Scene<dim> &,                     \
                                                         const std::array<unsigned int, dim> &); \
  template Sample                        take_sample<dim>(const Scene<dim> &, const MPI_Comm);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
