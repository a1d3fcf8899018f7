// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/bond_law.h>
#include <perideal/operators/solid/bond_table.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <vector>

namespace PeriDeal
{
  /**
   * How far bonds are stretched by displacements: e = M . (u_j - u_i) - s x, s the mean thermal
   * strain of both ends, or with full kinematics Y = xi + u_j - u_i and e =
   * |Y| - x - s x. The force then acts along Y/|Y|.
   *
   * Displacements have up-to-date ghosts, and those of fictitious nodes have been found
   * (BondEnds::find()). Not collective.
   */
  template <int dim>
  class BondKinematics
  {
  public:
    using Bond = SolidBond<dim>;

    /** All have to outlive this object. */
    BondKinematics(const Families<dim>  &families,
                   const BondEnds<dim>  &ends,
                   const BondTable<dim> &bonds,
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

    const ThermalStrains &strains() const
    {
      return thermal;
    }

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

    /** The same with W x^2, as laws see them, without damage. */
    BondValues values(const double *u, const unsigned int i, const Bond &bond) const
    {
      const dealii::Tensor<1, dim> xi = ends.vector(i, bond.neighbor);
      const double                 x  = xi.norm();
      return {extension_moment(u, i, bond), full ? length(bond) * x : bond.moment * xi, 0., x};
    }

    /** Y, with full kinematics of the length W x, else W xi. */
    dealii::Tensor<1, dim> direction(const double *u, const unsigned int i, const Bond &bond) const;

    /** W x, with full kinematics. */
    double length(const Bond &bond) const
    {
      return bonds.rows_of(bond.number).nonlinear.lengths[bonds.place(bond.number)];
    }

    std::size_t memory_consumption() const
    {
      return strains_beyond.capacity() * sizeof(double);
    }

  private:
    double strained_extension_moment(const double *u, const unsigned int i, const Bond &bond) const;

    const Families<dim>  &families;
    const BondEnds<dim>  &ends;
    const BondTable<dim> &bonds;
    const ThermalStrains &thermal;
    const bool            full;
    std::vector<double>   strains_beyond; // of the bonds to fictitious nodes; empty: none
  };
} // namespace PeriDeal
