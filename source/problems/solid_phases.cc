// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_phases.h"

#include <perideal/output/tables.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  nlohmann::ordered_json describe_phases(const SolidProblem<dim> &model,
                                         const Scene<dim>        &scene,
                                         std::string             &totals,
                                         const MPI_Comm           communicator)
  {
    const double time   = scene.time.steady ? 0. : scene.time.end_time;
    auto         phases = nlohmann::ordered_json::object();
    const auto   row    = [&](const std::string &quantity, const double value) {
      totals += full_precision(time) + "," + model.name() + "," + quantity + "," +
                full_precision(value) + "\n";
    };
    for (const PhaseStatistics &phase :
         phase_statistics(model.stress_samples(), scene.material.phases.all().names, communicator))
      {
        auto &entry              = phases[phase.name];
        entry["volume fraction"] = phase.volume_fraction;
        row("volume fraction of " + phase.name, phase.volume_fraction);
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int b = a; b < 3; ++b)
            if (b < dim || (dim == 2 && a == 2))
              {
                const std::string name     = std::string(1, "xyz"[a]) + "xyz"[b];
                entry["mean stress"][name] = phase.mean_stress[a][b];
                row("mean stress " + name + " in " + phase.name, phase.mean_stress[a][b]);
              }
        entry["von mises"] = {{"mean", phase.mean_von_mises},
                              {"99th percentile", phase.highest_percentile},
                              {"maximum", phase.largest_von_mises}};
        row("mean von Mises stress in " + phase.name, phase.mean_von_mises);
        row("99th percentile of the von Mises stress in " + phase.name, phase.highest_percentile);
        row("largest von Mises stress in " + phase.name, phase.largest_von_mises);
      }
    return phases;
  }


#define PERIDEAL_INSTANTIATE(dim)                                            \
  template nlohmann::ordered_json describe_phases(const SolidProblem<dim> &, \
                                                  const Scene<dim> &,        \
                                                  std::string &,             \
                                                  const MPI_Comm);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
