// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling/breakable_zone.h>
#include <perideal/operators/coupling/node_weights.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The zone of a blending whose bonds break, on a lattice. In the overlap both energies are
   * weighed, and elements would hold together what bonds part. So a bond breaks only where weights
   * are 1 at all corners of all cells that touch the box around it: nothing is left of elements
   * there, and both families it belongs to have their whole energy.
   *
   * Where the body is about to break, weights become 1 within a reach, of two horizons (that of the
   * bond, and that of the families at its ends) or more, and fall over the overlap outside of it.
   */
  template <int dim>
  class FamilyZone : public BreakableZone<dim>
  {
  public:
    using typename BreakableZone<dim>::Joining;

    /** Both have to outlive this object. @param reach, overlap lengths */
    FamilyZone(const Families<dim> &families,
               NodeWeights<dim>    &weights,
               const double         reach,
               const double         overlap);

    const Families<dim> &families_of_bonds() const override
    {
      return families;
    }

    double weight_of(const unsigned int node) const override
    {
      return weights[node];
    }

    bool is_free(const unsigned int node) const override
    {
      return may_break(node, node);
    }

    bool may_break(const unsigned int node, const unsigned int neighbor) const override;
    void find_joining(const dealii::Point<dim> &place, std::vector<Joining> &list) const override;
    void join_nodes(const std::vector<Joining> &list) override;

    std::size_t memory_consumption() const
    {
      return this->memory_of_marks();
    }

  private:
    using Site = typename Lattice<dim>::Index;

    const Families<dim> &families;
    NodeWeights<dim>    &weights;
    const double         reach, overlap;
  };
} // namespace PeriDeal
