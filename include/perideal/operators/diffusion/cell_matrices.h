// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/bonds_beside_elements.h>
#include <perideal/operators/diffusion/cell_material.h>
#include <perideal/operators/parts/cut_cells.h>

#include <vector>

namespace PeriDeal
{
  /**
   * What finite elements conduct cell by cell: the matrix of the whole cell, of which a coupling
   * takes what its bonds conduct, cracks what they cut (CutCells), and which is multiplied by the
   * mean of the factors of its vertices (CrackSideFactors), but for the pairs that cracks separate.
   *
   * The arguments of the constructor must outlive this.
   */
  template <int dim>
  class CellMatrices
  {
  public:
    using Cell = typename CellMaterial<dim>::Cell;

    /** Matrices of one cell. */
    struct Matrices
    {
      explicit Matrices(const unsigned int n)
        : stiffness(n, n)
        , mass(n, n)
        , transfer(n, n)
        , indices(n)
      {}

      dealii::FullMatrix<double>                   stiffness, mass, transfer;
      std::vector<dealii::types::global_dof_index> indices;
    };

    /** No cell is cut yet. @param bonds or null, for finite elements alone */
    CellMatrices(const dealii::DoFHandler<dim>      &dofs,
                 const CellMaterial<dim>            &material,
                 const BondsBesideElements<dim>     *bonds,
                 CrackSideFactors                   &factors,
                 const typename CutCells<dim>::Rule &rule);

    CutCells<dim> &cut()
    {
      return cut_by_cracks;
    }

    const CutCells<dim> &cut() const
    {
      return cut_by_cracks;
    }

    /**
     * Stiffness, mass and indices of an own cell as it is now; transfer is left to the caller.
     * They stay until any other function is called that is not about cuts. Not collective.
     *
     * @param with_bonds else as if there were no coupling
     */
    Matrices &assemble(const Cell &cell, const bool with_bonds = true) const;

    /** The same before cracks cut it, without factors. */
    Matrices &assemble_intact(const Cell &cell, const bool with_bonds) const;

    /** Find the factors of all nodes. @p layout of the vectors. Collective. */
    void find_factors(const Vector &layout);

    /**
     * Find those of some owned nodes, all others keep theirs.
     * @param cells all that have such a node
     * @param sums  zero; what is left in them is up to the caller
     *
     * Collective.
     */
    void find_factors(const std::vector<Cell>         &cells,
                      const std::vector<unsigned int> &nodes,
                      CrackSideFactors::Sums          &sums);

    /** Add what this process's cut cells conduct through cracks. Collective. */
    void add_heat(const Vector &u, Balance &balance) const;

    /**
     * Lowest eigenvalue of what the coupling leaves of any cell before cracks cut it, in units of
     * the conductivity times h^(dim-2); infinite if it leaves all cells as they are. Collective.
     */
    double lowest_remainder() const;

  private:
    /** @param in_pairs each pair of vertices conducts by itself, as in cut cells */
    bool assemble_whole(const Cell &cell, const bool with_bonds, const bool in_pairs = false) const;

    /** What lies between two vertices of a cell, which has to outlive it. */
    typename CutCells<dim>::PairConductivity pair_conductivity(const Cell &cell) const;
    void assemble_cut(const Cell &cell, const bool with_bonds) const;

    const dealii::DoFHandler<dim>  &dofs;
    const CellMaterial<dim>        &material;
    const BondsBesideElements<dim> *bonds;
    CrackSideFactors               &factors;
    CutCells<dim>                   cut_by_cracks;
    mutable Matrices                matrices; // memory of the cell loops

    /** Pairs of the cell cut last; only where there are factors. */
    mutable std::vector<typename CutCells<dim>::SeparatedPair> separated;
  };
} // namespace PeriDeal
