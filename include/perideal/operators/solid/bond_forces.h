// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_kinematics.h>
#include <perideal/operators/solid/deformed_rows.h>
#include <perideal/operators/solid/law_steps.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The two passes over bonds that any law takes, bond by bond: what a node makes of the extensions
   * of its bonds (tau), and the forces; their energy, and what the tangent needs (linearize(): W x
   * Y/|Y| in the place of W xi, across the bond the stiffness force/|Y|, slopes of the law). Bonds
   * are those of a BondTable, their law is the linear solid or that of LawSteps. With full
   * kinematics the linear solid takes several bonds at once (DeformedRows).
   *
   * Displacements have up-to-date ghosts. Nothing is collective but where it says so.
   */
  template <int dim>
  class BondForces
  {
  public:
    using Bond = SolidBond<dim>;

    /** All have to outlive this object. */
    BondForces(const Families<dim>       &families,
               const BondEnds<dim>       &ends,
               BondTable<dim>            &bonds,
               const NodeLaws<dim>       &laws,
               const LawSteps            &law,
               const BondKinematics<dim> &kinematics);

    /** Forces follow from extensions bond by bond, thermal ones included. */
    bool is_bond_by_bond() const
    {
      return kinematics.is_full() || law.any();
    }

    /** W x e* of a bond of an owned node; W x e of the linear solid. */
    double effective_moment(const double *u, const unsigned int i, const Bond &bond) const
    {
      return law.any() ? law->effective(values(u, i, bond), history(bond)) :
                         kinematics.extension_moment(u, i, bond);
    }

    /** Force over length, with full kinematics, at the last linearize(). */
    double stiffness_across(const Bond &bond) const
    {
      return bonds.rows_of(bond.number).nonlinear.across[bonds.place(bond.number)];
    }

    /** tau = c theta/q of the owned nodes, from extensions; with a law of e*. */
    void find_tensions(double *tau, const double *u) const;

    /** y = -F of the deformed or warmer body, with tau = c theta/q. Collective. */
    void find_forces(Vector &y, const double *u, const Vector &tau) const;

    /** What the bonds of an owned node in the body pull at it by. */
    dealii::Tensor<1, dim> force_on(const unsigned int i, const double *u, const Vector &tau) const;

    /** find_forces() of single nodes in the body, with full kinematics of the linear solid. */
    void find_forces_of(const std::vector<unsigned int> &nodes,
                        double                          *y,
                        const double                    *u,
                        const Vector                    &tau) const;

    /**
     * What bonds of owned nodes store by their extensions, those that two nodes have in halves, of
     * the linear solid. Not collective.
     */
    double energy_of_extensions(const double *u) const;

    /**
     * What these owned nodes have of all that bonds and dilatations store; or if the state is
     * @p accepted, what the law has dissipated in the step, whose histories then are those of u.
     * Collective.
     */
    double energy_of(const std::vector<unsigned int> &nodes,
                     const Vector                    &u,
                     const bool                       accepted = false) const;

    /**
     * With full kinematics of the linear solid: find_forces() is to look for bonds with e/x above a
     * limit, which each owned node has.
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

    /** The largest slope of a law at the last linearize(), at least 1. */
    double largest_slope() const;

    /** Adds to y what stiffness across bonds does. Collective. */
    void add_geometric_forces(Vector &y, const double *x) const;

    /**
     * What makes K another one: with full kinematics |Y|/x - 1 over unbroken bonds in the body, and
     * how far slopes of a law that is not linear are above 1. Collective.
     */
    double largest_stretch(const double *u) const;

    std::size_t memory_consumption() const;

    /** Of nodes of this process and ghosts, for laws that know it (BondLaw::knows_damage()). */
    std::vector<double> damage;

  private:
    BondValues values(const double *u, const unsigned int i, const Bond &bond) const
    {
      if (law->is_linear())
        return {kinematics.extension_moment(u, i, bond), 0.}; // what it is of matters not
      BondValues result = kinematics.values(u, i, bond);
      if (!damage.empty())
        result.damage = 0.5 * (damage[i] + damage[ends.origin(bond.neighbor)]);
      return result;
    }

    double *history(const Bond &bond) const
    {
      const bool is_beyond = (bond.number & BondTable<dim>::of_beyond) != 0;
      return (is_beyond ? bonds.beyond : bonds.body).nonlinear.history.data() +
             law.n_history() * bonds.place(bond.number);
    }

    /** The rows of the body with these displacements, which are taken over, and tau, or null. */
    DeformedRows rows_at(const double *u, const Vector *tau) const;

    template <typename Visit>
    void visit_beyond(const Visit &visit) const
    {
      for (const unsigned int i : bonds.beyond.nodes)
        bonds.for_each_beyond(i, [&](const Bond &bond) { visit(i, bond); });
    }

    double force(const double *u, const unsigned int i, const Bond &bond, const Vector &tau) const;

    /** Take a force of a bond from y, and pull at the other node if that is a fictitious one. */
    void subtract(Vector                       &y,
                  const unsigned int            i,
                  const unsigned int            j,
                  const dealii::Tensor<1, dim> &force) const;

    const Families<dim>       &families;
    const BondEnds<dim>       &ends;
    BondTable<dim>            &bonds;
    const NodeLaws<dim>       &laws;
    const LawSteps            &law;
    const BondKinematics<dim> &kinematics;
    std::vector<double>        limits; // of e/x; empty: none

    // Of owned nodes and ghosts, with full kinematics, for the loops over rows.
    mutable std::vector<DeformedRows::Node> nodes;
    mutable std::vector<unsigned char>      exceeds;
    mutable std::vector<double>             histories;    // of a node's bonds, summed
    mutable bool                            seen = false; // exceeds is that of these displacements
  };
} // namespace PeriDeal
