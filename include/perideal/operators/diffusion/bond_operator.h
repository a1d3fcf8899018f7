// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/extended_bond_term.h>
#include <perideal/operators/diffusion/field_operator.h>
#include <perideal/operators/diffusion/heat_surface_factors.h>
#include <perideal/operators/diffusion/node_loads.h>
#include <perideal/operators/diffusion/side_term.h>

namespace PeriDeal
{
  /**
   * Peridynamic diffusion: rho c V_i dT_i/dt = sum_j W_ij (T_j - T_i) + loads (Bobaru 2012 eq 12
   * times the node's volume).
   *
   * Loads are those of NodeLoads. Vectors have the horizon-wide halo of the nodes.
   */
  template <int dim>
  class BondOperator : public FieldOperator<dim>
  {
  public:
    /**
     * Collective. Throws UserError, among others for isolated nodes, a storage that is not
     * positive, a form that does not suit.
     */
    BondOperator(Nodes<dim> &nodes, const BodyParameters<dim> &body);

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
      values = bond_term.values({u, t});
    }

  protected:
    bool   apply_change(const ChangeSet<dim> &change) override;
    void   make_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    void   add_crack_heat(Balance &balance, const Vector &u) const override;
    double content(const Vector &u) const override;
    bool   counts(const unsigned int row) const override
    {
      return constraints.kind(row) == NodeConstraints<dim>::free;
    }

    dealii::Point<dim> position(const unsigned int local_index) const override
    {
      return bonds.nodes().position(local_index);
    }

  private:
    using typename FieldOperator<dim>::Rows;
    using DiffusionOperatorBase<dim>::body;
    using DiffusionOperatorBase<dim>::capacity;
    using DiffusionOperatorBase<dim>::stiffness_diagonal;
    using DiffusionOperatorBase<dim>::bounds;

    void choose_form(const OperatorForm wanted);
    void find_capacity(const Vector *u);
    void update_crack_sides();

    /** Throws UserError for free nodes without bonds. Collective. */
    void throw_if_isolated(const Rows &rows) const;

    Families<dim>           families;
    DiffusionBonds<dim>     bonds;
    NodeConstraints<dim>    constraints;
    const NodeLoads<dim>    loads;
    ExtendedBondTerm<dim>   bond_term;
    SideTerm<dim>           side_term;
    HeatSurfaceFactors<dim> factors;
    std::string             note;
  };
} // namespace PeriDeal
