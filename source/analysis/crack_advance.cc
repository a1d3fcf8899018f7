// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/crack_advance.h>
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
} // namespace PeriDeal
