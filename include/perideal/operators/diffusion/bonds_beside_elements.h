// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/interface/row_set.h>
#include <perideal/operators/lattice/bond_term.h>
#include <perideal/operators/parts/crack_side_factors.h>

#include <memory>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * The bonds of a coupling as part of the matrix K of finite elements, or, where the coupling
   * prefers it, apart from it: as a sum of their own, to which CellTerm adds the few rows of the
   * matrix that are not empty.
   *
   * Bonds are multiplied by the factors of crack-side scaling. Not collective unless stated.
   */
  template <int dim>
  class BondsBesideElements : public BondTerm<dim>
  {
  public:
    /** Some rows of bonds: numbers of neighbours (local) and conductances. */
    using Conductances = std::vector<std::vector<std::pair<unsigned int, double>>>;

    /** @param factors must outlive this */
    BondsBesideElements(std::unique_ptr<Coupling<dim>> coupling, const CrackSideFactors &factors);

    const Coupling<dim> &coupling() const
    {
      return *coupled;
    }

    /** Damage may leave nodes alone, which keep their heat. */
    bool has_damage() const;

    /** The bonds are not in the matrix. The same on all processes. */
    bool apart() const
    {
      return in_form;
    }

    /** The matrix needs nothing of a cell. */
    bool leaves_nothing(const typename Coupling<dim>::Cell &cell) const;

    /** Add what the matrix needs: of bonds, or, if they are apart, of cells that are not empty. */
    void add_pattern(const dealii::DoFHandler<dim>             &dofs,
                     dealii::TrilinosWrappers::SparsityPattern &pattern) const;

    /** The bonds of some owned nodes as they are now. */
    Conductances rows(const std::vector<unsigned int> &nodes) const;

    /** Add the bonds to the matrix of cells, unless they are apart; not compressed. */
    void add_to(dealii::TrilinosWrappers::SparseMatrix &matrix) const;

    /**
     * Move on to the cracks of a representative time, and the zone with them (Coupling).
     * @param nodes whose bonds may change
     * @return what their bonds were, for add_changes(); empty if they are apart
     */
    Conductances change_bonds(const ChangeSet<dim> &change, const std::vector<unsigned int> &nodes);

    /** Add to the matrix what has changed; rows that have are inserted into the set. */
    void add_changes(const std::vector<unsigned int>        &nodes,
                     const Conductances                     &old,
                     dealii::TrilinosWrappers::SparseMatrix &matrix,
                     RowSet                                 &touched) const;

    /** As Coupling. */
    void take_conductivities_at(const Vector &u);

    /** Make the form of bonds that are apart. Throws UserError if they cannot have it. */
    void make_form(const OperatorForm wanted);

    /** Take the bonds of some nodes anew into the form; their rows are inserted into the set. */
    void change_form(const std::vector<unsigned int> &nodes, RowSet &touched);

    /** Mark those of some owned nodes that have broken bonds. */
    void mark_broken(const std::vector<unsigned int> &nodes, CrackSideFactors::Sums &sums) const;

    /** Add the bonds of marked ones among some owned nodes. */
    void add_traces(const std::vector<unsigned int> &nodes, CrackSideFactors::Sums &sums) const;

    /** Add what this process's broken bonds conduct through cracks. Collective. */
    void add_heat(const Vector &u, Balance &balance) const;

    /** Bonds, numbers stored, memory and name of the form. Collective. */
    void add_to(OperatorSize &size) const override;

  private:
    void add_bonds(dealii::TrilinosWrappers::SparseMatrix &matrix,
                   const std::vector<unsigned int>        &nodes,
                   const Conductances                     &rows) const;
    void set_form_factors();

    const std::unique_ptr<Coupling<dim>>                             coupled;
    const CrackSideFactors                                          &factors;
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
    const bool                                                       in_form;
    mutable unsigned long long                                       n_bonds = 0;
    mutable bool                                                     recount = true;
  };
} // namespace PeriDeal
