// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_kinematics.h>
#include <perideal/operators/solid/fictitious_bonds.h>

#include <limits>
#include <memory>

namespace PeriDeal
{
  /**
   * The bonds of the linear peridynamic solid, inside the body and beyond its sides, with what
   * their forces follow from.
   */
  template <int dim>
  struct SolidBonds
  {
    /** Throws UserError for a body that cannot have them. Not collective. */
    static void require(const BodyParameters<dim> &body);

    /** Adds the halo to the nodes. Collective. Throws UserError, among others: isolated nodes. */
    SolidBonds(Nodes<dim> &nodes, const BodyParameters<dim> &body);

    SolidBonds(const SolidBonds &) = delete;

    /**
     * Let the cracks be those of a later time: bonds that they cut bear nothing any more, and q and
     * the springs that follow from it are those of the bonds that are left, as if the cracks had
     * been there from the start. Collective. Throws UserError: nodes without hold.
     * @param state  of the stored bonds
     * @param marked it has what is cut already, and bonds have been released
     */
    void apply_change(const ChangeSet<dim> &change, BondState &state, const bool marked);

    Families<dim>       families;
    NodeLaws<dim>       laws;
    ThermalStrains      thermal;
    SolidRows<dim>      rows;
    BondKinematics<dim> kinematics;
    // Of a mesh: least thickness of the body behind free sides, where it is thin (thin_on_mesh()).
    double                                thinnest = std::numeric_limits<double>::infinity();
    std::unique_ptr<FictitiousBonds<dim>> beyond; // or none, on all processes

  private:
    bool       has_parted(const unsigned int i, const BondState &state) const; // since the start
    void       part(const unsigned int i, const double t, BondState &state);
    void       renew_weights(const std::vector<unsigned int> &of_nodes, const BondState &state);
    const bool weights_follow; // q is that of the family, and not of a complete one
  };
} // namespace PeriDeal
