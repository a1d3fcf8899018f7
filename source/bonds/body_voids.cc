// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/connected_sets.h>
#include <perideal/base/instantiate.h>
#include <perideal/bonds/body_voids.h>
#include <perideal/bonds/bond_pieces.h>
#include <perideal/bonds/boundary_facets.h>
#include <perideal/mesh/mesh_builder.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Of a lattice: cells that do not exist. */
    template <int dim>
    class MissingCells : public BodyVoids<dim>
    {
    public:
      using Index = typename Lattice<dim>::Index;

      MissingCells(const Nodes<dim>         &nodes,
                   const Domain<dim>        &domain,
                   const KernelWeights<dim> &weights)
        : nodes(nodes)
        , domain(domain)
        , lattice(*nodes.lattice())
        , reach(weights.reach_in_sites())
      {
        for (unsigned int d = 0; d < dim; ++d)
          n_cells[d] = lattice.at_centers ? lattice.n_sites[d] : lattice.n_sites[d] - 1;
        find_cells();
        find_ways(weights.members());
      }

      bool is_near(const unsigned int node, const double distance) const override
      {
        if (nodes.n_local() == 0)
          return false;
        const Index center = lattice.index(nodes.position(node));
        Index       from, to;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const int far = static_cast<int>(std::ceil(distance / lattice.spacing[d])) + 1;
            from[d]       = std::clamp(center[d] - far, first[d], last[d]) - first[d];
            to[d]         = std::clamp(center[d] + far, first[d], last[d]) - first[d];
          }
        // How many are missing in a block, from sums over blocks that begin in the first corner.
        long sum = 0;
        for (unsigned int corner = 0; corner < (1u << dim); ++corner)
          {
            Index place;
            int   sign = 1;
            for (unsigned int d = 0; d < dim; ++d)
              {
                place[d] = (corner >> d) & 1 ? to[d] : from[d];
                sign     = (corner >> d) & 1 ? sign : -sign;
              }
            sum += sign * static_cast<long>(sums[number(place)]);
          }
        return sum != 0;
      }

      bool between(const unsigned int node, const unsigned int neighbor) const override
      {
        return leaves(lattice.index(nodes.position(node)), lattice.index(nodes.position(neighbor)));
      }

      bool before_site(const unsigned int node, const Index &site) const override
      {
        return leaves(lattice.index(nodes.position(node)), site);
      }

    private:
      /** A part of a way that stays in one cell, or on the edge of several: these, relatively. */
      using Part = std::vector<Index>;

      std::size_t number(const Index &place) const
      {
        std::size_t n = 0;
        for (unsigned int d = dim; d-- > 0;)
          n = n * (last[d] - first[d] + 1) + place[d];
        return n;
      }

      /** Cells around the nodes known here, and how many are missing in blocks of them. */
      void find_cells()
      {
        first.fill(0);
        last.fill(0);
        for (unsigned int i = 0; i < nodes.n_local(); ++i)
          {
            const Index site = lattice.index(nodes.position(i));
            for (unsigned int d = 0; d < dim; ++d)
              {
                first[d] = i == 0 ? site[d] : std::min(first[d], site[d]);
                last[d]  = i == 0 ? site[d] : std::max(last[d], site[d]);
              }
          }
        // The cell below a site has its number in `sums`; the first of each direction is empty.
        std::size_t n = 1;
        for (unsigned int d = 0; d < dim; ++d)
          {
            if (lattice.at_centers)
              ++last[d];
            n *= last[d] - first[d] + 1;
          }
        sums.assign(n, 0);
        for (std::size_t k = 0; k < n; ++k)
          {
            Index       place, cell;
            std::size_t rest = k;
            bool        edge = false;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const int width = last[d] - first[d] + 1;
                place[d]        = static_cast<int>(rest % width);
                rest /= width;
                cell[d] = first[d] + place[d] - 1;
                edge    = edge || place[d] == 0;
              }
            if (edge)
              continue;
            int sum = domain.has_cell_at(center_of(cell)) ? 0 : 1;
            for (unsigned int corner = 1; corner < (1u << dim); ++corner)
              {
                Index other = place;
                int   sign  = -1;
                for (unsigned int d = 0; d < dim; ++d)
                  if ((corner >> d) & 1)
                    {
                      --other[d];
                      sign = -sign;
                    }
                sum += sign * static_cast<int>(sums[number(other)]);
              }
            sums[k] = sum;
          }
      }

      Point<dim> center_of(const Index &cell) const
      {
        Point<dim> center;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double s = (cell[d] + 0.5) / n_cells[d];
            center[d]      = lattice.lower[d] * (1. - s) + lattice.upper[d] * s;
          }
        return center;
      }

      /** Beyond the sides the body is mirrored. */
      bool exists(Index cell) const
      {
        for (unsigned int d = 0; d < dim; ++d)
          {
            if (cell[d] < 0)
              cell[d] = -1 - cell[d];
            if (cell[d] >= n_cells[d])
              cell[d] = 2 * n_cells[d] - 1 - cell[d];
            if (cell[d] < 0)
              return true; // a body that is narrower than the way
          }
        return domain.has_cell_at(center_of(cell));
      }

      /** Between sites in the middle of cells lie those of a lattice of half cells. */
      std::vector<Part> way_along(Index offset) const
      {
        std::vector<Part> parts;
        for (int &steps : offset)
          steps *= lattice.at_centers ? 2 : 1;
        for (BondPiece<dim> &piece : bond_pieces<dim>(offset))
          {
            for (Index &cell : piece.cells)
              for (int &place : cell)
                if (lattice.at_centers) // the site is a vertex of half cells, the first
                  place = (place + 1 - ((place + 1) & 1)) / 2;
            parts.push_back(std::move(piece.cells));
          }
        return parts;
      }

      std::size_t way_number(const Index &offset) const
      {
        std::size_t n = 0;
        for (unsigned int d = dim; d-- > 0;)
          {
            if (std::abs(offset[d]) > reach[d])
              return ways.size();
            n = n * (2 * reach[d] + 1) + (offset[d] + reach[d]);
          }
        return n;
      }

      void find_ways(const std::vector<FamilyMember<dim>> &members)
      {
        std::size_t n = 1;
        for (unsigned int d = 0; d < dim; ++d)
          n *= 2 * reach[d] + 1;
        ways.resize(n);
        for (const FamilyMember<dim> &member : members)
          ways[way_number(member.offset)] = way_along(member.offset);
      }

      bool leaves(const Index &site, const Index &other) const
      {
        Index offset;
        for (unsigned int d = 0; d < dim; ++d)
          offset[d] = other[d] - site[d];
        const std::size_t n      = way_number(offset);
        const auto        leaves = [&](const std::vector<Part> &parts) {
          return std::any_of(parts.begin(), parts.end(), [&](const Part &part) {
            return std::none_of(part.begin(), part.end(), [&](Index cell) {
              for (unsigned int d = 0; d < dim; ++d)
                cell[d] += site[d];
              return exists(cell);
            });
          });
        };
        return n < ways.size() && !ways[n].empty() ? leaves(ways[n]) : leaves(way_along(offset));
      }

      const Nodes<dim>              &nodes;
      const Domain<dim>             &domain;
      const Lattice<dim>            &lattice;
      const Index                    reach; // of the members
      Index                          n_cells, first, last;
      std::vector<unsigned int>      sums;
      std::vector<std::vector<Part>> ways; // of the members, by offset
    };


    /** Of any other mesh: its faces on the boundary, as segments or triangles. */
    template <int dim>
    class BoundaryFaces : public BodyVoids<dim>
    {
    public:
      BoundaryFaces(const Nodes<dim> &nodes, const double reach)
        : nodes(nodes)
        , reach(reach)
        , tiny(1e-7 * nodes.smallest_spacing())
        , bins(reach)
      {
        for (const Facet &facet : gather_boundary_facets(nodes.dof_handler()))
          if (facet.side != crack_boundary_id)
            facets.push_back(facet);
        bins = bins_of_facets<dim>(facets, reach);
        rims = find_rims();
        for (unsigned int i = 0; i < nodes.n_local(); ++i)
          close.push_back(has_facet_ahead(i));
      }

      bool is_near(const unsigned int node, const double distance) const override
      {
        return distance > reach * (1. + 1e-9) ? !facets.empty() : close[node];
      }

      bool between(const unsigned int node, const unsigned int neighbor) const override
      {
        if (!close[node] && !close[neighbor])
          return false;
        // From one end, whichever is asked for, so that both directions agree to the last digit.
        const Point<dim> a = nodes.crack_point(node), b = nodes.crack_point(neighbor);
        for (unsigned int d = 0; d < dim; ++d)
          if (a[d] != b[d])
            return a[d] < b[d] ? leaves(a, b) : leaves(b, a);
        return false;
      }

    private:
      using Facet = BoundaryFacet<dim>;

      static double height_above(const Facet &facet, const Point<dim> &p)
      {
        return facet.normal * (p - facet.corners[0]);
      }

      /** Beyond whose plane a node of the body within the reach may lie. */
      bool has_facet_ahead(const unsigned int node) const
      {
        const Point<dim> &p   = nodes.position(node);
        bool              any = false;
        bins.visit_near(p, [&](const unsigned int f) {
          any = any || distance_to(facets[f], p) < reach * (1. + 1e-9);
        });
        return any;
      }

      static double distance_to(const Facet &facet, const Point<dim> &p)
      {
        return facet.at(facet.nearest_weights(p)).distance(p);
      }

      /**
       * How far outside the body a point is, less than 0 inside: by the nearest facet; where
       * several are as near, that which sees the point best.
       */
      double depth(const Point<dim> &p) const
      {
        double smallest = std::numeric_limits<double>::max(), height = 0.;
        bins.visit_near(p, [&](const unsigned int f) {
          const double distance = distance_to(facets[f], p), own = height_above(facets[f], p);
          if (distance < smallest - tiny ||
              (distance < smallest + tiny && std::abs(own) > std::abs(height)))
            height = own;
          smallest = std::min(smallest, distance);
        });
        return facets.empty() || height < 0. ? -smallest : smallest;
      }

      bool leaves(const Point<dim> &a, const Point<dim> &b) const
      {
        // Where the way meets the boundary; what lies between two such places is inside or not.
        std::vector<std::pair<double, unsigned int>> places; // and the facets there
        bins.visit_near(a + 0.5 * (b - a), [&](const unsigned int f) {
          const double from = height_above(facets[f], a), to = height_above(facets[f], b);
          if ((from <= tiny && to <= tiny) || (from > tiny && to > tiny))
            return;
          const double s = std::clamp(from / (from - to), 0., 1.);
          // Its rim belongs to it; the ends of the way may be crack points.
          if (distance_to(facets[f], Point<dim>(a + s * (b - a))) < 20. * tiny)
            places.emplace_back(s, f);
        });
        if (places.empty())
          return false;
        // Pieces of the body that touch have two faces at one place, or nearly so where these are
        // not plane.
        const double length = a.distance(b), near = 0.1 * nodes.smallest_spacing();
        for (std::size_t k = 0; k < places.size(); ++k)
          for (std::size_t l = 0; l < k; ++l)
            if (facets[places[k].second].normal * facets[places[l].second].normal < -0.9 &&
                std::abs(places[k].first - places[l].first) * length < near)
              return true;
        std::sort(places.begin(), places.end());
        places.insert(places.begin(), {0., places.front().second});
        places.emplace_back(1., places.back().second);
        // A way along a rim that curves away leaves the body by little: that is a chord of it.
        constexpr double slack = 1e-6, chord = 0.12;
        for (std::size_t k = 1; k < places.size(); ++k)
          if (const double part = places[k].first - places[k - 1].first; part > slack)
            {
              const bool   is_chord = rims[places[k].second] == rims[places[k - 1].second];
              const double middle   = 0.5 * (places[k].first + places[k - 1].first);
              if (depth(a + middle * (b - a)) >
                  std::max(2. * tiny, is_chord ? chord * part * length : 0.))
                return true;
            }
        return false;
      }

      /** Numbers of the parts of the boundary that hang together, by facet. */
      std::vector<unsigned int> find_rims() const
      {
        ConnectedSets                                   sets(facets.size());
        std::map<types::global_dof_index, unsigned int> at_node;
        for (unsigned int f = 0; f < facets.size(); ++f)
          for (const auto node : facets[f].nodes)
            sets.join(f, at_node.try_emplace(node, f).first->second);
        std::vector<unsigned int> of(facets.size());
        for (unsigned int f = 0; f < facets.size(); ++f)
          of[f] = sets.root(f);
        return of;
      }

      const Nodes<dim>         &nodes;
      const double              reach, tiny;
      std::vector<Facet>        facets;
      PointBins<dim>            bins;
      std::vector<unsigned int> rims;  // of the facets
      std::vector<bool>         close; // of the nodes known here: a facet is within the reach
    };
  } // namespace


  template <int dim>
  std::unique_ptr<BodyVoids<dim>> make_body_voids(const Nodes<dim>          &nodes,
                                                  const BodyParameters<dim> &body,
                                                  const KernelWeights<dim>  &weights)
  {
    if constexpr (dim > 1)
      if (body.peridynamics.across_voids != BondsAcrossVoids::keep)
        {
          if (!nodes.lattice())
            return std::make_unique<BoundaryFaces<dim>>(nodes, weights.reach());
          if (body.domain.has_voids())
            return std::make_unique<MissingCells<dim>>(nodes, body.domain, weights);
        }
    return {};
  }


  PERIDEAL_INSTANTIATE_CLASS(class BodyVoids);
  PERIDEAL_INSTANTIATE_FUNCTION(make_body_voids);
} // namespace PeriDeal
