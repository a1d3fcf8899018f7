// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/family_bonds.h>
#include <perideal/operators/solid/pair_bonds.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ZoneBonds<dim>::ZoneBonds(const Families<dim> &bonds_of_zone)
    : families(bonds_of_zone)
    , rows(families.nodes().n_owned())
  {
    for (const FamilyMember<dim> &member : families.weights().members())
      for (unsigned int d = 0; d < dim; ++d)
        reach[d] = std::max(reach[d], std::abs(member.offset[d]));
    std::array<int, dim> first = reach;
    for (int &x : first)
      x = -x;
    const Tensor<1, dim> &spacing = families.nodes().lattice()->spacing;
    for_each_site(first, reach, [&](const auto &site) {
      Tensor<1, dim> xi;
      bool           is_short = true;
      for (unsigned int d = 0; d < dim; ++d)
        {
          xi[d]    = site[d] * spacing[d];
          is_short = is_short && std::abs(site[d]) <= 1;
        }
      vectors.push_back(xi);
      is_between_vertices.push_back(is_short);
    });
  }


  template <int dim>
  unsigned int ZoneBonds<dim>::vector_between(const unsigned int node,
                                              const unsigned int neighbor) const
  {
    const Nodes<dim> &nodes = families.nodes();
    const auto        from  = nodes.lattice()->index(nodes.position(node)),
               to           = nodes.lattice()->index(nodes.position(neighbor));
    unsigned int key        = 0;
    for (unsigned int d = dim; d-- > 0;)
      key = key * (2 * reach[d] + 1) + (to[d] - from[d] + reach[d]);
    return key;
  }


  template <int dim>
  void ZoneBonds<dim>::set_row(const unsigned int                                     node,
                               const std::vector<typename DiffusionBonds<dim>::Bond> &list)
  {
    Row &row = rows[node];
    more     = more || (row.n == 0) != list.empty();
    unused += row.n;
    row = {bonds.size(), static_cast<unsigned int>(list.size())};
    for (const auto &bond : list)
      bonds.push_back({bond.neighbor, vector_between(node, bond.neighbor), bond.weight});
  }


  template <int dim>
  void ZoneBonds<dim>::finish_rows()
  {
    if (more)
      {
        with_rows.clear();
        for (unsigned int i = 0; i < rows.size(); ++i)
          if (rows[i].n > 0)
            with_rows.push_back(i);
        more = false;
      }
    if (unused > bonds.size() / 2)
      pack();
  }


  template <int dim>
  void ZoneBonds<dim>::pack()
  {
    std::vector<Bond> packed;
    packed.reserve(bonds.size() - unused);
    for (const unsigned int i : with_rows)
      {
        Row &row = rows[i];
        packed.insert(packed.end(), bonds.begin() + row.first, bonds.begin() + row.first + row.n);
        row.first = packed.size() - row.n;
      }
    bonds  = std::move(packed);
    unused = 0;
  }


  template <int dim>
  void ZoneBonds<dim>::release(const unsigned int node, const unsigned int neighbor)
  {
    const Row &row = rows[node];
    for (std::size_t k = row.first; k < row.first + row.n; ++k)
      if (bonds[k].neighbor == neighbor)
        bonds[k].strength = 0.;
  }


  template <int dim>
  void ZoneBonds<dim>::add_diagonal(Vector &diagonal) const
  {
    for (const unsigned int i : with_rows)
      {
        const Tensor<1, dim> own = diagonal_of(i);
        for (unsigned int d = 0; d < dim; ++d)
          diagonal.local_element(dim * i + d) += own[d];
      }
  }


  template <int dim>
  void ZoneBonds<dim>::add_between_vertices(TrilinosWrappers::SparseMatrix &matrix) const
  {
    const auto &layout = *families.nodes().partitioner();
    for (const unsigned int i : with_rows)
      for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        if (bond.strength == 0. || !is_between_vertices[bond.vector])
          return;
        const double factor = spring(i, bond);
        const auto   own    = dim * layout.local_to_global(i),
                   other    = dim * layout.local_to_global(bond.neighbor);
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int e = 0; e < dim; ++e)
            {
              const double value = factor * xi[c] * xi[e];
              matrix.add(own + c, own + e, value);
              matrix.add(own + c, other + e, -value);
            }
      });
  }


  template <int dim>
  double ZoneBonds<dim>::n_whole() const
  {
    double n = 0.;
    for (const unsigned int i : with_rows)
      for_each(i, [&](const Bond &bond, const auto &) { n += bond.strength > 0. ? 0.5 : 0.; });
    return n;
  }


  template <int dim>
  std::size_t ZoneBonds<dim>::memory_consumption() const
  {
    return bonds.capacity() * sizeof(Bond) + rows.capacity() * sizeof(Row) +
           with_rows.capacity() * sizeof(unsigned int) +
           vectors.capacity() * sizeof(Tensor<1, dim>);
  }


  template <int dim>
  std::unique_ptr<ZoneBonds<dim>> make_zone_bonds(Coupling<dim>             &coupling,
                                                  const BodyParameters<dim> &body)
  {
    if (const auto *lattice = dynamic_cast<const LatticeBonds<dim> *>(coupling.breakable()))
      return std::make_unique<PairBonds<dim>>(coupling, *lattice);
    return std::make_unique<FamilyBonds<dim>>(coupling, body);
  }


#define PERIDEAL_INSTANTIATE(dim)                                           \
  template class ZoneBonds<dim>;                                            \
  template std::unique_ptr<ZoneBonds<dim>> make_zone_bonds(Coupling<dim> &, \
                                                           const BodyParameters<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
