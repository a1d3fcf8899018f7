// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/cell_capacity.h>
#include <perideal/operators/diffusion/cell_matrices.h>
#include <perideal/operators/diffusion/contact_pairs.h>
#include <perideal/operators/diffusion/element_constraints.h>
#include <perideal/operators/diffusion/field_operator.h>
#include <perideal/operators/diffusion/heat_loads.h>
#include <perideal/operators/interface/matrix_term.h>
#include <perideal/operators/parts/event_work.h>

#include <functional>
#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * What cells conduct, by continuous finite elements Q1 to Q3 on the mesh as it is, with the sides
   * that transfer heat in their matrices and, of the model `coupled`, with bonds.
   *
   * Cracks: `faces` are in the mesh already (doubled vertices). `pairs` (Q1): in each cell with a
   * pair of vertices that a crack separates, the cell matrix is replaced by the pair conductances
   * w_ab = max(0, -K_ab) of the pairs that are not separated; a separated pair keeps the crack's
   * transmission (doc/theory.md). With `Surface correction = crack scaling` the cell matrices next
   * to cracks are multiplied by the mean of their vertices' factors. `removed`: cut cells conduct
   * nothing.
   *
   * With a coupling the cells keep what it leaves of them, and its bonds are added: in the matrix,
   * or as a sum of their own (BondsBesideElements). Then the elements are Q1, and vectors have the
   * horizon-wide halo of the nodes. Otherwise vectors have the locally relevant dofs as ghosts.
   *
   * Hanging nodes of a graded mesh follow from their neighbours: K is C^T K C, and their rows are
   * those of unknowns that are not free.
   *
   * It makes the parts of an operator that belong to it, and mends them all.
   */
  template <int dim>
  class CellTerm : public MatrixTerm<dim>
  {
  public:
    using typename Term<dim>::At;
    using typename Term<dim>::Rows;

    /**
     * As field_of_elements().
     * @param parts with layout and cracks
     */
    CellTerm(const dealii::DoFHandler<dim> &dof_handler,
             const BodyParameters<dim>     &body,
             std::unique_ptr<Coupling<dim>> coupling,
             const FieldParts<dim>         &parts);

    /** All that elements have beside the term: capacity, values, loads. */
    void give(FieldParts<dim> &parts) const;

    const dealii::DoFHandler<dim> &dof_handler() const
    {
      return dofs;
    }

    const Material &material() const
    {
      return body.material;
    }

    /** Cells of this process that a crack cuts, by active cell index. */
    const std::vector<bool> &cut_cells() const
    {
      return cells.cut().flags();
    }

    const HangingNodes<dim> &hanging_nodes() const
    {
      return *hanging;
    }

    /** Only in the model `coupled`. */
    const Coupling<dim> &bonds() const
    {
      Assert(zone_bonds, dealii::ExcMessage("Finite elements alone have no bonds."));
      return zone_bonds->coupling();
    }

    /**
     * K of the body without its cracks, with the bonds of the zone as it is now (or without any),
     * constraints left out. Collective.
     */
    void assemble_intact(dealii::TrilinosWrappers::SparseMatrix &matrix,
                         const bool                              with_bonds) const;

    /** See CellMatrices. Collective. */
    double lowest_remainder() const
    {
      return cells.lowest_remainder();
    }

    /**
     * Call visit(owned unknown, other unknown, conductance) for all pairs between which bonds or
     * cells conduct, by local numbers: the entries off the diagonal of K, with the sign changed. A
     * pair may come in several parts, and at both of its ends. Only with a coupling.
     */
    void visit_conductances(
      const std::function<void(const unsigned int, const unsigned int, const double)> &visit) const;

    void   begin(const At &at, double &entering) const override;
    void   set_then(Vector &y, const At &at, const Operator::RowsAction &finish) const override;
    void   add_rows(Vector &diagonal, std::vector<double> &sums, const Rows &rows) const override;
    Mended apply_change(const ChangeSet<dim> &change) override;
    void   take_material_at(const Vector &u) override;
    void   require_held(const RowsOfK &of_all) const override;
    void   make_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix,
                          const Vector                           &others) const override;
    bool   surrogate_is_exact() const override
    {
      return !apart();
    }

    void add_flows(Balance &balance, const At &at) const override;
    void add_to(OperatorSize &size) const override;

  private:
    using Cell = typename CellMatrices<dim>::Cell;

    /** The bonds are a sum of their own. */
    bool apart() const
    {
      return zone_bonds && zone_bonds->apart();
    }

    void fill();

    /** What sources and sides add to the matrix that are no lines in u (LoadTangents). */
    void add_tangents(dealii::TrilinosWrappers::SparseMatrix &sum) const;

    /** Mend cells and bonds; the rows that differ are in the memory of events. Collective. */
    void mend(const ChangeSet<dim> &change, const std::vector<dealii::BoundingBox<dim>> &joins);
    void add_changes(const std::vector<Cell>                       &changed,
                     const std::vector<dealii::FullMatrix<double>> &old);

    const dealii::DoFHandler<dim>                  &dofs;
    const BodyParameters<dim>                      &body;
    CrackSideFactors                                crack_factors;
    const std::unique_ptr<BondsBesideElements<dim>> zone_bonds; // null: finite elements alone
    const std::shared_ptr<const HangingNodes<dim>>  hanging;
    const std::vector<ContactPair>                  contact; // of cracks in the mesh
    const std::shared_ptr<HeatLoads<dim>>           loads;
    CellMaterial<dim>                               cell_material;
    const std::shared_ptr<ElementConstraints<dim>>  constraints;
    const std::shared_ptr<CellCapacity<dim>>        capacity;
    CellMatrices<dim>                               cells;
    std::unique_ptr<EventWork<dim>>                 event; // made for the first event
  };


  /**
   * Finite elements, or with a coupling the model `coupled`, with the loads of HeatLoads.
   *
   * With the cracks of time @p start, whatever the coupling has had before. Dofs and body must
   * outlive the operator. Collective. Throws UserError for material values that are not positive
   * and for nodes that `removed` isolates.
   */
  template <int dim>
  std::unique_ptr<FieldOperator<dim>> field_of_elements(
    const dealii::DoFHandler<dim> &dof_handler,
    const BodyParameters<dim>     &body,
    std::unique_ptr<Coupling<dim>> coupling = nullptr,
    const double                   start    = 0.);

  /** The cells of what field_of_elements() has made. */
  template <int dim>
  const CellTerm<dim> &cells_of(const FieldOperator<dim> &field)
  {
    return dynamic_cast<const CellTerm<dim> &>(field.first_term());
  }
} // namespace PeriDeal
