// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/bond_kinematics.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The thermal strain of a bond to a fictitious node. */
    template <int dim>
    double strain_beyond(const Nodes<dim>     &nodes,
                         const BondEnds<dim>  &ends,
                         const ThermalStrains &thermal,
                         const unsigned int    i,
                         const unsigned int    j)
    {
      // What a temperature linear in space does to a free body is no linear displacement. The bond
      // has no force then if its extension is that of what the image follows from, at r_k from the
      // node: e = sum f_k (s_k M.r_k - r_k^2/2 ds/dM), the mean of both ends for a mirror image.
      const Point<dim>     at  = nodes.position(i);
      const Tensor<1, dim> xi  = ends.vector(i, j);
      double               own = thermal[i], other = 0., mean = 0., half = 0., rest = 1.;
      ends.images->for_each_term(ends.image(j), [&](const auto &term) {
        Tensor<1, dim> r = nodes.position(term.node) - at;
        for (unsigned int d = 0; d < dim; ++d)
          r[d] = (term.mirrored >> d) & 1 ? xi[d] : r[d];
        const double f = term.factor / xi.norm_square(), s = thermal[term.node];
        other += term.factor * s;
        mean += f * s * (r * xi);
        half += 0.5 * f * r.norm_square();
        rest -= f * (r * xi);
      });
      // A body narrower than a family mirrors and continues along one axis: no such sum.
      mean -= half * (other - own);
      return std::abs(rest) > 1e-6 ? 0.5 * (own + other) : mean;
    }
  } // namespace


  template <int dim>
  BondKinematics<dim>::BondKinematics(const Families<dim>  &families,
                                      const BondEnds<dim>  &ends,
                                      const BondTable<dim> &bonds,
                                      const ThermalStrains &thermal,
                                      const bool            full)
    : families(families)
    , ends(ends)
    , bonds(bonds)
    , thermal(thermal)
    , full(full)
  {}


  template <int dim>
  void BondKinematics<dim>::take_thermal_strains()
  {
    strains_beyond.resize(thermal.any() ? bonds.beyond.size() : 0);
    if (thermal.any())
      for (const unsigned int i : bonds.beyond.nodes)
        bonds.for_each_beyond(i, [&](const Bond &bond) {
          strains_beyond[bonds.place(bond.number)] =
            strain_beyond(families.nodes(), ends, thermal, i, bond.neighbor);
        });
  }


  template <int dim>
  double BondKinematics<dim>::strained_extension_moment(const double      *u,
                                                        const unsigned int i,
                                                        const Bond        &bond) const
  {
    const Tensor<1, dim> xi     = ends.vector(i, bond.neighbor);
    const Tensor<1, dim> eta    = ends.change(u, i, bond.neighbor);
    double               strain = thermal.of_bond(i, ends.origin(bond.neighbor));
    if (ends.is_fictitious(bond.neighbor))
      strain = strains_beyond.empty() ? 0. : strains_beyond[bonds.place(bond.number)];
    if (!full)
      return bond.moment * eta - strain * (bond.moment * xi);
    // |Y| - |xi| without the difference of two nearly equal numbers
    const double x = xi.norm();
    return length(bond) * ((2. * xi + eta) * eta / ((xi + eta).norm() + x) - strain * x);
  }


  template <int dim>
  Tensor<1, dim> BondKinematics<dim>::direction(const double      *u,
                                                const unsigned int i,
                                                const Bond        &bond) const
  {
    if (!full)
      return bond.moment;
    const Tensor<1, dim> along = ends.vector(i, bond.neighbor) + ends.change(u, i, bond.neighbor);
    return length(bond) / along.norm() * along;
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondKinematics);
} // namespace PeriDeal
