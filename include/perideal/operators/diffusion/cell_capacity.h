// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/operators/diffusion/cell_material.h>
#include <perideal/operators/interface/capacity.h>
#include <perideal/operators/parts/hanging_nodes.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * Capacity of finite elements: int rho c N_i N_j, lumped or consistent. CellTerm puts it
   * together with its own matrix, from the matrices of cells. What hanging nodes have belongs to
   * the nodes they follow from.
   */
  template <int dim>
  class CellCapacity : public Capacity
  {
  public:
    /**
     * @param depends    rho c depends on the temperature
     * @param steady     as of CellMaterial
     * @param consistent C is a matrix
     *
     * The material and the hanging nodes must outlive this.
     */
    CellCapacity(const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout,
                 const CellMaterial<dim>                                          &material,
                 const HangingNodes<dim>                                          &hanging,
                 const bool                                                        depends,
                 const bool                                                        steady,
                 const bool                                                        consistent);

    /** With the pattern of the matrix of the operator. */
    void reinit(const dealii::TrilinosWrappers::SparsityPattern &pattern);

    /** Set all to zero. */
    void clear();

    /** Add int rho c N_i N_j of a cell. */
    void add(const dealii::FullMatrix<double>                   &of_cell,
             const std::vector<dealii::types::global_dof_index> &indices);

    /** After all cells. Collective. */
    void compress();

    bool is_diagonal() const override
    {
      return !consistent;
    }

    bool depends_on_solution() const override
    {
      return depends;
    }

    void        apply(Vector &y, const Vector &x) const override;
    void        heat_between(Vector &y, const Vector &u, const Vector &v) const override;
    double      content(const Vector &u) const override;
    std::size_t memory_consumption() const override;

  private:
    const CellMaterial<dim>               &material;
    const HangingNodes<dim>               &hanging;
    const bool                             depends, steady, consistent;
    dealii::TrilinosWrappers::SparseMatrix mass;
    dealii::Vector<double>                 lumps, of_diagonal; // of a cell
    mutable Vector                         change;             // of heat_between()
  };
} // namespace PeriDeal
