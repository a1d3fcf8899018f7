// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_state.h>
#include <perideal/operators/solid/solid_rows.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <vector>

namespace PeriDeal
{
  /**
   * How far bonds between nodes of the body are stretched by displacements: e = M . (u_j - u_i) - s
   * x, s the mean thermal strain of both ends, or with full kinematics Y = xi + u_j - u_i and e =
   * |Y| - x - s x. The force then acts along Y/|Y|, and the tangent of linearize() has W x Y/|Y| in
   * the place of W xi, and across the bond the stiffness force/|Y|.
   *
   * Displacements have up-to-date ghosts. Nothing is collective but where it says so.
   */
  template <int dim>
  class BondKinematics
  {
  public:
    using Bond = typename SolidRows<dim>::Bond;

    /** All have to outlive this object. */
    BondKinematics(const Families<dim>  &families,
                   SolidRows<dim>       &rows,
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

    /** To be called once before the other functions, with the rows of the undeformed body. */
    void keep_lengths();

    /** W x e of a bond of an owned node, thermal extension taken off. */
    double extension_moment(const double *u, const unsigned int i, const Bond &bond) const
    {
      if (is_strained())
        return strained_extension_moment(u, i, bond);
      double product = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        product += bond.moment[d] * (u[dim * bond.neighbor + d] - u[dim * i + d]);
      return product;
    }

    /** W x, with full kinematics. */
    double length(const Bond &bond) const
    {
      return lengths[bond.number];
    }

    /** Force over length, with full kinematics, at the last linearize(). */
    double stiffness_across(const Bond &bond) const
    {
      return across[bond.number];
    }

    /** tau = c theta/q of the owned nodes, from extensions. */
    void find_tensions(double *tau, const double *u, const NodeLaws<dim> &laws) const;

    /** y = -F of the deformed body, with tau = c theta/q. */
    void find_forces(Vector &y, const double *u, const Vector &tau) const;

    /** The same of single nodes, with full kinematics. y are those of the owned nodes. */
    void find_forces_of(const std::vector<unsigned int> &nodes,
                        double                          *y,
                        const double                    *u,
                        const Vector                    &tau) const;

    /**
     * Sum of (W x e)^2 spring/4 over the bonds of owned nodes: of their energy what is none of
     * dilatations. Not collective.
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

    /** Thermal strains are others. */
    void forget_exceeding()
    {
      seen = false;
    }

    void linearize(const double *u, const Vector &tau);

    /** Adds to y what stiffness across bonds does. */
    void add_geometric_forces(Vector &y, const double *x, const BondState &state) const;

    /** Of |Y|/x - 1, either sign, over unbroken bonds. Collective. */
    double largest_stretch(const double *u) const;

    /** Let a bond bear nothing any more. */
    void release(const std::size_t number);

    std::size_t memory_consumption() const;

  private:
    void         take(const double *u, const Vector *tau) const;
    DeformedRows all_rows() const;
    double strained_extension_moment(const double *u, const unsigned int i, const Bond &bond) const;
    dealii::Tensor<1, dim> deformed_bond(const double      *u,
                                         const unsigned int i,
                                         const unsigned int j) const;

    const Families<dim>  &families;
    SolidRows<dim>       &rows;
    const ThermalStrains &thermal;
    const bool            full;
    std::vector<double>   lengths, across; // of the stored bonds
    std::vector<double>   limits;          // of e/x; empty: none

    // Of owned nodes and ghosts, with full kinematics, for the loops over rows.
    mutable std::vector<DeformedRows::Node> nodes;
    mutable std::vector<unsigned char>      exceeds;
    mutable bool                            seen = false; // exceeds is that of these displacements
  };
} // namespace PeriDeal
