// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>
#include <perideal/operators/diffusion/cell_term.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Solve K x = b on the free unknowns of an operator, from x = 0. Collective. */
  using SolveSystem = std::function<void(Vector &x, const Vector &b)>;


  /**
   * Quadratic elements (Q2) on the mesh of a solution with bilinear ones (Q1): what Q1 leaves of
   * the equations is seen by tests that it does not have, the bubbles in the middles of edges,
   * faces and cells. A Q2 vector is the Q1 field P v and what its bubbles add.
   *
   * Cells that are not those of plain elements are left out: those that cracks cut, those beside
   * them if they are scaled, those of which a coupling takes something. No bubble is in them or on
   * their sides, so that what is left is conforming, and nothing is known of what their model does
   * to the solution.
   *
   * All functions are collective unless stated. Vectors need no ghosts.
   */
  template <int dim>
  class QuadraticElements
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** Why a body cannot have them; empty if it can. Not collective. */
    static std::string why_not(const BodyParameters<dim> &body);

    /**
     * @param op       of degree 1; it and the body must outlive this
     * @param coupling that of the operator, if it has one
     */
    QuadraticElements(const FieldOperator<dim>  &op,
                      const BodyParameters<dim> &body,
                      const Coupling<dim>       *coupling = nullptr);

    const dealii::DoFHandler<dim> &dof_handler() const
    {
      return *quadratic;
    }

    const FieldOperator<dim> &linear_operator() const
    {
      return op;
    }

    const BodyParameters<dim> &parameters() const
    {
      return body;
    }

    /** Zero, with the locally relevant dofs as ghosts. Not collective. */
    Vector quadratic_vector() const
    {
      return Vector(layout);
    }

    /** The same of Q1. Not collective. */
    Vector linear_vector() const
    {
      return Vector(linear_layout);
    }

    /** P v of a Q1 field whose hanging nodes are set. */
    Vector prolonged(const Vector &v) const;

    /** P^T r: what Q1 tests see of a residual of Q2. */
    Vector restricted(const Vector &r) const;

    /**
     * The bubbles of a smooth field of which v are the values at the vertices: from second
     * derivatives of the quadratic polynomials fitted to the vertices of the cells around each
     * vertex, of one material. None where values are prescribed.
     */
    Vector recovered_bubbles(const Vector &v) const;

    /** What values of time t, prescribed where bubbles are, add to P v; nothing else. */
    Vector prescribed_bubbles(const Vector &v, const double t) const;

    /**
     * For goals: bubbles that make of a Q1 field, which is 1 or 0 on each side with a value, one
     * whose integral over the given side is its area and over all others zero.
     */
    Vector boundary_bubbles(const std::string &side, const Vector &v) const;

    /** f(t) - K w on all unknowns that do not hang, with w a Q2 field. */
    Vector residual(const Vector &w, const double t) const;

    /** The same in Q1, of the same cells. */
    Vector linear_residual(const Vector &v, const double t) const;

    /** Of a Q2 field: the root of the mean of its square over the body. */
    double root_mean_square(const Vector &w) const;

    /** Shares of the bubbles' r_i w_i that belong to each owned cell, by active cell index. */
    std::vector<double> shares_of_cells(const Vector &r, const Vector &w) const;

    /** Part of the cells that is left out. */
    double share_left_out() const;

  private:
    void mark_cells_left_out(const Coupling<dim> *coupling);

    bool is_left_out(const Cell &cell) const;

    template <typename Visit>
    void for_each_bubble(const Visit &visit) const;

    template <typename Visit>
    void for_each_prolonged(const Visit &visit) const;

    std::vector<Vector> second_derivatives(const Vector &v) const;

    const FieldOperator<dim>                                  &op;
    const BodyParameters<dim>                                 &body;
    const std::unique_ptr<dealii::DoFHandler<dim>>             quadratic;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout, linear_layout;
    HangingNodes<dim>                                          hanging;
    HeatLoads<dim>                                             loads, linear_loads;
    mutable CellMaterial<dim>                                  material, linear_material;
    PrescribedValues<dim>                                      prescribed;
    dealii::FullMatrix<double>                                 prolongation; // of one cell
    Vector left_out; // positive: without bubble; with ghosts. In the middle of a cell: of the cell
    std::vector<char> vertex, held; // of owned unknowns
  };


  /**
   * The owned Q1 or Q2 unknowns of the side or part with this name and a prescribed value: 1 there,
   * 0 elsewhere. Collective.
   */
  template <int dim>
  void mark_side(const dealii::DoFHandler<dim>             &dofs,
                 const dealii::Utilities::MPI::Partitioner &layout,
                 const BodyParameters<dim>                 &body,
                 const HangingNodes<dim>                   &hanging,
                 const std::string                         &side,
                 Vector                                    &marks);


  /** The same cell with the unknowns of other elements. */
  template <int dim>
  typename dealii::DoFHandler<dim>::active_cell_iterator same_cell(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
    const dealii::DoFHandler<dim>                                &dofs)
  {
    return {&dofs.get_triangulation(), cell->level(), cell->index(), &dofs};
  }


  /** A copy with the ghosts of a layout that owns the same unknowns. Collective. */
  inline Vector with_ghosts(
    const Vector                                                     &v,
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout)
  {
    Vector copy(layout);
    copy.copy_locally_owned_data_from(v);
    copy.update_ghost_values();
    return copy;
  }
} // namespace PeriDeal
