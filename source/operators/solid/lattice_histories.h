// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/aligned_vector.h>

#include <perideal/base/archive.h>
#include <perideal/base/types.h>

#include <algorithm>
#include <deque>
#include <functional>

#include "../lattice/lattice_layout.h"
#include "bond_chunks.h"

namespace PeriDeal
{
  /**
   * What the bonds of a lattice's nodes remember in correspondence, z_p, each of its own end: of
   * owned nodes, and of ghosts, whose bonds to owned ones are needed. There is room for it only
   * where something is remembered, in chunks of sites along a row. Bonds of a whole family that a
   * node has not do not count, as the volumes at their far ends are 0.
   *
   * Sums are of w V_j, without the volume of the node. Not collective unless stated.
   */
  template <int dim>
  class LatticeHistories
  {
  public:
    /** Both have to outlive this object. */
    LatticeHistories(const Families<dim> &families, const LatticeLayout<dim> &layout);

    /** Displacements of owned nodes and ghosts, or changes of these. */
    void take(const double *u);

    /** A local node is among those that the next call of one of the following is about. */
    void want(const unsigned int node);

    bool wants_any() const
    {
      return !wanted.empty();
    }

    /** visit(owned node, place, sums at places); slopes(node) is G, row by row. */
    template <typename Slopes, typename Visit>
    void sum_elastic(const Slopes &slopes, const Visit &visit);

    /** z_p grows by lost(node) z_e: now, or when it is asked for. */
    template <typename Slopes, typename Lost>
    void let_flow(const Slopes &slopes, const Lost &lost);

    /** As sum_elastic(): keep z_e, and sum that alone. */
    template <typename Slopes, typename Visit>
    void keep_elastic(const Slopes &slopes, const Visit &visit);

    /** visit(owned node, sum) of what has been kept times du of what has been taken since. */
    template <typename Visit>
    void sum_products(const Visit &visit);

    enum class Of
    {
      plastic, // z_p
      elastic  // what has been kept
    };

    /**
     * Subtract from y, at the nodes of the layout's runs, what their far ends remember along their
     * own bonds: V_i sum of w V_j factor(j) times that.
     */
    void subtract_far(double                                          *y,
                      const Of                                         what,
                      const std::function<double(const unsigned int)> &factor);

    /** Of nodes that have something to remember. Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

    std::size_t memory_consumption() const;

  private:
    static constexpr unsigned int width = BondChunk::width, none = LatticePiece::none;

    struct Chunk
    {
      std::ptrdiff_t                slot;       // of the first site, which may lie before its row
      std::ptrdiff_t                begin, end; // of the row
      dealii::AlignedVector<double> plastic, elastic;
      double                        lost[width];
      double                        slopes[dim * dim * width]; // before, as what is lost
      bool                          is_pending = false;        // it has not flowed yet
      unsigned int                  wanted     = 0;            // bits
      bool                          remembers = false, is_kept = false;

      bool has(const Of what) const
      {
        return what == Of::plastic ? remembers : is_kept;
      }
    };

    /** The local node at a place of a chunk, or none. */
    unsigned int node_at(const Chunk &chunk, const unsigned int k) const
    {
      const std::ptrdiff_t at = chunk.slot + k;
      return at >= chunk.begin && at < chunk.end ? nodes[at] : none;
    }

    using Grids = std::array<std::vector<double>, dim + 1>;

    BondChunk bonds_of(const Chunk &chunk, const Grids &grids, const double *slopes) const;
    void      flow(Chunk &chunk); // if that is pending

    /** G of the sites. */
    template <typename Slopes>
    void gather(const Chunk &chunk, const Slopes &slopes, double *to) const;

    /** visit(chunk) of those with nodes that are wanted, which nobody wants any more then. */
    template <typename Visit>
    void for_each_wanted(const Visit &visit);

    /** visit(owned node, place) of those that are wanted. */
    template <typename Visit>
    void for_each_owned(const Chunk &chunk, const Visit &visit) const;

    void make_grids(Grids &of);
    void exchange_ghosts();

    const Families<dim>      &families;
    const LatticeLayout<dim> &layout;

    struct
    {
      std::size_t length, n;  // sites; chunks
      std::size_t before;     // sites of the first chunk before the row: owned nodes begin one
      std::size_t margin = 0; // of numbers before and behind the grids
    } row;

    // Backwards along rows: so whatever the chunks, far ends have their sums in the order of nodes,
    // and what is written is not read again by the next bonds.
    struct
    {
      std::vector<std::size_t>    numbers; // among the members
      std::vector<std::ptrdiff_t> offsets;
      std::vector<double>         vectors, weights; // xi, w
    } family;

    std::vector<std::uint32_t> nodes, slots; // by slot; of local nodes
    std::vector<std::uint32_t> number_of;    // of chunks
    std::deque<Chunk>          chunks;
    std::vector<std::uint32_t> wanted;

    Grids grids, before; // padded: u, V; u where z_p has still to flow
    Grids far;           // padded: what bonds remember, at their far ends
  };


  template <int dim>
  template <typename Slopes>
  void LatticeHistories<dim>::gather(const Chunk &chunk, const Slopes &slopes, double *to) const
  {
    for (unsigned int k = 0; k < width; ++k)
      {
        const unsigned int  node = node_at(chunk, k);
        const double *const from = node == none ? nullptr : slopes(node);
        for (unsigned int c = 0; c < dim * dim; ++c)
          to[c * width + k] = from == nullptr ? 0. : from[c];
      }
  }


  template <int dim>
  template <typename Visit>
  void LatticeHistories<dim>::for_each_wanted(const Visit &visit)
  {
    for (const std::uint32_t k : wanted)
      {
        visit(chunks[k]);
        chunks[k].wanted = 0;
      }
    wanted.clear();
  }


  template <int dim>
  template <typename Visit>
  void LatticeHistories<dim>::for_each_owned(const Chunk &chunk, const Visit &visit) const
  {
    for (unsigned int k = 0; k < width; ++k)
      if ((chunk.wanted >> k & 1U) != 0)
        if (const unsigned int node = node_at(chunk, k); node < families.nodes().n_owned())
          visit(node, k);
  }


  template <int dim>
  template <typename Slopes, typename Visit>
  void LatticeHistories<dim>::sum_elastic(const Slopes &slopes, const Visit &visit)
  {
    double    of_sites[dim * dim * width];
    ChunkSums sums;
    for_each_wanted([&](Chunk &chunk) {
      gather(chunk, slopes, of_sites);
      const BondChunk now = bonds_of(chunk, grids, of_sites);
      if (chunk.is_pending)
        let_flow_and_sum<dim>(bonds_of(chunk, before, chunk.slopes),
                              chunk.lost,
                              now,
                              chunk.plastic.data(),
                              sums);
      else
        PeriDeal::sum_elastic<dim>(now, chunk.plastic.data(), sums);
      chunk.is_pending = false;
      for_each_owned(chunk,
                     [&](const unsigned int node, const unsigned int k) { visit(node, k, sums); });
    });
  }


  template <int dim>
  template <typename Slopes, typename Lost>
  void LatticeHistories<dim>::let_flow(const Slopes &slopes, const Lost &lost)
  {
    for (Chunk &chunk : chunks)
      flow(chunk);
    for_each_wanted([&](Chunk &chunk) {
      gather(chunk, slopes, chunk.slopes);
      for (unsigned int k = 0; k < width; ++k)
        {
          const unsigned int node = node_at(chunk, k);
          chunk.lost[k]           = node == none ? 0. : lost(node);
        }
      chunk.remembers = chunk.is_pending = true;
    });
    make_grids(before);
    for (unsigned int a = 0; a < dim; ++a)
      grids[a].swap(before[a]);
  }


  template <int dim>
  template <typename Slopes, typename Visit>
  void LatticeHistories<dim>::keep_elastic(const Slopes &slopes, const Visit &visit)
  {
    for (Chunk &chunk : chunks)
      chunk.is_kept = false;
    double    of_sites[dim * dim * width];
    ChunkSums sums;
    for_each_wanted([&](Chunk &chunk) {
      gather(chunk, slopes, of_sites);
      flow(chunk);
      chunk.elastic.resize(chunk.plastic.size());
      chunk.is_kept = true;
      PeriDeal::keep_elastic<dim>(bonds_of(chunk, grids, of_sites),
                                  chunk.plastic.data(),
                                  chunk.elastic.data(),
                                  sums);
      for_each_owned(chunk,
                     [&](const unsigned int node, const unsigned int k) { visit(node, k, sums); });
    });
  }


  template <int dim>
  template <typename Visit>
  void LatticeHistories<dim>::sum_products(const Visit &visit)
  {
    double products[width];
    for_each_wanted([&](const Chunk &chunk) {
      PeriDeal::sum_products<dim>(bonds_of(chunk, grids, nullptr), chunk.elastic.data(), products);
      for_each_owned(chunk, [&](const unsigned int node, const unsigned int k) {
        visit(node, products[k]);
      });
    });
  }
} // namespace PeriDeal
