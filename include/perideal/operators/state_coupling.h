// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/fictitious_extension.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/elastic_coupling.h>
#include <perideal/operators/node_weights.h>
#include <perideal/scene/scene.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * What splice and blending of state-based peridynamics with finite elements share. Each node has
   * a weight beta_i of peridynamics, 1 in the zone, falling linearly to 0 over the overlap outside
   * of it. The strain energy of the family of node i is u . K_i u/2 with
   *
   *   K_i = c d/(V_i q_i^2) g_i g_i^T + b/q_i sum_j W_ij M_ij M_ij^T,
   *   g_i . u = sum_j W_ij xi . (u_j - u_i),   M_ij . u = xi/x . (u_j - u_i),
   *
   * the symbols as in StateOperator (d, c, b the factors of StateLaw); the sum of all K_i is its K.
   * Families are cut off at the surface of the body; with `Surface correction = fictitious nodes`
   * they are completed beyond flat sides by nodes whose displacement follows from those inside
   * (FictitiousExtension), in K_i only, since what is beyond has no energy. So K stays symmetric
   * and positive semidefinite, and away from holes and cracks a uniform strain has its energy at
   * each node; its forces are those of the stress on the sides, but for one horizon from edges and
   * corners. q_i is summed over the bonds that are left by cracks.
   *
   * In one dimension there is no dilatation, and the bonds of a family are visited one by one, so
   * that rows reach one horizon and not two.
   */
  template <int dim>
  class StateCoupling : public ElasticCoupling<dim>
  {
  public:
    using typename ElasticCoupling<dim>::Bond;
    using typename ElasticCoupling<dim>::Cell;
    using typename ElasticCoupling<dim>::Family;
    using typename ElasticCoupling<dim>::ThermalStrain;

    /** Collective. Throws UserError for a zone without nodes. */
    StateCoupling(Nodes<dim> &nodes, const Scene<dim> &scene, const Zone<dim> &zone);

    void        bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    void        visit_family(const unsigned int                         node,
                             const bool                                 intact,
                             const ThermalStrain                       &strain,
                             const std::function<void(const Family &)> &visit) const override;
    void        visit_nodes_of_family(const unsigned int                         node,
                                      const std::function<void(const Family &)> &visit) const override;
    std::string fault_of(const unsigned int node) const override;
    std::vector<dealii::types::boundary_id> mirrors() const override;
    bool                                    in_zone(const unsigned int node) const override;
    const Families<dim>                    &families() const override;
    void                                    set_cracks_of(const double time) override;
    std::size_t                             memory_consumption() const override;

  protected:
    /** What the family of a node counts. */
    virtual double family_weight(const unsigned int node) const = 0;

    /** What is multiplied to the rows of a node. */
    virtual double row_weight(const unsigned int node) const = 0;

    /** beta. */
    const NodeWeights<dim> &weights() const;

  private:
    struct Part
    {
      unsigned int           place = 0; // of a node in its family's list
      dealii::Tensor<1, dim> moment;    // factor of its displacement
    };

    /** W x e = sum of the parts' moments times displacements, less thermal strain. */
    struct BondOfFamily
    {
      std::vector<Part> parts;          // of a real bond -W xi and W xi
      double            square, strain; // W x^2, and the thermal strain
      double            count;          // as Family::n_bonds counts it
    };

    void find_nodes_that_act();

    /** The bonds of an owned node whose family has a weight. */
    bool find_family(const unsigned int         node,
                     const bool                 intact,
                     const ThermalStrain       &strain,
                     std::vector<unsigned int> &nodes,
                     std::vector<BondOfFamily> &list) const;

    /** Of the first of the nodes. */
    void add_neighbors(const bool                 intact,
                       const ThermalStrain       &strain,
                       std::vector<unsigned int> &nodes,
                       std::vector<BondOfFamily> &list) const;
    void add_fictitious(const ThermalStrain       &strain,
                        std::vector<unsigned int> &nodes,
                        std::vector<BondOfFamily> &list) const;

    typename Lattice<dim>::Index site_of(const unsigned int node) const;
    static void                  set_size(Family &family);
    void                         find_rows(Family &family) const;

    /** Add the energy factor/2 (sum of moments times displacements - thermal)^2. */
    static void add_square(const std::vector<Part> &parts,
                           const double             factor,
                           const double             thermal,
                           Family                  &family);
    static void add_bond(const BondOfFamily &bond, const double factor, Family &family);
    static void add_dilatation(const std::vector<BondOfFamily> &list,
                               const double                     factor,
                               Family                          &family);
    void        scale_rows(Family &family) const;

    Families<dim>                           bonds;
    NodeWeights<dim>                        node_weights;
    std::optional<FictitiousExtension<dim>> extension;
    std::vector<dealii::types::boundary_id> symmetry_sides; // with an extension
    std::vector<bool>                       acts; // of owned nodes: the family reaches the zone
    std::vector<StateLaw>                   laws; // of owned nodes that act
  };


  /**
   * Energy blending (as the Arlequin method and its kin): sum_i beta_i K_i plus (1 - mean of beta
   * at the vertices) K_c for each cell. Symmetric and positive semidefinite, and since no K_i
   * strains a rigid motion, forces and moments balance; but linear fields are not exact where beta
   * changes.
   */
  template <int dim>
  class StateBlending : public StateCoupling<dim>
  {
  public:
    using StateCoupling<dim>::StateCoupling;
    using typename ElasticCoupling<dim>::Cell;

    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool symmetric() const override;

  protected:
    double family_weight(const unsigned int node) const override;
    double row_weight(const unsigned int node) const override;
  };


  /**
   * Splice: the rows of each node are beta_i times those of peridynamics, plus 1 - beta_i times
   * those of finite elements. Linear fields are exact where the zone with its overlap stays more
   * than two horizons clear of the surface; but K is not symmetric, and forces do not balance where
   * the zone ends.
   */
  template <int dim>
  class StateSplice : public StateCoupling<dim>
  {
  public:
    using StateCoupling<dim>::StateCoupling;
    using typename ElasticCoupling<dim>::Cell;

    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool symmetric() const override;

  protected:
    double family_weight(const unsigned int node) const override;
    double row_weight(const unsigned int node) const override;
  };
} // namespace PeriDeal
