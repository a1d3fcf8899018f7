// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/operators/diffusion/prescribed_values.h>
#include <perideal/operators/lattice/bond_term.h>

#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Bonds of nodes, those with the fictitious nodes beyond the sides of a body among them, and what
   * flows through the sides by these. Nothing where there are none.
   *
   * The arguments of the constructor must outlive this. Not collective unless stated.
   */
  template <int dim>
  class ExtendedBondTerm : public BondTerm
  {
  public:
    ExtendedBondTerm(const DiffusionBonds<dim>     &bonds,
                     const PrescribedValues<dim>   &prescribed,
                     const BoundaryConditions<dim> &conditions);

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

    /**
     * What flows in by the sides of this process, with what prescribed nodes get from beyond under
     * their own condition. Collective.
     */
    void add_flows(Balance &balance, const At &at) const override;

    /** Of the last values. */
    double value_beyond(const unsigned int fictitious) const
    {
      return outside[fictitious];
    }

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

    /** Conductances of bonds with fictitious nodes: their sums, so that flows are sums of nodes. */
    struct Sums
    {
      bool                                         known = false;
      std::vector<double>                          of_outside; // by fictitious node
      std::vector<std::pair<unsigned int, double>> of_nodes;
    };

    const DiffusionBonds<dim>     &bonds;
    const PrescribedValues<dim>   &prescribed;
    const BoundaryConditions<dim> &conditions;
    mutable std::vector<double>    outside;
    mutable Sums                   outside_sums;
  };
} // namespace PeriDeal
