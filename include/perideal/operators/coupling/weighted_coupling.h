// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/coupling/node_weights.h>
#include <perideal/operators/coupling/weighting.h>
#include <perideal/scene/body_parameters.h>

#include <vector>

namespace PeriDeal
{
  /**
   * What splice and blending share in diffusion and elasticity: each node has a weight beta_i of
   * peridynamics, 1 in the zone, falling linearly to 0 over the overlap outside of it. Nodes with
   * beta > 0 have whole families, cut off at the surface of the body.
   *
   * Energy blending (as the Arlequin method and its kin) weighs both energies: families by beta,
   * cells by 1 - beta (mean of the vertices). K is symmetric and positive semidefinite, but linear
   * fields are not exact where beta changes. Splice weighs rows: those of peridynamics by beta, of
   * finite elements by 1 - beta. Linear fields are exact where families are whole (for diffusion
   * quadratic ones, too), but K is not symmetric, and heat is not conserved, forces do not balance,
   * where beta changes.
   */
  template <int dim>
  class WeightedCoupling : public Coupling<dim>
  {
  public:
    using typename Coupling<dim>::Cell;

    /** Collective. Throws UserError for a zone without nodes. */
    WeightedCoupling(Nodes<dim>                &nodes,
                     const BodyParameters<dim> &body,
                     const Zone<dim>           &zone,
                     const CouplingScheme       scheme);

    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool finish_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool symmetric() const override
    {
      return weighting.symmetric();
    }

    std::vector<dealii::BoundingBox<dim>> joining_by(const double time) const override;
    void                                  join(const double time) override;
    bool                                  in_zone(const unsigned int node) const override
    {
      return weights_now[node] > 0.;
    }

    std::size_t memory_consumption() const final;

  protected:
    /** Besides that of the families and weights. */
    virtual std::size_t memory_of_bonds() const = 0;

    using Coupling<dim>::own_families;

    const double     overlap; // a length
    const Weighting  weighting;
    NodeWeights<dim> weights_now, weights_at_end;
  };
} // namespace PeriDeal
