// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/diffusion_operator_base.h>
#include <perideal/operators/diffusion/heat_surface_factors.h>
#include <perideal/operators/diffusion/node_loads.h>
#include <perideal/operators/diffusion/outside_flow.h>
#include <perideal/operators/lattice/bond_form.h>

#include <memory>

namespace PeriDeal
{
  /**
   * Peridynamic diffusion: rho c V_i dT_i/dt = sum_j W_ij (T_j - T_i) + loads (Bobaru 2012 eq 12
   * times the node's volume).
   *
   * Loads are those of NodeLoads. Vectors have the horizon-wide halo of the nodes.
   */
  template <int dim>
  class BondOperator : public DiffusionOperatorBase<dim>
  {
  public:
    using RowsAction = Operator::RowsAction;

    /** Throws UserError for a body that it cannot compute. Not collective. */
    static void require(const BodyParameters<dim> &body);

    /**
     * Collective. Throws UserError, among others for isolated nodes, a storage that is not
     * positive, a form that does not suit.
     */
    BondOperator(Nodes<dim> &nodes, const BodyParameters<dim> &body);

    void apply_then(Vector &y, const Vector &x, const RowsAction &finish) const override;
    void residual_then(Vector           &r,
                       const Vector     &u,
                       const double      t,
                       const RowsAction &finish) const override;
    void distribute(Vector &u, const double t) const override
    {
      constraints.distribute(u, t);
    }

    void distribute_homogeneous(Vector &x) const override
    {
      constraints.distribute_homogeneous(x);
    }

    void clear_constrained(Vector &y) const override
    {
      constraints.mask(y);
    }

    bool symmetric() const override
    {
      return bonds.symmetric() && !constraints.any_slave();
    }

    bool depends_on_time() const override
    {
      return loads.depends_on_time();
    }

    bool has_steady_state() const override;
    void surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    bool surrogate_is_exact() const override
    {
      return false;
    }

    void         heat_between(Vector &y, const Vector &u, const Vector &v) const override;
    void         take_material_at(const Vector &u) override;
    OperatorSize size() const override;

    const DiffusionBonds<dim> &diffusion_bonds() const
    {
      return bonds;
    }

    /** Which form is in use, and why, for the user. */
    const std::string &form_note() const
    {
      return note;
    }

    /** Values of the fictitious nodes for given node values (ghosts up to date) at time t. */
    void fictitious_values(const Vector &u, const double t, std::vector<double> &values) const
    {
      outside.values(u, t);
      values = outside.last_values();
    }

  protected:
    bool apply_change(const ChangeSet<dim> &change) override;
    void find_flows(Balance &balance, Vector &heat, const Vector &u, const double t) const override;
    dealii::Point<dim> position(const unsigned int local_index) const override
    {
      return bonds.nodes().position(local_index);
    }

  private:
    using DiffusionOperatorBase<dim>::body;
    using DiffusionOperatorBase<dim>::capacity;
    using DiffusionOperatorBase<dim>::stiffness_diagonal;
    using DiffusionOperatorBase<dim>::bounds;

    void choose_form(const OperatorForm wanted);
    void find_capacity(const Vector *u);
    void find_diagonal();
    void update_crack_sides();
    void add_crack_heat(const Vector &u, Balance &balance) const;

    /** Throws UserError for free nodes without bonds, by sums over bonds. Collective. */
    template <typename Rows>
    void throw_if_isolated(const Rows &rows) const;

    /** Gershgorin's bound of these rows on all processes. Collective. */
    template <typename Rows>
    double largest_rate(const Rows &rows) const;

    Families<dim>             families;
    DiffusionBonds<dim>       bonds;
    NodeConstraints<dim>      constraints;
    const NodeLoads<dim>      loads;
    OutsideFlow<dim>          outside;
    HeatSurfaceFactors<dim>   factors;
    std::unique_ptr<BondForm> form;
    std::string               note;
    mutable double            n_own_bonds = -1.; // of this process; negative: to be counted
    mutable Vector            scratch;
  };
} // namespace PeriDeal
