// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_conductivities.h>
#include <perideal/bonds/families.h>
#include <perideal/bonds/node_factors.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The bonds of each node, one family at a time: who is bonded to whom and with which conductance.
   * This is the plain definition of the peridynamic model, from which both forms of the operator
   * are built.
   *
   * The heat that flows from j to i is W_ij (T_j - T_i) with
   *
   *   W_ij = V_i V_j w(xi) k_ij g_ij t_ij,   w = kernel * volume fraction / r^n
   *
   * (power; 2D per unit thickness, 1D per unit area), k_ij the bond's conductivity by the interface
   * rule, t_ij the cracks' transmission, g_ij the surface correction. `Self term = paper` adds
   * V_i^2 s(xi) k_ij for the touching neighbours, with the node's own volume; only then W is not
   * symmetric. Numbers of neighbours and the order of a family are those of Neighbors.
   */
  template <int dim>
  class DiffusionBonds
  {
  public:
    struct Bond
    {
      unsigned int neighbor;
      double       weight; // W_ij as above
      double       intact; // W_ij without t_ij and g_ij
      bool         cut;    // some crack separates the nodes
    };

    /**
     * Collective. Throws UserError for conductivities that are not positive. Families have to
     * outlive this object.
     */
    DiffusionBonds(Families<dim> &families, const BodyParameters<dim> &body);

    /**
     * The family of an owned node, in its fixed order. @p bonds is overwritten, its memory is
     * reused.
     */
    void bonds_of(const unsigned int node,
                  std::vector<Bond> &bonds,
                  const bool         with_self_term = true) const;

    /**
     * The same for any node known here: the bonds whose other ends are known here, too. Without
     * self term.
     */
    void known_bonds_of(const unsigned int node, std::vector<Bond> &bonds) const;

    /**
     * On a lattice only: the bonds to neighbours one spacing away along an axis, without self term.
     * Else as bonds_of().
     */
    void nearest_bonds_of(const unsigned int node, std::vector<Bond> &bonds) const;

    const Families<dim> &families() const
    {
      return own_families;
    }

    // Of the families.
    const Nodes<dim>     &nodes() const;
    const Neighbors<dim> &neighbors() const
    {
      return topology;
    }
    const KernelWeights<dim> &weights() const;

    /** The material along a bond. */
    const BondConductivities<dim> &conductivities() const
    {
      return material;
    }
    BondConductivities<dim> &conductivities();

    /** The cracks as they are now. Node factors stay as they are when these change. */
    const CrackSet<dim> &cracks() const;
    CrackSet<dim>       &cracks();

    /** Bonds are multiplied by these. */
    NodeFactors<dim> &factors();

    /** Surface correction by energy: bonds everywhere may have factors. */
    bool corrects_every_bond() const
    {
      return corrects_all;
    }

    /** Some bond of this node may cross a crack, or be scaled for one. */
    bool near_crack(const unsigned int node) const;

    /**
     * What the cracks leave of a bond's conductance, and whether it crosses any.
     * @param of_way as CrackSet::kept_fraction() has it
     */
    double kept_fraction(const unsigned int node,
                         const unsigned int neighbor,
                         bool              &cut,
                         const bool         of_way = false) const;

    /** Whether W is symmetric. */
    bool symmetric() const;

    /** Without that of the families. */
    std::size_t memory_consumption() const;

  private:
    void add_bond(const unsigned int node,
                  const unsigned int neighbor,
                  const double       w,
                  std::vector<Bond> &bonds) const;
    void add_self_term(const unsigned int node, std::vector<Bond> &bonds) const;

    Families<dim>          &own_families;
    const Neighbors<dim>   &topology;
    BondConductivities<dim> material;
    NodeFactors<dim>        node_factors;
    const bool              corrects_all;
  };
} // namespace PeriDeal
