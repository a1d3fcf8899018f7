// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/operators/bonds_beside_elements.h>
#include <perideal/operators/cell_material.h>
#include <perideal/operators/cut_cells.h>
#include <perideal/operators/event_work.h>
#include <perideal/operators/hanging_nodes.h>
#include <perideal/operators/heat_loads.h>
#include <perideal/operators/operator.h>
#include <perideal/operators/prescribed_values.h>
#include <perideal/operators/spectrum.h>
#include <perideal/scene/scene.h>

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
  class FEMOperator : public DiffusionOperator
  {
  public:
    /**
     * With the cracks of time @p start, whatever the coupling has had before. Collective. Throws
     * UserError for material values that are not positive and for nodes that `removed` isolates.
     */
    FEMOperator(const dealii::DoFHandler<dim> &dof_handler,
                const Scene<dim>              &scene,
                std::unique_ptr<Coupling<dim>> coupling = nullptr,
                const double                   start    = 0.);

    void          initialize_vector(Vector &vector) const override;
    void          apply(Vector &y, const Vector &x) const override;
    void          residual(Vector &r, const Vector &u, const double t) const override;
    void          apply_then(Vector &y, const Vector &x, const RowsAction &finish) const override;
    void          distribute(Vector &u, const double t) const override;
    void          distribute_homogeneous(Vector &x) const override;
    void          clear_constrained(Vector &y) const override;
    const Vector &lumped_capacity() const override;
    bool          capacity_is_diagonal() const override;
    void          apply_capacity(Vector &y, const Vector &x) const override;
    const Vector &diagonal() const override;
    Spectrum      spectrum() const override;
    bool          symmetric() const override;
    bool          depends_on_time() const override;
    bool          has_steady_state() const override;
    void          surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    bool          surrogate_is_exact() const override;
    double        next_event(const double t) const override;
    bool          update(const double t) override;
    bool          depends_on_solution() const override;
    bool          capacity_depends_on_solution() const override;
    void          heat_between(Vector &y, const Vector &u, const Vector &v) const override;
    void          take_material_at(const Vector &u) override;
    Balance       balance(const Vector &u, const double t, const bool steady) const override;
    std::string   place_of(const unsigned int local_index) const override;
    OperatorSize  size() const override;

    const dealii::DoFHandler<dim> &dof_handler() const;
    const Material                &material() const;

    /** Cells of this process that a crack cuts, by active cell index. */
    const std::vector<bool> &cut_cells() const;

    /** Only in the model `coupled`. */
    const Coupling<dim> &bonds() const;

    /**
     * K of the body without its cracks, with the bonds of the zone as it is now (or without any),
     * constraints left out. Collective.
     */
    void assemble_intact(dealii::TrilinosWrappers::SparseMatrix &matrix,
                         const bool                              with_bonds) const;

    /**
     * Call visit(owned unknown, other unknown, conductance) for all pairs between which bonds or
     * cells conduct, by local numbers: the entries off the diagonal of K, with the sign changed. A
     * pair may come in several parts, and at both of its ends. Only with a coupling.
     */
    void visit_conductances(
      const std::function<void(const unsigned int, const unsigned int, const double)> &visit) const;

    /** y = K x, constraints left out. Collective. */
    void multiply(Vector &y, const Vector &x) const;

    /**
     * Numbers in [-1, 1] that look random but depend on the unknowns' positions alone. Collective.
     */
    const Vector &noise() const;

    /**
     * Heat in the body, which must have constant capacities; u has been through distribute().
     * Collective.
     */
    double heat(const Vector &u) const;

    const HangingNodes<dim> &hanging_nodes() const;

    /**
     * Lowest eigenvalue of what the coupling leaves of any cell before cracks cut it, in units of
     * the conductivity times h^(dim-2); infinite if it leaves all cells as they are. Collective.
     */
    double lowest_remainder() const;

  private:
    struct CellData;
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** The bonds are a form of their own. */
    bool apart() const;

    void   find_diagonal();
    void   multiply_then(Vector &y, const Vector &x, const RowsAction &finish) const;
    void   assemble_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const;
    void   scale_beside_cracks(CellData &data) const;
    void   update_rows(const bool zone_moves);
    void   add_crack_heat(const Vector &u, Balance &balance) const;
    void   assemble();
    void   fill();
    double heat_of(const Vector &u) const;
    bool assemble_whole_cell(const Cell &cell, CellData &data, const bool with_bonds = true) const;
    void assemble_cell(const Cell &cell, CellData &data, const bool with_bonds = true) const;
    std::vector<Cell> cells_near(const std::vector<dealii::BoundingBox<dim>> &cuts,
                                 const std::vector<dealii::BoundingBox<dim>> &joins,
                                 const double                                 wide) const;
    void              add_changes(const std::vector<Cell>                       &cells,
                                  const std::vector<dealii::FullMatrix<double>> &old);
    void              fill_noise(Vector &vector) const;
    void              find_crack_factors();
    void              find_crack_factors(const std::vector<Cell>         &cells,
                                         const std::vector<unsigned int> &nodes,
                                         CrackSideFactors::Sums          &sums);
    void              find_gershgorin();

    const dealii::DoFHandler<dim>                  &dofs;
    const Scene<dim>                               &scene;
    CrackSideFactors                                crack_factors;
    const std::unique_ptr<BondsBesideElements<dim>> zone_bonds; // null: finite elements alone
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout; // of vectors
    const HangingNodes<dim>                                          hanging;
    const HeatLoads<dim>                                             loads;
    CellMaterial<dim>                                                cell_material;
    const PrescribedValues<dim>                                      prescribed;
    const CrackHistory<dim>                                          history;
    double                                 cracks_of; // representative time of the cracks in K
    CutCells<dim>                          cut_by_cracks;
    dealii::TrilinosWrappers::SparseMatrix stiffness, mass;
    Vector                                 capacity, stiffness_diagonal;
    std::shared_ptr<CellData>              cell_data; // memory of the cell loops
    std::unique_ptr<EventWork<dim>>        event;     // made for the first event
    SpectralBounds                         bounds;
  };
} // namespace PeriDeal
