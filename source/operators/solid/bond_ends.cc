// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/bond_ends.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  unsigned int BondEnds<dim>::n_ends(const unsigned int i, const unsigned int j) const
  {
    if (!is_fictitious(j))
      return 1;
    const Term      &term = images->first_term(image(j));
    const Point<dim> far = (*images)[image(j)].place, p = families.nodes().position(term.node),
                     own = families.nodes().position(i);
    const double slack   = 1e-6 * families.nodes().smallest_spacing();
    for (unsigned int d = 0; d < dim; ++d)
      if (((term.mirrored >> d) & 1) && std::abs(far[d] + p[d] - 2. * own[d]) > slack)
        return 1;
    return 0;
  }


  template <int dim>
  bool BondEnds<dim>::is_own_image(const unsigned int i, const unsigned int j) const
  {
    if (!is_fictitious(j) || !may_break(j))
      return false;
    const Term &term = images->first_term(image(j));
    return term.mirrored != 0 && term.node == i;
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondEnds);
} // namespace PeriDeal
