// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/crack_surface.h>
#include <perideal/base/gathered_lists.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/point_order.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <tuple>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  unsigned int CrackFacet<dim>::normal() const
  {
    unsigned int n = 0;
    for (unsigned int d = 1; d < dim; ++d)
      if (upper[d] - lower[d] < upper[n] - lower[n])
        n = d;
    return n;
  }


  template <int dim>
  std::vector<Point<dim>> CrackFacet<dim>::corners() const
  {
    std::vector<Point<dim>> list{lower, upper};
    if (dim == 3)
      {
        const unsigned int e = (normal() + 1) % dim;
        Point<dim>         second(lower), fourth(upper);
        second[e] = upper[e];
        fourth[e] = lower[e];
        list      = {lower, second, upper, fourth};
      }
    return list;
  }


  template <int dim>
  CrackSurface<dim>::CrackSurface(const Families<dim> &families)
    : families(families)
  {
    const Neighbors<dim> &neighbors = families.neighbors();
    sums.fill(Vector(families.nodes().partitioner()));
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      neighbors.for_each(i, [&](const unsigned int j, const double weight) {
        if (!neighbors.is_real(j))
          return;
        const Tensor<1, dim> xi = neighbors.bond_vector(i, j);
        for (unsigned int n = 0; n < dim; ++n)
          sums[n].local_element(i) +=
            0.5 * weight * xi.norm_square() * families.nodes().volume(j) * std::abs(xi[n]);
      });
    for (Vector &sum : sums)
      sum.update_ghost_values();
  }


  template <int dim>
  double CrackSurface<dim>::exact_sum(const std::vector<double> &shares, const double scale) const
  {
    // Integers do not depend on their order.
    const double       unit = std::ldexp(1., std::ilogb(scale) - 34);
    unsigned long long sum  = 0;
    for (const double share : shares)
      sum += std::llround(share / unit);
    return unit * static_cast<double>(Utilities::MPI::sum(sum, families.nodes().communicator()));
  }


  template <int dim>
  std::vector<double> CrackSurface<dim>::weights_of(const std::vector<BondBreak> &breaks) const
  {
    std::vector<double> weights;
    for (const auto &[i, other, time] : breaks)
      {
        double found = 0.;
        families.neighbors().for_each(i, [&, other = other](const unsigned int j, const double w) {
          if (j == other)
            found = w;
        });
        weights.push_back(found * families.neighbors().bond_vector(i, other).norm_square());
      }
    return weights;
  }


  template <int dim>
  Vector CrackSurface<dim>::sums_across(const std::vector<BondBreak> &breaks,
                                        const std::vector<double>    &weights) const
  {
    const Nodes<dim>       &nodes = families.nodes();
    std::array<Vector, dim> normals;
    normals.fill(Vector(nodes.partitioner()));
    for (std::size_t k = 0; k < breaks.size(); ++k)
      {
        const auto &[i, j, time]  = breaks[k];
        const Tensor<1, dim> part = weights[k] * families.neighbors().bond_vector(i, j);
        for (unsigned int n = 0; n < dim; ++n)
          {
            normals[n].local_element(i) += nodes.volume(j) * part[n];
            normals[n].local_element(j) -= nodes.volume(i) * part[n];
          }
      }
    for (Vector &normal : normals)
      normal.compress(VectorOperation::add);
    // Where bonds have broken on all sides no direction is known: so small a part, squared, tells
    // it.
    constexpr double least = 1e-6;
    Vector           across(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double all = 0., sum = 0.;
        for (unsigned int n = 0; n < dim; ++n)
          {
            const double share = std::pow(normals[n].local_element(i), 2) +
                                 least * std::pow(sums[n].local_element(i), 2);
            all += share;
            sum += share * sums[n].local_element(i);
          }
        across.local_element(i) = sum / all;
      }
    across.update_ghost_values();
    return across;
  }


  template <int dim>
  double CrackSurface<dim>::area(const std::vector<BondBreak> &breaks) const
  {
    const Nodes<dim>         &nodes   = families.nodes();
    const std::vector<double> weights = weights_of(breaks);
    const Vector              across  = sums_across(breaks, weights);
    std::vector<double>       shares;
    for (std::size_t k = 0; k < breaks.size(); ++k)
      {
        const auto &[i, j, time] = breaks[k];
        shares.push_back(0.5 * weights[k] * nodes.volume(i) * nodes.volume(j) *
                         (1. / across.local_element(i) + 1. / across.local_element(j)));
      }
    return exact_sum(shares, std::pow(nodes.smallest_spacing(), dim - 1));
  }


  template <int dim>
  double CrackSurface<dim>::damaged_volume(const std::vector<BondBreak> &breaks,
                                           const std::vector<double>    &damage,
                                           const double                  threshold) const
  {
    const Nodes<dim> &nodes = families.nodes();
    // What other processes know of their bonds to nodes of this one.
    Vector lost(nodes.partitioner());
    for (const BondBreak &bond : breaks)
      {
        lost.local_element(bond.node)     = 1.;
        lost.local_element(bond.neighbor) = 1.;
      }
    lost.compress(VectorOperation::add);
    std::vector<double> volumes;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (lost.local_element(i) > 0. && damage[i] > threshold)
        volumes.push_back(nodes.volume(i));
    return exact_sum(volumes, std::pow(nodes.smallest_spacing(), dim));
  }


  template <int dim>
  std::vector<CrackFacet<dim>> CrackSurface<dim>::facets(const std::vector<BondBreak> &breaks,
                                                         const std::vector<double>    &damage) const
  {
    const Nodes<dim> &nodes = families.nodes();
    if (dim == 1 || !nodes.lattice() || nodes.has_doubled_nodes())
      return {};
    const Lattice<dim> &lattice = *nodes.lattice();
    Vector              known(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      known.local_element(i) = damage[i];
    known.update_ghost_values();
    std::vector<double> own;
    for (const BondBreak &bond : breaks)
      {
        const auto a          = lattice.index(nodes.position(bond.node)),
                   b          = lattice.index(nodes.position(bond.neighbor));
        unsigned int distance = 0;
        for (unsigned int d = 0; d < dim; ++d)
          distance += std::abs(a[d] - b[d]);
        if (distance != 1)
          continue;
        // In numbers of half spacings, so that facets have corners in common.
        const Point<dim> middle = nodes.position(bond.node) +
                                  0.5 * (nodes.position(bond.neighbor) - nodes.position(bond.node));
        for (const double side : {-0.5, 0.5})
          for (unsigned int d = 0; d < dim; ++d)
            own.push_back(a[d] != b[d] ? middle[d] :
                                         std::clamp(middle[d] + side * lattice.spacing[d],
                                                    lattice.lower[d],
                                                    lattice.upper[d]));
        own.push_back(bond.time);
        own.push_back(std::max(known.local_element(bond.node), known.local_element(bond.neighbor)));
      }
    constexpr unsigned int       n_numbers = 2 * dim + 2;
    std::vector<CrackFacet<dim>> all;
    for (const std::vector<double> &list : gathered_lists(nodes.communicator(), own))
      for (std::size_t k = 0; k < list.size(); k += n_numbers)
        {
          all.emplace_back();
          for (unsigned int d = 0; d < dim; ++d)
            {
              all.back().lower[d] = list[k + d];
              all.back().upper[d] = list[k + dim + d];
            }
          all.back().time   = list[k + 2 * dim];
          all.back().damage = list[k + 2 * dim + 1];
        }
    std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) {
      return a.lower == b.lower ? comes_first(a.upper, b.upper) : comes_first(a.lower, b.lower);
    });
    return all;
  }


  template <int dim>
  double CrackFront<dim>::distance(const Point<dim> &p) const
  {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto &[a, b] : edges)
      {
        const Tensor<1, dim> along  = b - a;
        const double         square = along.norm_square(),
                     s = square > 0. ? std::clamp((p - a) * along / square, 0., 1.) : 0.;
        nearest        = std::min(nearest, (p - a - s * along).norm());
      }
    return nearest;
  }


  namespace
  {
    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();


    /** The corners of facets, each once, and how they are connected. */
    template <int dim>
    class CrackGraph
    {
    public:
      CrackGraph(const std::vector<CrackFacet<dim>> &facets, const double reach)
        : reach(reach)
      {
        std::map<Key, unsigned int> known;
        for (const CrackFacet<dim> &facet : facets)
          for (const Point<dim> &p : facet.corners())
            {
              const auto [entry, is_new] = known.emplace(key_of(p, 1e-6 * reach), places.size());
              if (is_new)
                {
                  places.push_back(p);
                  times.push_back(facet.time);
                }
              times[entry->second] = std::min(times[entry->second], facet.time);
            }
        for (unsigned int k = 0; k < places.size(); ++k)
          bins[key_of(places[k], reach)].push_back(k);
        ways.assign(places.size(), std::numeric_limits<double>::infinity());
        fronts.assign(places.size(), none);
      }

      /** The shortest paths from the fronts, and from which. */
      void find_ways(const std::vector<CrackFront<dim>> &from)
      {
        using Entry = std::tuple<double, unsigned int, unsigned int>; // way, front, corner
        std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> next;
        for (unsigned int f = 0; f < from.size(); ++f)
          for (unsigned int k = 0; k < places.size(); ++k)
            if (const double way = from[f].distance(places[k]); way <= reach)
              next.emplace(way, f, k);
        while (!next.empty())
          {
            const auto [way, front, k] = next.top();
            next.pop();
            if (fronts[k] != none)
              continue;
            ways[k]   = way;
            fronts[k] = front;
            for_each_within(k,
                            reach,
                            [&, way = way, front = front](const unsigned int l, const double r) {
                              if (fronts[l] == none)
                                next.emplace(way + r, front, l);
                            });
          }
      }

      /** Call visit(corner, distance) for those within a distance, itself included. */
      template <typename Visit>
      void for_each_within(const unsigned int k, const double distance, const Visit &visit) const
      {
        const Key                         middle = key_of(places[k], reach);
        const int                         n      = static_cast<int>(std::ceil(distance / reach));
        const double                      most   = distance * (1. + 1e-9);
        Key                               key;
        std::function<void(unsigned int)> look = [&](const unsigned int d) {
          if (d < dim)
            {
              for (int o = -n; o <= n; ++o)
                {
                  key[d] = middle[d] + o;
                  look(d + 1);
                }
              return;
            }
          if (const auto bin = bins.find(key); bin != bins.end())
            for (const unsigned int l : bin->second)
              if (const double r = places[k].distance(places[l]); r <= most)
                visit(l, r);
        };
        look(0);
      }

      /** Corners in connected groups, each and all in the order of places. */
      std::vector<std::vector<unsigned int>> groups_of(std::vector<unsigned int> list) const
      {
        std::sort(list.begin(), list.end(), [&](const unsigned int a, const unsigned int b) {
          return comes_first(places[a], places[b]);
        });
        std::map<unsigned int, bool>           taken; // of those in the list
        std::vector<std::vector<unsigned int>> groups;
        for (const unsigned int k : list)
          taken[k] = false;
        for (const unsigned int first : list)
          {
            if (taken[first])
              continue;
            taken[first] = true;
            groups.push_back({first});
            for (std::size_t g = 0; g < groups.back().size(); ++g)
              for_each_within(groups.back()[g], reach, [&](const unsigned int l, const double) {
                if (const auto found = taken.find(l); found != taken.end() && !found->second)
                  {
                    found->second = true;
                    groups.back().push_back(l);
                  }
              });
          }
        return groups;
      }

      const double              reach;
      std::vector<Point<dim>>   places;
      std::vector<double>       times, ways;
      std::vector<unsigned int> fronts;

    private:
      using Key = std::array<long long, dim>;

      static Key key_of(const Point<dim> &p, const double unit)
      {
        Key key;
        for (unsigned int d = 0; d < dim; ++d)
          key[d] = static_cast<long long>(std::floor(p[d] / unit + 0.5));
        return key;
      }

      std::map<Key, std::vector<unsigned int>> bins;
    };


    template <int dim>
    CrackAdvance<dim> advance_of(const CrackGraph<dim>           &graph,
                                 const std::vector<unsigned int> &corners,
                                 const double                     time)
    {
      const double              reach = graph.reach, same = 0.05 * reach;
      CrackAdvance<dim>         advance;
      std::vector<unsigned int> farthest, ends;
      for (const unsigned int k : corners)
        advance.length = std::max(advance.length, graph.ways[k]);
      std::vector<std::pair<double, double>> history;
      for (const unsigned int k : corners)
        {
          history.emplace_back(graph.times[k], graph.ways[k]);
          if (graph.ways[k] >= advance.length - same)
            farthest.push_back(k);
          bool is_end = true;
          graph.for_each_within(k, reach, [&](const unsigned int l, const double) {
            is_end = is_end &&
                     !(graph.fronts[l] == graph.fronts[k] && graph.ways[l] > graph.ways[k] + same);
          });
          if (is_end)
            ends.push_back(k);
        }
      const std::vector<unsigned int> group = graph.groups_of(farthest)[0];
      advance.tip                           = Point<dim>();
      for (const unsigned int k : group)
        advance.tip += graph.places[k] / static_cast<double>(group.size());
      advance.n_tips = graph.groups_of(ends).size();
      if (advance.length >= reach)
        advance.speed = fitted_speed(std::move(history), 4. * reach, time);
      return advance;
    }
  } // namespace


  double fitted_speed(std::vector<std::pair<double, double>> times_and_ways,
                      const double                           span,
                      const double                           now)
  {
    // The longest path until each time at which it grew.
    std::sort(times_and_ways.begin(), times_and_ways.end());
    std::vector<std::pair<double, double>> steps;
    for (const auto &[time, way] : times_and_ways)
      if (steps.empty() || way > steps.back().second)
        {
          if (!steps.empty() && time == steps.back().first)
            steps.back().second = way;
          else
            steps.emplace_back(time, way);
        }
    if (steps.empty())
      return 0.;
    std::size_t first = 0;
    while (steps[first].second < steps.back().second - span)
      ++first;
    const double begin = steps[first].first, duration = now - begin;
    if (!(duration > 0.))
      return 0.;
    // Integrals of the path length, constant between steps, times the time from the middle.
    double moment = 0.;
    for (std::size_t k = first; k < steps.size(); ++k)
      {
        const double from = steps[k].first - begin - 0.5 * duration,
                     to =
                       (k + 1 < steps.size() ? steps[k + 1].first : now) - begin - 0.5 * duration;
        moment += (steps[k].second - steps[first].second) * 0.5 * (to * to - from * from);
      }
    return 12. * moment / (duration * duration * duration);
  }


  template <int dim>
  std::vector<CrackAdvance<dim>> find_advances(const std::vector<CrackFacet<dim>> &facets,
                                               const std::vector<CrackFront<dim>> &fronts,
                                               const double                        reach,
                                               const double                        time)
  {
    CrackGraph<dim> graph(facets, reach);
    graph.find_ways(fronts);
    std::vector<std::vector<unsigned int>> corners(fronts.size());
    for (unsigned int k = 0; k < graph.places.size(); ++k)
      if (graph.fronts[k] != none)
        corners[graph.fronts[k]].push_back(k);
    std::vector<CrackAdvance<dim>> list(fronts.size());
    for (unsigned int f = 0; f < fronts.size(); ++f)
      if (!corners[f].empty())
        list[f] = advance_of(graph, corners[f], time);
    return list;
  }


  PERIDEAL_INSTANTIATE_CLASS(struct CrackFront);
  PERIDEAL_INSTANTIATE_FUNCTION(find_advances);
  PERIDEAL_INSTANTIATE_CLASS(struct CrackFacet);
  PERIDEAL_INSTANTIATE_CLASS(class CrackSurface);
} // namespace PeriDeal
