// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling.h>
#include <perideal/operators/lattice_bonds.h>
#include <perideal/scene/scene.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Bondwise exchange on a lattice of equal cells (doc/coupling.md): each active bond is added, and
   * what the finite elements conduct along that very bond is taken away from the cells that it
   * passes,
   *
   *   R_c = K_c + kappa_c (M - Q[A]) - sum of active bonds W_b share L_b,
   *
   * M = sum over the full family of w V^2 share L, A = (1/2) sum w V xi xi^T over the full family,
   * Q[A] the cell matrix of the conductivity A; M = Q[A] on linear fields. So a linear field
   * conducts the same with and without bonds, for any set of them, and R_c is positive
   * semidefinite.
   *
   * W_b = w(xi) V_i V_j kappa, kappa the smallest conductivity of the cells on the bond's way.
   * Which bonds are active: LatticeBonds.
   */
  template <int dim>
  class LatticeExchange : public Coupling<dim>
  {
  public:
    using typename Coupling<dim>::Bond;
    using typename Coupling<dim>::Cell;

    /** Collective. Throws UserError for a zone without nodes. */
    LatticeExchange(Nodes<dim> &nodes, const Scene<dim> &scene, const Zone<dim> &zone);

    void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    void possible_neighbors_of(const unsigned int         node,
                               std::vector<unsigned int> &neighbors) const override;
    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool leaves_nothing(const Cell &cell) const override;
    bool has_form() const override;
    std::unique_ptr<BondForm>             make_form() override;
    void                                  set_form_factors(std::vector<double> factors) override;
    bool                                  symmetric() const override;
    std::vector<dealii::BoundingBox<dim>> joining_by(const double time) const override;
    void                                  set_cracks_of(const double time) override;
    bool                                  in_zone(const unsigned int node) const override;
    const Families<dim>                  &families() const override;
    std::size_t                           memory_consumption() const override;


  private:
    using Site = typename Lattice<dim>::Index;

    void find_full_matrix();

    LatticeBonds<dim>          bonds;
    DiffusionBonds<dim>        of_families;
    OperatorForm               form       = OperatorForm::automatic;
    bool                       calibrated = true; // A is the unit matrix
    dealii::FullMatrix<double> surplus;           // M - Q[A], for unit conductivity
  };
} // namespace PeriDeal
