// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What changes in a run besides its solutions: the mesh, how far it is; and keeping all of it.

#include <perideal/problems/result_record.h>
#include <perideal/scene/with_formulas.h>
#include <perideal/simulation/simulation.h>

#include <algorithm>

#include "run_output.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void Simulation<dim>::prepare_adaptation()
  {
    if (scene.coupling.zone != ZoneKind::adaptive)
      return;
    grading = std::make_unique<Grading<dim>>(scene, *mesh);
    if (scene.time.steady)
      return;
    for (unsigned int round = 0; round < scene.domain.coarsening && adapt(0.); ++round)
      for (auto &problem : problems)
        problem->start_anew();
  }


  template <int dim>
  bool Simulation<dim>::adapt(const double t)
  {
    if (!grading)
      return false;
    grading->set_time(t);
    const auto guide = std::find_if(problems.begin(), problems.end(), [](const auto &problem) {
      return problem->name() == to_string(ModelKind::coupled);
    });
    const RecoveryIndicators found = (*guide)->indicators();
    // A uniform field has fluxes of round-off only.
    constexpr double round_off = 1e-20;
    const double     least     = round_off * found.size / scene.domain.spacing().norm_square();
    const double     goal      = scene.coupling.adaptive_tolerance;
    const double     target =
      goal * goal * std::max(found.energy, least) / mesh->n_global_active_cells();
    {
      Timings::Scope scope(timings, "mesh adaptation");
      if (!grading->mark(*mesh, found.squares, target))
        return false;
      for (auto &problem : problems)
        problem->before_remesh();
      history.record(*mesh);
      time_of_mesh = t;
      mesh->execute_coarsening_and_refinement();
    }
    with_formulas(communicator, [&] {
      for (auto &problem : problems)
        problem->after_remesh(t, scene.time.steady);
    });
    for (auto &problem : problems)
      problem->renew_stepper();
    readers_fit = false;
    return true;
  }


  template <int dim>
  void Simulation<dim>::Place::exchange(Archive &archive)
  {
    archive.exchange("now", now);
    archive.exchange("next output", output);
    archive.exchange("stops", stops);
    archive.exchange("next stop", stop);
    archive.exchange("problem", problem);
  }


  template <int dim>
  void Simulation<dim>::exchange(Archive &archive)
  {
    {
      const Archive::Part part(archive, "mesh");
      history.exchange(archive);
      archive.exchange("time", time_of_mesh);
    }
    place.exchange(archive);
    timings.exchange(archive);
    for (const auto &[list, name] :
         {std::make_pair(&companions, "companion "), std::make_pair(&problems, "problem ")})
      for (std::size_t k = 0; k < list->size(); ++k)
        {
          const Archive::Part part(archive, name + std::to_string(k));
          (*list)[k]->exchange(archive);
        }
  }


  template <int dim>
  void Simulation<dim>::restore_mesh(Archive &archive)
  {
    const Archive::Part part(archive, "mesh");
    history.exchange(archive);
    archive.exchange("time", time_of_mesh);
    if (history.n_adaptations() == 0)
      return;
    history.repeat(*mesh);
    grading->set_time(time_of_mesh);
    with_formulas(communicator, [&] {
      for (auto &problem : problems)
        problem->rebuild(time_of_mesh);
    });
    readers_fit = false;
  }


  template <int dim>
  void Simulation<dim>::offer_checkpoint(const double)
  {}


#define PERIDEAL_INSTANTIATE(dim)                         \
  template void Simulation<dim>::prepare_adaptation();    \
  template bool Simulation<dim>::adapt(const double);     \
  template void Simulation<dim>::exchange(Archive &);     \
  template void Simulation<dim>::restore_mesh(Archive &); \
  template void Simulation<dim>::offer_checkpoint(const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
