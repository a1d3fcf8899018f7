// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_table.h>
#include <perideal/operators/solid/deformed_rows.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <vector>

namespace PeriDeal
{
  /**
   * How far bonds are stretched by displacements: e = M . (u_j - u_i) - s x, s the mean thermal
   * strain of both ends, or with full kinematics Y = xi + u_j - u_i and e =
   * |Y| - x - s x. The force then acts along Y/|Y|, and the tangent of linearize() has W x Y/|Y| in
   * the place of W xi, and across the bond the stiffness force/|Y|.
   *
   * Displacements have up-to-date ghosts. Nothing is collective but where it says so.
   */
  template <int dim>
  class BondKinematics
  {
  public:
    using Bond = SolidBond<dim>;

    /** All have to outlive this object. */
    BondKinematics(const Families<dim>  &families,
                   const BondEnds<dim>  &ends,
                   BondTable<dim>       &bonds,
                   const ThermalStrains &thermal,
                   const bool            full);

    bool is_full() const
    {
      return full;
    }

    /** Extensions are no linear functions of displacements, for a thermal strain or a rotation. */
    bool is_strained() const
    {
      return full || thermal.any();
    }

    /** To be called once before the other functions, when bonds have their springs. */
    void take_positions();

    /** Thermal strains are others. */
    void take_thermal_strains();

    /** W x e of a bond of an owned node, thermal extension taken off. */
    double extension_moment(const double *u, const unsigned int i, const Bond &bond) const
    {
      if (is_strained())
        return strained_extension_moment(u, i, bond);
      const double *const far     = ends.value(u, bond.neighbor);
      double              product = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        product += bond.moment[d] * (far[d] - u[dim * i + d]);
      return product;
    }

    /** W x, with full kinematics. */
    double length(const Bond &bond) const
    {
      return bonds.rows_of(bond.number).lengths[bonds.place(bond.number)];
    }

    /** Force over length, with full kinematics, at the last linearize(). */
    double stiffness_across(const Bond &bond) const
    {
      return bonds.rows_of(bond.number).across[bonds.place(bond.number)];
    }

    /** tau = c theta/q of the owned nodes, from extensions. */
    void find_tensions(double *tau, const double *u, const NodeLaws<dim> &laws) const;

    /** y = -F of the deformed or warmer body, with tau = c theta/q. Collective. */
    void find_forces(Vector &y, const double *u, const Vector &tau) const;

    /** What the bonds of an owned node in the body pull at it by. */
    dealii::Tensor<1, dim> force_on(const unsigned int i, const double *u, const Vector &tau) const;

    /** find_forces() of single nodes in the body, with full kinematics. */
    void find_forces_of(const std::vector<unsigned int> &nodes,
                        double                          *y,
                        const double                    *u,
                        const Vector                    &tau) const;

    /**
     * What bonds of owned nodes store by their extensions, those that two nodes have in halves. Not
     * collective.
     */
    double energy_of_extensions(const double *u) const;

    /**
     * With full kinematics: find_forces() is to look for bonds with e/x above a limit, which each
     * owned node has.
     */
    void watch(std::vector<double> limits);

    /**
     * Whether bonds of owned nodes may be above their limits at u, by round-off; null: that has not
     * been looked at. Valid until the next call of a function that takes displacements.
     */
    const unsigned char *exceeding(const double *u) const;

    void linearize(const double *u, const Vector &tau);

    /** Adds to y what stiffness across bonds does. Collective. */
    void add_geometric_forces(Vector &y, const double *x) const;

    /** Of |Y|/x - 1, either sign, over unbroken bonds in the body. Collective. */
    double largest_stretch(const double *u) const;

    std::size_t memory_consumption() const;

  private:
    /** The rows of the body with these displacements, which are taken over, and tau, or null. */
    DeformedRows rows_at(const double *u, const Vector *tau) const;

    double strained_extension_moment(const double *u, const unsigned int i, const Bond &bond) const;

    template <typename Visit>
    void visit_beyond(const Visit &visit) const
    {
      for (const unsigned int i : bonds.beyond.nodes)
        bonds.for_each_beyond(i, [&](const Bond &bond) { visit(i, bond); });
    }

    /** Y, with full kinematics of the length W x, else W xi. */
    dealii::Tensor<1, dim> direction(const double *u, const unsigned int i, const Bond &bond) const;

    double force(const double *u, const unsigned int i, const Bond &bond, const Vector &tau) const;

    /** Take a force of a bond from y, and pull at the other node if that is a fictitious one. */
    void subtract(Vector                       &y,
                  const unsigned int            i,
                  const unsigned int            j,
                  const dealii::Tensor<1, dim> &force) const;

    const Families<dim>  &families;
    const BondEnds<dim>  &ends;
    BondTable<dim>       &bonds;
    const ThermalStrains &thermal;
    const bool            full;
    std::vector<double>   strains_beyond; // of the bonds to fictitious nodes; empty: none
    std::vector<double>   limits;         // of e/x; empty: none

    // Of owned nodes and ghosts, with full kinematics, for the loops over rows.
    mutable std::vector<DeformedRows::Node> nodes;
    mutable std::vector<unsigned char>      exceeds;
    mutable bool                            seen = false; // exceeds is that of these displacements
  };
} // namespace PeriDeal
