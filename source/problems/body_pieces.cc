// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "body_pieces.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/base/connected_sets.h>
#include <perideal/base/gathered_lists.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    using Corners = std::array<Point<dim>, GeometryInfo<dim>::vertices_per_cell>;


    /** Whether p is in the cell with these corners: Newton's method for its unit coordinates. */
    template <int dim>
    bool is_in_cell(const Corners<dim> &corners, const Point<dim> &p)
    {
      constexpr unsigned int most  = 20;
      constexpr double       slack = 1e-10, far = 4.;
      Point<dim>             unit;
      for (unsigned int d = 0; d < dim; ++d)
        unit[d] = 0.5;
      for (unsigned int n = 0; n < most; ++n)
        {
          Tensor<1, dim> left = p - Point<dim>();
          Tensor<2, dim> slope;
          for (unsigned int v = 0; v < corners.size(); ++v)
            {
              left -=
                GeometryInfo<dim>::d_linear_shape_function(unit, v) * (corners[v] - Point<dim>());
              slope += outer_product(corners[v] - Point<dim>(),
                                     GeometryInfo<dim>::d_linear_shape_function_gradient(unit, v));
            }
          if (determinant(slope) == 0.)
            return false;
          const Tensor<1, dim> change = invert(slope) * left;
          unit += change;
          if (unit.norm() > far)
            return false;
          if (change.norm() < slack)
            break;
        }
      return GeometryInfo<dim>::is_inside_unit_cell(unit, slack);
    }


    /** How far p is from a face, which is taken for a disc in space. */
    template <int dim>
    double distance_from_face(const Corners<dim> &corners,
                              const unsigned int  f,
                              const Point<dim>   &p)
    {
      constexpr unsigned int    n = GeometryInfo<dim>::vertices_per_face;
      std::array<Point<dim>, n> at;
      Point<dim>                middle;
      for (unsigned int v = 0; v < n; ++v)
        {
          at[v] = corners[GeometryInfo<dim>::face_to_cell_vertices(f, v)];
          middle += (at[v] - Point<dim>()) / n;
        }
      const Tensor<1, dim> way = p - middle;
      if constexpr (dim == 1)
        return way.norm();
      else
        {
          Tensor<1, dim> normal;
          if constexpr (dim == 2)
            normal = cross_product_2d(at[1] - at[0]);
          else
            normal = cross_product_3d(at[3] - at[0], at[2] - at[1]);
          if (normal.norm() == 0.)
            return way.norm();
          const double across = way * normal / normal.norm();
          double       radius = 0.;
          for (const Point<dim> &corner : at)
            radius = std::max(radius, corner.distance(middle));
          const double along = std::sqrt(std::max(0., way.norm_square() - across * across));
          return std::hypot(across, std::max(0., along - radius));
        }
    }
  } // namespace


  /** Displacements of corners of cells. */
  template <int dim>
  struct BodyPieces<dim>::Displacement
  {
    explicit Displacement(const SolidProblem<dim> &run)
      : at_corners(run.dofs().get_fe().n_dofs_per_vertex() > 0)
      , unknowns(run.dofs().get_fe().n_dofs_per_cell())
    {
      for (unsigned int d = 0; d < dim; ++d)
        components.push_back(component_of(run.dofs(), run.displacement, dim, d));
    }

    Corners<dim> corners(const Cell &cell) const
    {
      cell->get_dof_indices(unknowns);
      Corners<dim> result;
      for (unsigned int v = 0; v < result.size(); ++v)
        {
          result[v] = cell->vertex(v);
          for (unsigned int d = 0; d < dim; ++d)
            result[v][d] += components[d](unknowns[at_corners ? v : 0]);
        }
      return result;
    }

    const bool                                   at_corners;
    mutable std::vector<types::global_dof_index> unknowns;
    std::vector<Vector>                          components;
  };


  template <int dim>
  BodyPieces<dim>::BodyPieces(const SolidProblem<dim> &run)
    : run(run)
  {
    // Coarse cells are known to all processes.
    const Triangulation<dim> &mesh = run.dofs().get_triangulation();
    ConnectedSets             vertices(mesh.n_vertices());
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      for (const unsigned int v : cell->vertex_indices())
        vertices.join(cell->vertex_index(0), cell->vertex_index(v));
    if (run.scene.cracks.on_faces()) // nodes there are doubled
      {
        const auto is_before = [](const Point<dim> &a, const Point<dim> &b) {
          for (unsigned int d = 0; d < dim; ++d)
            if (a[d] != b[d])
              return a[d] < b[d];
          return false;
        };
        std::map<Point<dim>, unsigned int, decltype(is_before)> places(is_before);
        for (const auto &cell : mesh.cell_iterators_on_level(0))
          for (const unsigned int v : cell->vertex_indices())
            vertices.join(places.emplace(cell->vertex(v), cell->vertex_index(v)).first->second,
                          cell->vertex_index(v));
      }
    std::map<unsigned int, unsigned int> numbers;
    std::vector<double>                  volumes;
    of_coarse.resize(mesh.n_cells(0));
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      {
        const unsigned int root  = vertices.root(cell->vertex_index(0));
        const unsigned int piece = numbers.emplace(root, numbers.size()).first->second;
        of_coarse[cell->index()] = piece;
        volumes.resize(numbers.size());
        middles.resize(numbers.size());
        volumes[piece] += cell->measure();
        middles[piece] += cell->measure() * (cell->center() - Point<dim>());
      }
    n_pieces = numbers.size();
    for (unsigned int piece = 0; piece < n_pieces; ++piece)
      middles[piece] /= volumes[piece];
  }


  template <int dim>
  unsigned int BodyPieces<dim>::piece_of(const Cell &cell) const
  {
    typename Triangulation<dim>::cell_iterator coarse = cell;
    while (coarse->level() > 0)
      coarse = coarse->parent();
    return of_coarse[coarse->index()];
  }


  template <int dim>
  template <typename Visit>
  void BodyPieces<dim>::for_each_own_cell(const Visit &visit) const
  {
    for (const auto &cell : run.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        visit(cell);
  }


  template <int dim>
  std::vector<typename BodyPieces<dim>::Box> BodyPieces<dim>::boxes(const Displacement &u) const
  {
    // The highest of each coordinate and of minus it.
    std::vector<double> ends(2 * dim * n_pieces, std::numeric_limits<double>::lowest());
    for_each_own_cell([&](const Cell &cell) {
      double *const of_piece = &ends[2 * dim * piece_of(cell)];
      for (const Point<dim> &corner : u.corners(cell))
        for (unsigned int d = 0; d < dim; ++d)
          {
            of_piece[2 * d]     = std::max(of_piece[2 * d], corner[d]);
            of_piece[2 * d + 1] = std::max(of_piece[2 * d + 1], -corner[d]);
          }
    });
    Utilities::MPI::max(ends, run.dofs().get_communicator(), ends);
    std::vector<Box> result;
    for (unsigned int piece = 0; piece < n_pieces; ++piece)
      {
        Point<dim> lower, upper;
        for (unsigned int d = 0; d < dim; ++d)
          {
            upper[d] = ends[2 * (dim * piece + d)];
            lower[d] = -ends[2 * (dim * piece + d) + 1];
          }
        result.emplace_back(std::make_pair(lower, upper));
      }
    return result;
  }


  template <int dim>
  std::vector<typename BodyPieces<dim>::Corner> BodyPieces<dim>::corners_near(
    const Displacement     &u,
    const std::vector<Box> &boxes) const
  {
    std::vector<double> own;
    for_each_own_cell([&](const Cell &cell) {
      if (!cell->at_boundary())
        return;
      const unsigned int piece   = piece_of(cell);
      const Corners<dim> corners = u.corners(cell);
      for (unsigned int v = 0; v < corners.size(); ++v)
        {
          bool is_near = false;
          for (unsigned int other = 0; other < n_pieces && !is_near; ++other)
            is_near = other != piece && boxes[other].point_inside(corners[v]);
          if (!is_near)
            continue;
          own.push_back(piece);
          for (unsigned int d = 0; d < dim; ++d)
            own.insert(own.end(), {cell->vertex(v)[d], corners[v][d]});
        }
    });
    return corners_of_all(own);
  }


  template <int dim>
  std::vector<typename BodyPieces<dim>::Corner> BodyPieces<dim>::corners_of_all(
    const std::vector<double> &own) const
  {
    std::vector<Corner> list;
    for (const std::vector<double> &some : gathered_lists(run.dofs().get_communicator(), own))
      for (auto from = some.begin(); from != some.end();)
        {
          Corner corner;
          corner.piece = static_cast<unsigned int>(*from++);
          for (unsigned int d = 0; d < dim; ++d)
            {
              corner.at[d]  = *from++;
              corner.now[d] = *from++;
            }
          list.push_back(corner);
        }
    return list;
  }


  template <int dim>
  std::vector<std::pair<unsigned int, typename BodyPieces<dim>::Corner>> BodyPieces<dim>::inside(
    const Displacement        &u,
    const std::vector<Corner> &corners,
    const double               slack) const
  {
    std::vector<std::pair<Point<dim>, unsigned int>> entries;
    for (unsigned int k = 0; k < corners.size(); ++k)
      entries.emplace_back(corners[k].now, k);
    const auto          tree = pack_rtree(entries);
    std::vector<double> own; // the piece that a corner is in, and the corner
    for_each_own_cell([&](const Cell &cell) {
      const unsigned int piece = piece_of(cell);
      const Corners<dim> now   = u.corners(cell);
      const Box          box(std::vector<Point<dim>>(now.begin(), now.end()));
      const auto         is_at_surface = [&](const Point<dim> &p) {
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() && distance_from_face<dim>(now, f, p) <= slack)
            return true;
        return false;
      };
      for (auto entry = tree.qbegin(boost::geometry::index::intersects(box)); entry != tree.qend();
           ++entry)
        {
          const Corner &corner = corners[entry->second];
          if (corner.piece == piece || is_at_surface(corner.now) || !is_in_cell(now, corner.now))
            continue;
          own.insert(own.end(), {1. * piece, 1. * entry->second});
        }
    });
    std::vector<std::pair<unsigned int, Corner>> result;
    for (const std::vector<double> &some : gathered_lists(run.dofs().get_communicator(), own))
      for (std::size_t k = 0; k < some.size(); k += 2)
        result.emplace_back(static_cast<unsigned int>(some[k]),
                            corners[static_cast<unsigned int>(some[k + 1])]);
    return result;
  }


  template <int dim>
  typename BodyPieces<dim>::Overlap BodyPieces<dim>::deepest(const Displacement &u) const
  {
    const MPI_Comm all = run.dofs().get_communicator();
    // Displacements are found to the tolerance of a solver; cells that move as they are overlap by
    // what they should have been strained.
    constexpr double       of_displacement = 1e-6, of_places = 1e-12, nearly = 1e-3;
    double                 largest = 0., farthest = 0., uneven = 0.;
    const std::vector<Box> of_pieces = boxes(u);
    for (const Box &box : of_pieces)
      for (const Point<dim> &end :
           {box.get_boundary_points().first, box.get_boundary_points().second})
        farthest = std::max(farthest, end.norm());
    largest = run.displacement.linfty_norm();
    if (!u.at_corners)
      for_each_own_cell([&](const Cell &cell) {
        for (const unsigned int f : cell->face_indices())
          if (!cell->face(f)->at_boundary() && cell->neighbor(f)->is_active() &&
              !cell->neighbor(f)->is_artificial())
            {
              const Cell neighbor(cell->neighbor(f));
              uneven = std::max(uneven,
                                ((u.corners(cell)[0] - cell->vertex(0)) -
                                 (u.corners(neighbor)[0] - neighbor->vertex(0)))
                                  .norm());
            }
      });
    const double slack =
      of_displacement * largest + of_places * farthest + Utilities::MPI::max(uneven, all);

    const auto          candidates = inside(u, corners_near(u, of_pieces), slack);
    std::vector<double> depths(candidates.size(), std::numeric_limits<double>::max());
    if (candidates.empty())
      return {};
    for_each_own_cell([&](const Cell &cell) {
      if (!cell->at_boundary())
        return;
      const unsigned int piece = piece_of(cell);
      const Corners<dim> now   = u.corners(cell);
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary())
          for (std::size_t k = 0; k < candidates.size(); ++k)
            if (candidates[k].first == piece)
              depths[k] =
                std::min(depths[k], distance_from_face<dim>(now, f, candidates[k].second.now));
    });
    Utilities::MPI::min(depths, all, depths);
    const double most = *std::max_element(depths.begin(), depths.end());
    if (most <= slack)
      return {};
    // Of many that are as deep the same one on any number of processes.
    const auto is_before = [&](const std::size_t a, const std::size_t b) {
      const Point<dim> &p = candidates[a].second.at, &q = candidates[b].second.at;
      for (unsigned int d = 0; d < dim; ++d)
        if (p[d] != q[d])
          return p[d] < q[d];
      return false;
    };
    std::size_t first = candidates.size();
    for (std::size_t k = 0; k < candidates.size(); ++k)
      if (depths[k] > (1. - nearly) * most && (first == candidates.size() || is_before(k, first)))
        first = k;
    return {depths[first], candidates[first].second, candidates[first].first};
  }


  template <int dim>
  std::string BodyPieces<dim>::text(const Overlap &deep, const double t) const
  {
    std::ostringstream message;
    if (!run.scene.time.steady)
      message << " at t = " << t;
    message << ": the one about " << place_text(middles[deep.corner.piece]) << ", with its corner "
            << place_text(deep.corner.at) << " displaced to " << place_text(deep.corner.now)
            << ", is " << rounded_text(deep.depth) << " deep in the one about "
            << place_text(middles[deep.other]) << ". No cells join them, and ";
    return message.str();
  }


  template <int dim>
  std::string BodyPieces<dim>::overlap(const double t, const std::string &start) const
  {
    const Overlap deep = n_pieces < 2 ? Overlap() : deepest(Displacement(run));
    if (deep.depth == 0.)
      return "";
    if (run.stepper)
      return text(deep, t) +
             "nothing is between them here: they pass through each other. With 'Models = peridynamics', 'Kinematics = full' and 'Contact = true' in section 'Elasticity' and 'Stepper = verlet' in section 'Time' they press on each other.";
    const std::string at_rest = "at rest separate pieces do not press on each other; ";
    AssertThrow(
      run.scene.elasticity.text("Contact") == "false",
      UserError(
        start + text(deep, t) + at_rest +
        "in motion they do, by 'Models = peridynamics' with 'Solver = dynamics' and 'Kinematics = full' in section 'Elasticity'. Use that, load them so that they do not meet (with 'Kinematics = linear' all results go with the load, so that a small one will do), join them by cells, "
        "or let them pass through each other: 'Contact = false' in section 'Elasticity', which holds for the faces of cracks, too."));
    return text(deep, t) + at_rest +
           "'Contact = false' in section 'Elasticity' lets them pass through each other.";
  }


  template class BodyPieces<1>;
  template class BodyPieces<2>;
  template class BodyPieces<3>;
} // namespace PeriDeal
