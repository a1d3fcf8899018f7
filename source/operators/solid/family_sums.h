// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_table.h>

#include <algorithm>
#include <type_traits>

namespace PeriDeal
{
  /** Bonds of a node, among those in the body or beyond its sides. */
  struct Span
  {
    std::size_t begin = 0, end = 0;
  };


  /** Those of an owned node, or none. */
  template <int dim>
  Span span_of(const BondRows<dim> &rows, const unsigned int node)
  {
    const auto place = std::lower_bound(rows.nodes.begin(), rows.nodes.end(), node);
    if (place == rows.nodes.end() || *place != node)
      return {};
    const std::size_t row = place - rows.nodes.begin();
    return {rows.starts[row], rows.starts[row + 1]};
  }


  /** visit(i, in the body, beyond) of all owned nodes, which all store their bonds. */
  template <int dim, typename Visit>
  void for_each_family(const BondTable<dim> &bonds, const Visit &visit)
  {
    const BondRows<dim> &beyond = bonds.beyond;
    std::size_t          row    = 0;
    for (unsigned int i = 0; i < bonds.body.nodes.size(); ++i)
      {
        const Span inside{bonds.body.starts[i], bonds.body.starts[i + 1]};
        Span       outside;
        if (row < beyond.nodes.size() && beyond.nodes[row] == i)
          {
            outside = {beyond.starts[row], beyond.starts[row + 1]};
            ++row;
          }
        visit(i, inside, outside);
      }
  }


  /**
   * y = -F of the forces force(i, rows, bond, far end, whether that has a family), by which bonds
   * pull at node i. Collective.
   */
  template <int dim, typename Force>
  void sum_forces_of_families(Vector               &y,
                              const BondTable<dim> &bonds,
                              const BondEnds<dim>  &ends,
                              const Force          &force)
  {
    const FictitiousImages<dim> *images = ends.images.get();
    if (images)
      images->begin_forces();
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      dealii::Tensor<1, dim> sum;
      for (std::size_t k = inside.begin; k < inside.end; ++k)
        sum += force(i, bonds.body, k, bonds.body.neighbors[k], std::true_type());
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        {
          const unsigned int           j       = bonds.beyond.neighbors[k];
          const dealii::Tensor<1, dim> of_bond = force(i, bonds.beyond, k, j, std::false_type());
          sum += of_bond;
          images->pull(ends.image(j), of_bond);
        }
      for (unsigned int d = 0; d < dim; ++d)
        y.local_element(dim * i + d) = -sum[d];
    });
    if (images)
      images->pass_on(y);
  }
} // namespace PeriDeal
