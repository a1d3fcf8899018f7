// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/types.h>

#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Nodes on the sides of larger cells. So that fields are continuous they follow from nodes of
   * the larger cell, their masters: u_h = sum c_hm u_m, or u = C u_free for all nodes. A matrix of
   * cells then is C^T K C and a load C^T b. Rows of hanging nodes are those of unknowns that are
   * not free. Where nodes have several unknowns, interleaved, each component follows by itself.
   *
   * Where a mesh has no hanging node on any process, all functions but add_to() do nothing, and
   * none is collective.
   */
  template <int dim>
  class HangingNodes
  {
  public:
    /**
     * @param dofs         with one component: the nodes
     * @param layout       of the nodes: owned dofs, and ghosts with the masters among them
     * @param n_components of vectors and matrices: component c of node i is n_components i + c
     *
     * Collective.
     */
    HangingNodes(const dealii::DoFHandler<dim>             &dofs,
                 const dealii::Utilities::MPI::Partitioner &layout,
                 const unsigned int                         n_components = 1);

    /**
     * Let owned unknowns follow from one other each, too, of the same component: those of nodes of
     * which cracks leave no cell. @param pairs local numbers of the unknown and its master, which
     * may be a ghost, ascending. is_hanging() does not know them: no cell has a part of them.
     * Collective.
     */
    void let_follow(const std::vector<std::pair<unsigned int, unsigned int>> &pairs,
                    const MPI_Comm                                            communicator);

    /** On any process. */
    bool any() const
    {
      return on_any_process;
    }

    /** By global number of an unknown; known for those of owned nodes and of ghost cells. */
    bool is_hanging(const dealii::types::global_dof_index unknown) const;

    /** Local numbers of the owned unknowns, ascending. */
    const std::vector<unsigned int> &owned() const
    {
      return unknowns;
    }

    /** For the patterns of matrices. */
    const dealii::AffineConstraints<double> &constraints() const
    {
      return lines;
    }

    /** Add the entries of one cell to the pattern of a matrix. Not collective. */
    void add_to(dealii::TrilinosWrappers::SparsityPattern          &pattern,
                const std::vector<dealii::types::global_dof_index> &indices) const;

    /**
     * b := C^T b: give what owned hanging nodes have of an integral, a load for instance, to their
     * masters. Ghosts do not count. Collective.
     */
    void condense(Vector &loads) const;

    /** v := C v: set the owned hanging nodes to what follows from their masters. Collective. */
    void interpolate(Vector &v) const;

    /** Set the entries of owned hanging nodes. Not collective. */
    void set(Vector &v, const double value) const;

    /**
     * Add C^T K C of one cell to a matrix with the pattern of constraints(). Hanging nodes get
     * something positive on their diagonal. Not collective.
     */
    void add_to(dealii::TrilinosWrappers::SparseMatrix             &matrix,
                const dealii::FullMatrix<double>                   &of_cell,
                const std::vector<dealii::types::global_dof_index> &indices) const;

  private:
    dealii::AffineConstraints<double> lines;
    bool                              on_any_process;
    std::vector<unsigned int>         unknowns; // owned

    // Of each owned one: local numbers and weights.
    std::vector<std::vector<std::pair<unsigned int, double>>> masters;
  };
} // namespace PeriDeal
