// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling.h>
#include <perideal/operators/node_weights.h>
#include <perideal/scene/scene.h>

#include <vector>

namespace PeriDeal
{
  /**
   * What splice and blending share: each node has a weight b_i of peridynamics, 1 in the zone,
   * falling linearly to 0 over the overlap outside of it. Nodes with b > 0 have whole families, cut
   * off at the surface of the body.
   */
  template <int dim>
  class WeightedCoupling : public Coupling<dim>
  {
  public:
    using typename Coupling<dim>::Bond;
    using typename Coupling<dim>::Cell;

    /** Collective. Throws UserError for a zone without nodes. */
    WeightedCoupling(Nodes<dim> &nodes, const Scene<dim> &scene, const Zone<dim> &zone);

    void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    void possible_neighbors_of(const unsigned int         node,
                               std::vector<unsigned int> &neighbors) const override;
    std::vector<dealii::BoundingBox<dim>> joining_by(const double time) const override;
    void                                  set_cracks_of(const double time) override;
    bool                                  in_zone(const unsigned int node) const override;
    const Families<dim>                  &families() const override;
    std::size_t                           memory_consumption() const override;

  protected:
    /** What a bond counts, for the row of a node. */
    virtual double bond_weight(const double own, const double neighbor) const = 0;

    const NodeWeights<dim> &weights() const;

  private:
    Families<dim>       own_families;
    DiffusionBonds<dim> bonds;
    Zone<dim>           zone;
    double              overlap; // a length
    NodeWeights<dim>    weights_now, weights_at_end;
  };


  /**
   * Energy blending: both energies, weighted. W_ij (b_i + b_j)/2 for each bond, 1 - b (mean of the
   * vertices) times K_c for each cell. Symmetric and positive semidefinite, but a linear field is
   * not exact where b changes.
   */
  template <int dim>
  class Blending : public WeightedCoupling<dim>
  {
  public:
    using WeightedCoupling<dim>::WeightedCoupling;
    using typename Coupling<dim>::Cell;

    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool symmetric() const override;

  protected:
    double bond_weight(const double own, const double neighbor) const override;
  };


  /**
   * Splice: the row of each node is b_i times its row of peridynamics, plus 1 - b_i times that of
   * finite elements. Linear and quadratic fields are exact, but K is not symmetric and heat is not
   * conserved where b changes.
   */
  template <int dim>
  class Splice : public WeightedCoupling<dim>
  {
  public:
    using WeightedCoupling<dim>::WeightedCoupling;
    using typename Coupling<dim>::Cell;

    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    void finish_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool symmetric() const override;

  protected:
    double bond_weight(const double own, const double neighbor) const override;
  };
} // namespace PeriDeal
