// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/coupling/family_zone.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FamilyZone<dim>::FamilyZone(const Families<dim> &families,
                              NodeWeights<dim>    &weights,
                              const double         reach,
                              const double         overlap)
    : families(families)
    , weights(weights)
    , reach(reach)
    , overlap(overlap)
  {}


  template <int dim>
  bool FamilyZone<dim>::may_break(const unsigned int node, const unsigned int neighbor) const
  {
    const Nodes<dim> &nodes = families.nodes();
    const Site        a     = nodes.lattice()->index(nodes.position(node)),
               b            = nodes.lattice()->index(nodes.position(neighbor));
    Site first, last;
    for (unsigned int d = 0; d < dim; ++d)
      {
        first[d] = std::min(a[d], b[d]) - 1;
        last[d]  = std::max(a[d], b[d]) + 1;
      }
    bool alone = true;
    for_each_site(first, last, [&](const Site &site) {
      if (alone)
        if (const unsigned int k = families.neighbors().node_at(site);
            k != numbers::invalid_unsigned_int)
          alone = weights[k] == 1.;
    });
    return alone;
  }


  template <int dim>
  void FamilyZone<dim>::find_joining(const Point<dim> &place, std::vector<Joining> &list) const
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    const double        within = reach * (1. + 1e-9), farthest = within + overlap;
    Site                first, last;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double middle = (place[d] - lattice.position(Site{})[d]) / lattice.spacing[d],
                     half   = farthest / lattice.spacing[d];
        first[d]            = std::max<int>(std::ceil(middle - half), 0);
        last[d]             = std::min<int>(std::floor(middle + half), lattice.n_sites[d] - 1);
      }
    for_each_site(first, last, [&](const Site &site) {
      const unsigned int node = families.neighbors().node_at(site);
      if (node == numbers::invalid_unsigned_int || weights[node] == 1.)
        return;
      const double outside = lattice.position(site).distance(place) - within,
                   weight  = outside <= 0.     ? 1. :
                             outside < overlap ? 1. - outside / overlap :
                                                 0.;
      if (weight > weights[node])
        list.push_back({node, weight});
    });
  }


  template <int dim>
  void FamilyZone<dim>::join_nodes(const std::vector<Joining> &list)
  {
    for (const Joining &joining : list)
      weights.raise(joining.node, joining.weight);
  }


  PERIDEAL_INSTANTIATE_CLASS(class FamilyZone);
} // namespace PeriDeal
