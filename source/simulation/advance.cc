// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// From one output time to the next, through events of the cracks and changes of the mesh.

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/simulation.h>
#include <perideal/solvers/linear_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "result_record.h"
#include "run_context.h"
#include "with_formulas.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void Simulation<dim>::make_steppers()
  {
    for (auto &model : models)
      model->begin({progress, *record, *output});
  }


  template <int dim>
  void Simulation<dim>::solve_models()
  {
    for (auto &model : models)
      {
        if (output->is_open())
          progress.doing("solving " + model->name());
        model->solve();
      }
  }


  template <int dim>
  double Simulation<dim>::share_done(const unsigned int n, const double t) const
  {
    double some = 0., all = 0.;
    for (unsigned int k = 0; k < models.size(); ++k)
      {
        const double work = models[k]->work_of(t - now);
        all += work;
        if (k < n)
          some += work;
      }
    return (now + some / all * (t - now)) / scene.time.end_time;
  }


  template <int dim>
  void Simulation<dim>::advance_to(const double t)
  {
    if (scene.time.steady)
      {
        solve_models();
        constexpr double settled = 0.05; // share of cells more or fewer
        for (unsigned int round = 0; round < 2 * scene.domain.coarsening; ++round)
          {
            const double n_before = mesh->n_global_active_cells();
            if (!adapt(0.))
              break;
            solve_models();
            if (std::abs(mesh->n_global_active_cells() - n_before) < settled * n_before)
              break;
          }
      }
    while (now < t)
      {
        const double next = grading ? grading->next_adaptation(now) :
                                      std::numeric_limits<double>::infinity();
        const double to   = std::min(t, next);
        for (unsigned int k = 0; k < models.size(); ++k)
          {
            if (output->is_open())
              {
                const double begin = share_done(k, to), end = share_done(k + 1, to);
                progress.doing(models[k]->name() + ": time stepping");
                progress.advancing(now, to, begin, end);
              }
            models[k]->advance(now, to, {}, {progress, *record, *output});
          }
        now = to;
        if (to == next)
          adapt(to);
      }
    now = t;
  }


  template <int dim>
  void Simulation<dim>::prepare_adaptation()
  {
    if (scene.coupling.zone != ZoneKind::adaptive)
      return;
    grading = std::make_unique<Grading<dim>>(scene, *mesh);
    if (scene.time.steady)
      return;
    for (unsigned int round = 0; round < scene.domain.coarsening && adapt(0.); ++round)
      for (auto &model : models)
        set_start(*model);
  }


  template <int dim>
  bool Simulation<dim>::adapt(const double t)
  {
    if (!grading)
      return false;
    grading->set_time(t);
    const auto    guide = std::find_if(models.begin(), models.end(), [](const auto &model) {
      return model->name() == to_string(ModelKind::coupled);
    });
    const Vector &u     = (*guide)->solution;
    u.update_ghost_values();
    const RecoveryIndicators found = (*guide)->indicators(u);
    u.set_ghost_state(false);
    // A uniform temperature has fluxes of round-off only.
    constexpr double round_off = 1e-20;
    const double     least     = round_off * found.size / scene.domain.spacing().norm_square();
    const double     goal      = scene.coupling.adaptive_tolerance;
    const double     target =
      goal * goal * std::max(found.energy, least) / mesh->n_global_active_cells();
    {
      Timings::Scope scope(timings, "mesh adaptation");
      if (!grading->mark(*mesh, found.squares, target))
        return false;
      for (auto &model : models)
        model->before_remesh();
      mesh->execute_coarsening_and_refinement();
    }
    with_formulas(communicator, [&] {
      for (auto &model : models)
        {
          model->after_remesh(t, scene.time.steady);
        }
    });
    for (auto &model : models)
      if (model->stepper)
        model->renew_stepper();
    readers_fit = false;
    ++n_adaptations;
    return true;
  }


#define PERIDEAL_INSTANTIATE(dim)                      \
  template void Simulation<dim>::make_steppers();      \
  template void Simulation<dim>::prepare_adaptation(); \
  template void Simulation<dim>::advance_to(const double t);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
