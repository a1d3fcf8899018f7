// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/scene/models.h>

#include <vector>

namespace PeriDeal
{
  /**
   * `Surface correction` of diffusion: the factors of nodes, with which their bonds are multiplied
   * (NodeFactors). With the sums M_a = sum_j W xi_a^2 over a node's bonds without factors,
   *
   * energy         g_a = 2 kappa V/M_a in each direction, or in one for all: the energy of a unit
   *                gradient is that of the classical body (Tan 2020)
   * crack scaling  g of crack_side_factors.h with the trace (1/2) sum_a M_a: what a family loses to
   *                a crack, the rest makes up for
   */
  template <int dim>
  class HeatSurfaceFactors
  {
  public:
    /** The arguments must outlive this. No node has a factor yet. */
    HeatSurfaceFactors(DiffusionBonds<dim> &bonds, const Peridynamics &parameters)
      : bonds(bonds)
      , parameters(parameters)
    {}

    /** The entry asks for factors. Not collective. */
    bool any() const
    {
      return parameters.surface_correction != SurfaceCorrection::none;
    }

    /** Owned nodes that may have a factor other than 1. Not collective. */
    std::vector<unsigned int> nodes() const;

    /**
     * Find the factors of some owned nodes, all others keep theirs, and give all to the bonds.
     * Throws UserError for a node without any bond in a direction. Collective.
     */
    void find(const std::vector<unsigned int> &of_nodes);

  private:
    DiffusionBonds<dim> &bonds;
    const Peridynamics  &parameters;
    std::vector<Vector>  factors; // one for each direction
  };
} // namespace PeriDeal
