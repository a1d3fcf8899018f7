// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/family_bonds.h>
#include <perideal/operators/solid/nodal_bonds.h>
#include <perideal/operators/solid/pair_bonds.h>

#include <algorithm>
#include <cmath>

#include "change_along.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ZoneBonds<dim>::ZoneBonds(const Families<dim> &bonds_of_zone, const NodalLaw *law)
    : families(bonds_of_zone)
    , law(law)
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
    bonds = std::move(packed);
    coefficients.slopes.clear(); // until the next linearize()
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
  double ZoneBonds<dim>::linearize(const Vector &u)
  {
    double largest = 1.;
    coefficients.slopes.assign(bonds.size(), 1.);
    for (const unsigned int i : with_rows)
      for (std::size_t k = rows[i].first; k < rows[i].first + rows[i].n; ++k)
        {
          const unsigned int    j  = bonds[k].neighbor;
          const Tensor<1, dim> &xi = vectors[bonds[k].vector];
          coefficients.slopes[k] =
            law->steps->slope(law->values(i, j, xi, change(i, bonds[k], u.begin(), nullptr)),
                              law->history(i, j, xi));
          if (bonds[k].strength != 0.)
            largest = std::max(largest, coefficients.slopes[k]);
        }
    return largest;
  }


  template <int dim>
  bool ZoneBonds<dim>::find_tensions(const double *u,
                                     const double *thermal,
                                     const bool    of_tangent) const
  {
    if (dim == 1 || coefficients.dilatation.size() == 0)
      return false;
    if (tensions.size() == 0)
      tensions.reinit(coefficients.dilatation);
    const bool   relaxes = law != nullptr && law->relaxes();
    const double slope   = relaxes ? law->steps->slope({}, nullptr) : 1.;
    for (const unsigned int i : with_rows)
      {
        double       sum = 0., beside = 0.;
        const double a = coefficients.dilatation.local_element(i);
        if (a != 0. || relaxes)
          for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
            const double c = change(i, bond, u, thermal);
            sum += bond.strength * c;
            if (relaxes && of_tangent)
              beside += bond.strength * (slope - 1.) * c;
            else if (relaxes)
              beside += bond.strength * (law->effective(i, bond.neighbor, xi, c) - c);
          });
        tensions.local_element(i) = a * sum;
        if (relaxes)
          tensions.local_element(i) += coefficients.shear.local_element(i) * beside;
      }
    tensions.update_ghost_values();
    return true;
  }


  template <int dim>
  void ZoneBonds<dim>::add_forces_of(const std::vector<unsigned int> &of_nodes,
                                     const double                     multiple,
                                     Vector                          &y,
                                     const double                    *u,
                                     const double                    *thermal,
                                     const bool                       of_tangent) const
  {
    const double *const tau = find_tensions(u, thermal, of_tangent) ? tensions.begin() : nullptr;
    const double        slope =
      of_tangent && law != nullptr && law->steps->is_linear() ? law->steps->slope({}, nullptr) : 1.;
    const auto effective = [&](const unsigned int i, const Bond &bond, const Tensor<1, dim> &xi) {
      const double c = change(i, bond, u, thermal);
      if (law != nullptr && !of_tangent)
        return law->effective(i, bond.neighbor, xi, c);
      const std::size_t k = &bond - bonds.data();
      return c * (of_tangent && k < coefficients.slopes.size() ? coefficients.slopes[k] : slope);
    };
    for (const unsigned int i : of_nodes)
      {
        Tensor<1, dim> sum;
        for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          sum += bond.strength *
                 LinearPeridynamicSolid::force(spring(i, bond),
                                               effective(i, bond, xi),
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
                                const double                    *thermal,
                                const bool                       dissipated) const
  {
    double               sum = 0.;
    BondValues           of_node{0., 1.};
    std::vector<double>  none;
    std::vector<double> &histories = law != nullptr ? law->of_node : none;
    histories.resize(law != nullptr ? law->histories.size() : 0);
    for (const unsigned int i : of_nodes)
      {
        double all = 0.;
        std::fill(histories.begin(), histories.end(), 0.);
        for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          const double c = change(i, bond, u, thermal);
          const double own =
            coefficients.stiffness.size() == 0 ?
              0.5 :
              LinearPeridynamicSolid::spring(coefficients.stiffness.local_element(i),
                                             xi.norm_square());
          all += bond.strength * c;
          if (law == nullptr)
            {
              sum += bond.strength * LinearPeridynamicSolid::bond_energy(own, c);
              return;
            }
          const double *const before = law->history(i, bond.neighbor, xi);
          sum += bond.strength * own *
                 law->steps->energy(law->values(i, bond.neighbor, xi, c), before, dissipated);
          for (unsigned int k = 0; k < histories.size(); ++k)
            histories[k] += bond.strength * before[k];
        });
        if (coefficients.dilatation.size() > 0 && !dissipated)
          sum += LinearPeridynamicSolid::node_energy(coefficients.dilatation.local_element(i) * all,
                                                     all);
        if (law == nullptr || !law->relaxes())
          continue;
        of_node.product = all;
        sum += coefficients.shear.local_element(i) *
               (law->steps->energy(of_node, histories.data(), dissipated) -
                (dissipated ? 0. : 0.5 * all * all));
      }
    return sum;
  }


  template <int dim>
  Tensor<1, dim> ZoneBonds<dim>::diagonal_of(const unsigned int node) const
  {
    const auto a = [this](const unsigned int j) {
      return coefficients.dilatation.size() > 0 ? coefficients.dilatation.local_element(j) : 0.;
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
        if (coefficients.dilatation.size() > 0)
          of_tensions.local_element(i) =
            std::abs(coefficients.dilatation.local_element(i)) * (all + size(own));
      }
    of_tensions.update_ghost_values();
    for (const unsigned int i : with_rows)
      {
        Tensor<1, dim> own;
        for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          const std::size_t k = &bond - bonds.data();
          const double      stiffer =
            k < coefficients.slopes.size() ? std::max(1., std::abs(coefficients.slopes[k])) : 1.;
          const double of_both = bond.strength * (2. * stiffer * spring(i, bond) * size(xi) +
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
           (coefficients.stiffness.size() > 0 ? 3 * coefficients.stiffness.memory_consumption() :
                                                0);
  }


  template <int dim>
  std::unique_ptr<ZoneBonds<dim>> make_zone_bonds(Coupling<dim>             &coupling,
                                                  const BodyParameters<dim> &body,
                                                  const NodalLaw            *law)
  {
    if (const auto *lattice = dynamic_cast<const LatticeBonds<dim> *>(coupling.breakable()))
      return std::make_unique<PairBonds<dim>>(coupling, *lattice, law);
    if (body.elasticity.is_correspondence())
      return std::make_unique<NodalBonds<dim>>(coupling, body);
    return std::make_unique<FamilyBonds<dim>>(coupling, body, law);
  }


  PERIDEAL_INSTANTIATE_CLASS(class ZoneBonds);
  PERIDEAL_INSTANTIATE_FUNCTION(make_zone_bonds);
} // namespace PeriDeal
