// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_tools.h>

#include <perideal/analysis/point_evaluator.h>
#include <perideal/base/gathered_lists.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/cell_search.h>
#include <perideal/scene/crack_geometry.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <unordered_map>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What a node counts in the value at a point, and in the gradient there. */
    template <int dim>
    struct Share
    {
      dealii::types::global_dof_index dof;
      double                          weight;
      dealii::Tensor<1, dim>          slope;
    };


    /** So many nodes, at most, make a value on one side of a crack. */
    template <int dim>
    constexpr unsigned int most_shares = 3 * (dim + 1);


    /** Whether a crack lies between two points. */
    template <int dim>
    bool parted(const std::vector<CrackGeometry<dim>> &cracks,
                const Point<dim>                      &a,
                const Point<dim>                      &b)
    {
      return std::any_of(cracks.begin(), cracks.end(), [&](const CrackGeometry<dim> &crack) {
        return crack.separates(a, b);
      });
    }


    /** The nodes of the cells around a point that no crack parts from it, the nearest first. */
    template <int dim>
    std::vector<std::pair<types::global_dof_index, Point<dim>>> nodes_on_own_side(
      const CellSearch<dim>                 &search,
      const typename CellSearch<dim>::Cell  &cell_of_point,
      const Point<dim>                      &point,
      const std::vector<CrackGeometry<dim>> &cracks)
    {
      std::vector<typename CellSearch<dim>::Cell> cells;
      const double                                size = cell_of_point->minimum_vertex_distance();
      search.find({cell_of_point->bounding_box()}, 0.6 * size, cells);
      std::map<types::global_dof_index, Point<dim>> found;
      std::vector<types::global_dof_index> indices(cell_of_point->get_fe().n_dofs_per_cell());
      for (const auto &cell : cells)
        {
          cell->get_dof_indices(indices);
          for (const unsigned int v : cell->vertex_indices())
            if (!parted(cracks, point, cell->vertex(v)))
              found.emplace(indices[v], cell->vertex(v));
        }
      std::vector<std::pair<types::global_dof_index, Point<dim>>> nodes(found.begin(), found.end());
      // Of equally near ones the first in space, so that it does not matter who counts them.
      const double slack = 1e-9 * size * size;
      std::sort(nodes.begin(), nodes.end(), [&](const auto &a, const auto &b) {
        const double difference = a.second.distance_square(point) - b.second.distance_square(point);
        if (std::abs(difference) > slack)
          return difference < 0.;
        for (unsigned int d = 0; d < dim; ++d)
          if (a.second[d] != b.second[d])
            return a.second[d] < b.second[d];
        return false;
      });
      nodes.resize(std::min<std::size_t>(nodes.size(), most_shares<dim>));
      return nodes;
    }


    /**
     * The linear function that fits the nodes best, each by the inverse square of its distance; the
     * nearest one alone where they do not make a linear function.
     */
    template <int dim>
    std::vector<Share<dim>> fit_linear(
      const std::vector<std::pair<types::global_dof_index, Point<dim>>> &nodes,
      const Point<dim>                                                  &point)
    {
      if (nodes.empty())
        return {};
      double scale = 0.;
      for (const auto &node : nodes)
        scale = std::max(scale, node.second.distance(point));
      using Row      = Eigen::Matrix<double, dim + 1, 1>;
      using Square   = Eigen::Matrix<double, dim + 1, dim + 1>;
      const auto row = [&](const Point<dim> &p) {
        Row a;
        a[0] = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          a[d + 1] = (p[d] - point[d]) / scale;
        return a;
      };
      const auto weight = [&](const Point<dim> &p) {
        return 1. / (0.05 + p.distance_square(point) / (scale * scale));
      };
      Square normal = Square::Zero();
      for (const auto &node : nodes)
        normal += weight(node.second) * row(node.second) * row(node.second).transpose();
      Eigen::FullPivLU<Square> solver(normal);
      solver.setThreshold(1e-6);
      if (!solver.isInvertible())
        return {{nodes[0].first, 1., {}}};
      const Square            inverse = solver.inverse();
      std::vector<Share<dim>> shares;
      for (const auto &node : nodes)
        {
          const Row      all = weight(node.second) * (inverse * row(node.second));
          Tensor<1, dim> slope;
          for (unsigned int d = 0; d < dim; ++d)
            slope[d] = all[d + 1] / scale;
          shares.push_back({node.first, all[0], slope});
        }
      return shares;
    }


    /**
     * What is read at a point beside a crack: the linear function that fits the nearest nodes of
     * the cells around, those that no crack parts from the point, each by about the inverse square
     * of its distance. The nearest one alone where they do not make a linear function; nothing
     * where there is none. Not collective.
     *
     * @param cell that holds the point
     */
    template <int dim>
    std::vector<Share<dim>> fit_own_side(const CellSearch<dim>                 &search,
                                         const typename CellSearch<dim>::Cell  &cell,
                                         const Point<dim>                      &point,
                                         const std::vector<CrackGeometry<dim>> &cracks)
    {
      return fit_linear(nodes_on_own_side(search, cell, point, cracks), point);
    }


    /** The way to the left of the cracks that a point lies on, or nothing. */
    template <int dim>
    Tensor<1, dim> off_cracks(const Point<dim> &p, const std::vector<CrackGeometry<dim>> &cracks)
    {
      Tensor<1, dim> way;
      for (const CrackGeometry<dim> &crack : cracks)
        if (crack.contains(p))
          way += crack.normal();
      return way;
    }


    /** A cell and a point of its unit cell. */
    template <int dim>
    using Place = std::pair<typename DoFHandler<dim>::active_cell_iterator, Point<dim>>;


    /** In coordinates of the unit cell; of a parallelepiped at once, which most cells are. */
    template <int dim>
    Point<dim> to_unit_cell(const MappingQ1<dim>                 &mapping,
                            const typename CellSearch<dim>::Cell &cell,
                            const Point<dim>                     &point)
    {
      constexpr double slack = 1e-12; // of its size
      Tensor<2, dim>   edges;
      const Point<dim> first = cell->vertex(0);
      double           size = 0., askew = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const Tensor<1, dim> edge = cell->vertex(1u << d) - first;
          size += edge.norm();
          for (unsigned int c = 0; c < dim; ++c)
            edges[c][d] = edge[c];
        }
      for (const unsigned int v : cell->vertex_indices())
        {
          Tensor<1, dim> corner;
          for (unsigned int d = 0; d < dim; ++d)
            corner[d] = (v >> d) & 1;
          askew += (first + edges * corner - cell->vertex(v)).norm();
        }
      return askew < slack * size ? Point<dim>(invert(edges) * (point - first)) :
                                    mapping.transform_real_to_unit_cell(cell, point);
    }


    /**
     * The first of this process's cells that hold the point and whose centre lies the given way, if
     * any: the cells on both sides of a crack on faces hold what lies on it. Returns 0; 1 if there
     * are only others that hold it, of which the first is taken; infinity if there is none.
     */
    template <int dim>
    double find_place(const CellSearch<dim> &search,
                      const Point<dim>      &point,
                      const Tensor<1, dim>  &way,
                      Place<dim>            &place)
    {
      constexpr double                            slack = 1e-8;
      double                                      least = std::numeric_limits<double>::infinity();
      const MappingQ1<dim>                        mapping;
      std::vector<typename CellSearch<dim>::Cell> near;
      const std::vector<BoundingBox<dim>>         box{{{point, point}}};
      search.find(box, slack * search.largest_diameter(), near);
      for (const auto &cell : near)
        if (cell->is_locally_owned())
          try
            {
              const Point<dim> unit = to_unit_cell(mapping, cell, point);
              const double     rank = way * (cell->center() - point) < 0. ? 1. : 0.;
              if (GeometryInfo<dim>::is_inside_unit_cell(unit, slack) && rank < least)
                {
                  place = {cell, unit};
                  least = rank;
                }
            }
          catch (const typename Mapping<dim>::ExcTransformationFailed &)
            {}
      return least;
    }
  } // namespace


  namespace
  {
    /** Whether a crack parts the point from a vertex of its cell. */
    template <int dim>
    bool is_beside_crack(const Place<dim>                      &place,
                         const Point<dim>                      &point,
                         const std::vector<CrackGeometry<dim>> &cracks)
    {
      for (const unsigned int v : place.first->vertex_indices())
        if (parted(cracks, point, place.first->vertex(v)))
          return true;
      return false;
    }


    /**
     * By the shape functions of the cell, mapped multilinearly: as FEValues does it, which is made
     * for many points of many cells and takes longer to set up than one point does.
     */
    template <int dim>
    std::vector<Share<dim>> interpolant(const Place<dim> &place)
    {
      const FiniteElement<dim>            &fe = place.first->get_fe();
      std::vector<types::global_dof_index> indices(fe.n_dofs_per_cell());
      place.first->get_dof_indices(indices);
      Tensor<2, dim> jacobian;
      for (const unsigned int v : place.first->vertex_indices())
        jacobian +=
          outer_product(Tensor<1, dim>(place.first->vertex(v)),
                        GeometryInfo<dim>::d_linear_shape_function_gradient(place.second, v));
      const Tensor<2, dim>    inverse = invert(jacobian);
      std::vector<Share<dim>> shares;
      for (unsigned int v = 0; v < indices.size(); ++v)
        shares.push_back(
          {indices[v], fe.shape_value(v, place.second), fe.shape_grad(v, place.second) * inverse});
      return shares;
    }
  } // namespace


  template <int dim>
  PointEvaluator<dim>::PointEvaluator(const DoFHandler<dim>                  &dofs,
                                      const Nodes<dim>                       *nodes,
                                      const Cracks<dim>                      &cracks,
                                      const std::vector<std::vector<double>> &coordinates,
                                      const std::string                      &entry,
                                      const Outside                           outside,
                                      const BesideCracks                      beside)
    : communicator(dofs.get_communicator())
    , n_points(static_cast<unsigned int>(coordinates.size()))
    , n_slots(1u << dim)
  {
    const std::vector<CrackGeometry<dim>> geometries =
      make_crack_geometries(cracks.pieces(cracks.end_time));
    const bool   at_centers = dofs.get_fe().n_dofs_per_vertex() == 0;
    const bool   on_lattice = nodes != nullptr && nodes->lattice() && !nodes->has_doubled_nodes();
    const double shift      = at_centers || cracks.on_faces() ?
                                1e-7 * GridTools::minimal_cell_diameter(dofs.get_triangulation()) :
                                0.;
    std::vector<Point<dim>>     points(n_points);
    std::vector<Tensor<1, dim>> ways(n_points);
    for (unsigned int k = 0; k < n_points; ++k)
      {
        for (unsigned int d = 0; d < dim; ++d)
          points[k][d] = coordinates[k][d];
        if (shift > 0.)
          ways[k] = off_cracks(points[k], geometries);
        points[k] += shift * ways[k];
      }
    inner                   = points;
    const bool across_cells = beside == BesideCracks::own_side && !at_centers &&
                              !cracks.on_faces() && !geometries.empty();
    if (on_lattice && !across_cells)
      locate_on_lattice(*nodes, points);
    else if (at_centers && nodes != nullptr)
      locate_nearest(dofs, *nodes, points);
    else
      locate_in_mesh(dofs,
                     points,
                     ways,
                     across_cells ? geometries : std::vector<CrackGeometry<dim>>());
    find_gaps(coordinates, entry, outside);
  }


  template <int dim>
  void PointEvaluator<dim>::locate_on_lattice(const Nodes<dim>              &nodes,
                                              const std::vector<Point<dim>> &points)
  {
    const Lattice<dim> &lattice = *nodes.lattice();
    const auto          key     = [&](const typename Lattice<dim>::Index &site) {
      std::size_t k = 0;
      for (unsigned int d = dim; d-- > 0;)
        k = k * (lattice.n_sites[d] + 1) + site[d];
      return k;
    };
    std::unordered_map<std::size_t, std::vector<std::pair<unsigned int, double>>> wanted;
    for (unsigned int k = 0; k < points.size(); ++k)
      {
        typename Lattice<dim>::Index base;
        std::array<double, dim>      fraction;
        bool                         inside = true;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double s = (points[k][d] - lattice.lower[d]) / lattice.spacing[d];
            if (lattice.at_centers)
              {
                // The nearest node; of two equally near ones the first in space.
                inside = inside && s > -1e-9 && s < lattice.n_sites[d] + 1e-9;
                base[d] =
                  std::clamp(static_cast<int>(std::ceil(s - 1e-9)) - 1, 0, lattice.n_sites[d] - 1);
                fraction[d] = 0.;
                continue;
              }
            base[d]     = static_cast<int>(std::floor(s + 1e-9));
            fraction[d] = s - base[d] < 1e-9 ? 0. : s - base[d];
            inside      = inside && base[d] >= 0 && base[d] < lattice.n_sites[d];
          }
        for (unsigned int v = 0; v < n_slots && inside; ++v)
          {
            typename Lattice<dim>::Index site   = base;
            double                       weight = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              {
                site[d] += (v >> d) & 1;
                weight *= ((v >> d) & 1) ? fraction[d] : 1. - fraction[d];
              }
            if (weight > 0.)
              wanted[key(site)].emplace_back(k * n_slots + v, weight);
          }
      }
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (const auto found = wanted.find(key(lattice.index(nodes.position(i))));
          found != wanted.end())
        for (const auto &[slot, weight] : found->second)
          parts.push_back({slot, i, weight, {}});
  }


  template <int dim>
  void PointEvaluator<dim>::locate_nearest(const DoFHandler<dim>         &dofs,
                                           const Nodes<dim>              &nodes,
                                           const std::vector<Point<dim>> &points)
  {
    // Every point has a nearest node, but not every point is in the body.
    const CellSearch<dim>     search(dofs);
    std::vector<unsigned int> here(points.size(), 0), in_body(points.size());
    Place<dim>                place;
    for (unsigned int k = 0; k < points.size(); ++k)
      here[k] = std::isfinite(find_place(search, points[k], Tensor<1, dim>(), place)) ? 1 : 0;
    Utilities::MPI::max(here, communicator, in_body);
    // Ties go to the node that comes first in space, so that the answer does not depend on the
    // partition.
    const auto before = [](const Point<dim> &a, const Point<dim> &b) {
      for (unsigned int d = dim; d-- > 0;)
        if (a[d] != b[d])
          return a[d] < b[d];
      return false;
    };
    std::vector<double>       own(points.size(), std::numeric_limits<double>::max());
    std::vector<unsigned int> nearest(points.size(), numbers::invalid_unsigned_int);
    const double              slack = 1e-9 * nodes.smallest_spacing() * nodes.smallest_spacing();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      for (unsigned int k = 0; k < points.size(); ++k)
        {
          const double square = nodes.position(i).distance_square(points[k]);
          if (square < own[k] - slack ||
              (square < own[k] + slack && before(nodes.position(i), nodes.position(nearest[k]))))
            {
              own[k]     = std::min(square, own[k]);
              nearest[k] = i;
            }
        }
    std::vector<double> best(own.size());
    Utilities::MPI::min(own, communicator, best);
    for (unsigned int k = 0; k < points.size(); ++k)
      {
        // Among processes with equally near nodes the one with the first position wins.
        const bool candidate = nearest[k] != numbers::invalid_unsigned_int &&
                               own[k] <= best[k] + slack;
        Point<dim> first;
        for (unsigned int d = 0; d < dim; ++d)
          first[d] = candidate ? nodes.position(nearest[k])[d] : std::numeric_limits<double>::max();
        bool mine = candidate;
        for (unsigned int d = dim; d-- > 0;)
          {
            const double lowest =
              Utilities::MPI::min(mine ? first[d] : std::numeric_limits<double>::max(),
                                  communicator);
            mine = mine && first[d] == lowest;
          }
        if (mine && in_body[k] > 0)
          parts.push_back({k * n_slots, nearest[k], 1., {}});
      }
  }


  template <int dim>
  void PointEvaluator<dim>::locate_in_mesh(const DoFHandler<dim>                 &dofs,
                                           const std::vector<Point<dim>>         &points,
                                           const std::vector<Tensor<1, dim>>     &ways,
                                           const std::vector<CrackGeometry<dim>> &cracks)
  {
    const unsigned int        me     = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int        nobody = Utilities::MPI::n_mpi_processes(communicator);
    const CellSearch<dim>     search(dofs);
    std::vector<unsigned int> finder(points.size(), nobody), first(points.size());
    std::vector<Place<dim>>   places(points.size());
    std::vector<double>       rank(points.size()), least(points.size());
    for (unsigned int k = 0; k < points.size(); ++k)
      rank[k] = find_place(search, points[k], ways[k], places[k]);
    Utilities::MPI::min(rank, communicator, least);
    for (unsigned int k = 0; k < points.size(); ++k)
      if (std::isfinite(rank[k]) && rank[k] == least[k])
        finder[k] = me;
    Utilities::MPI::min(finder, communicator, first);
    n_slots = std::max(dofs.get_fe().n_dofs_per_cell(), cracks.empty() ? 0 : most_shares<dim>);
    std::vector<double>         own; // slot, dof, weight, slope, slot, ...
    std::vector<Tensor<1, dim>> moved(points.size());
    for (unsigned int k = 0; k < points.size(); ++k)
      if (first[k] == me)
        {
          moved[k] = 1e-6 * (places[k].first->center() - points[k]);
          std::vector<Share<dim>> shares;
          if (is_beside_crack(places[k], points[k], cracks))
            shares = fit_own_side<dim>(search, places[k].first, points[k], cracks);
          if (shares.empty())
            shares = interpolant(places[k]);
          for (unsigned int v = 0; v < shares.size(); ++v)
            {
              own.insert(own.end(),
                         {static_cast<double>(k * n_slots + v),
                          static_cast<double>(shares[v].dof),
                          shares[v].weight});
              for (unsigned int d = 0; d < dim; ++d)
                own.push_back(shares[v].slope[d]);
            }
        }
    for (unsigned int k = 0; k < points.size(); ++k)
      inner[k] += Utilities::MPI::sum(moved[k], communicator);
    // Each part goes to the owner of its dof: what ghosts a vector has, and in which order, depends
    // on the model.
    const IndexSet &owned = dofs.locally_owned_dofs();
    for (const std::vector<double> &list : gathered_lists(communicator, own))
      for (std::size_t i = 0; i < list.size(); i += 3 + dim)
        {
          const auto dof = static_cast<types::global_dof_index>(list[i + 1]);
          if (!owned.is_element(dof))
            continue;
          parts.push_back({static_cast<unsigned int>(list[i]),
                           static_cast<unsigned int>(owned.index_within_set(dof)),
                           list[i + 2],
                           {}});
          for (unsigned int d = 0; d < dim; ++d)
            parts.back().slope[d] = list[i + 3 + d];
        }
  }


  template <int dim>
  void PointEvaluator<dim>::find_gaps(const std::vector<std::vector<double>> &points,
                                      const std::string                      &entry,
                                      const Outside                           outside)
  {
    std::vector<double> weights(n_points, 0.), sums(n_points);
    for (const Part &part : parts)
      weights[part.slot / n_slots] += part.weight;
    Utilities::MPI::sum(weights, communicator, sums);
    for (unsigned int k = 0; k < n_points; ++k)
      gaps.push_back(std::abs(sums[k] - 1.) > 1e-6);
    const auto         first = std::find(gaps.begin(), gaps.end(), true);
    const bool         any   = std::find(gaps.begin(), gaps.end(), false) != gaps.end();
    std::ostringstream message;
    message << "'" << entry << "' in section 'Output': ";
    if (outside == Outside::leave_gaps)
      {
        AssertThrow(n_points == 0 || any,
                    UserError(message.str() + "none of its points is in the body."));
        parts.erase(std::remove_if(parts.begin(),
                                   parts.end(),
                                   [&](const Part &part) { return gaps[part.slot / n_slots]; }),
                    parts.end());
        return;
      }
    if (first == gaps.end())
      return;
    message << "the point (";
    const std::vector<double> &point = points[first - gaps.begin()];
    for (std::size_t d = 0; d < point.size(); ++d)
      message << (d > 0 ? ", " : "") << point[d];
    message << ") is not in the body. Move it into the body, or leave it out.";
    AssertThrow(false, UserError(message.str()));
  }


  template <int dim>
  template <typename Factor>
  std::vector<double> PointEvaluator<dim>::sum_parts(const Vector      &u,
                                                     const unsigned int n_components,
                                                     const unsigned int component,
                                                     const Factor      &factor) const
  {
    std::vector<double> own(static_cast<std::size_t>(n_points) * n_slots, 0.), all(own.size());
    for (const Part &part : parts)
      own[part.slot] = factor(part) * u.local_element(n_components * part.dof + component);
    Utilities::MPI::sum(own, communicator, all);
    std::vector<double> values(n_points, 0.);
    for (unsigned int k = 0; k < n_points; ++k)
      for (unsigned int v = 0; v < n_slots; ++v)
        values[k] += all[k * n_slots + v];
    for (unsigned int k = 0; k < n_points; ++k)
      if (gaps[k])
        values[k] = std::numeric_limits<double>::quiet_NaN();
    return values;
  }


  template <int dim>
  std::vector<double> PointEvaluator<dim>::evaluate(const Vector      &u,
                                                    const unsigned int n_components,
                                                    const unsigned int component) const
  {
    return sum_parts(u, n_components, component, [](const Part &part) { return part.weight; });
  }


  template <int dim>
  void PointEvaluator<dim>::add_weights(const unsigned int point, Vector &weights) const
  {
    for (const Part &part : parts)
      if (part.slot / n_slots == point)
        weights.local_element(part.dof) += part.weight;
  }


  template <int dim>
  std::vector<Tensor<1, dim>> PointEvaluator<dim>::gradients(const Vector      &u,
                                                             const unsigned int n_components,
                                                             const unsigned int component) const
  {
    std::vector<Tensor<1, dim>> result(n_points);
    for (unsigned int d = 0; d < dim; ++d)
      {
        const std::vector<double> slopes =
          sum_parts(u, n_components, component, [&](const Part &part) { return part.slope[d]; });
        for (unsigned int k = 0; k < n_points; ++k)
          result[k][d] = slopes[k];
      }
    return result;
  }

  PERIDEAL_INSTANTIATE_CLASS(class PointEvaluator);
} // namespace PeriDeal
