// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/operators/diffusion/field_operator.h>
#include <perideal/operators/diffusion/heat_surface_factors.h>
#include <perideal/operators/diffusion/node_constraints.h>
#include <perideal/operators/lattice/bond_term.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What the bonds of peridynamic nodes conduct, sum_j W_ij (u_i - u_j) (Bobaru 2012 eq 12 times
   * the node's volume): those with the fictitious nodes beyond the sides of a body among them, and
   * what flows through the sides by these. Vectors have the horizon-wide halo of the nodes.
   *
   * The arguments of the constructor must outlive this. Not collective unless stated.
   */
  template <int dim>
  class ExtendedBondTerm : public BondTerm<dim>
  {
  public:
    using typename Term<dim>::At;
    using typename Term<dim>::Rows;

    /** take_bonds() has to be called. Collective. Throws UserError. */
    ExtendedBondTerm(Nodes<dim> &nodes, const BodyParameters<dim> &body);

    /**
     * Find surface factors, and make the form of the bonds. Throws UserError for one that does not
     * suit. Collective.
     */
    void take_bonds();

    const DiffusionBonds<dim> &diffusion_bonds() const
    {
      return bonds;
    }

    /** The nodes that are not free. */
    const std::shared_ptr<NodeConstraints<dim>> &constraints() const
    {
      return prescribed;
    }

    /** Which form is in use, and why, for the user. */
    const std::string &form_note() const
    {
      return note;
    }

    /**
     * The fictitious nodes' values, which stay until the next call; ghosts of u are up to date. As
     * many as there are such nodes.
     */
    const std::vector<double> &values(const At &at) const;

    void update_rows(const Rows &rows) override;
    void update_conductivities() override;

    /** Collective. */
    void begin(const At &at, double &entering) const override;

    bool symmetric() const override
    {
      return bonds.symmetric();
    }

    Mended apply_change(const ChangeSet<dim> &change) override;
    void   take_material_at(const Vector &u) override;

    /** Free nodes have bonds, unless damage has taken them: such nodes keep their heat. */
    void require_held(const RowsOfK &of_all) const override;

    /** The graph of nearest neighbours. */
    void make_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix,
                        const Vector                           &others) const override;

    /**
     * What flows in by the sides of this process, with what prescribed nodes get from beyond under
     * their own condition. Collective.
     */
    void add_flows(Balance &balance, const At &at) const override;

    void add_to(OperatorSize &size) const override;

  private:
    const double *beyond() const override
    {
      return outside.data();
    }

    /** Call visit(node, bonds) for the owned nodes that may have bonds with fictitious nodes. */
    template <typename Visit>
    void for_each_family(const Visit &visit) const;

    bool reaches_outside(const unsigned int node) const;
    void find_sums() const;
    void update_crack_sides();
    void add_flows_through_sides(Balance &balance, const At &at) const;

    /** Conductances of bonds with fictitious nodes: their sums, so that flows are sums of nodes. */
    struct Sums
    {
      bool                                         known = false;
      std::vector<double>                          of_outside; // by fictitious node
      std::vector<std::pair<unsigned int, double>> of_nodes;
    };

    const BodyParameters<dim>                  &body;
    Families<dim>                               families;
    DiffusionBonds<dim>                         bonds;
    const std::shared_ptr<NodeConstraints<dim>> prescribed;
    HeatSurfaceFactors<dim>                     factors;
    std::string                                 note;
    mutable std::vector<double>                 outside;
    mutable Sums                                outside_sums;
  };


  /**
   * Peridynamics alone: bonds and sides of its nodes, with the loads of NodeLoads.
   *
   * @param nodes get the horizon-wide halo; they and the body must outlive the operator
   *
   * Collective. Throws UserError, among others for isolated nodes, a storage that is not positive,
   * a form that does not suit.
   */
  template <int dim>
  std::unique_ptr<FieldOperator<dim>> field_of_bonds(Nodes<dim>                &nodes,
                                                     const BodyParameters<dim> &body);

  /** The bonds of what field_of_bonds() has made. */
  template <int dim>
  const ExtendedBondTerm<dim> &bonds_of(const FieldOperator<dim> &field)
  {
    return dynamic_cast<const ExtendedBondTerm<dim> &>(field.first_term());
  }
} // namespace PeriDeal
