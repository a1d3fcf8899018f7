// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/bonds/node_factors.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  NodeFactors<dim>::NodeFactors(const Neighbors<dim> &neighbors)
    : neighbors(neighbors)
  {}


  template <int dim>
  void NodeFactors<dim>::set(std::vector<double> of_nodes,
                             const unsigned int  n,
                             const bool          have_mirrors)
  {
    Assert(of_nodes.empty() || of_nodes.size() == neighbors.nodes().n_local() * n,
           ExcDimensionMismatch(of_nodes.size(), neighbors.nodes().n_local() * n));
    factors      = std::move(of_nodes);
    n_directions = n;
    mirrored     = have_mirrors;
  }


  template <int dim>
  double NodeFactors<dim>::of_node(const unsigned int node, const unsigned int direction) const
  {
    if (!mirrored && !neighbors.is_real(node))
      return 1.;
    return factors[neighbors.real(node) * n_directions + direction];
  }


  template <int dim>
  double NodeFactors<dim>::of_bond(const unsigned int node, const unsigned int neighbor) const
  {
    if (n_directions == 1)
      return 0.5 * (of_node(node, 0) + of_node(neighbor, 0));
    const Tensor<1, dim> xi  = neighbors.bond_vector(node, neighbor);
    double               sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      sum += 0.5 * (of_node(node, d) + of_node(neighbor, d)) * xi[d] * xi[d];
    return sum / xi.norm_square();
  }


  template <int dim>
  std::size_t NodeFactors<dim>::memory_consumption() const
  {
    return factors.capacity() * sizeof(double);
  }

  PERIDEAL_INSTANTIATE_CLASS(class NodeFactors);
} // namespace PeriDeal
