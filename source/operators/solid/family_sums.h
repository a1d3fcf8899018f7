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


  /** visit(i, in the body, beyond) of n owned nodes; of some none in the body may be stored. */
  template <int dim, typename Visit>
  void for_each_family(const BondTable<dim> &bonds, const unsigned int n, const Visit &visit)
  {
    const BondRows<dim> &beyond = bonds.beyond;
    std::size_t          row    = 0;
    for (unsigned int i = 0; i < n; ++i)
      {
        Span inside, outside;
        if (!bonds.is_on_lattice(i))
          {
            const std::size_t k = bonds.row_in_body(i);
            inside              = {bonds.body.starts[k], bonds.body.starts[k + 1]};
          }
        if (row < beyond.nodes.size() && beyond.nodes[row] == i)
          {
            outside = {beyond.starts[row], beyond.starts[row + 1]};
            ++row;
          }
        visit(i, inside, outside);
      }
  }


  /** Of all owned nodes, which all store their bonds. */
  template <int dim, typename Visit>
  void for_each_family(const BondTable<dim> &bonds, const Visit &visit)
  {
    for_each_family(bonds, static_cast<unsigned int>(bonds.body.nodes.size()), visit);
  }


  /**
   * y = -F of the forces force(i, rows, bond, far end, whether that has a family), by which bonds
   * pull at node i; where y has that of bonds in the body that are not stored those beyond are
   * added. Collective.
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
    const unsigned int n = y.locally_owned_size() / dim;
    for_each_family(bonds, n, [&](const unsigned int i, const Span &inside, const Span &outside) {
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
      const bool has_some = bonds.is_on_lattice(i);
      for (unsigned int d = 0; d < dim; ++d)
        {
          double &all = y.local_element(dim * i + d);
          all         = has_some ? all - sum[d] : -sum[d];
        }
    });
    if (images)
      images->pass_on(y);
  }
} // namespace PeriDeal
