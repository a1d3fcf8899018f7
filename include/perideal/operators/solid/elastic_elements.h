// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/laws/elasticity.h>
#include <perideal/mesh/cell_search.h>
#include <perideal/operators/parts/condition_faces.h>
#include <perideal/operators/parts/crack_side_factors.h>
#include <perideal/operators/parts/cut_cells.h>
#include <perideal/operators/parts/hanging_nodes.h>
#include <perideal/operators/solid/solid_bonds_beside_elements.h>
#include <perideal/operators/solid/solid_operator.h>

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
   * One scalar DoFHandler numbers the nodes; each has dim unknowns, interleaved. Hanging nodes of a
   * graded mesh follow from their neighbours: K is C^T K C, and their rows, without mass, are those
   * of unknowns that are not free.
   *
   * With a coupling its bonds and families are added, with their thermal loads
   * (SolidBondsBesideElements), and the cells changed (Coupling); K is as symmetric as the
   * coupling. Cells that a crack cuts carry nothing (`Mesh = removed`), so that in a zone the bonds
   * around the crack alone hold what they do; unless the crack is cut into the mesh.
   *
   * Crack-side scaling: at nodes with broken bonds and on cut cells g_i = V_i C_abab/(-(1/2) sum_j
   * tr K_ij r_ij^2), C_abab = dim lambda + dim (dim + 1) mu, clipped to [0.5, 4]; elsewhere g = 1.
   * Bonds are multiplied by the mean of both ends, cells by that of their vertices.
   */
  template <int dim>
  class ElasticElements : public SolidOperator<dim>
  {
  public:
    /** Throws UserError for a body that it cannot deform, with its coupling or without. */
    static void require(const BodyParameters<dim> &body, const bool coupled);

    /** @param dof_handler FE_Q(p) with dofs distributed. Collective. Throws UserError. */
    ElasticElements(const dealii::DoFHandler<dim> &dof_handler,
                    const BodyParameters<dim>     &body,
                    std::unique_ptr<Coupling<dim>> coupling = nullptr);
    ~ElasticElements() override;

    Spectrum spectrum() const override;
    bool     surrogate_is_exact() const override
    {
      return true;
    }

    OperatorSize size() const override;
    bool         symmetric() const override
    {
      return !zone_bonds || zone_bonds->coupling().symmetric();
    }

    bool zone_follows_cracks() const override
    {
      return zone_bonds && zone_bonds->coupling().zone_follows_cracks() &&
             this->has_growing_cracks();
    }

    ForceBalance forces(const Vector &u, const double t) const override;
    double       energy(const Vector &u) const override;
    void         multiply(Vector &y, const Vector &x) const override
    {
      stiffness.vmult(y, x);
      hanging.set(y, 0.); // the nodes they follow from have all of it
    }

    void distribute(Vector &u, const double t) const override
    {
      conditions->distribute(u, t);
      hanging.interpolate(u);
    }

    void      set_temperature_change(const Vector &nodal) override;
    Inversion inverted(const Vector &u) const override;

    const dealii::Point<dim> &position(const unsigned int node) const override
    {
      return positions[node];
    }

    /** The layout of vectors with one number for each node. */
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &node_layout() const;

    /** Volume of a node: its share of the lumped integral of 1. */
    double volume(const unsigned int node) const
    {
      return volumes.local_element(node);
    }

    /** Of all components. */
    const HangingNodes<dim> &hanging_nodes() const
    {
      return hanging;
    }

    /** Only in the model `coupled`. */
    const Coupling<dim> &bonds() const
    {
      return zone_bonds->coupling();
    }

    /** NodeFamilies::mirrors(), if the coupling has families. */
    std::vector<dealii::types::boundary_id> mirrors() const
    {
      return zone_bonds ? zone_bonds->mirrors() : std::vector<dealii::types::boundary_id>();
    }

    /** Cells of this process that a crack cuts, by active cell index. */
    const std::vector<bool> &cut_cells() const
    {
      return cut_by_cracks.flags();
    }

    /** Nodes join that will do so on the whole way of the cracks; K stays as it is. Collective. */
    void join_whole_way()
    {
      zone_bonds->join(body.cracks.end_time);
    }

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
    void assemble_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    bool join_zone(const ChangeSet<dim> &change) override;
    void apply_change(const ChangeSet<dim> &change, const bool loaded) override;
    void find_loads(Vector &loads, const double t) const override;

  private:
    using SolidOperator<dim>::body;
    using SolidOperator<dim>::nodes;
    using SolidOperator<dim>::unknowns;
    using SolidOperator<dim>::conditions;
    using SolidOperator<dim>::mass;
    using SolidOperator<dim>::stiffness_diagonal;
    using SolidOperator<dim>::thermal_loads;

    struct CellData;
    using Cell  = typename dealii::DoFHandler<dim>::active_cell_iterator;
    using Boxes = std::vector<dealii::BoundingBox<dim>>;

    /** Of cells alone, with rows of other processes; not compressed. */
    dealii::TrilinosWrappers::SparsityPattern element_pattern() const;

    void find_positions();
    void find_conditions();
    void assemble();
    void assemble_cell(CellData &data) const;
    void change_cell(const Cell &cell, CellData &data) const;
    void find_crack_factors();
    bool any_thermal() const;
    void add_thermal(const CellData &data, double &energy);
    void finish_thermal(const double energy);
    void find_thermal();
    void find_diagonal();
    bool scales_beside_cracks() const;
    void add_parts(const std::vector<Cell>         &of_cells,
                   const std::vector<unsigned int> &of_nodes,
                   const double                     multiple);
    /**
     * Take anew what is added to K by cells within a distance of boxes and by bonds within the
     * reach of a family. Collective.
     *
     * @param make_change between the old and the new ones; gets the cells, or null where all of the
     *                    body is taken anew
     */
    template <typename MakeChange>
    void mend(const Boxes &boxes, const double of_cells, const MakeChange &make_change);
    void throw_if_isolated() const;
    template <typename Visit>
    void for_each_own_cell(const Visit &visit) const;
    template <typename Visit>
    void for_each_load(const double t, const Visit &visit) const;

    const dealii::DoFHandler<dim>                 &dofs;
    std::unique_ptr<SolidBondsBesideElements<dim>> zone_bonds; // null: finite elements alone
    CutCells<dim>                                  cut_by_cracks;
    ConditionFaces<dim>                            condition_faces;
    const HangingNodes<dim>                        hanging;
    std::vector<PartUnknown<dim>>                  part_unknowns; // of regions and points
    std::vector<dealii::Point<dim>>                positions;
    dealii::TrilinosWrappers::SparseMatrix         stiffness;
    std::unique_ptr<CellData>                      cell_data;
    Vector                                         volumes;
    CrackSideFactors                               crack_factors;
    std::unique_ptr<CellSearch<dim>>               search;       // where cracks grow
    double                                         n_bonds = 0.; // of this process
    double thermal_energy = 0.; // of a body that is held everywhere
  };
} // namespace PeriDeal
