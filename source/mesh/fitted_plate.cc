// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/mesh/fitted_plate.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What is cut out of a lattice for the holes, in the course of which nothing is smoothed. */
    class CutLattice
    {
    public:
      CutLattice(const Point<2>                    &lower,
                 const Point<2>                    &upper,
                 const std::array<unsigned int, 2> &n,
                 const std::vector<Hole>           &holes,
                 const std::string                 &where)
        : lower(lower)
        , upper(upper)
        , n(n)
        , holes(holes)
        , where(where)
        , state(n[0] * n[1], kept)
      {
        for (unsigned int d = 0; d < 2; ++d)
          h[d] = (upper[d] - lower[d]) / n[d];
        for (const Hole &hole : holes)
          aligned.push_back(is_aligned(hole));
        remove();
        while (remove_what_hangs())
          ;
        require_room();
      }

      static constexpr int kept = -2, gone = -1; // else the number of the hole it made room for

      bool is_kept(const int i, const int j) const
      {
        return is_inside(i, j) && state[i + n[0] * j] == kept;
      }

      /** The hole whose row of cells begins at an edge beyond which this cell would lie, or -1. */
      int hole_at(const int i, const int j) const
      {
        return is_inside(i, j) && state[i + n[0] * j] >= 0 ? state[i + n[0] * j] : -1;
      }

      Point<2> vertex(const double i, const double j) const
      {
        return {lower[0] + (upper[0] - lower[0]) * i / n[0],
                lower[1] + (upper[1] - lower[1]) * j / n[1]};
      }

      double spacing() const
      {
        return std::min(h[0], h[1]);
      }

      [[noreturn]] void refuse(const std::string &what) const
      {
        throw UserError("Entry " + where + ": 'fitted': " + what +
                        " Choose more 'Cells', or 'Rims = stairs'.");
      }

    private:
      bool is_inside(const int i, const int j) const
      {
        return i >= 0 && j >= 0 && i < static_cast<int>(n[0]) && j < static_cast<int>(n[1]);
      }

      bool is_aligned(const Hole &hole) const
      {
        constexpr double slack   = 1e-7; // of a cell
        const auto       on_line = [&](const Point<2> &p, const unsigned int d) {
          const double s = std::clamp((p[d] - lower[d]) / h[d], 0., double(n[d]));
          return std::abs(s - std::round(s)) < slack;
        };
        const std::size_t n_corners = hole.corners.size();
        for (std::size_t k = 0; k < n_corners; ++k)
          {
            const Point<2> &a = hole.corners[k], &b = hole.corners[(k + 1) % n_corners];
            const bool      upright = std::abs(a[0] - b[0]) < slack * h[0],
                       level        = std::abs(a[1] - b[1]) < slack * h[1];
            if (!on_line(a, 0) || !on_line(a, 1) || !(upright || level))
              return false;
          }
        return n_corners > 0;
      }

      /** Cells in holes, and those that would leave less than some part of a cell to a rim. */
      void remove()
      {
        constexpr double least = 0.4;
        for (unsigned int j = 0; j < n[1]; ++j)
          for (unsigned int i = 0; i < n[0]; ++i)
            for (unsigned int k = 0; k < holes.size(); ++k)
              {
                const double distance = aligned[k] ? holes[k].distance(vertex(i + 0.5, j + 0.5)) :
                                                     nearest_in_cell(holes[k], i, j);
                int         &mine     = state[i + n[0] * j];
                if (aligned[k] && distance < 0.)
                  mine = gone;
                else if (!aligned[k] && distance < least * spacing())
                  {
                    if (mine >= 0 && mine != static_cast<int>(k))
                      refuse("there are less than some two cells between '" + holes[mine].text +
                             "' and '" + holes[k].text + "'.");
                    if (mine == kept)
                      mine = k;
                  }
              }
      }

      /** The smallest distance of points of a cell, so dense that no hole falls between them. */
      double nearest_in_cell(const Hole &hole, const unsigned int i, const unsigned int j) const
      {
        constexpr double            dense = 0.5; // of the shorter edge
        std::array<unsigned int, 2> n_steps;
        for (unsigned int d = 0; d < 2; ++d)
          n_steps[d] = static_cast<unsigned int>(std::ceil(h[d] / (dense * spacing()) - 1e-9));
        double nearest = std::numeric_limits<double>::max();
        for (unsigned int a = 0; a <= n_steps[0]; ++a)
          for (unsigned int b = 0; b <= n_steps[1]; ++b)
            nearest = std::min(nearest,
                               hole.distance(vertex(i + static_cast<double>(a) / n_steps[0],
                                                    j + static_cast<double>(b) / n_steps[1])));
        return nearest;
      }

      /** The hole that made room of one of the cells next to this one, and how many it has. */
      std::pair<int, unsigned int> beside(const int i, const int j) const
      {
        int          hole = -1;
        unsigned int n_of = 0;
        for (const auto &[a, b] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
          if (const int other = hole_at(i + a, j + b); other >= 0)
            {
              hole = other;
              ++n_of;
            }
        return {hole, n_of};
      }

      /** Cells that hang on one edge, and pairs that meet at a corner alone. */
      bool remove_what_hangs()
      {
        for (int j = 0; j < static_cast<int>(n[1]); ++j)
          for (int i = 0; i < static_cast<int>(n[0]); ++i)
            {
              if (!is_kept(i, j))
                continue;
              const auto [hole, n_of] = beside(i, j);
              bool hangs              = n_of > 2;
              for (const int a : {-1, 1})
                for (const int b : {-1, 1})
                  hangs = hangs || (is_kept(i + a, j + b) && hole_at(i + a, j) >= 0 &&
                                    hole_at(i, j + b) >= 0);
              if (hangs)
                {
                  state[i + n[0] * j] = hole;
                  return true;
                }
            }
        return false;
      }

      void require_room() const
      {
        for (unsigned int k = 0; k < holes.size(); ++k)
          if (!aligned[k] && std::count(state.begin(), state.end(), static_cast<int>(k)) == 0)
            refuse("'" + holes[k].text + "' lies outside the plate.");
        for (int j = 0; j < static_cast<int>(n[1]); ++j)
          for (int i = 0; i < static_cast<int>(n[0]); ++i)
            if (const int hole = hole_at(i, j); hole >= 0)
              for (int a = -1; a < 2; ++a)
                for (int b = -1; b < 2; ++b)
                  {
                    if (!is_inside(i + a, j + b))
                      refuse("there is less than a cell between '" + holes[hole].text +
                             "' and a side of the plate.");
                    const int other = state[i + a + n[0] * (j + b)];
                    if (other != kept && other != hole)
                      refuse("there is less than a cell between '" + holes[hole].text +
                             "' and another hole.");
                  }
      }

      const Point<2>                    lower, upper;
      const std::array<unsigned int, 2> n;
      const std::vector<Hole>          &holes;
      const std::string                 where;
      Tensor<1, 2>                      h;
      std::vector<bool>                 aligned;
      std::vector<int>                  state;
    };


    /** Twice the area of the triangle at corner k of a cell. */
    double turn(const FittedPlate &plate, const std::array<unsigned int, 4> &cell, unsigned int k)
    {
      const Point<2>    &p = plate.vertices[cell[k]];
      const Tensor<1, 2> a = plate.vertices[cell[(k + 1) % 4]] - p,
                         b = plate.vertices[cell[(k + 3) % 4]] - p;
      return (a[0] * b[1] - a[1] * b[0]);
    }


    /** The smallest sine of an angle at a corner of a cell; negative if it is folded. */
    double worst_sine(const FittedPlate &plate, const std::array<unsigned int, 4> &cell)
    {
      double worst = 1.;
      for (unsigned int k = 0; k < 4; ++k)
        {
          const Point<2> &p = plate.vertices[cell[k]];
          const double    a = p.distance(plate.vertices[cell[(k + 1) % 4]]),
                       b    = p.distance(plate.vertices[cell[(k + 3) % 4]]);
          worst             = std::min(worst, turn(plate, cell, k) / (a * b));
        }
      return worst;
    }


    /** Builds the rows between the lattice and the rims. */
    class RimRows
    {
    public:
      RimRows(FittedPlate &plate, const CutLattice &lattice, const std::vector<Hole> &holes)
        : plate(plate)
        , lattice(lattice)
        , holes(holes)
      {}

      /** @param next of vertices along the border of the lattice at a hole, the hole to the left */
      void add(const std::map<unsigned int, unsigned int> &next,
               const std::map<unsigned int, int>          &hole_of)
      {
        std::set<unsigned int> done;
        for (const auto &[first, second] : next)
          if (done.count(first) == 0)
            {
              std::vector<unsigned int> loop;
              for (unsigned int v = first; done.insert(v).second; v = next.at(v))
                loop.push_back(v);
              add_loop(loop, hole_of.at(first));
            }
      }

      /** A vertex on a rim, between two others along it; corners of polygons stay. */
      struct RimVertex
      {
        unsigned int vertex, hole;
        std::size_t  before, after; // the numbers of these two
        double       place;
        bool         stays;
      };

      const std::vector<RimVertex> &rim_vertices() const
      {
        return on_rim;
      }

      const std::vector<unsigned int> &new_cells() const
      {
        return made;
      }

    private:
      void add_loop(const std::vector<unsigned int> &loop, const unsigned int h)
      {
        const std::vector<double> places = places_on_rim(loop, holes[h]);
        const unsigned int        first = plate.vertices.size(), n = loop.size();
        const std::size_t         start = on_rim.size();
        for (unsigned int k = 0; k < n; ++k)
          {
            on_rim.push_back({first + k,
                              h,
                              start + (k + n - 1) % n,
                              start + (k + 1) % n,
                              places[k],
                              is_corner(holes[h], places[k])});
            plate.vertices.push_back(holes[h].point_on_rim(places[k]));
          }
        for (unsigned int k = 0; k < n; ++k)
          {
            const unsigned int l = (k + 1) % n;
            made.push_back(plate.cells.size());
            plate.cells.push_back({{loop[k], loop[l], first + l, first + k}});
          }
      }

      /**
       * Of the nearest points, in the order of the loop, corners of polygons at the vertices
       * nearest to them, and evenly between these.
       */
      std::vector<double> places_on_rim(const std::vector<unsigned int> &loop,
                                        const Hole                      &hole) const
      {
        const double        length = hole.rim_length();
        const std::size_t   n      = loop.size();
        std::vector<double> places(n);
        for (std::size_t k = 0; k < n; ++k)
          places[k] = hole.place_on_rim(plate.vertices[loop[k]]);
        // The loop runs around the hole once, in one direction: unroll.
        const auto step = [&](const double from, const double to) {
          return std::remainder(to - from, length);
        };
        double around = 0.;
        for (std::size_t k = 0; k < n; ++k)
          around += step(places[k], places[(k + 1) % n]);
        if (std::abs(std::abs(around) - length) > 1e-6 * length)
          lattice.refuse("'" + hole.text + "' is smaller than some two cells, or has a neck.");
        const double sign = around > 0. ? 1. : -1.;
        return hole.corners.empty() ? evened(places, length, sign) :
                                      with_corners(places, hole, length, sign);
      }

      static bool is_corner(const Hole &hole, const double place)
      {
        const double length = hole.rim_length();
        double       corner = 0.;
        for (std::size_t c = 0; c < hole.corners.size(); ++c)
          {
            if (std::abs(std::remainder(place - corner, length)) < 1e-9 * length)
              return true;
            corner += hole.corners[c].distance(hole.corners[(c + 1) % hole.corners.size()]);
          }
        return false;
      }

      /** Where stairs crowd, points of a circle move towards the middle of their neighbours. */
      static std::vector<double> evened(std::vector<double> places,
                                        const double        length,
                                        const double        sign)
      {
        const std::size_t n = places.size();
        for (std::size_t k = 1; k < n; ++k)
          places[k] = places[k - 1] + std::remainder(places[k] - places[k - 1], length);
        for (unsigned int pass = 0; pass < 20; ++pass)
          {
            std::vector<double> before = places;
            for (std::size_t k = 0; k < n; ++k)
              {
                const double left  = k > 0 ? before[k - 1] : before[n - 1] - sign * length,
                             right = k + 1 < n ? before[k + 1] : before[0] + sign * length;
                places[k]          = 0.5 * before[k] + 0.25 * (left + right);
              }
          }
        return places;
      }

      /** From one corner on over a way, in so many steps: near the nearest points, but apart. */
      static std::vector<double> relaxed(const std::vector<double> &places,
                                         const std::size_t          from,
                                         const std::size_t          steps,
                                         const double               start,
                                         const double               way,
                                         const double               length)
      {
        constexpr unsigned int n_passes = 8;
        std::vector<double>    s(steps + 1);
        for (std::size_t k = 0; k <= steps; ++k)
          {
            double nearest = places[(from + k) % places.size()] - start;
            nearest -= std::round((nearest - way * k / steps) / length) * length;
            s[k] = std::clamp(nearest / way, 0., 1.);
          }
        s[0]     = 0.;
        s[steps] = 1.;
        for (unsigned int pass = 0; pass < n_passes; ++pass)
          for (std::size_t k = 1; k < steps; ++k)
            s[k] = 0.25 * s[k - 1] + 0.5 * s[k] + 0.25 * s[k + 1];
        std::vector<double> result;
        for (std::size_t k = 0; k < steps; ++k)
          // some of an even division, so that none coincide
          result.push_back(start + way * (0.9 * s[k] + 0.1 * k / steps));
        return result;
      }

      std::vector<double> with_corners(const std::vector<double> &places,
                                       const Hole                &hole,
                                       const double               length,
                                       const double               sign) const
      {
        const std::size_t                           n = places.size();
        std::vector<std::pair<std::size_t, double>> fixed; // vertex of the loop, place of a corner
        double                                      corner = 0.;
        for (std::size_t c = 0; c < hole.corners.size(); ++c)
          {
            std::size_t nearest = 0;
            double      best    = std::numeric_limits<double>::max();
            for (std::size_t k = 0; k < n; ++k)
              if (const double d = std::abs(std::remainder(places[k] - corner, length)); d < best)
                {
                  best    = d;
                  nearest = k;
                }
            // Several vertices may have the corner for their nearest point: the middle one.
            std::size_t before = 0, after = 0;
            const auto  has = [&](const std::size_t k) {
              return std::abs(std::remainder(places[k % n] - corner, length)) <
                     best + 1e-9 * length;
            };
            while (after < n && has(nearest + after + 1))
              ++after;
            while (before < n && has(nearest + n - before - 1))
              ++before;
            fixed.emplace_back((nearest + n + (after - before) / 2) % n, corner);
            if (after < before)
              fixed.back().first = (nearest + n - (before - after) / 2) % n;
            corner += hole.corners[c].distance(hole.corners[(c + 1) % hole.corners.size()]);
          }
        std::sort(fixed.begin(), fixed.end());
        std::vector<double> result(n);
        double              all = 0.;
        for (std::size_t f = 0; f < fixed.size(); ++f)
          {
            const auto &[from, start] = fixed[f];
            const auto &[to, end]     = fixed[(f + 1) % fixed.size()];
            std::size_t steps         = (to + n - from) % n;
            double      way           = sign * (end - start);
            way -= std::floor(way / length) * length;
            all += way;
            if (steps == 0 || way <= 0. || all > (1. + 1e-6) * length)
              lattice.refuse("'" + hole.text + "' has corners that are less than a cell apart.");
            const std::vector<double> between =
              relaxed(places, from, steps, start, sign * way, length);
            for (std::size_t k = 0; k < steps; ++k)
              result[(from + k) % n] = between[k];
          }
        return result;
      }

      FittedPlate              &plate;
      const CutLattice         &lattice;
      const std::vector<Hole>  &holes;
      std::vector<unsigned int> made;
      std::vector<RimVertex>    on_rim;
    };


    /** Moves vertices beside rims, and along them, as long as the worst angles get better. */
    class Smoothing
    {
    public:
      Smoothing(FittedPlate &plate, const RimRows &rows, const std::vector<Hole> &holes)
        : plate(plate)
        , holes(holes)
        , on_rim(rows.rim_vertices())
        , cells(plate.vertices.size())
        , neighbors(plate.vertices.size())
      {
        std::map<std::pair<unsigned int, unsigned int>, unsigned int> n_cells;
        for (unsigned int c = 0; c < plate.cells.size(); ++c)
          for (unsigned int k = 0; k < 4; ++k)
            {
              const unsigned int a = plate.cells[c][k], b = plate.cells[c][(k + 1) % 4];
              cells[a].push_back(c);
              neighbors[a].insert(b);
              neighbors[b].insert(a);
              ++n_cells[std::minmax(a, b)];
            }
        std::set<unsigned int> border, near;
        for (const auto &[edge, n] : n_cells)
          if (n == 1)
            border.insert({edge.first, edge.second});
        for (const unsigned int c : rows.new_cells())
          near.insert(plate.cells[c].begin(), plate.cells[c].end());
        for (unsigned int ring = 0; ring < 2; ++ring)
          for (const unsigned int v : std::set<unsigned int>(near))
            near.insert(neighbors[v].begin(), neighbors[v].end());
        for (const unsigned int v : near)
          if (border.count(v) == 0)
            inside.push_back(v);
      }

      void run()
      {
        constexpr unsigned int n_passes = 60;
        for (unsigned int pass = 0; pass < n_passes; ++pass)
          {
            for (const unsigned int v : inside)
              {
                Tensor<1, 2> sum;
                for (const unsigned int w : neighbors[v])
                  sum += plate.vertices[w] - Point<2>();
                const Point<2> middle(Point<2>() + 1. / neighbors[v].size() * sum),
                  here = plate.vertices[v];
                for (const double share : {1., 0.5, 0.2, -0.2})
                  try_at(v, (1. - share) * here + share * middle);
                // Away from the longest diagonal of what is folded there is no mean to go to.
                const double step = 0.1 * here.distance(plate.vertices[*neighbors[v].begin()]);
                for (unsigned int k = 0; k < 8; ++k)
                  try_at(v,
                         plate.vertices[v] +
                           step * Point<2>(std::cos(k * 0.785), std::sin(k * 0.785)));
              }
            for (std::size_t k = 0; k < on_rim.size(); ++k)
              slide(k);
          }
      }

      double worst() const
      {
        double sine = 1.;
        for (const auto &cell : plate.cells)
          sine = std::min(sine, worst_sine(plate, cell));
        return sine;
      }

    private:
      double worst_at(const unsigned int v) const
      {
        double sine = 1.;
        for (const unsigned int c : cells[v])
          sine = std::min(sine, worst_sine(plate, plate.cells[c]));
        return sine;
      }

      bool try_at(const unsigned int v, const Point<2> &p)
      {
        constexpr double enough = 0.75; // better is no aim
        const double     before = worst_at(v);
        const Point<2>   here   = plate.vertices[v];
        if (before > enough)
          return false;
        plate.vertices[v] = p;
        if (worst_at(v) > before)
          return true;
        plate.vertices[v] = here;
        return false;
      }

      /** Along the rim, between the two others. */
      void slide(const std::size_t k)
      {
        RimRows::RimVertex &one = on_rim[k];
        if (one.stays)
          return;
        const Hole  &hole   = holes[one.hole];
        const double length = hole.rim_length(),
                     before = std::remainder(on_rim[one.before].place - one.place, length),
                     after  = std::remainder(on_rim[one.after].place - one.place, length);
        for (const double step : {0.5 * (before + after), 0.25 * before, 0.25 * after})
          if (try_at(one.vertex, hole.point_on_rim(one.place + step)))
            {
              one.place += step;
              return;
            }
      }

      FittedPlate                           &plate;
      const std::vector<Hole>               &holes;
      std::vector<RimRows::RimVertex>        on_rim;
      std::vector<std::vector<unsigned int>> cells;
      std::vector<std::set<unsigned int>>    neighbors;
      std::vector<unsigned int>              inside;
    };
  } // namespace


  FittedPlate fitted_plate(const Point<2>                    &lower,
                           const Point<2>                    &upper,
                           const std::array<unsigned int, 2> &n_cells,
                           const std::vector<Hole>           &holes,
                           const std::string                 &where)
  {
    const CutLattice lattice(lower, upper, n_cells, holes, where);
    FittedPlate      plate;
    // Where two cells touch at a corner alone, aligned holes between them, it is one vertex still.
    std::map<std::pair<int, int>, unsigned int> numbers;
    const auto                                  vertex = [&](const int i, const int j) {
      const auto [entry, is_new] =
        numbers.try_emplace({i, j}, static_cast<unsigned int>(plate.vertices.size()));
      if (is_new)
        plate.vertices.push_back(lattice.vertex(i, j));
      return entry->second;
    };
    std::map<unsigned int, unsigned int> next; // around each hole
    std::map<unsigned int, int>          hole_of;
    for (int j = 0; j < static_cast<int>(n_cells[1]); ++j)
      for (int i = 0; i < static_cast<int>(n_cells[0]); ++i)
        if (lattice.is_kept(i, j))
          {
            const std::array<unsigned int, 4> cell = {
              {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)}};
            const std::array<int, 4> beyond = {{lattice.hole_at(i, j - 1),
                                                lattice.hole_at(i + 1, j),
                                                lattice.hole_at(i, j + 1),
                                                lattice.hole_at(i - 1, j)}};
            for (unsigned int k = 0; k < 4; ++k)
              if (beyond[k] >= 0)
                {
                  next[cell[(k + 1) % 4]] = cell[k];
                  hole_of[cell[k]] = hole_of[cell[(k + 1) % 4]] = beyond[k];
                }
            plate.cells.push_back(cell);
          }
    if (plate.cells.empty())
      lattice.refuse("the holes leave nothing of the plate.");
    RimRows rows(plate, lattice, holes);
    rows.add(next, hole_of);
    if (!next.empty())
      {
        constexpr double least = 0.1; // of the sine of an angle
        Smoothing        smoothing(plate, rows, holes);
        smoothing.run();
        if (smoothing.worst() < least)
          lattice.refuse("cells at a hole would be folded or nearly so.");
      }
    return plate;
  }
} // namespace PeriDeal
