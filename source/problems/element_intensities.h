// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/analysis/front_intensity.h>
#include <perideal/operators/solid/elastic_elements.h>

#include <vector>

namespace PeriDeal
{
  /**
   * CrackEndIntegral, in three dimensions FrontIntegral, of elements. Cells that cracks cut have no
   * stress: up to the crack all is as on the faces of the cells beside them.
   * @param bonds that are along cracks bear what cut cells do not; else these are no part of the
   *              body (CrackEndIntegral::add_strip())
   * @param t     of body forces
   * Collective.
   */
  template <int dim>
  std::vector<StressIntensity> intensities_of_cells(const Scene<dim>              &scene,
                                                    const ElasticElements<dim>    &elements,
                                                    const dealii::DoFHandler<dim> &dofs,
                                                    const Vector                  &u,
                                                    const bool                     bonds,
                                                    const double                   t);
} // namespace PeriDeal
