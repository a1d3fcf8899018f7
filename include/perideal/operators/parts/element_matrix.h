// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/alike_rows.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/operators/parts/hanging_nodes.h>
#include <perideal/scene/domain.h>

#include <memory>

namespace PeriDeal
{
  /**
   * Where nodes are on a lattice, finer than the cells' since cells of higher degree have nodes
   * inside, as AlikeRows wants to know it. Not collective.
   */
  template <int dim>
  std::vector<std::uint64_t> places_on_lattice(const std::vector<dealii::Point<dim>> &positions,
                                               const Domain<dim>                     &lattice);


  /**
   * The matrix of elements with n unknowns at each node, interleaved: at first one of Trilinos,
   * which solvers want; where there are only products to come, as in explicit steps, rows that
   * share their values (AlikeRows) in place of it. Cells can be added to either.
   */
  template <int dim, int n>
  class ElementMatrix
  {
  public:
    using Sparse  = dealii::TrilinosWrappers::SparseMatrix;
    using Pattern = dealii::TrilinosWrappers::SparsityPattern;

    /** A matrix of zeros, one of Trilinos. Collective. */
    void reinit(const Pattern &pattern);

    /** Add C^T K C of one cell. Not collective; compress() has to follow. */
    void add(const HangingNodes<dim>                            &hanging,
             const dealii::FullMatrix<double>                   &of_cell,
             const std::vector<dealii::types::global_dof_index> &unknowns);

    void compress();

    /**
     * Let rows share their values, of a mesh without hanging nodes, if that takes less than half of
     * the memory; asked again it does nothing until there is another pattern. Collective.
     *
     * @param places as AlikeRows() has them
     */
    void share_rows(const typename AlikeRows<n>::Layout &nodes,
                    const std::vector<std::uint64_t>    &places);

    /** share_rows() has been asked since reinit(). */
    bool was_asked_to_share() const
    {
      return asked;
    }

    bool shares_rows() const
    {
      return alike != nullptr;
    }

    /** The matrix of Trilinos, which is empty where rows are shared. */
    Sparse &sparse()
    {
      return matrix;
    }

    const Sparse &sparse() const
    {
      return matrix;
    }

    /**
     * Make another matrix with the same entries. Collective.
     *
     * @param pattern where rows are shared, at least what they have
     */
    void copy_to(Sparse &other, const Pattern &pattern) const;

    /** y = K x; ghosts of x are up to date where rows are shared. Collective. */
    void multiply(Vector &y, const Vector &x) const;

    /** As PeriDeal::for_each_entry(), with values that do not change. */
    template <typename Visit>
    void for_each_entry(const Visit &visit) const
    {
      if (alike)
        alike->for_each_entry(visit);
      else
        PeriDeal::for_each_entry(matrix, visit);
    }

    /** On the diagonal, of an owned unknown. Not collective. */
    double diagonal(const unsigned int node, const unsigned int component) const;

    std::size_t n_entries() const // of all processes
    {
      return number_of_entries;
    }

    std::size_t memory_consumption() const
    {
      return alike ? alike->memory_consumption() : matrix.memory_consumption();
    }

  private:
    Sparse                        matrix;
    std::unique_ptr<AlikeRows<n>> alike;
    bool                          asked             = false;
    std::size_t                   number_of_entries = 0;
  };
} // namespace PeriDeal
