// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "edge_nodes.h"

#include <perideal/base/instantiate.h>
#include <perideal/mesh/lattice_sites.h>

#include <algorithm>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Tensor<1, dim> bond_of(const FamilyMember<dim> &member, const Lattice<dim> &lattice)
    {
      Tensor<1, dim> xi;
      for (unsigned int d = 0; d < dim; ++d)
        xi[d] = member.offset[d] * lattice.spacing[d];
      return xi;
    }
  } // namespace


  template <int dim>
  CompleteFamilies<dim>::CompleteFamilies(const Families<dim>       &families,
                                          const LatticeCoefficients &coefficients)
    : volume(families.nodes().lattice()->cell_volume())
    , stiffness(coefficients.stiffness)
    , dilatation(coefficients.dilatation)
  {
    const Lattice<dim>             &lattice = *families.nodes().lattice();
    std::vector<std::array<int, 3>> offsets(1);
    std::vector<Tensor<1, dim>>     vectors(1);
    std::vector<double>             weights(1);
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        const Tensor<1, dim> xi = bond_of(member, lattice);
        for (unsigned int d = 0; d < dim; ++d)
          center[d] -= 2. * stiffness * member.weight * xi[d] * xi[d] / xi.norm_square();
        if (*std::min_element(member.offset.begin(), member.offset.end()) < 0)
          continue;
        std::array<int, 3> offset{};
        std::copy(member.offset.begin(), member.offset.end(), offset.begin());
        offsets.push_back(offset);
        vectors.push_back(xi);
        weights.push_back(member.weight);
      }
    std::vector<double> values(offsets.size());
    for (unsigned int a = 0; a < dim; ++a)
      {
        for (std::size_t k = 0; k < values.size(); ++k)
          values[k] = weights[k] * vectors[k][a];
        std::array<bool, 3> odd{};
        odd[a] = true;
        moments.emplace_back(dim, offsets, values, odd);
      }
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        {
          values[0] = a == b ? center[a] : 0.;
          for (std::size_t k = 1; k < values.size(); ++k)
            values[k] = 2. * stiffness * weights[k] * vectors[k][a] * vectors[k][b] /
                        vectors[k].norm_square();
          std::array<bool, 3> odd{};
          odd[a] = odd[b] = a != b;
          springs.emplace_back(dim, offsets, values, odd);
        }
  }


  template <int dim>
  void EdgeNodes<dim>::add(const Families<dim>         &families,
                           const CompleteFamilies<dim> &complete,
                           const LatticeCoefficients   &coefficients,
                           const unsigned int           i,
                           Tensor<1, dim>              &moment)
  {
    const Nodes<dim>          &nodes  = families.nodes();
    const std::vector<double> &excess = coefficients.excesses;
    const auto                 site   = nodes.lattice()->index(nodes.position(i));
    Node                       edge;
    edge.excess     = excess[i];
    edge.dilatation = coefficients.dilatations.empty() ? 0. : coefficients.dilatations[i];
    edge.block.fill(0.);
    moment = Tensor<1, dim>();
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        const unsigned int j = families.neighbors().node_at(site + member.offset);
        if (j == numbers::invalid_unsigned_int)
          continue;
        const Tensor<1, dim> xi     = bond_of(member, *nodes.lattice());
        const double         weight = nodes.volume(j) * member.weight,
                     spring = 2. * complete.stiffness * (1. + excess[i] + excess[j]) * weight /
                              xi.norm_square();
        moment += weight * xi;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            edge.block[complete.pair(a, b)] += spring * xi[a] * xi[b];
      }
    for (unsigned int a = 0; a < dim; ++a)
      edge.block[complete.pair(a, a)] +=
        complete.center[a] * nodes.volume(i) * (1. + 2. * excess[i]);
    list.push_back(edge);
  }


  template <int dim>
  EdgeNodes<dim>::EdgeNodes(const Families<dim>         &families,
                            const CompleteFamilies<dim> &complete,
                            const LatticeCoefficients   &coefficients,
                            const std::vector<bool>     &computed)
  {
    const Nodes<dim>                              &nodes = families.nodes();
    std::map<std::array<double, dim>, std::size_t> known; // moments
    Tensor<1, dim>                                 moment;
    number_of.assign(nodes.n_owned(), none);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        if (!computed[i])
          continue;
        const auto like_most = [&](const unsigned int j) {
          return j != numbers::invalid_unsigned_int && nodes.volume(j) == complete.volume &&
                 coefficients.excesses[j] == 0.;
        };
        bool       regular = like_most(i) && (coefficients.dilatations.empty() ||
                                        coefficients.dilatations[i] == complete.dilatation);
        const auto site    = nodes.lattice()->index(nodes.position(i));
        for (const FamilyMember<dim> &member : families.weights().members())
          regular = regular && like_most(families.neighbors().node_at(site + member.offset));
        if (regular)
          continue;
        number_of[i] = static_cast<std::uint32_t>(list.size());
        add(families, complete, coefficients, i, moment);
        std::array<double, dim> key;
        std::copy(moment.begin_raw(), moment.end_raw(), key.begin());
        const auto [entry, is_new] = known.try_emplace(key, moments.size());
        if (is_new)
          moments.push_back(moment);
        moment_of.push_back(static_cast<std::uint32_t>(entry->second));
      }
    list.shrink_to_fit();
    moments.shrink_to_fit();
    moment_of.shrink_to_fit();
  }


  template <int dim>
  std::size_t EdgeNodes<dim>::memory_consumption() const
  {
    return (number_of.capacity() + moment_of.capacity()) * sizeof(std::uint32_t) +
           moments.capacity() * sizeof(Tensor<1, dim>) + list.capacity() * sizeof(Node);
  }


  PERIDEAL_INSTANTIATE_CLASS(struct CompleteFamilies);
  PERIDEAL_INSTANTIATE_CLASS(class EdgeNodes);
} // namespace PeriDeal
