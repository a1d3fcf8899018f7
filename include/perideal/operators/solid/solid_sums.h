// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_table.h>

#include <memory>

namespace PeriDeal
{
  template <int dim>
  class StateLattice;


  /**
   * Sums of the linear peridynamic solid over all bonds of a BondTable, that an application takes:
   * linear in the displacements. Where nodes store no bonds a convolution on the lattice finds
   * them. Displacements have up-to-date ghosts.
   */
  template <int dim>
  class SolidSums
  {
  public:
    /** All have to outlive this object, which knows no lattice yet. */
    SolidSums(const Families<dim>  &families,
              const BondEnds<dim>  &ends,
              const BondTable<dim> &bonds,
              const NodeLaws<dim>  &laws);
    ~SolidSums();

    /**
     * Once q is final, and on ghosts: take over those nodes that store no bonds.
     * @param c_is_1 tensions are those of c = 1, forces those of any tensions
     */
    void take_lattice(const bool c_is_1 = false);

    bool has_lattice() const
    {
      return lattice != nullptr;
    }

    /** The family of an owned node and those of its neighbours are like most others. */
    bool is_regular(const unsigned int i) const;

    /** tau of the owned nodes, of c or 1, thermal strains left aside. Not collective. */
    void find_tensions(double *tau, const double *u) const;

    /**
     * y = -F, of the tangent with full kinematics. tau of owned and ghost nodes is that of the last
     * find_tensions(), or null: only what the extensions of bonds do. Collective.
     */
    void find_forces(Vector &y, const double *u, const double *tau) const;

    /** y = -F of tensions of owned and ghost nodes alone, without extensions. Collective. */
    void find_forces_of_tensions(Vector &y, const double *tau) const;

    std::size_t memory_consumption() const;

  private:
    /** Those that are not gone: visit(j, p, s, w), W xi = w p, the spring s/w. */
    template <bool is_beyond, typename Visit>
    void visit_parts(const BondRows<dim> &rows, const std::size_t row, const Visit &visit) const;

    const Families<dim>               &families;
    const BondEnds<dim>               &ends;
    const BondTable<dim>              &bonds;
    const NodeLaws<dim>               &laws;
    std::unique_ptr<StateLattice<dim>> lattice; // or none
    bool                               c_is_1 = false;
  };
} // namespace PeriDeal
