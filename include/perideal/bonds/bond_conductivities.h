// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/neighbors.h>
#include <perideal/scene/material.h>

#include <vector>

namespace PeriDeal
{
  /** The conductivities of nodes, and of bonds by the interface rule. */
  template <int dim>
  class BondConductivities
  {
  public:
    /**
     * At the initial temperatures. Collective. Throws UserError where one is not positive.
     * Neighbours and material have to outlive this object.
     */
    BondConductivities(const Neighbors<dim> &neighbors,
                       const Material       &material,
                       const Expression     &initial_value);

    /** One conductivity everywhere. */
    bool uniform() const;
    bool depend_on_temperature() const;

    double of_node(const unsigned int node) const;
    double of_bond(const unsigned int node, const unsigned int neighbor) const;

    /**
     * Those at the temperatures u, whose ghosts are up to date. Collective. Throws UserError where
     * one is not positive.
     */
    void take_at(const Vector &u);

    std::size_t memory_consumption() const;

  private:
    const Neighbors<dim> &neighbors;
    const Material       &material;
    const bool            all_alike;
    std::vector<double>   values; // of nodes, or the one
  };
} // namespace PeriDeal
