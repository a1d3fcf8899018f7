// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/family_fit.h>
#include <perideal/analysis/stress_intensity.h>

#include <vector>

namespace PeriDeal
{
  /**
   * CrackEndIntegral of peridynamics alone: gradients are those of FamilyFit, the stress follows
   * from them by Hooke's law, and each node stands for its cell of the lattice, which is integrated
   * with 3 x 3 points. Beside the crack nothing is left out.
   *
   * @param values of the displacements and, if it is warm, of the thermal strain in the plane
   *               (RingPoint); of nodes known here
   * @param t          of body forces
   * @param crack_time as for crack_end_integrals()
   * Collective.
   */
  std::vector<StressIntensity> bond_intensities(const Scene<2>             &scene,
                                                const Families<2>          &families,
                                                const FamilyFit<2>::Values &values,
                                                const bool                  warm,
                                                const double                t,
                                                const double                crack_time);
} // namespace PeriDeal
