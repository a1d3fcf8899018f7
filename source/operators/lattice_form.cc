// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/bonds/stencil_kernel.h>
#include <perideal/operators/bond_form.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "node_loops.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();


    /** Consecutive local nodes on consecutive sites of one lattice row. */
    struct Piece
    {
      std::size_t   slot; // in the padded grid
      std::uint32_t node, n;
      std::uint32_t varying;            // where in the lists of varying values, or none: then
      double        volume, family_sum; // all nodes have these
    };


    /** A stored difference to the template: adds coefficient * (u_row - u_column). */
    struct Correction
    {
      std::uint32_t column;
      double        coefficient;
    };


    struct OutsideNode
    {
      std::size_t   slot;
      std::uint32_t number;
      double        volume;
    };


    /**
     * Nodes that are computed together: a block of rows of one plane, in 1D a stretch of the bar. What is needed of the grid
     * is filled in just before, and the sums are finished while they are in cache. Each number is the end of the group's
     * part of a list.
     */
    struct Group
    {
      std::size_t fills, runs, pieces, corrected, ranges;
    };


    template <int dim>
    class LatticeForm : public BondForm
    {
    public:
      explicit LatticeForm(const Families<dim> &families)
        : families(families)
        , kernel(make_kernel(false))
        , n_owned(families.nodes().n_owned())
        , n_local(families.nodes().n_local())
      {
        lay_out_grid();
        find_pieces();
        find_groups();
        find_fictitious_slots();
        find_family_sums();
        find_corrections();
      }

      void apply(double            *y,
                 const double      *values,
                 const double      *outside,
                 const NodesAction &finish) const override
      {
        const bool fill_first = !outside_nodes.empty();
        if (fill_first)
          fill_grid(values, outside);
        Group at{0, 0, 0, 0, 0};
        for (const Group &end : groups)
          {
            for (std::size_t k = at.fills; k < end.fills && !fill_first; ++k)
              fill(fills[k], values);
            convolve(kernel, at.runs, end.runs, y);
            for (std::size_t k = at.pieces; k < end.pieces; ++k)
              combine(pieces[k], values, y);
            for (std::size_t k = at.corrected; k < end.corrected; ++k)
              y[corrected_rows[k]] += correction(k, values, outside);
            for (std::size_t k = at.ranges; k < end.ranges && finish; ++k)
              finish(ranges[k].first, ranges[k].second);
            at = end;
          }
      }

      void row_sums(double *sums, double &n_bonds) const override
      {
        for (const Piece &piece : pieces)
          for (std::uint32_t k = 0; k < piece.n; ++k)
            sums[piece.node + k] = volume(piece, k) * family_sum(piece, k);
        // The number of bonds is a convolution of ones with ones; half a bond is the other node's.
        const StencilKernel       counter = make_kernel(true);
        const std::vector<double> halves(n_local, 0.5),
          wholes(families.fictitious().size(), 1.);
        std::vector<double> count(n_owned);
        fill_grid_with_values(halves, wholes);
        convolve(counter, 0, stencil_runs.size(), count.data());
        // Near cracks the plain way.
        std::vector<typename Families<dim>::Bond> bonds;
        for (const std::uint32_t i : corrected_rows)
          {
            families.bonds_of(i, bonds);
            sums[i] = count[i] = 0.;
            for (const auto &bond : bonds)
              {
                sums[i] += bond.weight;
                if (bond.weight > 0.)
                  count[i] += bond.neighbor < n_local ? 0.5 : 1.;
              }
          }
        n_bonds = 0.;
        for (const double c : count)
          n_bonds += c;
      }

      std::size_t memory_consumption() const override
      {
        return sizeof(double) *
                 (grid.capacity() + varying_volumes.capacity() + varying_sums.capacity()) +
               (fills.capacity() + pieces.capacity()) * sizeof(Piece) +
               groups.capacity() * sizeof(Group) + ranges.capacity() * sizeof(ranges[0]) +
               stencil_runs.capacity() * sizeof(StencilKernel::Run) +
               corrections.capacity() * sizeof(Correction) +
               corrected_rows.capacity() * sizeof(std::uint32_t) +
               correction_starts.capacity() * sizeof(std::size_t) +
               outside_nodes.capacity() * sizeof(OutsideNode);
      }

      unsigned long long n_stored() const override
      {
        return corrections.size();
      }

      std::string name() const override
      {
        return "lattice";
      }

    private:
      using Index = typename Lattice<dim>::Index;

      /** The stencil w kappa on the nonnegative offsets, with the self term as it is inside the body; or ones. */
      StencilKernel make_kernel(const bool ones) const
      {
        std::vector<std::array<int, 3>> offsets;
        std::vector<double>             weights;
        const double                    kappa = families.conductivity(0);
        for (const FamilyMember<dim> &member : families.lattice_members())
          {
            std::array<int, 3> offset{{0, 0, 0}};
            std::copy(member.offset.begin(), member.offset.end(), offset.begin());
            if (*std::min_element(offset.begin(), offset.end()) < 0)
              continue;
            double weight = member.weight;
            for (const FamilyMember<dim> &self : families.self_members())
              if (self.offset == member.offset)
                weight += self.weight;
            offsets.push_back(offset);
            weights.push_back(ones ? 1. : kappa * weight);
          }
        return StencilKernel(dim, offsets, weights);
      }


      std::size_t slot(const Index &site) const
      {
        std::size_t s = 0;
        for (unsigned int d = dim; d-- > 0;)
          s = s * extent[d] + (site[d] - corner[d]);
        return s;
      }

      /** Coordinates of a slot in the grid. */
      std::array<std::ptrdiff_t, 3> place(std::size_t s) const
      {
        std::array<std::ptrdiff_t, 3> p{{0, 0, 0}};
        for (unsigned int d = 0; d < dim; ++d)
          {
            p[d] = s % extent[d];
            s /= extent[d];
          }
        return p;
      }

      Index site_of(const unsigned int node) const
      {
        return families.nodes().lattice()->index(families.nodes().position(node));
      }


      void lay_out_grid()
      {
        Index low{}, high{};
        for (unsigned int i = 0; i < n_owned; ++i)
          {
            const Index site = site_of(i);
            for (unsigned int d = 0; d < dim; ++d)
              {
                low[d]  = i == 0 ? site[d] : std::min(low[d], site[d]);
                high[d] = i == 0 ? site[d] : std::max(high[d], site[d]);
              }
          }
        std::size_t n = 1;
        for (unsigned int d = 0; d < dim; ++d)
          {
            corner[d] = low[d] - kernel.halo()[d];
            extent[d] = high[d] + kernel.halo()[d] + 1 - corner[d];
            n *= extent[d];
          }
        grid.assign(n, 0.);
      }


      bool in_grid(const Index &site) const
      {
        for (unsigned int d = 0; d < dim; ++d)
          if (site[d] < corner[d] || site[d] >= corner[d] + extent[d])
            return false;
        return true;
      }


      /** Maximal pieces of rows, owned nodes and ghosts apart; their values come later. */
      void find_pieces()
      {
        constexpr std::uint32_t longest = dim == 1 ? 8192 : none;
        std::size_t             next    = 0;
        for (unsigned int i = 0; i < n_local; ++i)
          {
            const Index site = site_of(i);
            if (!in_grid(site))
              continue;
            const std::size_t s         = slot(site);
            const bool        continues = !fills.empty() && s == next && i != n_owned &&
                                   fills.back().node + fills.back().n == i &&
                                   (s % extent[0]) != 0 && fills.back().n < longest;
            if (continues)
              ++fills.back().n;
            else
              fills.push_back({s, i, 1, none, 0., 0.});
            next = s + 1;
          }
      }


      /** The order of computation. */
      void find_groups()
      {
        for (const Piece &piece : fills)
          if (piece.node < n_owned)
            {
              const auto         p = place(piece.slot);
              StencilKernel::Run run;
              run.x = p[0];
              run.y = p[1];
              run.z = p[2];
              run.n = piece.n;
              stencil_runs.push_back(run);
            }
        StencilKernel::sort_for_reuse(stencil_runs);
        for (const StencilKernel::Run &run : stencil_runs)
          {
            Index                               site;
            const std::array<std::ptrdiff_t, 3> p{{run.x, run.y, run.z}};
            for (unsigned int d = 0; d < dim; ++d)
              site[d] = corner[d] + static_cast<int>(p[d]);
            const std::uint32_t node = families.node_at(site);
            pieces.push_back({slot(site), node, static_cast<std::uint32_t>(run.n), none, 0., 0.});
          }
        const auto together = [](const StencilKernel::Run &a, const StencilKernel::Run &b) {
          constexpr std::ptrdiff_t n = StencilKernel::block_rows;
          return dim > 1 && a.z == b.z && a.y / n == b.y / n;
        };
        for (std::size_t k = 0; k < pieces.size(); ++k)
          {
            const bool          same = k > 0 && together(stencil_runs[k - 1], stencil_runs[k]);
            const std::uint32_t first = pieces[k].node, end = first + pieces[k].n;
            if (!same)
              groups.push_back({0, k, k, 0, 0});
            if (same && ranges.back().second == first)
              ranges.back().second = end;
            else
              ranges.emplace_back(first, end);
            groups.back().runs = groups.back().pieces = k + 1;
            groups.back().ranges                      = ranges.size();
          }
        order_fills();
      }


      /** Put pieces to be filled in the order in which groups first need them; leave out those that none needs. */
      void order_fills()
      {
        const std::size_t        n_y = dim > 1 ? extent[dim > 1] : 1, n_z = dim > 2 ? extent[dim - 1] : 1;
        std::vector<std::size_t> starts(n_y * n_z + 1, 0);
        const auto row_of = [&](const Piece &piece) { return piece.slot / extent[0]; };
        std::stable_sort(fills.begin(), fills.end(), [&](const Piece &a, const Piece &b) {
          return row_of(a) < row_of(b);
        });
        for (const Piece &piece : fills)
          ++starts[row_of(piece) + 1];
        for (std::size_t r = 0; r + 1 < starts.size(); ++r)
          starts[r + 1] += starts[r];
        std::vector<bool>  done(fills.size(), false);
        std::vector<Piece> ordered;
        std::size_t        run = 0;
        const auto         halo = kernel.halo();
        for (Group &group : groups)
          {
            const std::ptrdiff_t        z     = stencil_runs[run].z;
            std::ptrdiff_t              x_end = 0, x_begin = extent[0], y_end = 0, y_begin = n_y;
            for (; run < group.runs; ++run)
              {
                const StencilKernel::Run &r = stencil_runs[run];
                x_begin                     = std::min(x_begin, r.x);
                x_end   = std::max(x_end, r.x + static_cast<std::ptrdiff_t>(r.n));
                y_begin = std::min(y_begin, r.y);
                y_end   = std::max(y_end, r.y + 1);
              }
            for (std::ptrdiff_t c = z - halo[2]; c <= z + halo[2]; ++c)
              for (std::ptrdiff_t b = y_begin - halo[1]; b < y_end + halo[1]; ++b)
                for (std::size_t k = starts[b + n_y * c]; k < starts[b + n_y * c + 1]; ++k)
                  {
                    const auto p = place(fills[k].slot);
                    if (done[k] || p[0] >= x_end + halo[0] ||
                        p[0] + static_cast<std::ptrdiff_t>(fills[k].n) <= x_begin - halo[0])
                      continue;
                    done[k] = true;
                    ordered.push_back(fills[k]);
                  }
            group.fills = ordered.size();
          }
        fills.swap(ordered);
        fills.shrink_to_fit();
      }


      /** Where the fictitious nodes go in the grid, and which of these sites no real node fills. */
      void find_fictitious_slots()
      {
        for (std::uint32_t f = 0; f < families.fictitious().size(); ++f)
          {
            const FictitiousNode<dim> &node = families.fictitious()[f];
            if (!in_grid(node.site))
              continue;
            outside_nodes.push_back({slot(node.site), f, node.volume});
            if (families.node_at(node.site) == numbers::invalid_unsigned_int)
              emptied_slots.push_back(slot(node.site));
          }
      }


      /** The template's sum of coefficients at each node: its convolution of the volumes. */
      void find_family_sums()
      {
        std::vector<double> volumes(n_local), outside, sums(n_owned);
        for (unsigned int i = 0; i < n_local; ++i)
          volumes[i] = families.nodes().volume(i);
        for (const FictitiousNode<dim> &node : families.fictitious())
          outside.push_back(node.volume);
        fill_grid_with_values(volumes, outside);
        convolve(kernel, 0, stencil_runs.size(), sums.data());
        for (std::size_t k = 0, g = 0; g < groups.size(); ++g)
          {
            // A group's pieces have to stay together: the list is rebuilt behind them.
            for (; k < groups[g].pieces; ++k)
              split(pieces[k], volumes, sums.data(), split_pieces);
            piece_ends.push_back(split_pieces.size());
          }
        pieces.swap(split_pieces);
        split_pieces.clear();
        for (std::size_t k = 0, g = 0; g < groups.size(); ++g)
          {
            groups[g].pieces = piece_ends[g];
            for (; k < groups[g].fills; ++k)
              split(fills[k], volumes, nullptr, split_pieces);
            groups[g].fills = split_pieces.size();
          }
        fills.swap(split_pieces);
        for (auto *list : {&fills, &pieces})
          list->shrink_to_fit();
        split_pieces = {};
        piece_ends   = {};
      }
    };
  } // namespace
} // namespace PeriDeal
