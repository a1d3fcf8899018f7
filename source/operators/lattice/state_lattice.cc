// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "state_lattice.h"

#include <perideal/base/instantiate.h>
#include <perideal/scene/rules.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::string StateLattice<dim>::obstacle(const BodyParameters<dim> &body)
  {
    return body.elasticity.has_full_kinematics() ?
             "with 'Kinematics = full' each bond has its own direction" :
           body.material.law.kind != SolidLaw::linear && !body.elasticity.is_correspondence() &&
               !relaxes_at_nodes(body) ?
             "with another 'Law' than 'linear' each bond answers by itself" :
           body.moduli_change() && !body.elasticity.is_correspondence() ?
             "moduli that follow a computed temperature change all the time" :
           body.elasticity.is_static() && body.material.breaks() ?
             "bonds may break in a body at rest" :
           body.peridynamics.corrects_elastic_bonds() ?
             "with 'Surface correction' bonds have factors of their own" :
             "";
  }


  template <int dim>
  StateLattice<dim>::StateLattice(const Families<dim>       &families,
                                  const LatticeCoefficients &coefficients,
                                  const std::vector<bool>   &computed)
    : families(families)
    , complete(families, coefficients)
    , edges(families, complete, coefficients, computed)
    , layout(families, complete.moments[0].halo(), computed)
    , stretches(layout, edges.number_of)
  {
    std::vector<double> volumes(families.nodes().n_local());
    for (unsigned int i = 0; i < volumes.size(); ++i)
      volumes[i] = families.nodes().volume(i);
    layout.set_values(volumes, std::vector<double>(families.nodes().n_owned(), 0.));
    find_excesses(coefficients.excesses, volumes);
    set_terms();
  }


  template <int dim>
  void StateLattice<dim>::find_excesses(const std::vector<double> &excesses,
                                        const std::vector<double> &volumes)
  {
    for (unsigned int i = 0; i < volumes.size(); ++i)
      {
        const auto site = families.nodes().lattice()->index(families.nodes().position(i));
        if (excesses[i] == 0. || !layout.in_grid(site))
          continue;
        const std::size_t slot = layout.slot(site);
        ExcessRun *const  last = excess_runs.empty() ? nullptr : &excess_runs.back();
        if (last != nullptr && last->node + last->n == i && last->slot + last->n == slot)
          ++last->n;
        else
          excess_runs.push_back({slot, i, 1});
        excess_factors.push_back(volumes[i] * excesses[i]);
      }
    excess_runs.shrink_to_fit();
    excess_factors.shrink_to_fit();
  }


  template <int dim>
  void StateLattice<dim>::set_terms()
  {
    const std::size_t n = layout.n_slots();
    if (dim > 1)
      tensions.resize(n, 0.);
    for (unsigned int d = 0; d < dim; ++d)
      {
        displacements[d].resize(n, 0.);
        for (auto *list : {&sums[d], &own_sums[d]})
          list->resize(list == &sums[d] || !edges.list.empty() ? stretches.n_sums : 0);
      }
    for (unsigned int a = 0; a < dim; ++a)
      {
        dilatation_terms.push_back({&complete.moments[a], layout.grid(displacements[a].data())});
        force_terms[a].push_back({&complete.moments[a], layout.grid(tensions.data())});
        for (unsigned int b = 0; b < dim; ++b)
          {
            const StencilKernel *kernel = &complete.springs[complete.pair(a, b)];
            force_terms[a].push_back({kernel, layout.grid(displacements[b].data())});
          }
      }
  }


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
  void StateLattice<dim>::add_up_at_edges(const std::size_t                     group,
                                          std::array<std::vector<double>, dim> &to) const
  {
    for (std::size_t c = group == 0 ? 0 : stretches.groups[group - 1].clusters;
         c < stretches.groups[group].clusters;
         ++c)
      for (unsigned int a = 0; a < dim; ++a)
        stretches.apply_to_cluster(force_terms[a].data() + 1, dim, c, to[a].data());
  }


  /** The sums of V e u take the place of those of V u in the grid, which is filled anew before. */
  template <int dim>
  void StateLattice<dim>::add_excess(double *y, const double *u) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        std::fill(displacements[d].begin(), displacements[d].end(), 0.);
        const double *factor = excess_factors.data();
        for (const ExcessRun &run : excess_runs)
          {
            double *const       to   = displacements[d].data() + run.slot;
            const double *const from = u + static_cast<std::size_t>(dim) * run.node + d;
            for (std::uint32_t k = 0; k < run.n; ++k)
              to[k] = *factor++ * from[dim * k];
          }
      }
    std::size_t s = 0;
    for (std::size_t group = 0; group < stretches.groups.size(); ++group)
      {
        add_up_at_edges(group, own_sums);
        for (; s < stretches.groups[group].stretches; ++s)
          if (const Stretch &stretch = stretches.list[s]; stretch.edge != none)
            for (std::uint32_t k = 0; k < stretch.n; ++k)
              for (unsigned int a = 0; a < dim; ++a)
                y[static_cast<std::size_t>(dim) * (stretch.node + k) + a] -=
                  families.nodes().volume(stretch.node + k) * own_sums[a][stretch.at + k];
      }
  }


  template <int dim>
  void StateLattice<dim>::dilatation_forces(double *tau, const double *u) const
  {
    std::size_t s = 0;
    for (std::size_t group = 0; group < stretches.groups.size(); ++group)
      {
        fill<dim>(displacements.data(), group, u);
        stretches.apply(dilatation_terms.data(), dim, group, sums[0].data());
        for (; s < stretches.groups[group].stretches; ++s)
          {
            const Stretch      &stretch = stretches.list[s];
            const double *const found   = sums[0].data() + stretch.at;
            double *const       to      = tau + stretch.node;
            if (stretch.edge == none)
              for (std::uint32_t k = 0; k < stretch.n; ++k)
                to[k] = complete.dilatation * found[k];
            else
              for (std::uint32_t k = 0; k < stretch.n; ++k)
                {
                  const Tensor<1, dim> &moment = edges.moment(stretch.edge + k);
                  const double *const own = u + static_cast<std::size_t>(dim) * (stretch.node + k);
                  double              sum = found[k];
                  for (unsigned int d = 0; d < dim; ++d)
                    sum -= moment[d] * own[d];
                  to[k] = edges.list[stretch.edge + k].dilatation * sum;
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
          to[dim * k] = -complete.volume * from[k];
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
        const auto           &edge   = edges.list[stretch.edge + k];
        const Tensor<1, dim> &moment = edges.moment(stretch.edge + k);
        const std::size_t     node = stretch.node + k, at = stretch.at + k;
        const double          tension = tau != nullptr ? tau[node] : 0.;
        for (unsigned int a = 0; a < dim; ++a)
          {
            double force = sums[a][at] + tension * moment[a];
            if (u != nullptr)
              {
                force += edge.excess * own_sums[a][at];
                for (unsigned int b = 0; b < dim; ++b)
                  force -= edge.block[complete.pair(a, b)] * u[dim * node + b];
              }
            y[dim * node + a] = -families.nodes().volume(node) * force;
          }
      }
  }


  template <int dim>
  void StateLattice<dim>::forces(double *y, const double *u, const double *tau) const
  {
    const bool  with_tau = dim > 1 && tau != nullptr;
    std::size_t s        = 0;
    for (std::size_t group = 0; group < stretches.groups.size(); ++group)
      {
        if (with_tau)
          fill<1>(&tensions, group, tau);
        else
          fill<dim>(displacements.data(), group, u);
        for (unsigned int a = 0; a < dim; ++a)
          stretches.apply(force_terms[a].data() + (with_tau ? 0 : 1),
                          (u != nullptr ? dim : 0) + (with_tau ? 1 : 0),
                          group,
                          sums[a].data());
        if (u != nullptr && !excess_runs.empty())
          add_up_at_edges(group, own_sums);
        for (; s < stretches.groups[group].stretches; ++s)
          if (stretches.list[s].edge == none)
            finish(stretches.list[s], y);
          else
            finish_edge(stretches.list[s], u, tau, y);
      }
    if (u != nullptr && !excess_runs.empty())
      add_excess(y, u);
  }


  template <int dim>
  bool StateLattice<dim>::is_regular(const unsigned int node) const
  {
    return edges.number_of[node] == none;
  }


  template <int dim>
  std::size_t StateLattice<dim>::memory_consumption() const
  {
    std::size_t bytes = layout.memory_consumption() + edges.memory_consumption() +
                        stretches.memory_consumption() +
                        excess_runs.capacity() * sizeof(ExcessRun) +
                        (excess_factors.capacity() + tensions.capacity()) * sizeof(double);
    for (unsigned int d = 0; d < dim; ++d)
      for (const auto *list : {&displacements[d], &sums[d], &own_sums[d]})
        bytes += list->capacity() * sizeof(double);
    return bytes;
  }


  PERIDEAL_INSTANTIATE_CLASS(class StateLattice);
} // namespace PeriDeal
