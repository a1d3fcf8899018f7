// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "lattice_histories.h"

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>

#include <map>
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
    const auto                        &members = families.weights().members();
    std::map<int, std::vector<Column>> columns;
    for (std::size_t k = 0; k < members.size(); ++k)
      {
        const auto    &offset = members[k].offset;
        std::ptrdiff_t rows   = dim > 1 ? offset[dim > 1] : 0;
        if (dim > 2)
          rows += offset[dim - 1] * (grid.plane_stride / grid.row_stride);
        const std::ptrdiff_t step = offset[0] + rows * static_cast<std::ptrdiff_t>(row.length);
        family.offsets.push_back(step);
        family.weights.push_back(members[k].weight);
        for (unsigned int d = 0; d < dim; ++d)
          family.vectors.push_back(offset[d] * lattice.spacing[d]);
        columns[offset[0]].push_back({rows, members.size() - 1 - k, members[k].weight});
        row.margin = std::max(row.margin, static_cast<std::size_t>(std::abs(step)) + 2 * width);
      }
    family.columns.assign(columns.begin(), columns.end());
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
  void LatticeHistories<dim>::add_far_of(const StencilKernel::Run &run,
                                         const Of                  what,
                                         double *const            *to) const
  {
    const auto           length = static_cast<std::ptrdiff_t>(row.length);
    const std::ptrdiff_t own    = run.y + run.z * (layout.grid(nullptr).plane_stride / length);
    const auto           before = static_cast<std::ptrdiff_t>(row.before);
    std::vector<FarBond> bonds, next; // what comes next is asked for before what has come is added
    double              *at[3] = {}, *at_next[3] = {};
    const auto           add = [&]() {
      if (!bonds.empty())
        add_far<dim>(bonds.data(), bonds.size(), at);
      bonds.swap(next);
      std::swap(at, at_next);
    };
    for (const auto &[steps, columns] : family.columns)
      for (std::ptrdiff_t place = (run.x + before + steps) / width;
           place <= (run.x + before + steps + static_cast<std::ptrdiff_t>(run.n) - 1) / width;
           ++place)
        {
          next.clear();
          for (const Column &column : columns)
            {
              const std::uint32_t k = number_of[(own + column.rows) * row.n + place];
              if (k == none)
                continue;
              const Chunk &chunk = chunks[k];
              if (!(what == Of::plastic ? chunk.remembers : chunk.is_kept))
                continue;
              const double *const remembered =
                (what == Of::plastic ? chunk.plastic : chunk.elastic).data() +
                dim * width * column.opposite;
              for (unsigned int a = 0; a < dim; ++a)
                __builtin_prefetch(remembered + a * width);
              next.push_back({remembered, chunk.factors, column.weight});
            }
          for (unsigned int a = 0; a < dim; ++a)
            at_next[a] =
              to[a] + (place * static_cast<std::ptrdiff_t>(width) - before - steps - run.x);
          add();
        }
    next.clear();
    add();
  }


  template <int dim>
  void LatticeHistories<dim>::subtract_far(double                                          *y,
                                           const Of                                         what,
                                           const std::function<double(const unsigned int)> &factor)
  {
    bool any = false;
    for (Chunk &chunk : chunks)
      if (what == Of::plastic ? chunk.remembers : chunk.is_kept)
        {
          any = true;
          flow(chunk);
          for (unsigned int k = 0; k < width; ++k)
            {
              const unsigned int node = node_at(chunk, k);
              chunk.factors[k] = node == none ? 0. : families.nodes().volume(node) * factor(node);
            }
        }
    if (!any)
      return;
    std::vector<double>     sums(dim * (row.length + 2 * width));
    std::array<double *, 3> to{};
    for (unsigned int a = 0; a < dim; ++a)
      to[a] = sums.data() + a * (row.length + 2 * width) + width;
    for (std::size_t r = 0; r < layout.runs.size(); ++r)
      {
        std::fill(sums.begin(), sums.end(), 0.);
        add_far_of(layout.runs[r], what, to.data());
        for (std::size_t k = 0; k < layout.runs[r].n; ++k)
          {
            const std::size_t node = layout.first_nodes[r] + k;
            for (unsigned int a = 0; a < dim; ++a)
              y[dim * node + a] -= families.nodes().volume(node) * to[a][k];
          }
      }
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
                  pairs.keys.push_back({keys[node], bond});
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
        for (unsigned int a = 0; a < dim; ++a)
          chunk.plastic[(dim * pairs.keys[k][1] + a) * width + (slots[node] - chunk.slot)] =
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
      n += grids[a].capacity() + before[a].capacity();
    return n * sizeof(double) + chunks.size() * sizeof(Chunk) +
           (nodes.capacity() + slots.capacity() + number_of.capacity() + wanted.capacity()) *
             sizeof(std::uint32_t);
  }


  PERIDEAL_INSTANTIATE_CLASS(class LatticeHistories);
} // namespace PeriDeal
