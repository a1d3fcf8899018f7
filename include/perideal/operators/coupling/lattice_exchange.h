// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling/exchange_laws.h>
#include <perideal/scene/body_parameters.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Bondwise exchange on a lattice of equal cells (doc/coupling.md): each active bond is added, and
   * what the finite elements carry along that very bond is taken away from the cells that it
   * passes,
   *
   *   R_c = K_c + k_c S - sum of active bonds W_b share L_b (x) v v^T.
   *
   * S is zero on linear fields, so that these conduct or have forces alike with and without bonds,
   * for any set of them; R_c is positive semidefinite. Bonds of a solid keep the matrix symmetric,
   * and momentum is conserved. A cell of which a bond between two of its own vertices has broken
   * keeps nothing. S, v and the stiffness k are those of the law, ConductingBonds or
   * ElasticBonds; which bonds are active: LatticeBonds.
   */
  template <int dim, typename Law>
  class LatticeExchange : public LatticeBonds<dim>
  {
  public:
    using typename Coupling<dim>::Bond;
    using typename Coupling<dim>::Cell;

    /** Collective. Throws UserError for a zone without nodes, and as Law::calibrate(). */
    LatticeExchange(Nodes<dim> &nodes, const BodyParameters<dim> &body, const Zone<dim> &zone);

    void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool finish_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool leaves_nothing(const Cell &cell) const override;
    DiffusionBonds<dim> *bonds_of_form() override;
    void                 take_conductivities_at(const Vector &u) override;
    std::size_t          memory_consumption() const override;

  private:
    using typename LatticeBonds<dim>::Site;
    using LatticeBonds<dim>::own_families;

    Law         law;
    CellSurplus surplus;
  };
} // namespace PeriDeal
