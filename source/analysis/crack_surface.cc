// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/crack_surface.h>
#include <perideal/base/gathered_lists.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/point_order.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  unsigned int CrackFacet<dim>::normal() const
  {
    unsigned int n = 0;
    for (unsigned int d = 1; d < dim; ++d)
      if (upper[d] - lower[d] < upper[n] - lower[n])
        n = d;
    return n;
  }


  template <int dim>
  std::vector<Point<dim>> CrackFacet<dim>::corners() const
  {
    std::vector<Point<dim>> list{lower, upper};
    if (dim == 3)
      {
        const unsigned int e = (normal() + 1) % dim;
        Point<dim>         second(lower), fourth(upper);
        second[e] = upper[e];
        fourth[e] = lower[e];
        list      = {lower, second, upper, fourth};
      }
    return list;
  }


  template <int dim>
  CrackSurface<dim>::CrackSurface(const Families<dim> &families)
    : families(families)
  {
    const Neighbors<dim> &neighbors = families.neighbors();
    sums.fill(Vector(families.nodes().partitioner()));
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      neighbors.for_each(i, [&](const unsigned int j, const double weight) {
        if (!neighbors.is_real(j))
          return;
        const Tensor<1, dim> xi = neighbors.bond_vector(i, j);
        for (unsigned int n = 0; n < dim; ++n)
          sums[n].local_element(i) +=
            0.5 * weight * xi.norm_square() * families.nodes().volume(j) * std::abs(xi[n]);
      });
    for (Vector &sum : sums)
      sum.update_ghost_values();
  }


  template <int dim>
  double CrackSurface<dim>::exact_sum(const std::vector<double> &shares, const double scale) const
  {
    // Integers do not depend on their order.
    const double       unit = std::ldexp(1., std::ilogb(scale) - 34);
    unsigned long long sum  = 0;
    for (const double share : shares)
      sum += std::llround(share / unit);
    return unit * static_cast<double>(Utilities::MPI::sum(sum, families.nodes().communicator()));
  }


  template <int dim>
  std::vector<double> CrackSurface<dim>::weights_of(const std::vector<BondBreak> &breaks) const
  {
    std::vector<double> weights;
    for (const auto &[i, other, time] : breaks)
      {
        double found = 0.;
        families.neighbors().for_each(i, [&, other = other](const unsigned int j, const double w) {
          if (j == other)
            found = w;
        });
        weights.push_back(found * families.neighbors().bond_vector(i, other).norm_square());
      }
    return weights;
  }


  template <int dim>
  Vector CrackSurface<dim>::sums_across(const std::vector<BondBreak> &breaks,
                                        const std::vector<double>    &weights) const
  {
    const Nodes<dim>       &nodes = families.nodes();
    std::array<Vector, dim> normals;
    normals.fill(Vector(nodes.partitioner()));
    for (std::size_t k = 0; k < breaks.size(); ++k)
      {
        const auto &[i, j, time]  = breaks[k];
        const Tensor<1, dim> part = weights[k] * families.neighbors().bond_vector(i, j);
        for (unsigned int n = 0; n < dim; ++n)
          {
            normals[n].local_element(i) += nodes.volume(j) * part[n];
            normals[n].local_element(j) -= nodes.volume(i) * part[n];
          }
      }
    for (Vector &normal : normals)
      normal.compress(VectorOperation::add);
    // Where bonds have broken on all sides no direction is known: so small a part, squared, tells
    // it.
    constexpr double least = 1e-6;
    Vector           across(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double all = 0., sum = 0.;
        for (unsigned int n = 0; n < dim; ++n)
          {
            const double share = std::pow(normals[n].local_element(i), 2) +
                                 least * std::pow(sums[n].local_element(i), 2);
            all += share;
            sum += share * sums[n].local_element(i);
          }
        across.local_element(i) = sum / all;
      }
    across.update_ghost_values();
    return across;
  }


  template <int dim>
  double CrackSurface<dim>::area(const std::vector<BondBreak> &breaks) const
  {
    const Nodes<dim>         &nodes   = families.nodes();
    const std::vector<double> weights = weights_of(breaks);
    const Vector              across  = sums_across(breaks, weights);
    std::vector<double>       shares;
    for (std::size_t k = 0; k < breaks.size(); ++k)
      {
        const auto &[i, j, time] = breaks[k];
        shares.push_back(0.5 * weights[k] * nodes.volume(i) * nodes.volume(j) *
                         (1. / across.local_element(i) + 1. / across.local_element(j)));
      }
    return exact_sum(shares, std::pow(nodes.smallest_spacing(), dim - 1));
  }


  template <int dim>
  double CrackSurface<dim>::damaged_volume(const std::vector<BondBreak> &breaks,
                                           const std::vector<double>    &damage,
                                           const double                  threshold) const
  {
    const Nodes<dim> &nodes = families.nodes();
    // What other processes know of their bonds to nodes of this one.
    Vector lost(nodes.partitioner());
    for (const BondBreak &bond : breaks)
      {
        lost.local_element(bond.node)     = 1.;
        lost.local_element(bond.neighbor) = 1.;
      }
    lost.compress(VectorOperation::add);
    std::vector<double> volumes;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (lost.local_element(i) > 0. && damage[i] > threshold)
        volumes.push_back(nodes.volume(i));
    return exact_sum(volumes, std::pow(nodes.smallest_spacing(), dim));
  }


  template <int dim>
  std::vector<CrackFacet<dim>> CrackSurface<dim>::facets(const std::vector<BondBreak> &breaks,
                                                         const std::vector<double>    &damage) const
  {
    const Nodes<dim> &nodes = families.nodes();
    if (dim == 1 || !nodes.lattice() || nodes.has_doubled_nodes())
      return {};
    const Lattice<dim> &lattice = *nodes.lattice();
    Vector              known(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      known.local_element(i) = damage[i];
    known.update_ghost_values();
    std::vector<double> own;
    for (const BondBreak &bond : breaks)
      {
        const auto a          = lattice.index(nodes.position(bond.node)),
                   b          = lattice.index(nodes.position(bond.neighbor));
        unsigned int distance = 0;
        for (unsigned int d = 0; d < dim; ++d)
          distance += std::abs(a[d] - b[d]);
        if (distance != 1)
          continue;
        // In numbers of half spacings, so that facets have corners in common.
        const Point<dim> middle = nodes.position(bond.node) +
                                  0.5 * (nodes.position(bond.neighbor) - nodes.position(bond.node));
        for (const double side : {-0.5, 0.5})
          for (unsigned int d = 0; d < dim; ++d)
            own.push_back(a[d] != b[d] ? middle[d] :
                                         std::clamp(middle[d] + side * lattice.spacing[d],
                                                    lattice.lower[d],
                                                    lattice.upper[d]));
        own.push_back(bond.time);
        own.push_back(std::max(known.local_element(bond.node), known.local_element(bond.neighbor)));
      }
    constexpr unsigned int       n_numbers = 2 * dim + 2;
    std::vector<CrackFacet<dim>> all;
    for (const std::vector<double> &list : gathered_lists(nodes.communicator(), own))
      for (std::size_t k = 0; k < list.size(); k += n_numbers)
        {
          all.emplace_back();
          for (unsigned int d = 0; d < dim; ++d)
            {
              all.back().lower[d] = list[k + d];
              all.back().upper[d] = list[k + dim + d];
            }
          all.back().time   = list[k + 2 * dim];
          all.back().damage = list[k + 2 * dim + 1];
        }
    std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) {
      return a.lower == b.lower ? comes_first(a.upper, b.upper) : comes_first(a.lower, b.lower);
    });
    return all;
  }


  PERIDEAL_INSTANTIATE_CLASS(struct CrackFacet);
  PERIDEAL_INSTANTIATE_CLASS(class CrackSurface);
} // namespace PeriDeal
