// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  template <int n_components>
  void StateLattice<dim>::fill(std::vector<double> *to,
                               const std::size_t    group,
                               const double        *values) const
  {
    const std::size_t begin = group == 0 ? 0 : layout.groups[group - 1].fills;
    for (std::size_t f = begin; f < layout.groups[group].fills; ++f)
      {
        const LatticePiece &piece = layout.fills[f];
        const double       *from  = values + static_cast<std::size_t>(n_components) * piece.node;
        for (unsigned int d = 0; d < n_components; ++d)
          {
            double *row = to[d].data() + piece.slot;
            if (!piece.varies())
              for (std::uint32_t k = 0; k < piece.n; ++k)
                row[k] = piece.volume * from[n_components * k + d];
            else
              for (std::uint32_t k = 0; k < piece.n; ++k)
                row[k] = layout.varying_volumes[piece.varying + k] * from[n_components * k + d];
          }
      }
  }


  template <int dim>
  void StateLattice<dim>::fill_excess(const double *u) const
  {
    for (const ExcessSlot &at : excess_slots)
      for (unsigned int d = 0; d < dim; ++d)
        excesses[d][at.slot] = at.factor * u[static_cast<std::size_t>(dim) * at.node + d];
  }


  template <int dim>
  void StateLattice<dim>::convolve(const std::vector<StencilKernel::Term> &terms,
                                   const std::size_t                       first_term,
                                   const std::size_t                       group,
                                   double                                 *to) const
  {
    const std::size_t begin = group == 0 ? 0 : layout.groups[group - 1].runs,
                      end   = layout.groups[group].runs;
    for (std::size_t k = begin; k < end; ++k)
      runs[k].out = to + places[k];
    StencilKernel::apply_sum(terms.data() + first_term,
                             terms.size() - first_term,
                             runs.data() + begin,
                             end - begin);
  }


  template <int dim>
  void StateLattice<dim>::convolve_edges(const std::size_t group) const
  {
    for (std::size_t c = group == 0 ? 0 : groups[group - 1].clusters; c < groups[group].clusters;
         ++c)
      {
        const std::size_t begin = c == 0 ? 0 : clusters[c - 1], n = clusters[c] - begin;
        for (unsigned int a = 0; a < dim; ++a)
          for (const bool own : {true, false})
            {
              double *to = (own ? own_sums : other_sums)[a].data();
              for (std::size_t k = begin; k < begin + n; ++k)
                edge_runs[k].out = to + edge_places[k];
              StencilKernel::apply_sum(own ? force_terms[a].data() + 1 : excess_terms[a].data(),
                                       dim,
                                       edge_runs.data() + begin,
                                       n);
            }
      }
  }


  template <int dim>
  void StateLattice<dim>::dilatation_forces(double *tau, const double *u) const
  {
    std::size_t s = 0;
    for (std::size_t group = 0; group < groups.size(); ++group)
      {
        fill<dim>(displacements.data(), group, u);
        convolve(dilatation_terms, 0, group, sums[0].data());
        for (; s < groups[group].stretches; ++s)
          {
            const Stretch      &stretch = stretches[s];
            const double *const found   = sums[0].data() + stretch.at;
            double *const       to      = tau + stretch.node;
            if (stretch.edge == none)
              for (std::uint32_t k = 0; k < stretch.n; ++k)
                to[k] = dilatation * found[k];
            else
              for (std::uint32_t k = 0; k < stretch.n; ++k)
                {
                  const EdgeNode     &edge = edges[stretch.edge + k];
                  const double *const own  = u + static_cast<std::size_t>(dim) * (stretch.node + k);
                  double              sum  = found[k];
                  for (unsigned int d = 0; d < dim; ++d)
                    sum -= edge.moment[d] * own[d];
                  to[k] = edge.dilatation * sum;
                }
          }
      }
  }


  template <int dim>
  void StateLattice<dim>::finish(const Stretch &stretch, double *y) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double *const from = sums[d].data() + stretch.at;
        double *const       to   = y + static_cast<std::size_t>(dim) * stretch.node + d;
        for (std::uint32_t k = 0; k < stretch.n; ++k)
          to[dim * k] = -volume * from[k];
      }
  }


  template <int dim>
  void StateLattice<dim>::finish_edge(const Stretch &stretch,
                                      const double  *u,
                                      const double  *tau,
                                      double        *y) const
  {
    for (std::uint32_t k = 0; k < stretch.n; ++k)
      {
        const EdgeNode     &edge = edges[stretch.edge + k];
        const std::size_t   node = stretch.node + k, at = stretch.at + k;
        const double *const own     = u + dim * node;
        const double        tension = tau != nullptr ? tau[node] : 0.;
        for (unsigned int a = 0; a < dim; ++a)
          {
            double force = sums[a][at] + tension * edge.moment[a] + edge.excess * own_sums[a][at];
            if (!excess_slots.empty())
              force += other_sums[a][at];
            for (unsigned int b = 0; b < dim; ++b)
              force -= edge.block[pair(a, b)] * own[b];
            y[dim * node + a] = -families.nodes().volume(node) * force;
          }
      }
  }


  template <int dim>
  void StateLattice<dim>::forces(double *y, const double *u, const double *tau) const
  {
    const bool with_tau = dim > 1 && tau != nullptr;
    fill_excess(u);
    std::size_t s = 0;
    for (std::size_t group = 0; group < groups.size(); ++group)
      {
        if (with_tau)
          fill<1>(&tensions, group, tau);
        else
          fill<dim>(displacements.data(), group, u);
        for (unsigned int a = 0; a < dim; ++a)
          convolve(force_terms[a], with_tau ? 0 : 1, group, sums[a].data());
        if (!excess_slots.empty())
          convolve_edges(group);
        for (; s < groups[group].stretches; ++s)
          if (stretches[s].edge == none)
            finish(stretches[s], y);
          else
            finish_edge(stretches[s], u, tau, y);
      }
  }


#define PERIDEAL_INSTANTIATE(dim)                                                     \
  template void StateLattice<dim>::dilatation_forces(double *, const double *) const; \
  template void StateLattice<dim>::forces(double *, const double *, const double *) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
