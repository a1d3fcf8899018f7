// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/laws/elasticity.h>
#include <perideal/operators/condition_faces.h>
#include <perideal/operators/crack_side_factors.h>
#include <perideal/operators/cut_cells.h>
#include <perideal/operators/displacement_conditions.h>
#include <perideal/operators/elastic_coupling.h>
#include <perideal/operators/elastic_operator.h>

#include <memory>

namespace dealii::TrilinosWrappers
{
  class SparsityPattern;
}

namespace PeriDeal
{
  /**
   * Linear elasticity with finite elements Qp: K_ab = int lambda grad_a (x) grad_b + mu (grad_b (x)
   * grad_a + grad_a . grad_b I), in 2D with the lambda of plane stress or plane strain, in 1D with
   * Young's modulus. Material, thermal strain and loads are evaluated at quadrature points, a
   * temperature at nodes interpolated there. The thermal strain alpha dT (in plane strain (1 + nu)
   * alpha dT) makes the load int grad_a (dim lambda + 2 mu) alpha dT.
   *
   * One scalar DoFHandler numbers the nodes; each has dim unknowns, interleaved.
   *
   * With a coupling its bonds and families are added, with their thermal loads, and the cells
   * changed (ElasticCoupling); K is as symmetric as the coupling. Cells that a crack cuts carry
   * nothing (`Mesh = removed`), so that in a zone the bonds around the crack alone hold what they
   * do; unless the crack is cut into the mesh. Thermal strains of bonds are the means of both ends.
   *
   * Crack-side scaling: at nodes with broken bonds and on cut cells g_i = V_i C_abab/(-(1/2) sum_j
   * tr K_ij r_ij^2), C_abab = dim lambda + dim (dim + 1) mu, clipped to [0.5, 4]; elsewhere g = 1.
   * Bonds are multiplied by the mean of both ends, cells by that of their vertices.
   */
  template <int dim>
  class ElasticElements : public ElasticOperator
  {
  public:
    /** @param dof_handler FE_Q(p) with dofs distributed. Collective. Throws UserError. */
    ElasticElements(const dealii::DoFHandler<dim>        &dof_handler,
                    const Scene<dim>                     &scene,
                    std::unique_ptr<ElasticCoupling<dim>> coupling = nullptr);
    ~ElasticElements() override;

    void                initialize_vector(Vector &vector) const override;
    void                apply(Vector &y, const Vector &x) const override;
    void                residual(Vector &r, const Vector &u, const double t) const override;
    void                distribute(Vector &u, const double t) const override;
    void                distribute_homogeneous(Vector &x) const override;
    void                clear_constrained(Vector &y) const override;
    const Vector       &lumped_capacity() const override;
    const Vector       &diagonal() const override;
    Spectrum            spectrum() const override;
    bool                depends_on_time() const override;
    bool                has_steady_state() const override;
    void                surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    bool                surrogate_is_exact() const override;
    std::vector<Vector> near_null_space() const override;
    std::string         place_of(const unsigned int local_index) const override;
    OperatorSize        size() const override;
    unsigned int        n_components() const override;
    bool                symmetric() const override;
    ForceBalance        forces(const Vector &u, const double t) const override;
    double              energy(const Vector &u) const override;
    void                multiply(Vector &y, const Vector &x) const override;
    void                unbalanced(Vector &r, const Vector &u, const double t) const override;
    void                mechanical_loads(Vector &loads, const double t) const override;
    void                initialize_nodal_vector(Vector &vector) const override;
    void                set_temperature_change(const Vector &nodal) override;
    Inversion           inverted(const Vector &u) const override;

    /** Place of a node of this process, by local number. */
    const dealii::Point<dim> &position(const unsigned int node) const;

    /** The layout of vectors with one number for each node. */
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &node_layout() const;

    /** Volume of a node: its share of the lumped integral of 1. */
    double volume(const unsigned int node) const;

    /** Only in the model `coupled`. */
    const ElasticCoupling<dim> &bonds() const;

    /** Cells of this process that a crack cuts, by active cell index. */
    const std::vector<bool> &cut_cells() const;

    /**
     * K of the body without its cracks and conditions, with the bonds of the zone or without any.
     * Collective.
     */
    void assemble_intact(dealii::TrilinosWrappers::SparseMatrix &matrix,
                         const bool                              with_bonds) const;

    /**
     * Lowest eigenvalue of what the coupling leaves of any cell, in units of its shear modulus
     * times h^(dim-2). Collective.
     */
    double lowest_remainder() const;

  protected:
    void fill_noise(Vector &vector) const override;

  private:
    struct CellData;
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** Of cells alone, with rows of other processes; not compressed. */
    dealii::TrilinosWrappers::SparsityPattern element_pattern() const;

    void   find_positions();
    void   find_conditions();
    void   assemble();
    void   assemble_cell(CellData &data) const;
    void   change_cell(const Cell &cell, CellData &data) const;
    void   find_crack_factors();
    void   add_bond_pattern(dealii::TrilinosWrappers::SparsityPattern &pattern) const;
    void   add_bonds(dealii::TrilinosWrappers::SparseMatrix &matrix, const bool intact) const;
    void   add_thermal_bonds();
    void   add_family_pattern(dealii::TrilinosWrappers::SparsityPattern &pattern) const;
    double add_families(dealii::TrilinosWrappers::SparseMatrix &matrix,
                        const bool                              intact) const; // their bonds
    void   unknowns_of(const typename ElasticCoupling<dim>::Family  &family,
                       std::vector<dealii::types::global_dof_index> &indices) const;
    void   add_thermal_families();
    bool   any_thermal() const;
    double thermal_strain_at(const unsigned int node) const;
    void   count_bonds(const double n_in_families);
    double temperature_change_at(const unsigned int node) const;
    double thermal_strain(const dealii::Point<dim> &p, const double temperature_change) const;
    void   add_thermal(const CellData &data, double &energy);
    void   finish_thermal(const double energy);
    void   throw_if_isolated() const;
    void   assemble_loads(Vector &loads, const double t) const;
    template <typename Visit>
    void for_each_own_cell(const Visit &visit) const;
    template <typename Visit>
    void for_each_load(const double t, const Visit &visit) const;

    const dealii::DoFHandler<dim>        &dofs;
    const Scene<dim>                     &scene;
    std::unique_ptr<ElasticCoupling<dim>> coupling; // null: finite elements alone
    CutCells<dim>                         cut_by_cracks;
    ConditionFaces<dim>                   condition_faces;
    std::vector<PartUnknown<dim>>         part_unknowns; // of regions and points
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> nodes, unknowns;
    std::vector<dealii::Point<dim>>                            positions;
    std::unique_ptr<DisplacementConditions<dim>>               conditions;
    dealii::TrilinosWrappers::SparseMatrix                     stiffness;
    std::unique_ptr<CellData>                                  cell_data;
    Vector                                                     mass, volumes, stiffness_diagonal;
    CrackSideFactors                                           crack_factors;
    unsigned long long                                         n_bonds = 0;
    double         thermal_energy = 0.; // of a body that is held everywhere
    bool           loads_vary     = false;
    Vector         constant_loads, thermal_loads;
    mutable Vector scratch;
  };


  /**
   * The rigid motions of nodes at the given places: dim translations, then the rotations. @p layout
   * sets the vectors' layout.
   */
  template <int dim>
  std::vector<Vector> rigid_motions(const std::vector<dealii::Point<dim>> &positions,
                                    const Vector                          &layout);
} // namespace PeriDeal
