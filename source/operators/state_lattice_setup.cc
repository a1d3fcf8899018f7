// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What the lattice of elastic bonds knows before it computes anything.

#include <perideal/mesh/lattice_sites.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::array<int, 3> no_offset()
    {
      return {{0, 0, 0}};
    }

    /** Reach of the family along each axis. */
    template <int dim>
    std::array<int, 3> reach_of(const Families<dim> &families)
    {
      std::array<int, 3> reach = no_offset();
      for (const FamilyMember<dim> &member : families.weights().members())
        for (unsigned int d = 0; d < dim; ++d)
          reach[d] = std::max(reach[d], member.offset[d]);
      return reach;
    }

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
  std::string StateLattice<dim>::obstacle(const BodyParameters<dim> &body)
  {
    return body.elasticity.kinematics == Kinematics::full ?
             "with 'Kinematics = full' each bond has its own direction" :
           body.material.fracture_energy || body.material.critical_stretch ?
             "bonds may break" :
           body.peridynamics.corrects_elastic_bonds() ?
             "with 'Surface correction' bonds have factors of their own" :
             "";
  }


  template <int dim>
  StateLattice<dim>::StateLattice(const Families<dim>     &families,
                                  const Coefficients      &coefficients,
                                  const std::vector<bool> &computed)
    : families(families)
    , volume(families.nodes().lattice()->cell_volume())
    , reference(coefficients.stiffness)
    , dilatation(coefficients.dilatation)
    , layout(families, reach_of(families), computed)
  {
    make_kernels();
    find_edges(coefficients, computed);
    find_stretches();
    std::vector<double> volumes(families.nodes().n_local());
    for (unsigned int i = 0; i < volumes.size(); ++i)
      volumes[i] = families.nodes().volume(i);
    layout.set_values(volumes, std::vector<double>(families.nodes().n_owned(), 0.));
    for (unsigned int i = 0; i < volumes.size(); ++i)
      {
        const auto site = families.nodes().lattice()->index(families.nodes().position(i));
        if (excess[i] != 0. && layout.in_grid(site))
          excess_slots.push_back({layout.slot(site), i, volumes[i] * excess[i]});
      }
    set_terms();
  }


  template <int dim>
  void StateLattice<dim>::make_kernels()
  {
    const Lattice<dim>             &lattice = *families.nodes().lattice();
    std::vector<std::array<int, 3>> offsets{no_offset()};
    std::vector<Tensor<1, dim>>     vectors{Tensor<1, dim>()};
    std::vector<double>             weights{0.};
    std::fill(center, center + dim, 0.);
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        const Tensor<1, dim> xi = bond_of(member, lattice);
        for (unsigned int d = 0; d < dim; ++d)
          center[d] -= 2. * reference * member.weight * xi[d] * xi[d] / xi.norm_square();
        if (*std::min_element(member.offset.begin(), member.offset.end()) < 0)
          continue;
        std::array<int, 3> offset = no_offset();
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
        std::array<bool, 3> odd{{false, false, false}};
        odd[a] = true;
        moments.emplace_back(dim, offsets, values, odd);
      }
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        {
          values[0] = a == b ? center[a] : 0.;
          for (std::size_t k = 1; k < values.size(); ++k)
            values[k] = 2. * reference * weights[k] * vectors[k][a] * vectors[k][b] /
                        vectors[k].norm_square();
          std::array<bool, 3> odd{{false, false, false}};
          odd[a] = odd[b] = a != b;
          springs.emplace_back(dim, offsets, values, odd);
        }
  }


  template <int dim>
  typename StateLattice<dim>::EdgeNode StateLattice<dim>::edge_node(
    const unsigned int  i,
    const Coefficients &coefficients) const
  {
    const Nodes<dim> &nodes = families.nodes();
    const auto        site  = nodes.lattice()->index(nodes.position(i));
    EdgeNode          edge;
    edge.excess     = excess[i];
    edge.dilatation = coefficients.dilatations.empty() ? 0. : coefficients.dilatations[i];
    edge.block.fill(0.);
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        const unsigned int j = families.neighbors().node_at(site + member.offset);
        if (j == numbers::invalid_unsigned_int)
          continue;
        const Tensor<1, dim> xi     = bond_of(member, *nodes.lattice());
        const double         weight = nodes.volume(j) * member.weight,
                     spring =
                       2. * reference * (1. + excess[i] + excess[j]) * weight / xi.norm_square();
        edge.moment += weight * xi;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            edge.block[pair(a, b)] += spring * xi[a] * xi[b];
      }
    for (unsigned int a = 0; a < dim; ++a)
      edge.block[pair(a, a)] += center[a] * nodes.volume(i) * (1. + 2. * excess[i]);
    return edge;
  }


  template <int dim>
  void StateLattice<dim>::find_edges(const Coefficients      &coefficients,
                                     const std::vector<bool> &computed)
  {
    const Nodes<dim> &nodes = families.nodes();
    for (const double s : coefficients.stiffnesses)
      excess.push_back(0.5 * (s / reference - 1.)); // those of most nodes are equal to the last bit
    edge_of.assign(nodes.n_owned(), none);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        if (!computed[i])
          continue;
        const auto like_most = [&](const unsigned int j) {
          return j != numbers::invalid_unsigned_int && nodes.volume(j) == volume && excess[j] == 0.;
        };
        bool       regular = like_most(i) && (coefficients.dilatations.empty() ||
                                        coefficients.dilatations[i] == dilatation);
        const auto site    = nodes.lattice()->index(nodes.position(i));
        for (const FamilyMember<dim> &member : families.weights().members())
          regular = regular && like_most(families.neighbors().node_at(site + member.offset));
        if (regular)
          continue;
        edge_of[i] = static_cast<std::uint32_t>(edges.size());
        edges.push_back(edge_node(i, coefficients));
      }
    edges.shrink_to_fit();
  }


  template <int dim>
  void StateLattice<dim>::find_stretches()
  {
    std::size_t run = 0, most = 0;
    runs = layout.runs;
    for (const auto &group : layout.groups)
      {
        std::map<std::array<std::ptrdiff_t, 3>, std::uint32_t> places_of; // of edge runs
        std::uint32_t                                          at = 0;
        for (; run < group.runs; ++run)
          {
            places.push_back(at);
            const std::uint32_t node = layout.first_nodes[run],
                                n    = static_cast<std::uint32_t>(runs[run].n);
            for (std::uint32_t k = 0; k < n; ++k)
              {
                const std::uint32_t edge    = edge_of[node + k];
                Stretch            *last    = k > 0 ? &stretches.back() : nullptr;
                const bool          goes_on = last != nullptr &&
                                     (edge == none ?
                                        last->edge == none :
                                        last->edge != none && last->edge + last->n == edge);
                if (goes_on)
                  ++last->n;
                else
                  {
                    stretches.push_back({node + k, 1, at + k, edge});
                    if (edge != none)
                      {
                        StencilKernel::Run part = runs[run];
                        part.x += k;
                        edge_runs.push_back(part);
                        places_of[{part.x, part.y, part.z}] = at + k;
                      }
                  }
                if (edge != none)
                  edge_runs.back().n = stretches.back().n;
              }
            at += n;
          }
        find_clusters(clusters.empty() ? 0 : clusters.back(), edge_runs.size());
        for (std::size_t k = edge_places.size(); k < edge_runs.size(); ++k)
          edge_places.push_back(places_of.at({edge_runs[k].x, edge_runs[k].y, edge_runs[k].z}));
        groups.push_back({stretches.size(), clusters.size()});
        most = std::max<std::size_t>(most, at);
      }
    stretches.shrink_to_fit();
    for (unsigned int d = 0; d < dim; ++d)
      for (auto *list : {&sums[d], &own_sums[d], &other_sums[d]})
        list->resize(list == &sums[d] || !edges.empty() ? most : 0);
  }


  /**
   * Edge runs of a group are computed in rectangles, what lies between them too: cut the group
   * where that saves work. Neither part of a cut shares a row, or neither a column.
   */
  template <int dim>
  void StateLattice<dim>::find_clusters(const std::size_t begin, const std::size_t end)
  {
    if (begin == end)
      return;
    const auto first = edge_runs.begin() + begin, last = edge_runs.begin() + end;
    const auto cost = [&](const auto from, const auto to) {
      std::ptrdiff_t low[2] = {from->x, from->y}, high[2] = {from->x, from->y};
      for (auto run = from; run != to; ++run)
        {
          low[0]  = std::min(low[0], run->x);
          high[0] = std::max(high[0], run->x + static_cast<std::ptrdiff_t>(run->n));
          low[1]  = std::min(low[1], run->y);
          high[1] = std::max(high[1], run->y + 1);
        }
      return (high[0] - low[0] + 8.) * (high[1] - low[1] + 4.);
    };
    const auto by_column = [](const auto &a, const auto &b) {
      return std::tie(a.x, a.y) < std::tie(b.x, b.y);
    };
    const auto by_row = [](const auto &a, const auto &b) {
      return std::tie(a.y, a.x) < std::tie(b.y, b.x);
    };
    double      best   = 0.9 * cost(first, last);
    std::size_t cut    = 0;
    bool        column = false;
    for (const bool along_x : {true, false})
      {
        along_x ? std::sort(first, last, by_column) : std::sort(first, last, by_row);
        std::ptrdiff_t filled = first->x;
        for (auto run = first; run != last; ++run)
          {
            const bool may_cut = run != first &&
                                 (along_x ? run->x >= filled : run->y > (run - 1)->y);
            filled = std::max(filled, run->x + static_cast<std::ptrdiff_t>(run->n));
            if (!may_cut)
              continue;
            const double found = cost(first, run) + cost(run, last);
            if (found < best)
              {
                best   = found;
                cut    = run - first;
                column = along_x;
              }
          }
      }
    if (cut == 0)
      {
        clusters.push_back(end);
        return;
      }
    if (column)
      std::sort(first, last, by_column);
    find_clusters(begin, begin + cut);
    find_clusters(begin + cut, end);
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
        excesses[d].resize(excess_slots.empty() ? 0 : n, 0.);
      }
    for (unsigned int a = 0; a < dim; ++a)
      {
        dilatation_terms.push_back({&moments[a], layout.grid(displacements[a].data())});
        force_terms[a].push_back({&moments[a], layout.grid(tensions.data())});
        for (unsigned int b = 0; b < dim; ++b)
          {
            const StencilKernel *kernel = &springs[pair(a, b)];
            force_terms[a].push_back({kernel, layout.grid(displacements[b].data())});
            excess_terms[a].push_back({kernel, layout.grid(excesses[b].data())});
          }
      }
  }


  template <int dim>
  bool StateLattice<dim>::is_regular(const unsigned int node) const
  {
    return edge_of[node] == none;
  }


  template <int dim>
  std::size_t StateLattice<dim>::memory_consumption() const
  {
    std::size_t bytes = layout.memory_consumption() + excess.capacity() * sizeof(double) +
                        edge_of.capacity() * sizeof(std::uint32_t) +
                        edges.capacity() * sizeof(EdgeNode) + groups.capacity() * sizeof(Group) +
                        stretches.capacity() * sizeof(Stretch) +
                        (places.capacity() + edge_places.capacity()) * sizeof(std::uint32_t) +
                        excess_slots.capacity() * sizeof(ExcessSlot) +
                        (runs.capacity() + edge_runs.capacity()) * sizeof(StencilKernel::Run) +
                        tensions.capacity() * sizeof(double);
    for (unsigned int d = 0; d < dim; ++d)
      for (const auto *list :
           {&displacements[d], &excesses[d], &sums[d], &own_sums[d], &other_sums[d]})
        bytes += list->capacity() * sizeof(double);
    return bytes;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                   \
  template std::string StateLattice<dim>::obstacle(const BodyParameters<dim> &);    \
  template StateLattice<dim>::StateLattice(const Families<dim> &,                   \
                                           const StateLattice<dim>::Coefficients &, \
                                           const std::vector<bool> &);              \
  template bool        StateLattice<dim>::is_regular(const unsigned int) const;     \
  template std::size_t StateLattice<dim>::memory_consumption() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
