// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/prescribed_values.h>
#include <perideal/operators/parts/hanging_nodes.h>

#include <algorithm>
#include <memory>

namespace PeriDeal
{
  /** Which unknowns of finite elements are not free: prescribed values and hanging nodes. */
  template <int dim>
  class ElementConstraints : public PrescribedValues<dim>
  {
  public:
    /** As PrescribedValues. Collective. Throws UserError. */
    ElementConstraints(const dealii::DoFHandler<dim>                  &dofs,
                       const dealii::Utilities::MPI::Partitioner      &layout,
                       const BoundaryConditions<dim>                  &conditions,
                       const std::shared_ptr<const HangingNodes<dim>> &hanging,
                       const std::vector<PartUnknown<dim>>            &parts)
      : PrescribedValues<dim>(dofs, layout, conditions, *hanging, parts)
      , hanging(hanging)
    {}

    /** Sets hanging nodes, too. */
    void distribute(Vector &u, const double t) const override
    {
      PrescribedValues<dim>::distribute(u, t);
      hanging->interpolate(u);
    }

    bool counts_in_bounds(const unsigned int row) const override
    {
      return !std::binary_search(hanging->owned().begin(), hanging->owned().end(), row);
    }

  private:
    const std::shared_ptr<const HangingNodes<dim>> hanging;
  };
} // namespace PeriDeal
