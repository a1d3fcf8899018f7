// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "crack_note.h"

#include <perideal/scene/lists.h>

#include <cmath>


namespace PeriDeal
{
  template <int dim>
  void note_missing_crack_scaling(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    const SurfaceCorrection correction = scene.peridynamics.surface_correction;
    const bool bonds = runs(scene, ModelKind::peridynamics) || runs(scene, ModelKind::coupled),
               pairs = scene.cracks.cut_pairs();
    if (dim == 1 || scene.cracks.cracks.empty() || scene.cracks.conduct() || (!bonds && !pairs) ||
        (correction != SurfaceCorrection::none && correction != SurfaceCorrection::automatic))
      return;
    const PhysicsNames &names = names_of(scene.general.physics);
    notes.push_back(
      "beside a crack bonds " + std::string(pairs ? "and the pairs of cut cells " : "") +
      "conduct too little along it, and the jump of the " + names.field +
      " across it comes out some percent too large: 'Surface correction = crack scaling' in section "
      "'Peridynamics' makes up for most of that.");
  }


  template <int dim>
  void note_growth(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    if (scene.cracks.tips.empty())
      return;
    const CrackHistory<dim> history = scene.crack_history();
    const double            leaps =
      scene.domain.has_lattice() ?
                   history.longest_advance() / scene.domain.spacing().norm() * std::sqrt(dim) :
                   0.;
    notes.push_back(
      "the cracks grow in " + std::to_string(history.events().size()) +
      " events, between which no tip advances more than " + number_text(history.longest_advance()) +
      (leaps > 1.5 ? ", a leap over " + rounded_text(leaps) + " nodes at once" : "") +
      "; bonds are cut too early or too late by at most the time that it needs for half of that ('Growth step' in section "
      "'Cracks').");
  }


#define PERIDEAL_INSTANTIATE(dim)                                                           \
  template void note_missing_crack_scaling(const Scene<dim> &, std::vector<std::string> &); \
  template void note_growth(const Scene<dim> &, std::vector<std::string> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
