// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/family_fit.h>
#include <perideal/analysis/front_intensity.h>

#include <vector>

namespace PeriDeal
{
  /**
   * CrackEndIntegral, in three dimensions FrontIntegral, of peridynamics alone: gradients are those
   * of FamilyFit, the stress follows from them by Hooke's law, and each node stands for its cell of
   * the lattice, which is integrated with 3 x 3 or 2 x 2 x 2 points. Beside the crack nothing is
   * left out.
   *
   * @param values of the displacements and, if it is warm, of the thermal strain in the plane
   *               (RingPoint); of nodes known here
   * @param t          of body forces
   * @param crack_time as for crack_end_integrals()
   * Collective.
   */
  template <int dim>
  std::vector<StressIntensity> bond_intensities(const Scene<dim>                      &scene,
                                                const Families<dim>                   &families,
                                                const typename FamilyFit<dim>::Values &values,
                                                const bool                             warm,
                                                const double                           t,
                                                const double                           crack_time);
} // namespace PeriDeal
