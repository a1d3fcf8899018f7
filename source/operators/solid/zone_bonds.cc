// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/family_bonds.h>
#include <perideal/operators/solid/pair_bonds.h>

#include <algorithm>
#include <cmath>

#include "change_along.h"

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
  void ZoneBonds<dim>::set_row(const unsigned int                                     node,
                               const std::vector<typename DiffusionBonds<dim>::Bond> &list)
  {
    Row &row = rows[node];
    more     = more || (row.n == 0) != list.empty();
    unused += row.n;
    row                     = {bonds.size(), static_cast<unsigned int>(list.size())};
    const Nodes<dim> &nodes = families.nodes();
    const auto        from  = nodes.lattice()->index(nodes.position(node));
    for (const auto &bond : list)
      {
        const auto   to     = nodes.lattice()->index(nodes.position(bond.neighbor));
        unsigned int vector = 0;
        for (unsigned int d = dim; d-- > 0;)
          vector = vector * (2 * reach[d] + 1) + (to[d] - from[d] + reach[d]);
        bonds.push_back({bond.neighbor, vector, bond.weight});
      }
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
    if (unused <= bonds.size() / 2)
      return;
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
  double ZoneBonds<dim>::change(const unsigned int i,
                                const Bond        &bond,
                                const double      *u,
                                const double      *thermal) const
  {
    const Tensor<1, dim> &xi  = vectors[bond.vector];
    const double          sum = u == nullptr ? 0. : change_along(xi, u, i, bond.neighbor);
    return thermal == nullptr ?
             sum :
             sum - 0.5 * (thermal[i] + thermal[bond.neighbor]) * xi.norm_square();
  }


  template <int dim>
  bool ZoneBonds<dim>::find_tensions(const double *u, const double *thermal) const
  {
    if (dim == 1 || dilatation.size() == 0)
      return false;
    if (tensions.size() == 0)
      tensions.reinit(dilatation);
    for (const unsigned int i : with_rows)
      {
        double       sum = 0.;
        const double a   = dilatation.local_element(i);
        if (a != 0.)
          for_each(i, [&](const Bond &bond, const Tensor<1, dim> &) {
            sum += bond.strength * change(i, bond, u, thermal);
          });
        tensions.local_element(i) = a * sum;
      }
    tensions.update_ghost_values();
    return true;
  }


  template <int dim>
  void ZoneBonds<dim>::add_forces_of(const std::vector<unsigned int> &of_nodes,
                                     const double                     multiple,
                                     Vector                          &y,
                                     const double                    *u,
                                     const double                    *thermal) const
  {
    const double *const tau = find_tensions(u, thermal) ? tensions.begin() : nullptr;
    for (const unsigned int i : of_nodes)
      {
        Tensor<1, dim> sum;
        for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          sum += bond.strength *
                 LinearPeridynamicSolid::force(spring(i, bond),
                                               change(i, bond, u, thermal),
                                               tau != nullptr ? tau[i] + tau[bond.neighbor] : 0.) *
                 xi;
        });
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) -= multiple * sum[d];
      }
  }


  template <int dim>
  double ZoneBonds<dim>::energy(const double                    *u,
                                const std::vector<unsigned int> &of_nodes,
                                const double                    *thermal) const
  {
    double sum = 0.;
    for (const unsigned int i : of_nodes)
      {
        double all = 0.;
        for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          const double c = change(i, bond, u, thermal);
          const double own =
            stiffness.size() == 0 ?
              0.5 :
              LinearPeridynamicSolid::spring(stiffness.local_element(i), xi.norm_square());
          all += bond.strength * c;
          sum += bond.strength * LinearPeridynamicSolid::bond_energy(own, c);
        });
        if (dilatation.size() > 0)
          sum += LinearPeridynamicSolid::node_energy(dilatation.local_element(i) * all, all);
      }
    return sum;
  }


  template <int dim>
  Tensor<1, dim> ZoneBonds<dim>::diagonal_of(const unsigned int node) const
  {
    const auto a = [this](const unsigned int j) {
      return dilatation.size() > 0 ? dilatation.local_element(j) : 0.;
    };
    Tensor<1, dim> sum, own;
    for_each(node, [&](const Bond &bond, const Tensor<1, dim> &xi) {
      const double factor = bond.strength * (spring(node, bond) + a(bond.neighbor) * bond.strength);
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] += factor * xi[d] * xi[d];
      own += bond.strength * xi;
    });
    for (unsigned int d = 0; d < dim; ++d)
      sum[d] += a(node) * own[d] * own[d];
    return sum;
  }


  /*
   * With g_n what makes the sum over the family of n of u, K has a_n g_n g_n^T of it: in the row of
   * a neighbour W |xi| times the sum over |g_n|.
   */
  template <int dim>
  void ZoneBonds<dim>::add_row_sums(std::vector<double> &sums) const
  {
    const auto size = [](const Tensor<1, dim> &v) {
      double sum = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        sum += std::abs(v[d]);
      return sum;
    };
    Vector of_tensions(families.nodes().partitioner()); // |a_n| times the sum over |g_n|
    for (const unsigned int i : with_rows)
      {
        double         all = 0.;
        Tensor<1, dim> own;
        for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          all += bond.strength * size(xi);
          own += bond.strength * xi;
        });
        if (dilatation.size() > 0)
          of_tensions.local_element(i) = std::abs(dilatation.local_element(i)) * (all + size(own));
      }
    of_tensions.update_ghost_values();
    for (const unsigned int i : with_rows)
      {
        Tensor<1, dim> own;
        for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          const double of_both = bond.strength * (2. * spring(i, bond) * size(xi) +
                                                  of_tensions.local_element(bond.neighbor));
          for (unsigned int d = 0; d < dim; ++d)
            sums[dim * i + d] += of_both * std::abs(xi[d]);
          own += bond.strength * xi;
        });
        for (unsigned int d = 0; d < dim; ++d)
          sums[dim * i + d] += of_tensions.local_element(i) * std::abs(own[d]);
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
        const double factor = bond.strength * spring(i, bond);
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
           vectors.capacity() * sizeof(Tensor<1, dim>) +
           (stiffness.size() > 0 ? 3 * stiffness.memory_consumption() : 0);
  }


  template <int dim>
  std::unique_ptr<ZoneBonds<dim>> make_zone_bonds(Coupling<dim>             &coupling,
                                                  const BodyParameters<dim> &body)
  {
    if (const auto *lattice = dynamic_cast<const LatticeBonds<dim> *>(coupling.breakable()))
      return std::make_unique<PairBonds<dim>>(coupling, *lattice);
    return std::make_unique<FamilyBonds<dim>>(coupling, body);
  }


  PERIDEAL_INSTANTIATE_CLASS(class ZoneBonds);
  PERIDEAL_INSTANTIATE_FUNCTION(make_zone_bonds);
} // namespace PeriDeal
