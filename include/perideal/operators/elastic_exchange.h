// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/elastic_coupling.h>
#include <perideal/operators/lattice_bonds.h>

namespace PeriDeal
{
  /**
   * Bondwise exchange of the part of the stiffness that bonds can carry (doc/coupling.md): a bond
   * along xi exerts the force W xi (xi . (u_j - u_i)) with
   *
   *   W = w V_i V_j k,   sum over half the family of w V xi xi xi xi = dd + dd + dd,
   *
   * d the Kronecker symbols, and k (dd + dd + dd) the largest stiffness of this kind that leaves a
   * positive semidefinite remainder (bond_part()); k is the smallest of the cells on the bond's
   * way. What finite elements carry along that very bond is taken away from the cells that it
   * passes,
   *
   *   R_c = K_c + k_c S - sum of active bonds W_b share L_b (x) xi xi^T,
   *
   * with L_b as in LatticeExchange. S is zero on linear fields, so that these have the same forces
   * with and without bonds, for any set of them; the matrix is symmetric and momentum is conserved.
   * With M = sum over the full family of w V^2 share L (x) xi xi^T and Q the cell matrix of the
   * stiffness dd + dd + dd, S is M - Q in one and two dimensions, where M = Q on linear fields, and
   * R_c is positive semidefinite. In three dimensions the pieces of a bond in one cell also push
   * the corners in the mode x y z, which only the cells around a node together take back: M has a
   * block B between linear fields and the others. Bonds then get the part eta = 0.95 of k, and S =
   * eta (M - Q) + eta^2/(1 - eta) B^T Q^+ B on the others, with which R_c again is positive
   * semidefinite (Schur complement).
   *
   * w is the influence function kernel/r^n times the volume fraction over r^2, times sum_{a <= b}
   * s_ab xi_a^2 xi_b^2/r^4 with the s for which the sum above holds on the lattice.
   */
  template <int dim>
  class ElasticExchange : public ElasticCoupling<dim>
  {
  public:
    using typename ElasticCoupling<dim>::Bond;
    using typename ElasticCoupling<dim>::Cell;

    /**
     * Collective. Throws UserError for a zone without nodes, for families too small and for cells
     * too long to calibrate.
     */
    ElasticExchange(Nodes<dim> &nodes, const Scene<dim> &scene, const Zone<dim> &zone);

    void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool symmetric() const override;
    bool in_zone(const unsigned int node) const override;
    const Families<dim> &families() const override;
    void                 set_cracks_of(const double time) override;
    std::size_t          memory_consumption() const override;

  private:
    void                   calibrate();
    void                   find_surplus();
    dealii::Tensor<1, dim> vector_of(const typename LatticeBonds<dim>::Offset &offset) const;

    LatticeBonds<dim>          bonds;
    dealii::FullMatrix<double> surplus; // S
  };
} // namespace PeriDeal
