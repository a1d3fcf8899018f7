// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/elasticity.h>
#include <perideal/operators/elastic_coupling.h>
#include <perideal/scene/scene.h>

#include <vector>

namespace PeriDeal
{
  /**
   * What splice and blending of state-based (or bond-based) peridynamics with finite elements share. Each node has a weight beta_i of peridynamics, 1 in the zone, falling linearly to 0
   * over the overlap outside of it. The strain energy of the family of node i is u . K_i u/2 with
   *
   *   K_i = c d/(V_i q_i^2) g_i g_i^T + b/q_i sum_j W_ij M_ij M_ij^T,   g_i . u = sum_j W_ij xi . (u_j - u_i),   M_ij . u = xi/x . (u_j - u_i),
   *
   * the symbols as in StateOperator (d, c, b the factors of StateLaw); the sum of all K_i is its K. Families are cut off at the surface of the body, and there is no correction for it. A
   * family keeps its own q_i where cracks cut bonds of it.
   *
   * Without a dilatation the bonds of a family are visited one by one, so that rows reach one horizon and not two.
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

    void                 bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    void                 visit_family(const unsigned int                         node,
                                      const bool                                 intact,
                                      const ThermalStrain                       &strain,
                                      const std::function<void(const Family &)> &visit) const override;
    bool                 in_zone(const unsigned int node) const override;
    const Families<dim> &families() const override;
    std::size_t          memory_consumption() const override;

  protected:
    /** What the family of a node counts. */
    virtual double family_weight(const unsigned int node) const = 0;

    /** What is multiplied to the rows of a node. */
    virtual double row_weight(const unsigned int node) const = 0;

    /** beta of a node, and at a vertex of a cell. */
    double weight(const unsigned int node) const;
    double weight_at(const Cell &cell, const unsigned int vertex) const;

  private:
    struct BondOfFamily
    {
      dealii::Tensor<1, dim> moment;         // W xi
      double                 square, strain; // W x^2, and the thermal strain
    };

    static void set_nodes(const std::vector<unsigned int> &nodes, Family &family);
    static void add_dilatation(const std::vector<BondOfFamily> &list,
                               const double                     factor,
                               Family                          &family);

    /** @p place of the neighbour in the list of nodes. */
    static void add_bond(const BondOfFamily &bond,
                         const unsigned int  place,
                         const double        factor,
                         Family             &family);
    void        scale_rows(Family &family) const;

    Families<dim>         bonds;
    std::vector<StateLaw> laws;    // of owned nodes
    std::vector<double>   weights; // of nodes, ghosts too
    bool                  volumetric = false;
  };


  /**
   * Energy blending (as the Arlequin method and its kin): sum_i beta_i K_i plus (1 - mean of beta at the vertices) K_c for each cell. Symmetric and positive semidefinite, and since
   * no K_i strains a rigid motion, forces and moments balance; but linear fields are not exact where beta changes.
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
   * Splice: the rows of each node are beta_i times those of peridynamics, plus 1 - beta_i times those of finite elements. Linear fields are exact where the zone with its overlap stays more than
   * two horizons clear of the surface; but K is not symmetric, and forces do not balance where the zone ends.
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
