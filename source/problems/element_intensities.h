// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/analysis/stress_intensity.h>
#include <perideal/operators/solid/elastic_elements.h>

#include <vector>

namespace PeriDeal
{
  /**
   * CrackEndIntegral of elements. Cells that cracks cut have no stress: up to the crack all is as
   * on the edges of the cells beside them.
   * @param bonds that are along cracks bear what cut cells do not; else these are no part of the
   *              body (CrackEndIntegral::add_strip())
   * @param t     of body forces
   * Collective.
   */
  std::vector<StressIntensity> intensities_of_cells(const Scene<2>              &scene,
                                                    const ElasticElements<2>    &elements,
                                                    const dealii::DoFHandler<2> &dofs,
                                                    const Vector                &u,
                                                    const bool                   bonds,
                                                    const double                 t);

  /** Those of the families of a body that has bonds everywhere (bond_intensities()). Collective. */
  std::vector<StressIntensity> intensities_of_bonds(const Scene<2>           &scene,
                                                    const ElasticElements<2> &elements,
                                                    const Vector             &u,
                                                    const double              t);
} // namespace PeriDeal
