// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>

#include <perideal/operators/solid/solid_bonds.h>
#include <perideal/operators/solid/solid_contact.h>

#include <memory>

namespace PeriDeal
{
  /**
   * CrackContact of peridynamics in the whole body, across bonds that cracks cut or that have
   * broken. All have to outlive it.
   * @param layout of the nodes; ghosts are all neighbours
   */
  template <int dim>
  std::unique_ptr<SolidContact> make_crack_contact(
    const SolidBonds<dim>                                            &solid,
    const BodyParameters<dim>                                        &body,
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout);

  /** ShortRangeContact of full kinematics. Both have to outlive it. Collective. */
  template <int dim>
  std::unique_ptr<SolidContact> make_short_range_contact(const SolidBonds<dim>     &solid,
                                                         const BodyParameters<dim> &body);
} // namespace PeriDeal
