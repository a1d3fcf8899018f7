// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "gradient_lattice.h"

#include <perideal/base/instantiate.h>
#include <perideal/mesh/lattice_sites.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Stencils of w xi_a, odd in a, and of w. */
    template <int dim>
    std::vector<StencilKernel> kernels_of_gradients(const Families<dim> &families)
    {
      const Lattice<dim>             &lattice = *families.nodes().lattice();
      std::vector<std::array<int, 3>> offsets(1);
      std::vector<double>             weights(1, 0.);
      for (const FamilyMember<dim> &member : families.weights().members())
        if (*std::min_element(member.offset.begin(), member.offset.end()) >= 0)
          {
            std::array<int, 3> offset{};
            std::copy(member.offset.begin(), member.offset.end(), offset.begin());
            offsets.push_back(offset);
            weights.push_back(member.weight);
          }
      std::vector<StencilKernel> kernels;
      for (unsigned int a = 0; a < dim; ++a)
        {
          std::vector<double> moments(weights);
          for (std::size_t k = 0; k < moments.size(); ++k)
            moments[k] *= offsets[k][a] * lattice.spacing[a];
          std::array<bool, 3> odd{};
          odd[a] = true;
          kernels.emplace_back(dim, offsets, moments, odd);
        }
      kernels.emplace_back(dim, offsets, weights);
      return kernels;
    }
  } // namespace


  template <int dim>
  GradientLattice<dim>::GradientLattice(const Families<dim>     &families,
                                        const std::vector<bool> &computed)
    : layout(families, kernels_of_gradients(families)[dim].halo(), computed)
    , families(families)
    , stretches(layout, std::vector<std::uint32_t>(families.nodes().n_owned(), LatticePiece::none))
    , kernels(kernels_of_gradients(families))
  {
    const Nodes<dim>   &nodes = families.nodes();
    std::vector<double> volumes(nodes.n_local());
    for (unsigned int i = 0; i < volumes.size(); ++i)
      volumes[i] = nodes.volume(i);
    layout.set_values(volumes, std::vector<double>(nodes.n_owned(), 0.));
    for (unsigned int d = 0; d < dim; ++d)
      displacements[d].resize(layout.n_slots(), 0.);
    for (auto *list : {&squares_of, &stiffnesses})
      list->resize(layout.n_slots(), 0.);
    for (auto &list : tensors)
      list.resize(layout.n_slots(), 0.);
    for (auto &list : products)
      list.resize(layout.n_slots(), 0.);
    found.resize((dim * dim + dim + 1) * stretches.n_sums);
    smooth.resize(dim * nodes.n_owned());
    edges.resize(nodes.n_owned());
    for (std::size_t k = 0; k < stretches.list.size(); ++k)
      for (std::uint32_t l = 0; l < stretches.list[k].n; ++l)
        {
          const std::uint32_t i    = stretches.list[k].node + l;
          const auto          site = nodes.lattice()->index(nodes.position(i));
          for (const FamilyMember<dim> &member : families.weights().members())
            if (const unsigned int j = families.neighbors().node_at(site + member.offset);
                j != numbers::invalid_unsigned_int)
              {
                const double weight = nodes.volume(j) * member.weight;
                edges[i].all += weight;
                for (unsigned int d = 0; d < dim; ++d)
                  edges[i].moment[d] += weight * (member.offset[d] * nodes.lattice()->spacing[d]);
              }
        }
  }


  template <int dim>
  template <typename Value>
  void GradientLattice<dim>::fill(const std::size_t    group,
                                  std::vector<double> &grid,
                                  const Value         &value) const
  {
    const std::size_t begin = group == 0 ? 0 : layout.groups[group - 1].fills;
    for (std::size_t f = begin; f < layout.groups[group].fills; ++f)
      {
        const LatticePiece &piece = layout.fills[f];
        double *const       row   = grid.data() + piece.slot;
        if (piece.varies())
          for (std::uint32_t k = 0; k < piece.n; ++k)
            row[k] = layout.varying_volumes[piece.varying + k] * value(piece.node + k);
        else
          for (std::uint32_t k = 0; k < piece.n; ++k)
            row[k] = piece.volume * value(piece.node + k);
      }
  }


  template <int dim>
  void GradientLattice<dim>::sum_group(const std::size_t group,
                                       const double     *u,
                                       const bool        squares) const
  {
    const std::size_t n  = stretches.n_sums;
    const auto        at = [&](const std::size_t k) { return found.data() + k * n; };
    for (unsigned int a = 0; a < dim; ++a)
      fill(group, displacements[a], [u, a](const std::size_t i) { return u[dim * i + a]; });
    for (unsigned int a = 0; a < dim; ++a)
      {
        const StencilKernel::Grid grid = layout.grid(displacements[a].data());
        for (unsigned int b = 0; b <= dim; ++b)
          {
            const StencilKernel::Term term{&kernels[b], grid};
            stretches.apply(&term, 1, group, at(b < dim ? dim * a + b : dim * dim + a));
          }
      }
    if (!squares)
      return;
    fill(group, squares_of, [u](const std::size_t i) {
      double square = 0.;
      for (unsigned int a = 0; a < dim; ++a)
        square += u[dim * i + a] * u[dim * i + a];
      return square;
    });
    const StencilKernel::Term term{&kernels[dim], layout.grid(squares_of.data())};
    stretches.apply(&term, 1, group, at(dim * dim + dim));
  }


  template <int dim>
  void GradientLattice<dim>::find_forces(double            *y,
                                         const double      *u,
                                         const double      *numbers,
                                         const unsigned int n) const
  {
    const std::size_t n_sums = stretches.n_sums;
    std::size_t       s      = 0;
    for (std::size_t group = 0; group < stretches.groups.size(); ++group)
      {
        for (unsigned int k = 0; k < dim * dim; ++k)
          fill(group, tensors[k], [=](const std::size_t i) { return numbers[n * i + k]; });
        fill(group, stiffnesses, [=](const std::size_t i) { return numbers[n * i + dim * dim]; });
        for (unsigned int a = 0; a < dim; ++a)
          fill(group, products[a], [=](const std::size_t i) {
            return numbers[n * i + dim * dim] * u[dim * i + a];
          });
        for (unsigned int a = 0; a < dim; ++a)
          {
            std::array<StencilKernel::Term, dim + 1> terms;
            for (unsigned int b = 0; b < dim; ++b)
              terms[b] = {&kernels[b], layout.grid(tensors[dim * a + b].data())};
            terms[dim] = {&kernels[dim], layout.grid(products[a].data())};
            stretches.apply(terms.data(), dim + 1, group, found.data() + a * n_sums);
          }
        const StencilKernel::Term term{&kernels[dim], layout.grid(stiffnesses.data())};
        stretches.apply(&term, 1, group, found.data() + dim * n_sums);
        for (; s < stretches.groups[group].stretches; ++s)
          for (std::uint32_t k = 0; k < stretches.list[s].n; ++k)
            {
              const std::size_t   node   = stretches.list[s].node + k;
              const double *const at     = found.data() + stretches.list[s].at + k;
              const double *const own    = numbers + n * node;
              const Edge         &edge   = edges[node];
              const double        volume = families.nodes().volume(node);
              for (unsigned int a = 0; a < dim; ++a)
                {
                  const double value = u[dim * node + a];
                  double       force = at[a * n_sums] - value * at[dim * n_sums] +
                                 own[dim * dim] * (smooth[dim * node + a] - edge.all * value);
                  for (unsigned int b = 0; b < dim; ++b)
                    force += own[dim * a + b] * edge.moment[b];
                  y[dim * node + a] = -volume * force;
                }
            }
      }
  }


  template <int dim>
  std::size_t GradientLattice<dim>::memory_consumption() const
  {
    std::size_t n =
      squares_of.capacity() + stiffnesses.capacity() + found.capacity() + smooth.capacity();
    for (const auto &list : displacements)
      n += list.capacity();
    for (const auto &list : tensors)
      n += list.capacity();
    for (const auto &list : products)
      n += list.capacity();
    return n * sizeof(double) + edges.capacity() * sizeof(Edge) + layout.memory_consumption() +
           stretches.memory_consumption();
  }


  PERIDEAL_INSTANTIATE_CLASS(class GradientLattice);
} // namespace PeriDeal
