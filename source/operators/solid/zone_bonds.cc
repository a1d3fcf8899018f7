// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/operators/solid/zone_bonds.h>

#include <algorithm>
#include <cmath>

#include "change_along.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ZoneBonds<dim>::ZoneBonds(const Coupling<dim> &coupling, const LatticeBonds<dim> &bonds)
    : coupling(coupling)
    , of_lattice(bonds)
    , reach(bonds.reach)
    , rows(bonds.families.nodes().n_owned())
  {
    typename LatticeBonds<dim>::Site first = reach;
    for (int &x : first)
      x = -x;
    const Tensor<1, dim> &spacing = bonds.families.nodes().lattice()->spacing;
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
    const Nodes<dim> &nodes = of_lattice.families.nodes();
    const auto        from  = nodes.lattice()->index(nodes.position(node)),
               to           = nodes.lattice()->index(nodes.position(neighbor));
    unsigned int key        = 0;
    for (unsigned int d = dim; d-- > 0;)
      key = key * (2 * reach[d] + 1) + (to[d] - from[d] + reach[d]);
    return key;
  }


  template <int dim>
  void ZoneBonds<dim>::set_rows(const std::vector<unsigned int> &of_nodes,
                                const CrackSideFactors          &factors)
  {
    std::vector<typename Coupling<dim>::Bond> list;
    bool                                      more = false;
    for (const unsigned int i : of_nodes)
      {
        coupling.bonds_of(i, list);
        Row &row = rows[i];
        more     = more || (row.n == 0) != list.empty();
        unused += row.n;
        row = {bonds.size(), static_cast<unsigned int>(list.size())};
        for (const auto &bond : list)
          bonds.push_back({bond.neighbor,
                           vector_between(i, bond.neighbor),
                           bond.weight * factors.of_bond(i, bond.neighbor)});
      }
    if (more)
      {
        with_rows.clear();
        for (unsigned int i = 0; i < rows.size(); ++i)
          if (rows[i].n > 0)
            with_rows.push_back(i);
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
  void ZoneBonds<dim>::add_forces(Vector &y, const Vector &u) const
  {
    add_forces_of(with_rows, 1., y, u);
  }


  template <int dim>
  void ZoneBonds<dim>::add_forces_of(const std::vector<unsigned int> &of_nodes,
                                     const double                     multiple,
                                     Vector                          &y,
                                     const Vector                    &u) const
  {
    const double *const all = u.begin();
    for (const unsigned int i : of_nodes)
      {
        Tensor<1, dim> sum;
        const Row     &row = rows[i];
        for (std::size_t k = row.first; k < row.first + row.n; ++k)
          {
            const Tensor<1, dim> &xi = vectors[bonds[k].vector];
            sum += bonds[k].strength * change_along<dim>(xi, all, i, bonds[k].neighbor) * xi;
          }
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) -= multiple * sum[d];
      }
  }


  template <int dim>
  void ZoneBonds<dim>::add_diagonal(Vector &diagonal) const
  {
    for (const unsigned int i : with_rows)
      for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        for (unsigned int d = 0; d < dim; ++d)
          diagonal.local_element(dim * i + d) += bond.strength * xi[d] * xi[d];
      });
  }


  template <int dim>
  void ZoneBonds<dim>::add_row_sums(std::vector<double> &sums) const
  {
    for (const unsigned int i : with_rows)
      for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        double length = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          length += std::abs(xi[d]);
        for (unsigned int d = 0; d < dim; ++d)
          sums[dim * i + d] += 2. * bond.strength * std::abs(xi[d]) * length;
      });
  }


  template <int dim>
  void ZoneBonds<dim>::add_between_vertices(TrilinosWrappers::SparseMatrix &matrix) const
  {
    const auto &layout = *of_lattice.families.nodes().partitioner();
    for (const unsigned int i : with_rows)
      for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        if (bond.strength == 0. || !is_between_vertices[bond.vector])
          return;
        const auto own   = dim * layout.local_to_global(i),
                   other = dim * layout.local_to_global(bond.neighbor);
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int e = 0; e < dim; ++e)
            {
              const double value = bond.strength * xi[c] * xi[e];
              matrix.add(own + c, own + e, value);
              matrix.add(own + c, other + e, -value);
            }
      });
  }


  template <int dim>
  double ZoneBonds<dim>::energy(const Vector                    &u,
                                const std::vector<unsigned int> &of_nodes,
                                const std::vector<double>       &thermal) const
  {
    double sum = 0.;
    for (const unsigned int i : of_nodes)
      for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        double change = change_along<dim>(xi, u.begin(), i, bond.neighbor);
        if (!thermal.empty())
          change -= 0.5 * (thermal[i] + thermal[bond.neighbor]) * xi.norm_square();
        sum += 0.25 * bond.strength * change * change;
      });
    return sum;
  }


  template <int dim>
  double ZoneBonds<dim>::add_thermal(Vector                          &loads,
                                     const std::vector<unsigned int> &of_nodes,
                                     const std::vector<double>       &thermal,
                                     const double                     multiple) const
  {
    double held = 0.;
    for (const unsigned int i : of_nodes)
      for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        const double mean = 0.5 * (thermal[i] + thermal[bond.neighbor]), square = xi.norm_square();
        for (unsigned int d = 0; d < dim; ++d)
          loads.local_element(dim * i + d) -= multiple * bond.strength * mean * square * xi[d];
        held += 0.25 * multiple * bond.strength * std::pow(mean * square, 2);
      });
    return held;
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


  template class ZoneBonds<1>;
  template class ZoneBonds<2>;
  template class ZoneBonds<3>;
} // namespace PeriDeal
