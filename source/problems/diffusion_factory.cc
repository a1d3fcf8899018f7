// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/diffusion/bond_operator.h>
#include <perideal/operators/diffusion/fem_operator.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/linear_solver.h>

#include <algorithm>

#include "crack_note.h"
#include "diffusion_notes.h"
#include "physics_factories.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void require_diffusion(const Scene<dim> &scene)
  {
    for (const ModelKind model : scene.general.models)
      if (model == ModelKind::peridynamics)
        BondOperator<dim>::require(scene);
      else
        FEMOperator<dim>::require(scene, model == ModelKind::coupled);
    if (scene.time.steady)
      require_steady_state(scene);
  }


  /** Of cracks that grow, and entries that have no effect. */
  template <int dim>
  void note_diffusion(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    note_growth(scene, notes);
    const auto &transfers = scene.boundary_conditions.transfers;
    if (!scene.peridynamics.natural_fluxes() &&
        std::all_of(transfers.begin(), transfers.end(), [](const SurfaceTransfer &transfer) {
          return transfer.fixes_level();
        }))
      notes.push_back(
        "'Flux treatment' in section 'Peridynamics' has no effect: no side is named in 'Flux' (an insulated side "
        "needs 'side: 0' there).");
  }


  namespace
  {
    template <int dim>
    class DiffusionFactory : public ProblemFactory<dim>
    {
    public:
      void require_computable(const Scene<dim> &scene) const override
      {
        require_diffusion(scene);
      }

      void note_scene(const Scene<dim>         &scene,
                      const Triangulation<dim> &mesh,
                      std::vector<std::string> &notes) const override
      {
        note_missing_crack_scaling(scene, notes);
        note_diffusion(scene, notes);
        note_transmission(scene, notes);
        note_smooth_field(scene, notes);
        note_unseen_source(scene, mesh, notes);
      }

      std::unique_ptr<Problem<dim>> make_problem(Model<dim>       &model,
                                                 const Scene<dim> &scene) const override
      {
        std::unique_ptr<Problem<dim>> problem;
        with_formulas(model.mesh.get_communicator(),
                      [&] { problem = make_diffusion_problem(model, scene); });
        return problem;
      }
    };
  } // namespace


  template <int dim>
  std::unique_ptr<ProblemFactory<dim>> make_diffusion_factory()
  {
    return std::make_unique<DiffusionFactory<dim>>();
  }


#define PERIDEAL_INSTANTIATE(dim)                                               \
  template void require_diffusion(const Scene<dim> &);                          \
  template void note_diffusion(const Scene<dim> &, std::vector<std::string> &); \
  template std::unique_ptr<ProblemFactory<dim>> make_diffusion_factory();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
