// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/cell_paths.h>

#include <algorithm>
#include <cmath>
#include <utility>

// Paths in general: cut at all faces nearby, then each piece looked for in all cells.

// Paths from cell to cell through the inside of faces.

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Whether a point lies in a cell or on its surface; @p unit is then near that point of the unit
     * cell.
     */
    template <int dim>
    bool is_inside(const CellCorners<dim> &corners, const Point<dim> &p, Point<dim> &unit)
    {
      for (unsigned int d = 0; d < dim; ++d)
        unit[d] = 0.5;
      constexpr double slack = 1e-9; // less than the crack points of a path lie beside its ends
      if constexpr (dim == 2)
        {
          constexpr unsigned int around[5] = {0, 1, 3, 2, 0}; // a convex quadrilateral
          for (unsigned int k = 0; k < 4; ++k)
            {
              const Tensor<1, dim> side = corners[around[k + 1]] - corners[around[k]],
                                   to_p = p - corners[around[k]];
              if (!(side[0] * to_p[1] - side[1] * to_p[0] > -slack * side.norm_square()))
                return false;
            }
          return true;
        }
      if (!unit_point(corners, p, unit))
        return false;
      for (unsigned int d = 0; d < dim; ++d)
        if (!(unit[d] > -slack && unit[d] < 1. + slack))
          return false;
      return true;
    }
  } // namespace


  /** Finds the cells that a path may pass. */
  template <int dim>
  struct CellPaths<dim>::Tree
  {
    using Entry = std::pair<BoundingBox<dim>, unsigned int>;

    Tree(const std::vector<PathCell<dim>> &cells, const std::vector<unsigned int> &near)
    {
      std::vector<Entry> list;
      list.reserve(near.size());
      for (const unsigned int c : near)
        {
          BoundingBox<dim> box(cells[c].corners);
          double           size = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            size = std::max(size, box.side_length(d));
          box.extend(1e-6 * size);
          list.emplace_back(box, c);
        }
      entries = pack_rtree(list);
    }

    RTree<Entry> entries;
  };


  namespace
  {
    /** Whether the sphere around a box meets the line through a. @p along has length 1. */
    template <int dim>
    bool is_near_line(const BoundingBox<dim> &box, const Point<dim> &a, const Tensor<1, dim> &along)
    {
      const auto &[low, high]        = box.get_boundary_points();
      const Tensor<1, dim> to_middle = 0.5 * ((low - a) + (high - a));
      const double         ahead     = to_middle * along;
      return to_middle.norm_square() - ahead * ahead < 0.2501 * (high - low).norm_square();
    }
  } // namespace


  template <int dim>
  CellPaths<dim>::CellPaths(const std::vector<PathCell<dim>> &cells,
                            const std::vector<Point<dim>>    &ends,
                            const double                      reach,
                            const bool                        regular)
    : cells(cells)
    , regular(regular)
  {
    const std::vector<unsigned int> near = cells_near(ends, reach);
    tree                                 = std::make_unique<Tree>(cells, near);
    connect(near);
  }


  template <int dim>
  CellPaths<dim>::~CellPaths() = default;


  template <int dim>
  std::vector<unsigned int> CellPaths<dim>::cells_near(const std::vector<Point<dim>> &ends,
                                                       const double                   reach) const
  {
    namespace index                  = boost::geometry::index;
    const RTree<Point<dim>>   points = pack_rtree(ends);
    std::vector<unsigned int> near;
    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        // No place on a path is farther from both ends than half of its length.
        BoundingBox<dim> box(cells[c].corners);
        box.extend(0.5001 * reach);
        if (points.qbegin(index::intersects(box)) != points.qend())
          near.push_back(c);
      }
    return near;
  }


  template <int dim>
  bool CellPaths<dim>::follow_plainly(const End &from, const End &to, std::vector<Piece> &pieces)
  {
    namespace index        = boost::geometry::index;
    const Point<dim>    &a = from.position, &b = to.position;
    const Tensor<1, dim> along = (b - a) / a.distance(b);
    found.clear();
    places.clear();
    // A cell that the path passes has a face that it crosses, since it begins and ends at vertices.
    constexpr double       apart = 1e-9;
    const BoundingBox<dim> whole(std::vector<Point<dim>>{a, b});
    for (auto entry = tree->entries.qbegin(index::intersects(whole)); entry != tree->entries.qend();
         ++entry)
      {
        if (!is_near_line(entry->first, a, along))
          continue;
        const std::size_t before = places.size();
        add_face_crossings(cells[entry->second].corners, a, b, places);
        if (std::any_of(places.begin() + before, places.end(), [](const double s) {
              return s > -1e-6 && s < 1. + 1e-6;
            }))
          found.push_back(entry->second);
      }
    std::sort(found.begin(), found.end());
    std::sort(places.begin(), places.end());
    cuts.assign(1, 0.);
    for (const double s : places)
      if (s > cuts.back() + apart && s < 1. - apart)
        cuts.push_back(s);
    cuts.push_back(1.);
    pieces.clear();
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
      {
        // Which side of a crack cut into the mesh a path runs along is told by the crack points of
        // its ends.
        const double      middle = 0.5 * (cuts[k] + cuts[k + 1]);
        const Point<dim>  p      = from.crack_point + middle * (to.crack_point - from.crack_point);
        const std::size_t first  = pieces.size();
        for (const unsigned int c : found)
          {
            const CellCorners<dim> &corners = cells[c].corners;
            Point<dim>              start_of_piece;
            if (!is_inside(corners, p, start_of_piece))
              continue;
            Point<dim> end_of_piece = start_of_piece;
            if (!unit_point(corners, a + cuts[k] * (b - a), start_of_piece) ||
                !unit_point(corners, a + cuts[k + 1] * (b - a), end_of_piece))
              return false;
            const auto before = shape_values(start_of_piece);
            Piece      piece{c, shape_values(end_of_piece)};
            for (unsigned int v = 0; v < n_corners; ++v)
              piece.change[v] -= before[v];
            pieces.push_back(piece);
          }
        const std::size_t n_around = pieces.size() - first;
        if (n_around == 0)
          return false; // leaves the body
        const double factor = 1. / std::sqrt((cuts[k + 1] - cuts[k]) * n_around);
        for (std::size_t w = first; w < pieces.size(); ++w)
          for (double &x : pieces[w].change)
            x *= factor;
      }
    return true;
  }


  template <int dim>
  std::size_t CellPaths<dim>::memory_consumption() const
  {
    return numbers.capacity() * sizeof(unsigned int) + beyond.capacity() * sizeof(unsigned int) +
           at_node.capacity() * sizeof(at_node[0]) +
           tree->entries.size() * sizeof(typename Tree::Entry);
  }


  namespace
  {
    constexpr double apart = 1e-9; // places of a path that are told from each other
    constexpr double slack = 1e-6; // of a face: closer to its edges a crossing is unclear
    constexpr double steep = 1e-4; // least component of a start into a cell
    constexpr double flat  = 1e-4; // of a face: paths so near to a side of the body lie in it

    constexpr unsigned int none = numbers::invalid_unsigned_int;


    /** Corners of the faces of a cell, in ascending order. */
    template <int dim>
    constexpr auto face_corners = [] {
      constexpr unsigned int                                   n_corners = 1u << (dim - 1);
      std::array<std::array<unsigned int, n_corners>, 2 * dim> corners{};
      for (unsigned int face = 0; face < 2 * dim; ++face)
        for (unsigned int k = 0; k < n_corners; ++k)
          {
            const unsigned int d = face / 2, below = k & ((1u << d) - 1);
            corners[face][k] = below | (face % 2) << d | (k - below) << 1;
          }
      return corners;
    }();


    /** The columns of the Jacobian at a corner. */
    template <int dim>
    Tensor<2, dim> jacobian_at_corner(const CellCorners<dim> &corners, const unsigned int corner)
    {
      Tensor<2, dim> jacobian;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const Tensor<1, dim> edge = corners[corner | (1u << d)] - corners[corner & ~(1u << d)];
          for (unsigned int c = 0; c < dim; ++c)
            jacobian[c][d] = edge[c];
        }
      return jacobian;
    }
  } // namespace


  /** A path, and directions across it. */
  template <int dim>
  struct CellPaths<dim>::Line
  {
    Line(const Point<dim> &a, const Point<dim> &b)
      : a(a)
    {
      const Tensor<1, dim> whole = b - a;
      along                      = whole / whole.norm_square();
      if constexpr (dim == 2)
        across[0] = cross_product_2d(whole) / whole.norm();
      else if constexpr (dim == 3)
        {
          unsigned int longest = 0;
          for (unsigned int d = 1; d < 3; ++d)
            if (std::abs(whole[d]) > std::abs(whole[longest]))
              longest = d;
          Tensor<1, 3> helper;
          helper[(longest + 1) % 3] = 1.;
          across[0]                 = cross_product_3d(whole, helper);
          across[0] /= across[0].norm();
          across[1] = cross_product_3d(along, across[0]) * whole.norm();
        }
    }

    Point<dim>                                          a;
    Tensor<1, dim>                                      along; // over the length
    std::array<Tensor<1, dim>, (dim > 1 ? dim - 1 : 1)> across;
  };


  namespace
  {
    /** Corners of a cell as seen along a path: across it, and places on it. */
    template <int dim>
    struct Seen
    {
      static constexpr unsigned int n = GeometryInfo<dim>::vertices_per_cell;
      double                        across[dim > 1 ? dim - 1 : 1][n], along[n];
    };


    /** Zeros of c2 x^2 + c1 x + c0; the number of them. */
    unsigned int find_roots(const double c2, const double c1, const double c0, double (&roots)[2])
    {
      const double size = std::abs(c2) + std::abs(c1) + std::abs(c0);
      if (std::abs(c2) < 1e-14 * size)
        {
          roots[0] = -c0 / c1;
          return c1 != 0. ? 1 : 0;
        }
      const double radicand = c1 * c1 - 4. * c2 * c0;
      if (!(radicand >= 0.))
        return 0;
      const double q = -0.5 * (c1 + std::copysign(std::sqrt(radicand), c1));
      roots[0]       = q / c2;
      if (q == 0.)
        return 1;
      roots[1] = c0 / q;
      return 2;
    }


    bool is_corner_of_face(const unsigned int corner, const unsigned int face)
    {
      return ((corner >> (face / 2)) & 1) == face % 2;
    }


    /** Whether a coordinate of a face is on it: 1 inside, 0 beside, -1 close to its edge. */
    int side_of_edge(const double u)
    {
      return u > slack && u < 1. - slack ? 1 : (u > -slack && u < 1. + slack ? -1 : 0);
    }


    /** In one dimension paths are followed plainly. */
    unsigned int find_crossings(const Seen<1> &, const unsigned int *, double (&)[2][2])
    {
      return 0;
    }


    /** Places u at which a path crosses a straight edge. */
    unsigned int find_crossings(const Seen<2>      &seen,
                                const unsigned int *corners,
                                double (&coordinates)[2][2])
    {
      const double c0 = seen.across[0][corners[0]], c1 = seen.across[0][corners[1]];
      if (c0 == c1)
        return 0;
      coordinates[0][0] = c0 / (c0 - c1);
      return 1;
    }


    /** Places u, v at which a path crosses a bilinear face: its values across it are 0, 0 there. */
    unsigned int find_crossings(const Seen<3>      &seen,
                                const unsigned int *f,
                                double (&coordinates)[2][2])
    {
      const auto  &first = seen.across[0], &second = seen.across[1];
      const double a1 = first[f[0]], b1 = first[f[1]] - a1, g1 = first[f[2]] - a1,
                   d1 = (first[f[3]] - first[f[2]]) - b1;
      const double a2 = second[f[0]], b2 = second[f[1]] - a2, g2 = second[f[2]] - a2,
                   d2 = (second[f[3]] - second[f[2]]) - b2;
      double roots[2];
      // (a1 + b1 u) + v (g1 + d1 u) = 0 and the same with 2, v eliminated.
      const unsigned int n = find_roots(b2 * d1 - b1 * d2,
                                        a2 * d1 + b2 * g1 - a1 * d2 - b1 * g2,
                                        a2 * g1 - a1 * g2,
                                        roots);
      for (unsigned int k = 0; k < n; ++k)
        {
          const double u = roots[k], under1 = g1 + d1 * u, under2 = g2 + d2 * u;
          coordinates[k][0] = u;
          coordinates[k][1] = std::abs(under1) > std::abs(under2) ? -(a1 + b1 * u) / under1 :
                                                                    -(a2 + b2 * u) / under2;
        }
      return n;
    }


    /** Faces of a cell that the path may cross, as bits: not with all corners on one side of it. */
    template <int dim>
    unsigned int faces_to_cross(const Seen<dim> &seen, const double tolerance)
    {
      constexpr unsigned int n_corners = GeometryInfo<dim>::vertices_per_cell;
      unsigned int           faces     = 0;
      unsigned int           above[2], below[2]; // corners
      for (unsigned int d = 0; d + 1 < dim; ++d)
        {
          above[d] = below[d] = 0;
          for (unsigned int v = 0; v < n_corners; ++v)
            {
              above[d] |= static_cast<unsigned int>(seen.across[d][v] > tolerance) << v;
              below[d] |= static_cast<unsigned int>(seen.across[d][v] < -tolerance) << v;
            }
        }
      constexpr unsigned int corners_with[3][2] = {{0x55, 0xaa}, {0x33, 0xcc}, {0x0f, 0xf0}};
      constexpr unsigned int all                = (1u << n_corners) - 1;
      for (unsigned int face = 0; face < 2 * dim; ++face)
        {
          const unsigned int corners = corners_with[face / 2][face % 2] & all;
          bool               beside  = false;
          for (unsigned int d = 0; d + 1 < dim; ++d)
            beside |= (above[d] & corners) == corners || (below[d] & corners) == corners;
          faces |= static_cast<unsigned int>(!beside) << face;
        }
      return faces;
    }


    /** Shape functions of an edge or a face. */
    template <int dim>
    std::array<double, GeometryInfo<dim>::vertices_per_cell / 2> face_values(const double (&u)[2])
    {
      if constexpr (dim == 1)
        return {{1.}};
      else if constexpr (dim == 2)
        return {{1. - u[0], u[0]}};
      else
        return {{(1. - u[0]) * (1. - u[1]), u[0] * (1. - u[1]), (1. - u[0]) * u[1], u[0] * u[1]}};
    }
  } // namespace


  template <int dim>
  typename CellPaths<dim>::Step CellPaths<dim>::leave(const unsigned int cell,
                                                      const unsigned int entry,
                                                      const unsigned int outer,
                                                      const Line        &line,
                                                      const double       from,
                                                      Exit              &exit) const
  {
    const CellCorners<dim> &corners = cells[cell].corners;
    Seen<dim>               seen;
    for (unsigned int v = 0; v < n_corners; ++v)
      {
        const Tensor<1, dim> x = corners[v] - line.a;
        seen.along[v]          = x * line.along;
        for (unsigned int d = 0; d + 1 < dim; ++d)
          seen.across[d][v] = x * line.across[d];
      }
    // What counts as close to an edge, with some room.
    const double tolerance =
      (outer == none ? 20. * slack : 2. * flat) * (corners[n_corners - 1] - corners[0]).norm();
    Step         result = Step::stays;
    unsigned int faces  = faces_to_cross(seen, tolerance);
    if (entry != none)
      faces &= ~(1u << entry);
    if (outer != none)
      faces &= ~(1u << outer);
    for (unsigned int face = 0; face < n_faces; ++face)
      {
        if (!((faces >> face) & 1))
          continue;
        const unsigned int *const f = face_corners<dim>[face].data();
        double                    coordinates[2][2];
        const unsigned int        n = find_crossings(seen, f, coordinates);
        for (unsigned int k = 0; k < n; ++k)
          {
            int inside = 1;
            for (unsigned int d = 0; d + 1 < dim; ++d)
              {
                int side = side_of_edge(coordinates[k][d]);
                // A path within a side of the body crosses the edges there.
                if (outer != none && face / 2 != outer / 2 &&
                    d == outer / 2 - (outer > face ? 1 : 0) &&
                    std::abs(coordinates[k][d] - outer % 2) < flat)
                  side = 1;
                inside = side == 0 || inside == 0 ? 0 : std::min(inside, side);
              }
            if (inside == 0)
              continue;
            const auto weights = face_values<dim>(coordinates[k]);
            double     place   = 0.;
            for (unsigned int c = 0; c < n_face_corners; ++c)
              place += weights[c] * seen.along[f[c]];
            if (place < from + apart || place > 1. - apart)
              continue; // the start, the end, or beyond
            if (inside < 0 || result == Step::leaves)
              return Step::unclear;
            result = Step::leaves;
            exit   = {place, face, weights};
          }
      }
    return result;
  }


  template <int dim>
  void CellPaths<dim>::start_at(const End &a)
  {
    start = a.node;
    starts.clear();
    for (auto at = std::lower_bound(at_node.begin(), at_node.end(), std::make_pair(a.node, 0u));
         at != at_node.end() && at->first == a.node;
         ++at)
      {
        const unsigned int cell = at->second / n_corners, corner = at->second % n_corners;
        Tensor<2, dim>     inverse = invert(jacobian_at_corner<dim>(cells[cell].corners, corner));
        for (unsigned int d = 0; d < dim; ++d)
          if ((corner >> d) & 1)
            inverse[d] *= -1.;
        starts.push_back({cell, corner, inverse});
      }
  }


  /** The start of a path in a cell; @p outer is the outer face that the path lies in, if any. */
  template <int dim>
  const typename CellPaths<dim>::Start *CellPaths<dim>::start_into(const Tensor<1, dim> &along,
                                                                   unsigned int &outer) const
  {
    outer = none;
    for (const Start &candidate : starts)
      {
        const Tensor<1, dim> unit   = candidate.inverse * along;
        double               lowest = unit[0], highest = unit[0];
        for (unsigned int d = 1; d < dim; ++d)
          {
            lowest  = std::min(lowest, unit[d]);
            highest = std::max(highest, unit[d]);
          }
        if (lowest > steep * highest)
          return &candidate;
        if (!(regular && std::abs(lowest) < flat * highest))
          continue;
        unsigned int n_flat = 0, flat = 0; // directions, and the last of them
        for (unsigned int d = 0; d < dim; ++d)
          if (unit[d] < steep * highest)
            {
              ++n_flat;
              flat = d;
            }
        const unsigned int face = 2 * flat + ((candidate.corner >> flat) & 1);
        if (n_flat == 1 && beyond[numbers[candidate.cell] * n_faces + face] == none)
          {
            outer = face;
            return &candidate;
          }
      }
    return nullptr;
  }


  /** The outer face of the next cell that continues one of this cell; none if the side ends. */
  template <int dim>
  unsigned int CellPaths<dim>::outer_beyond(const unsigned int cell,
                                            const unsigned int outer,
                                            const unsigned int exit) const
  {
    const unsigned int other = beyond[numbers[cell] * n_faces + exit], next = other / n_faces,
                       entry = other % n_faces;
    for (unsigned int face = 0; face < n_faces; ++face)
      {
        bool continues = face / 2 != entry / 2 && beyond[numbers[next] * n_faces + face] == none;
        for (unsigned int v = 0; v < n_corners && continues; ++v)
          if (is_corner_of_face(v, outer) && is_corner_of_face(v, exit))
            for (unsigned int w = 0; w < n_corners; ++w)
              if (cells[next].nodes[w] == cells[cell].nodes[v] && !is_corner_of_face(w, face))
                continues = false;
        if (continues)
          return face;
      }
    return none;
  }


  template <int dim>
  bool CellPaths<dim>::follow_edge(const End &b, std::vector<Piece> &pieces) const
  {
    pieces.clear();
    for (const Start &at : starts)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int other = at.corner ^ (1u << d);
          if (cells[at.cell].nodes[other] != b.node)
            continue;
          pieces.push_back({at.cell, {}});
          pieces.back().change[at.corner] = -1.;
          pieces.back().change[other]     = 1.;
        }
    const double factor = 1. / std::sqrt(static_cast<double>(pieces.size()));
    for (Piece &piece : pieces)
      for (double &x : piece.change)
        x *= factor;
    return !pieces.empty();
  }


  template <int dim>
  bool CellPaths<dim>::walk(const End &a, const End &b, std::vector<Piece> &pieces) const
  {
    unsigned int outer;
    const Start *at = start_into(b.position - a.position, outer);
    if (at == nullptr)
      return regular && follow_edge(b, pieces);
    pieces.clear();
    const Line   line(a.position, b.position);
    unsigned int cell = at->cell, entry = none;
    double       from = 0.;
    Piece        piece{cell, {}};
    piece.change[at->corner] = -1.;
    for (;;)
      {
        Exit       exit{};
        const Step step = leave(cell, entry, outer, line, from, exit);
        if (step == Step::unclear)
          return false;
        const auto &nodes = cells[cell].nodes;
        if (step == Step::stays)
          {
            const auto end = std::find(nodes.begin(), nodes.end(), b.node);
            if (end == nodes.end())
              return false;
            piece.change[end - nodes.begin()] += 1.;
            exit.place = 1.;
          }
        else
          for (unsigned int k = 0; k < n_face_corners; ++k)
            piece.change[face_corners<dim>[exit.face][k]] += exit.weights[k];
        const double factor = 1. / std::sqrt(exit.place - from);
        for (double &x : piece.change)
          x *= factor;
        pieces.push_back(piece);
        if (step == Step::stays)
          return true;
        const unsigned int next = beyond[numbers[cell] * n_faces + exit.face];
        if (next == none)
          return false;
        if (outer != none && (outer = outer_beyond(cell, outer, exit.face)) == none)
          return false;
        piece = {next / n_faces, {}};
        entry = next % n_faces;
        // The same values of the shape functions, seen from the other cell.
        for (unsigned int k = 0; k < n_face_corners; ++k)
          {
            const unsigned int corner = face_corners<dim>[entry][k];
            for (unsigned int l = 0; l < n_face_corners; ++l)
              if (cells[piece.cell].nodes[corner] == nodes[face_corners<dim>[exit.face][l]])
                piece.change[corner] = -exit.weights[l];
          }
        cell = piece.cell;
        from = exit.place;
      }
  }


  template <int dim>
  void CellPaths<dim>::connect(const std::vector<unsigned int> &near)
  {
    using FaceNodes = std::array<types::global_dof_index, n_face_corners>;
    std::vector<std::pair<FaceNodes, unsigned int>> faces;
    faces.reserve(near.size() * n_faces);
    at_node.reserve(near.size() * n_corners);
    numbers.assign(cells.size(), none);
    beyond.assign(near.size() * n_faces, none);
    for (unsigned int k = 0; k < near.size(); ++k)
      {
        const unsigned int c     = near[k];
        const auto        &nodes = cells[c].nodes;
        numbers[c]               = k;
        for (unsigned int v = 0; v < n_corners; ++v)
          at_node.emplace_back(nodes[v], c * n_corners + v);
        for (unsigned int face = 0; face < n_faces; ++face)
          {
            FaceNodes list;
            for (unsigned int v = 0; v < n_face_corners; ++v)
              list[v] = nodes[face_corners<dim>[face][v]];
            std::sort(list.begin(), list.end());
            faces.emplace_back(list, c * n_faces + face);
          }
      }
    std::sort(at_node.begin(), at_node.end());
    std::sort(faces.begin(), faces.end());
    for (std::size_t k = 0; k + 1 < faces.size(); ++k)
      if (faces[k].first == faces[k + 1].first)
        {
          const unsigned int one = faces[k].second, other = faces[k + 1].second;
          beyond[numbers[one / n_faces] * n_faces + one % n_faces]     = other;
          beyond[numbers[other / n_faces] * n_faces + other % n_faces] = one;
        }
  }


  template <int dim>
  bool CellPaths<dim>::follow(const End &a, const End &b, std::vector<Piece> &pieces)
  {
    // At a node doubled by a crack the crack points tell on which side the path runs.
    if constexpr (dim > 1)
      if (a.position == a.crack_point && b.position == b.crack_point)
        {
          if (a.node != start)
            start_at(a);
          if (walk(a, b, pieces))
            return true;
        }
    ++n_plain;
    return follow_plainly(a, b, pieces);
  }


  PERIDEAL_INSTANTIATE_CLASS(class CellPaths);
} // namespace PeriDeal
