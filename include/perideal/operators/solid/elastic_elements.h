// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/parts/element_matrix.h>
#include <perideal/operators/parts/hanging_nodes.h>
#include <perideal/operators/solid/elastic_cells.h>
#include <perideal/operators/solid/element_loads.h>
#include <perideal/operators/solid/solid_bonds_beside_elements.h>
#include <perideal/operators/solid/solid_operator.h>
#include <perideal/operators/solid/zone_breaking.h>

#include <memory>

namespace PeriDeal
{
  /**
   * Linear elasticity with finite elements Qp (ElasticCells).
   *
   * One scalar DoFHandler numbers the nodes; each has dim unknowns, interleaved. Hanging nodes of a
   * graded mesh follow from their neighbours: K is C^T K C, and their rows, without mass, are those
   * of unknowns that are not free.
   *
   * With a coupling its bonds and families are added, with their thermal loads
   * (SolidBondsBesideElements), and the cells changed (Coupling); K is as symmetric as the
   * coupling. Of cells that a crack cuts nothing is left, so that in a zone the bonds around the
   * crack alone hold what they do.
   *
   * Where bonds may break (ZoneBreaking) they are no part of the matrix but a list beside it, and
   * what breaks or joins the zone changes only cells and rows beside it. The preconditioner is then
   * made for the elements of cells that are not cut, with the bonds between vertices of one cell;
   * with correspondence in the zone (NodalZone), for these elements alone.
   *
   * With another law than the linear one (NodalLaw) the bonds of the zone answer by it, and where
   * it relaxes the shear of the cells does: with S the part of K that the shear modulus multiplies,
   * F = K u + S (u* - u), u* what the law makes of the displacements.
   *
   * With a law of stresses at quadrature points (StressCells) forces and energies are those of the
   * law, and K is its tangent; preconditioners are made for the one before anything has happened.
   * Full kinematics, which have large deformations, are for such laws; the linear law is then one,
   * too (St. Venant and Kirchhoff's), and preconditioners are made for the tangent as it is.
   *
   * Where explicit steps follow rows of the matrix share their values (ElementMatrix).
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

    Spectrum spectrum() const override;
    bool     surrogate_is_exact() const override
    {
      return !breaking && !law && !(zone_bonds && body.elasticity.is_correspondence());
    }

    OperatorSize size() const override;
    bool         symmetric() const override
    {
      return this->stepping.symmetric_law && (!zone_bonds || zone_bonds->coupling().symmetric());
    }

    bool zone_follows_cracks() const override
    {
      return zone_bonds && zone_bonds->coupling().zone_follows_cracks() &&
             (this->has_growing_cracks() || (breaking && body.coupling.follows_stretches()));
    }

    const BreakHistory *break_history() const override
    {
      return breaking ? breaking->history() : nullptr;
    }

    bool nonlinear() const override
    {
      return cells.is_full() || (cells.stresses && body.material.law.kind != SolidLaw::linear) ||
             (law && !law->nodal.steps->is_linear());
    }

    void   linearize(const Vector &u) override;
    double largest_stretch(const Vector &u) const override;
    void   accept(const Vector &u, const double t) override;

    std::vector<NodePair> broken_since(std::size_t &n_known) const override
    {
      return breaking ? breaking->broken_since(n_known) : std::vector<NodePair>();
    }

    unsigned long long break_bonds(const Vector &u, const double t, const double share) override;
    bool               widen_zone(const Vector &u) override;
    void               mend_unbalanced(Vector &r, const Vector &u, const double t) const override;

    double stretch_over_critical(const Vector &u, const double t) override
    {
      return breaking ? breaking->stretch_over_critical(u, t) : 0.;
    }

    /** Damage these bonds of the zone, named alike by all processes, at the state u. Collective. */
    void break_bonds(const std::vector<DamagedBond> &list, const Vector &u, const double t);

    std::pair<unsigned long long, std::string> stretched_outside(const Vector &u) const override
    {
      return breaking ? breaking->stretched_outside(u, cells.dof_handler()) :
                        std::pair<unsigned long long, std::string>();
    }

    /** Null: no bonds may break; none, or no cell, has another law than the linear one. */
    struct Beside
    {
      const ZoneBreaking<dim> *breaking;
      const NodalLaw          *law;
      const StressCells<dim>  *stresses;
    };

    /** Not collective. */
    Beside beside() const
    {
      return {breaking.get(), law ? &law->nodal : nullptr, cells.stresses.get()};
    }

    ForceBalance forces(const Vector &u, const double t) const override;
    double       energy(const Vector &u) const override;
    void         multiply(Vector &y, const Vector &x) const override;

    void distribute(Vector &u, const double t) const override
    {
      conditions->distribute(u, t, this->stepping.load_factor);
      hanging.interpolate(u);
    }

    void      set_temperature_change(const Vector &nodal) override;
    Inversion inverted(const Vector &u) const override;

    const dealii::Point<dim> &position(const unsigned int node) const override
    {
      return positions[node];
    }

    /** The layout of vectors with one number for each node. */
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &node_layout() const
    {
      return nodes;
    }

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

    /** Cells of this process that keep nothing, by active cell index. */
    const std::vector<bool> &cut_cells() const
    {
      return cells.cut();
    }

    /** Nodes join that will do so on the whole path of the cracks; K stays as it is. Collective. */
    void join_whole_way()
    {
      zone_bonds->coupling().join(body.cracks.end_time);
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
    double lowest_remainder() const
    {
      return dealii::Utilities::MPI::min(cells.lowest_remainder(), nodes->get_mpi_communicator());
    }

  protected:
    void assemble_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    bool join_zone(const ChangeSet<dim> &change) override;
    void apply_change(const ChangeSet<dim> &change, const bool loaded) override;
    void find_forces(Vector &y, const Vector &u, const double t) const override;
    void find_loads(Vector &loads, const double t) const override;
    void surrogate_made() const override
    {
      if (breaking)
        breaking->keep_zone();
    }

    void exchange_bonds(Archive                     &archive,
                        const NodeKeys              &keys,
                        const std::function<void()> &at_surrogate) override;

  private:
    using SolidOperator<dim>::body;
    using SolidOperator<dim>::contact;
    using SolidOperator<dim>::nodes;
    using SolidOperator<dim>::unknowns;
    using SolidOperator<dim>::conditions;
    using SolidOperator<dim>::mass;
    using SolidOperator<dim>::stiffness_diagonal;
    using SolidOperator<dim>::thermal_loads;

    using Cell  = typename ElasticCells<dim>::Cell;
    using Boxes = typename ElasticCells<dim>::Boxes;

    void find_conditions();
    /** Of K: the cells, and bonds now in the zone or those of all nodes that may ever join it. */
    dealii::TrilinosWrappers::SparsityPattern pattern(const bool with_bonds, const bool ever) const;
    /** @param thermal_alone thermal loads, of K as it is; else all that is there */
    void assemble(const bool thermal_alone);
    void find_diagonal();
    /**
     * Add a multiple of what cells and rows of bonds have of K.
     * @param u null, or where bonds break: ghosts are up to date; what is added to forces and
     *          thermal loads, too. Returns the energy at u of what is added.
     */
    double add_parts(const std::vector<Cell>         &of_cells,
                     const std::vector<unsigned int> &rows,
                     const double                     multiple,
                     const Vector                    *u = nullptr);
    /**
     * Take anew what is added to K by cells within a distance of boxes and by bonds within the
     * reach of a family. Collective.
     *
     * @param make_change between the old and the new ones; gets the cells, or null where all of the
     *                    body is taken anew
     */
    template <typename MakeChange>
    void mend(const Boxes &boxes, const double of_cells, const MakeChange &make_change);
    /**
     * Change what breaking bonds and a growing zone do to cells within a distance of boxes and to
     * rows of bonds. Returns the energy that is released at u, whose ghosts are up to date.
     * Collective.
     */
    double mend_zone(const Boxes                     &boxes,
                     const double                     of_cells,
                     const std::vector<unsigned int> &rows,
                     const Vector                    &u,
                     const std::function<void()>     &make_change);
    /** Let nodes join the zone where u, whose ghosts are up to date, stretches the body. */
    bool join_stretched(const Vector &u);

    std::unique_ptr<SolidBondsBesideElements<dim>> zone_bonds; // null: finite elements alone
    std::unique_ptr<ZoneBreaking<dim>>             breaking;   // null: no bonds may break
    ElasticCells<dim>                              cells;
    HangingNodes<dim>                              hanging;
    const ElementLoads<dim>                        mechanical;
    std::vector<dealii::Point<dim>>                positions;
    mutable ElementMatrix<dim, dim>                stiffness;
    Vector                                         volumes;
    double                                         n_bonds = 0.; // of this process
    double thermal_energy = 0.; // of a body that is held everywhere

    /** Of K u, by what broke or joined at the last u. */
    mutable struct
    {
      Vector forces;
      bool   any = false;
    } changes;

    struct Law
    {
      NodalLaw                nodal;
      ElementMatrix<dim, dim> shear;          // S, if the law relaxes
      mutable Vector          change, forces; // by it; memory
    };
    std::unique_ptr<Law> law; // null: the linear one
  };
} // namespace PeriDeal
