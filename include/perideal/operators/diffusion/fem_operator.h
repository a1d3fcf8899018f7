// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/cell_matrices.h>
#include <perideal/operators/diffusion/contact_pairs.h>
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
   * Heat conduction with continuous finite elements Q1 to Q3 on the mesh as it is.
   *
   * Cracks: `faces` are in the mesh already (doubled vertices). `pairs` (Q1): in each cell with a
   * pair of vertices that a crack separates, the cell matrix is replaced by the pair conductances
   * w_ab = max(0, -K_ab) of the pairs that are not separated; a separated pair keeps the crack's
   * transmission (doc/theory.md). With `Surface correction = crack scaling` the cell matrices next
   * to cracks are multiplied by the mean of their vertices' factors. `removed`: cut cells conduct
   * nothing.
   *
   * With a coupling the cells keep what it leaves of them, and its bonds are added: the model
   * `coupled`. Then the elements are Q1, and vectors have the horizon-wide halo of the nodes.
   * Otherwise vectors have the locally relevant dofs as ghosts.
   *
   * Hanging nodes of a graded mesh follow from their neighbours: K is C^T K C, and their rows are
   * those of unknowns that are not free.
   */
  template <int dim>
  class FEMOperator : public FieldOperator<dim>
  {
  public:
    /**
     * With the cracks of time @p start, whatever the coupling has had before. Collective. Throws
     * UserError for material values that are not positive and for nodes that `removed` isolates.
     */
    FEMOperator(const dealii::DoFHandler<dim> &dof_handler,
                const BodyParameters<dim>     &body,
                std::unique_ptr<Coupling<dim>> coupling = nullptr,
                const double                   start    = 0.);

    void distribute(Vector &u, const double t) const override
    {
      prescribed.distribute(u, t);
      hanging.interpolate(u);
    }

    bool capacity_is_diagonal() const override;
    void apply_capacity(Vector &y, const Vector &x) const override;
    bool surrogate_is_exact() const override
    {
      return !apart();
    }

    void         heat_between(Vector &y, const Vector &u, const Vector &v) const override;
    void         take_material_at(const Vector &u) override;
    OperatorSize size() const override;

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
      return hanging;
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

    /**
     * Heat in the body, which must have constant capacities; u has been through distribute().
     * Collective.
     */
    double heat(const Vector &u) const;

  protected:
    bool   apply_change(const ChangeSet<dim> &change) override;
    void   make_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    void   add_crack_heat(Balance &balance, const Vector &u) const override;
    double content(const Vector &u) const override;
    bool   counts(const unsigned int row) const override;
    dealii::Point<dim> position(const unsigned int local_index) const override;

  private:
    using typename FieldOperator<dim>::Rows;
    using Cell = typename CellMatrices<dim>::Cell;
    using DiffusionOperatorBase<dim>::body;
    using DiffusionOperatorBase<dim>::layout;
    using DiffusionOperatorBase<dim>::history;
    using DiffusionOperatorBase<dim>::capacity;
    using DiffusionOperatorBase<dim>::stiffness_diagonal;
    using DiffusionOperatorBase<dim>::bounds;

    /** The bonds are a form of their own. */
    bool apart() const
    {
      return zone_bonds && zone_bonds->apart();
    }

    void assemble();
    void fill();
    void find_bounds(const Rows &all, const std::vector<double> &sums);
    void update_rows(const bool zone_moves, const bool may_isolate);
    void add_changes(const std::vector<Cell>                       &changed,
                     const std::vector<dealii::FullMatrix<double>> &old);
    void fill_noise(Vector &vector) const;

    const dealii::DoFHandler<dim>                  &dofs;
    CrackSideFactors                                crack_factors;
    const std::unique_ptr<BondsBesideElements<dim>> zone_bonds; // null: finite elements alone
    const HangingNodes<dim>                         hanging;
    const std::vector<ContactPair>                  contact; // of cracks in the mesh
    const HeatLoads<dim>                            loads;
    CellMaterial<dim>                               cell_material;
    const PrescribedValues<dim>                     prescribed;
    CellMatrices<dim>                               cells;
    MatrixTerm                                      cell_term; // with bonds that are not apart
    dealii::TrilinosWrappers::SparseMatrix          mass;
    std::unique_ptr<EventWork<dim>>                 event; // made for the first event
  };
} // namespace PeriDeal
