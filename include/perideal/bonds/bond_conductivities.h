// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/neighbors.h>
#include <perideal/scene/material.h>

#include <unordered_map>
#include <vector>

namespace PeriDeal
{
  /** The conductivities of nodes, and of bonds by the interface rule. */
  template <int dim>
  class BondConductivities
  {
  public:
    /** Where nodes have their material, if that is not at their own place. */
    using SidePoints = std::unordered_map<unsigned int, dealii::Point<dim>>;

    /**
     * At the initial temperatures. Collective. Throws UserError where one is not positive.
     * Neighbours and material have to outlive this object.
     */
    BondConductivities(const Neighbors<dim> &neighbors,
                       const Material       &material,
                       const Expression     &initial_value,
                       SidePoints            side_points = {});

    /** One conductivity everywhere. */
    bool uniform() const
    {
      return all_alike;
    }
    bool depend_on_temperature() const;

    double of_node(const unsigned int node) const;
    double of_bond(const unsigned int node, const unsigned int neighbor) const;

    /**
     * Of the materials along a bond in series, 1/(s/k_i + (1-s)/k_j), with that of the node up to
     * a part s of the way. Along the way where the conductivity does not depend on the temperature.
     */
    double in_series(const unsigned int node, const unsigned int neighbor, const double s) const;

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

    SidePoints moved;

    double harmonic(const unsigned int node, const unsigned int neighbor) const;
    double at(const unsigned int node, const double T) const;
  };
} // namespace PeriDeal
