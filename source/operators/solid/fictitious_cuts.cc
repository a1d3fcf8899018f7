// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/fictitious_cuts.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  bool is_separated(const Families<dim>                                 &families,
                    const unsigned int                                   node,
                    const typename FictitiousExtension<dim>::Site::Term &term,
                    const Point<dim>                                    &mirror)
  {
    const Nodes<dim> &nodes = families.nodes();
    const Point<dim>  twice_planes(
      nodes.lattice() ? mirror + (nodes.position(term.node) - Point<dim>()) : mirror);
    for (unsigned int image = 0; image < (1u << dim); ++image)
      {
        if ((image & ~term.mirrored) != 0)
          continue;
        Point<dim> a = nodes.crack_point(node), b = nodes.crack_point(term.node);
        for (unsigned int d = 0; d < dim; ++d)
          if ((image >> d) & 1)
            a[d] = twice_planes[d] - a[d];
          else if ((term.mirrored >> d) & 1)
            b[d] = twice_planes[d] - b[d];
        if (families.cracks().separate(a, b))
          return true;
      }
    return false;
  }


  template <int dim>
  bool is_cut(const Families<dim>                                              &families,
              const unsigned int                                                node,
              const std::vector<typename FictitiousExtension<dim>::Site::Term> &terms,
              const Point<dim>                                                 &mirror)
  {
    return std::any_of(terms.begin(), terms.end(), [&](const auto &term) {
      if (term.mirrored != 0 || !families.nodes().lattice())
        return is_separated(families, node, term, mirror); // beyond the reach, too
      return term.node != node && families.cracks().cuts(node, term.node);
    });
  }


  PERIDEAL_INSTANTIATE_FUNCTION(is_separated);
  PERIDEAL_INSTANTIATE_FUNCTION(is_cut);
} // namespace PeriDeal
