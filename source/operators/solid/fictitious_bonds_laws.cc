// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What the bonds beyond the sides bear: which of them cracks cut, springs, thermal strains.

#include <perideal/operators/solid/fictitious_bonds.h>
#include <perideal/operators/solid/fictitious_cuts.h>

#include <cmath>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void FictitiousBonds<dim>::part(const unsigned int node, const double t)
  {
    std::vector<Term> terms;
    for_each_of(node, [&](const Bond &bond) {
      if (!bond.whole)
        return;
      terms.clear();
      fictitious.for_each_term(bond.image, [&](const Term &term) { terms.push_back(term); });
      const Point<dim> &mirror = families.nodes().lattice() ? fictitious[bond.image].place :
                                                              fictitious.twice_planes(bond.image);
      if (is_cut<dim>(families, node, terms, mirror))
        break_bond(bond.number, BondState::parted, t);
    });
  }


  template <int dim>
  bool FictitiousBonds<dim>::is_parted(const unsigned int node) const
  {
    bool any = false;
    for_each_of(node, [&](const Bond &bond) {
      // What was cut from the start has never had a weight.
      any = any || (state.is_parted(bond.number) && squares[bond.number] > 0.);
    });
    return any;
  }


  template <int dim>
  double FictitiousBonds<dim>::weight_left(const unsigned int node) const
  {
    double sum = 0.;
    for_each_of(node, [&](const Bond &bond) {
      if (!state.is_parted(bond.number))
        sum += squares[bond.number] / families.nodes().volume(node);
    });
    return sum;
  }


  template <int dim>
  void FictitiousBonds<dim>::renew_springs(const unsigned int node, const NodeLaws<dim> &of_nodes)
  {
    for_each_of(node, [&](const Bond &bond) {
      if (bond.whole)
        springs[bond.number] = of_nodes.stiffness(node) / squares[bond.number];
    });
  }


  template <int dim>
  void FictitiousBonds<dim>::add_weights(Vector &q) const
  {
    for_each([&](const Bond &bond) {
      q.local_element(bond.node) += bond.spring / families.nodes().volume(bond.node); // W x^2
    });
  }


  template <int dim>
  void FictitiousBonds<dim>::find_springs(const NodeLaws<dim> &of_nodes, const bool full)
  {
    laws = &of_nodes;
    if (packs)
      return;
    if (families.cracks().history().changes_ever())
      squares = springs;
    for_each([&](const Bond &bond) {
      springs[bond.number] = bond.whole ? laws->stiffness(bond.node) / bond.spring : 0.;
    });
    if (!full)
      return;
    across.resize(springs.size(), 0.);
    for (const Tensor<1, dim> &p : moments)
      lengths.push_back(p.norm());
  }


  template <int dim>
  void FictitiousBonds<dim>::set_thermal_strains(const ThermalStrains &strain)
  {
    strains.resize(image_of_bond.size());
    for_each([&](const Bond &bond) {
      // What a temperature linear in space does to a free body is no linear displacement. The bond
      // has no force then if its extension is that of what the image follows from, at r_k from the
      // node: e = sum f_k (s_k M.r_k - r_k^2/2 ds/dM), the mean of both ends for a mirror image.
      const Point<dim>     at  = families.nodes().position(bond.node);
      const Tensor<1, dim> xi  = bond_vector(bond);
      double               own = strain[bond.node], other = 0., mean = 0., half = 0., rest = 1.;
      fictitious.for_each_term(bond.image, [&](const Term &term) {
        Tensor<1, dim> r = families.nodes().position(term.node) - at;
        for (unsigned int d = 0; d < dim; ++d)
          r[d] = (term.mirrored >> d) & 1 ? xi[d] : r[d];
        const double f = term.factor / xi.norm_square(), s = strain[term.node];
        other += term.factor * s;
        mean += f * s * (r * xi);
        half += 0.5 * f * r.norm_square();
        rest -= f * (r * xi);
      });
      // A body narrower than a family mirrors and continues along one axis: no such sum.
      mean -= half * (other - own);
      strains[bond.number] = std::abs(rest) > 1e-6 ? 0.5 * (own + other) : mean;
    });
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                 \
  template void   FictitiousBonds<dim>::part(const unsigned int, const double);                   \
  template bool   FictitiousBonds<dim>::is_parted(const unsigned int) const;                      \
  template double FictitiousBonds<dim>::weight_left(const unsigned int) const;                    \
  template void   FictitiousBonds<dim>::renew_springs(const unsigned int, const NodeLaws<dim> &); \
  template void   FictitiousBonds<dim>::add_weights(Vector &) const;                              \
  template void   FictitiousBonds<dim>::find_springs(const NodeLaws<dim> &, const bool);          \
  template void   FictitiousBonds<dim>::set_thermal_strains(const ThermalStrains &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
