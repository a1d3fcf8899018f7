// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "lattice_histories.h"

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>

#include <unordered_map>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  LatticeHistories<dim>::LatticeHistories(const Families<dim>      &families,
                                          const LatticeLayout<dim> &layout)
    : families(families)
    , layout(layout)
  {
    const Nodes<dim>         &nodes_of = families.nodes();
    const Lattice<dim>       &lattice  = *nodes_of.lattice();
    const StencilKernel::Grid grid     = layout.grid(nullptr);
    const std::size_t         n        = layout.n_slots();
    row.length                         = dim > 1 ? grid.row_stride : n;
    const std::size_t first            = layout.runs.empty() ? 0 : layout.runs.front().x;
    row.before                         = (width - first % width) % width;
    row.n                              = (row.length + row.before + width - 1) / width;
    number_of.assign(n / row.length * row.n, none);
    nodes.assign(n, none);
    slots.assign(nodes_of.n_local(), none);
    for (unsigned int i = 0; i < nodes_of.n_local(); ++i)
      if (const auto site = lattice.index(nodes_of.position(i)); layout.in_grid(site))
        {
          slots[i]        = static_cast<std::uint32_t>(layout.slot(site));
          nodes[slots[i]] = i;
        }
    const auto &members = families.weights().members();
    for (std::size_t k = 0; k < members.size(); ++k)
      family.numbers.push_back(k);
    std::stable_sort(family.numbers.begin(),
                     family.numbers.end(),
                     [&](const std::size_t k, const std::size_t l) {
                       return members[k].offset[0] > members[l].offset[0];
                     });
    for (const std::size_t k : family.numbers)
      {
        const auto    &offset = members[k].offset;
        std::ptrdiff_t step   = offset[0];
        if (dim > 1)
          step += offset[dim > 1] * static_cast<std::ptrdiff_t>(row.length);
        if (dim > 2)
          step += offset[dim - 1] * static_cast<std::ptrdiff_t>(grid.plane_stride);
        family.offsets.push_back(step);
        family.weights.push_back(members[k].weight);
        for (unsigned int d = 0; d < dim; ++d)
          family.vectors.push_back(offset[d] * lattice.spacing[d]);
        row.margin = std::max(row.margin, static_cast<std::size_t>(std::abs(step)) + 2 * width);
      }
  }


  template <int dim>
  void LatticeHistories<dim>::make_grids(Grids &of)
  {
    if (!of[0].empty())
      return;
    for (auto &grid : of)
      grid.resize(layout.n_slots() + 2 * row.margin, 0.);
    for (const LatticePiece &piece : layout.fills)
      for (std::uint32_t k = 0; k < piece.n; ++k)
        of[dim][row.margin + piece.slot + k] = families.nodes().volume(piece.node + k);
  }


  template <int dim>
  void LatticeHistories<dim>::take(const double *u)
  {
    make_grids(grids);
    for (const LatticePiece &piece : layout.fills)
      for (unsigned int a = 0; a < dim; ++a)
        {
          double *const       to   = grids[a].data() + row.margin + piece.slot;
          const double *const from = u + static_cast<std::size_t>(dim) * piece.node + a;
          for (std::uint32_t k = 0; k < piece.n; ++k)
            to[k] = from[dim * k];
        }
  }


  template <int dim>
  void LatticeHistories<dim>::want(const unsigned int node)
  {
    const std::size_t slot = slots[node];
    if (slot == none)
      return;
    const std::size_t at = slot / row.length, place = (slot % row.length + row.before) / width;
    std::uint32_t    &number = number_of[at * row.n + place];
    if (number == none)
      {
        number = static_cast<std::uint32_t>(chunks.size());
        chunks.emplace_back();
        Chunk &chunk = chunks.back();
        chunk.begin  = at * row.length;
        chunk.end    = chunk.begin + row.length;
        chunk.slot   = chunk.begin + place * width - static_cast<std::ptrdiff_t>(row.before);
        chunk.plastic.resize(dim * width * family.weights.size());
      }
    if (chunks[number].wanted == 0)
      wanted.push_back(number);
    chunks[number].wanted |= 1U << ((slot % row.length + row.before) % width);
  }


  template <int dim>
  BondChunk LatticeHistories<dim>::bonds_of(const Chunk  &chunk,
                                            const Grids  &grids,
                                            const double *slopes) const
  {
    BondChunk bonds;
    bonds.n_bonds = family.weights.size();
    bonds.offsets = family.offsets.data();
    bonds.vectors = family.vectors.data();
    bonds.weights = family.weights.data();
    for (unsigned int a = 0; a < dim; ++a)
      bonds.values[a] = grids[a].data() + row.margin + chunk.slot;
    bonds.volumes = grids[dim].data() + row.margin + chunk.slot;
    bonds.slopes  = slopes;
    return bonds;
  }


  template <int dim>
  void LatticeHistories<dim>::flow(Chunk &chunk)
  {
    if (chunk.is_pending)
      PeriDeal::let_flow<dim>(bonds_of(chunk, before, chunk.slopes),
                              chunk.lost,
                              chunk.plastic.data());
    chunk.is_pending = false;
  }


  template <int dim>
  void LatticeHistories<dim>::subtract_far(double                                          *y,
                                           const Of                                         what,
                                           const std::function<double(const unsigned int)> &factor)
  {
    if (std::none_of(chunks.begin(), chunks.end(), [=](const Chunk &chunk) {
          return chunk.has(what);
        }))
      return;
    double *to[dim];
    for (unsigned int a = 0; a < dim; ++a)
      {
        far[a].assign(layout.n_slots() + 2 * row.margin, 0.);
        to[a] = far[a].data() + row.margin;
      }
    double factors[width];
    for (const std::uint32_t number : number_of) // sums do not depend on who owns which nodes
      {
        if (number == none || !chunks[number].has(what))
          continue;
        Chunk &chunk = chunks[number];
        flow(chunk);
        for (unsigned int k = 0; k < width; ++k)
          {
            const unsigned int node = node_at(chunk, k);
            factors[k] = node == none ? 0. : families.nodes().volume(node) * factor(node);
          }
        double *to_chunk[dim];
        for (unsigned int a = 0; a < dim; ++a)
          to_chunk[a] = to[a] + chunk.slot;
        add_to_far_ends<dim>(bonds_of(chunk, grids, nullptr),
                             factors,
                             (what == Of::plastic ? chunk.plastic : chunk.elastic).data(),
                             to_chunk);
      }
    for (std::size_t r = 0; r < layout.runs.size(); ++r)
      for (std::size_t node = layout.first_nodes[r];
           node < layout.first_nodes[r] + layout.runs[r].n;
           ++node)
        for (unsigned int a = 0; a < dim; ++a)
          y[dim * node + a] -= families.nodes().volume(node) * to[a][slots[node]];
  }


  template <int dim>
  void LatticeHistories<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    const std::size_t n = family.weights.size();
    make_grids(grids);
    for (Chunk &chunk : chunks)
      flow(chunk);
    KeyedPairs pairs; // a node, and which of its family
    if (!archive.loads())
      for (const Chunk &chunk : chunks)
        for (unsigned int k = 0; chunk.remembers && k < width; ++k)
          {
            const unsigned int node = node_at(chunk, k);
            if (node >= families.nodes().n_owned())
              continue;
            const auto of_bond = [&](const std::size_t bond, const unsigned int a) {
              return chunk.plastic[(dim * bond + a) * width + k];
            };
            bool any = false;
            for (std::size_t c = 0; c < dim * n; ++c)
              any = any || chunk.plastic[c * width + k] != 0.;
            for (std::size_t bond = 0; any && bond < n; ++bond)
              if (grids[dim][row.margin + chunk.slot + k + family.offsets[bond]] > 0.)
                {
                  pairs.keys.push_back({keys[node], family.numbers[bond]});
                  for (unsigned int a = 0; a < dim; ++a)
                    pairs.values.push_back(of_bond(bond, a));
                }
          }
    const Archive::Part part(archive, "lattice");
    archive.exchange("history", pairs, keys);
    if (!archive.loads())
      return;
    chunks.clear();
    std::fill(number_of.begin(), number_of.end(), none);
    std::vector<std::size_t> place_of(n); // of members of the family
    for (std::size_t bond = 0; bond < n; ++bond)
      place_of[family.numbers[bond]] = bond;
    std::unordered_map<std::uint64_t, unsigned int> node_of;
    for (unsigned int node = 0; node < keys.size(); ++node)
      node_of[keys[node]] = node;
    for (std::size_t k = 0; k < pairs.keys.size(); ++k)
      {
        const unsigned int node = node_of.at(pairs.keys[k][0]);
        want(node);
        Chunk &chunk    = chunks[wanted.back()];
        chunk.wanted    = 0;
        chunk.remembers = true;
        wanted.clear();
        const std::size_t first = dim * place_of[pairs.keys[k][1]];
        for (unsigned int a = 0; a < dim; ++a)
          chunk.plastic[(first + a) * width + (slots[node] - chunk.slot)] =
            pairs.values[dim * k + a];
      }
    exchange_ghosts();
  }


  template <int dim>
  void LatticeHistories<dim>::exchange_ghosts()
  {
    const Nodes<dim> &all = families.nodes();
    if (Utilities::MPI::max(chunks.empty() ? 0 : 1, all.communicator()) == 0)
      return;
    Vector of_bond(interleaved(*all.partitioner(), dim));
    for (std::size_t bond = 0; bond < family.weights.size(); ++bond)
      {
        of_bond = 0.;
        for (const Chunk &chunk : chunks)
          for (unsigned int k = 0; k < width; ++k)
            if (const unsigned int node = node_at(chunk, k); node < all.n_owned())
              for (unsigned int a = 0; a < dim; ++a)
                of_bond.local_element(dim * node + a) = chunk.plastic[(dim * bond + a) * width + k];
        of_bond.update_ghost_values();
        for (unsigned int node = all.n_owned(); node < all.n_local(); ++node)
          for (unsigned int a = 0; a < dim; ++a)
            if (const double value = of_bond.local_element(dim * node + a);
                value != 0. && slots[node] != none)
              {
                want(node);
                Chunk &chunk    = chunks[wanted.back()];
                chunk.wanted    = 0;
                chunk.remembers = true;
                wanted.clear();
                chunk.plastic[(dim * bond + a) * width + (slots[node] - chunk.slot)] = value;
              }
        of_bond.zero_out_ghost_values();
      }
  }


  template <int dim>
  std::size_t LatticeHistories<dim>::memory_consumption() const
  {
    std::size_t n = family.weights.capacity() + family.vectors.capacity();
    for (const Chunk &chunk : chunks)
      n += chunk.plastic.size() + chunk.elastic.size();
    for (unsigned int a = 0; a <= dim; ++a)
      n += grids[a].capacity() + before[a].capacity() + far[a].capacity();
    return n * sizeof(double) + chunks.size() * sizeof(Chunk) +
           (nodes.capacity() + slots.capacity() + number_of.capacity() + wanted.capacity()) *
             sizeof(std::uint32_t);
  }


  PERIDEAL_INSTANTIATE_CLASS(class LatticeHistories);
} // namespace PeriDeal
