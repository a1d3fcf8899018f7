// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/clipped.h>
#include <perideal/scene/holes.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What of a polygon lies in a box. Pieces of it hang together along the sides of the box. */
    Hole part_in_box(Hole polygon, const Point<2> &lower, const Point<2> &upper)
    {
      polygon.corners = clipped_to_box(std::move(polygon.corners), lower, upper);
      return polygon;
    }


    /**
     * The cells around a polygon, row by row. Lengths are cells, the first cell of the lattice goes
     * from 0 to 1.
     */
    class CellsAround
    {
    public:
      enum State : char
      {
        stays,
        holds_centre, // removed, since its centre lies in the polygon
        joins,        // removed to join others
        in_other      // removed for another hole
      };

      /** @param state_of by the numbers of a cell along x and y, perhaps beyond the lattice */
      template <typename StateOf>
      CellsAround(Hole                               polygon,
                  const std::array<unsigned int, 2> &n_lattice,
                  const StateOf                     &state_of)
        : hole(part_in_box(std::move(polygon),
                           Point<2>(-2., -2.),
                           Point<2>(n_lattice[0] + 2., n_lattice[1] + 2.)))
      {
        if (hole.corners.empty())
          return;
        const auto box = hole.box();
        for (unsigned int d = 0; d < 2; ++d)
          {
            first[d] = static_cast<long>(std::floor(box.first[d])) - 1;
            n[d]     = static_cast<long>(std::floor(box.second[d])) + 2 - first[d];
          }
        for (long k = 0; k < n[0] * n[1]; ++k)
          states.push_back(state_of(first[0] + k % n[0], first[1] + k / n[0]));
        shares.assign(states.size(), -1.);
        way.assign(states.size(), std::numeric_limits<double>::max());
        from.assign(states.size(), 0);
        find_tips();
        if (std::find(states.begin(), states.end(), holds_centre) == states.end() &&
            std::max(box.second[0] - box.first[0], box.second[1] - box.first[1]) >= 1.)
          {
            long best = 0;
            for (std::size_t k = 0; k < states.size(); ++k)
              best = share(k) > share(best) ? k : best;
            states[best] = joins;
          }
        for (std::size_t k = 0; k < states.size(); ++k)
          if (way[k] > 0. && (states[k] == holds_centre || states[k] == joins))
            grow_from(k);
        part_corners();
      }

      /** Call visit(number along x, number along y, state) for each that the polygon removes. */
      template <typename Visit>
      void for_each_removed(const Visit &visit) const
      {
        for (std::size_t k = 0; k < states.size(); ++k)
          if (states[k] == holds_centre || states[k] == joins)
            visit(first[0] + static_cast<long>(k) % n[0],
                  first[1] + static_cast<long>(k) / n[0],
                  states[k]);
      }

    private:
      /** A place that removed cells have to come near, up to a distance. */
      struct Tip
      {
        Point<2> place;
        double   reach;
      };

      /**
       * Ends of thin polygons: the middle of short edges, and corners between long ones. The
       * distances are those at which cells of a wide polygon, and of one with corners of 60 degrees
       * or more, are near enough to all of its rim.
       */
      void find_tips()
      {
        constexpr double  diagonal = 1.4142;
        const std::size_t m        = hole.corners.size();
        const auto        corner   = [&](const std::size_t i) { return hole.corners[i % m]; };
        const auto        is_long  = [&](const std::size_t i) {
          return corner(i).distance(corner(i + 1)) > diagonal;
        };
        for (std::size_t i = 0; i < m; ++i)
          if (!is_long(i))
            tips.push_back({corner(i) + 0.5 * (corner(i + 1) - corner(i)), 0.75});
          else if (is_long(i + m - 1))
            tips.push_back({corner(i), diagonal});
        for (std::size_t k = 0; k < states.size(); ++k)
          if (states[k] != stays)
            leave_tips_near(k);
      }

      Point<2> corner_of(const long k) const
      {
        return Point<2>(first[0] + k % n[0], first[1] + k / n[0]);
      }

      bool is_near(const Tip &tip, const long k) const
      {
        Point<2> nearest = corner_of(k);
        for (unsigned int d = 0; d < 2; ++d)
          nearest[d] = std::clamp(tip.place[d], nearest[d], nearest[d] + 1.);
        return nearest.distance(tip.place) <= tip.reach;
      }

      void leave_tips_near(const long k)
      {
        tips.erase(
          std::remove_if(tips.begin(), tips.end(), [&](const Tip &tip) { return is_near(tip, k); }),
          tips.end());
      }

      /** What of the area of a cell lies in the polygon. */
      double share(const long k)
      {
        if (shares[k] < 0.)
          {
            const Point<2> a = corner_of(k);
            shares[k]        = part_in_box(hole, a, a + Tensor<1, 2>({1., 1.})).area();
          }
        return shares[k];
      }

      /**
       * Dijkstra's way from a removed cell through the polygon to others and to tips, by the cells
       * with the largest shares; what it leads through is removed.
       */
      void grow_from(const long start)
      {
        constexpr double none = 1e-6;
        using Entry           = std::pair<double, long>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
        const auto reach = [&](const long k, const double length, const long before) {
          if (!(length < way[k]))
            return;
          way[k]  = length;
          from[k] = before;
          queue.emplace(length, k);
        };
        reach(start, 0., start);
        while (!queue.empty())
          {
            const auto [length, cell] = queue.top();
            queue.pop();
            if (length > way[cell])
              continue;
            if (length > 0. &&
                (states[cell] == holds_centre ||
                 std::any_of(tips.begin(), tips.end(), [&, k = cell](const Tip &tip) {
                   return is_near(tip, k);
                 })))
              {
                for (long k = cell; way[k] > 0.; k = from[k])
                  {
                    if (states[k] == stays)
                      states[k] = joins;
                    leave_tips_near(k);
                    reach(k, 0., from[k]);
                  }
                continue;
              }
            const std::array<long, 2> place{{cell % n[0], cell / n[0]}};
            for (unsigned int d = 0; d < 2; ++d)
              for (const long step : {-1L, 1L})
                if (place[d] + step >= 0 && place[d] + step < n[d])
                  if (const long k = cell + (d == 0 ? step : step * n[0]);
                      states[k] == holds_centre || share(k) > none)
                    reach(k, length + (states[k] == stays ? 1. + none - share(k) : 0.), cell);
          }
      }

      /** Of two removed cells that touch at a corner only, remove the better of those between. */
      void part_corners()
      {
        for (bool any = true; any;)
          {
            any = false;
            for (long k = 0; k < n[0] * (n[1] - 1); ++k)
              for (const long step : {-1L, 1L})
                {
                  if (k % n[0] + step < 0 || k % n[0] + step >= n[0])
                    continue;
                  const std::array<long, 2> touching{{k, k + n[0] + step}},
                    between{{k + step, k + n[0]}};
                  const auto is = [&](const State state) {
                    return states[touching[0]] == state || states[touching[1]] == state;
                  };
                  if (is(stays) || states[between[0]] != stays || states[between[1]] != stays ||
                      !(is(joins) || hole.contains(corner_of(k + n[0] + (step + 1) / 2))))
                    continue;
                  const long best = share(between[0]) > share(between[1]) ? between[0] : between[1];
                  if (share(best) > 0.)
                    {
                      states[best] = joins;
                      any          = true;
                    }
                }
          }
      }

      const Hole          hole;
      std::array<long, 2> first{}, n{};
      std::vector<State>  states;
      std::vector<double> shares; // negative where not known yet
      std::vector<double> way;    // to removed cells
      std::vector<long>   from;   // the cell before along it
      std::vector<Tip>    tips;   // those that no removed cell is near
    };
  } // namespace


  HoleCells cells_of_hole(const Hole                        &hole,
                          const std::vector<Hole>           &holes,
                          const Point<2>                    &lower,
                          const Point<2>                    &upper,
                          const std::array<unsigned int, 2> &n_cells)
  {
    const Tensor<1, 2> edges    = upper - lower;
    const auto         to_cells = [&](const Point<2> &p) {
      return Point<2>((p[0] - lower[0]) / edges[0] * n_cells[0],
                      (p[1] - lower[1]) / edges[1] * n_cells[1]);
    };
    const auto place = [&](const double i, const double j) {
      return Point<2>(lower[0] + edges[0] * i / n_cells[0], lower[1] + edges[1] * j / n_cells[1]);
    };
    HoleCells  cells;
    const auto count = [&](const long i, const long j) {
      const bool is_in = i >= 0 && j >= 0 && i < n_cells[0] && j < n_cells[1];
      cells.n_removed += is_in ? 1 : 0;
      return is_in;
    };
    if (hole.corners.empty()) // circles have no thin parts
      {
        const auto     box  = hole.box();
        const Point<2> from = to_cells(box.first), to = to_cells(box.second);
        for (long i = std::max(0., from[0] - 1.); i < std::min<double>(n_cells[0], to[0] + 1.); ++i)
          for (long j = std::max(0., from[1] - 1.); j < std::min<double>(n_cells[1], to[1] + 1.);
               ++j)
            if (hole.contains(place(i + 0.5, j + 0.5)))
              count(i, j);
        return cells;
      }
    Hole polygon;
    for (const Point<2> &corner : hole.corners)
      polygon.corners.push_back(to_cells(corner));
    const auto        box = hole.box();
    std::vector<Hole> near;
    for (const Hole &other : holes)
      {
        const auto of_other = other.box();
        bool       meets    = true;
        for (unsigned int d = 0; d < 2; ++d)
          {
            const double reach = 3. * edges[d] / n_cells[d];
            meets = meets && of_other.first[d] < box.second[d] + reach &&
                    of_other.second[d] > box.first[d] - reach;
          }
        if (meets)
          near.push_back(other);
      }
    const CellsAround around(std::move(polygon), n_cells, [&](const long i, const long j) {
      const Point<2> center = place(i + 0.5, j + 0.5);
      const auto     is_in  = [&](const Hole &one) { return one.contains(center); };
      return is_in(hole)                                    ? CellsAround::holds_centre :
             std::any_of(near.begin(), near.end(), is_in)   ? CellsAround::in_other :
                                                              CellsAround::stays;
    });
    around.for_each_removed([&](const long i, const long j, const CellsAround::State state) {
      if (!count(i, j) || state != CellsAround::joins)
        return;
      Hole joint;
      joint.corners = {place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)};
      cells.joints.push_back(joint);
    });
    return cells;
  }
} // namespace PeriDeal
