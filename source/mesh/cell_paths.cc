// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Paths in general: cut at all faces nearby, then each piece looked for in all cells.

#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/mesh/cell_paths.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
  std::size_t CellPaths<dim>::n_followed_plainly() const
  {
    return n_plain;
  }


  template <int dim>
  std::size_t CellPaths<dim>::memory_consumption() const
  {
    return numbers.capacity() * sizeof(unsigned int) + beyond.capacity() * sizeof(unsigned int) +
           at_node.capacity() * sizeof(at_node[0]) +
           tree->entries.size() * sizeof(typename Tree::Entry);
  }


  template class CellPaths<1>;
  template class CellPaths<2>;
  template class CellPaths<3>;
} // namespace PeriDeal
