// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "own_side.h"

#include <perideal/base/instantiate.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  bool parted(const std::vector<CrackGeometry<dim>> &cracks,
              const Point<dim>                      &a,
              const Point<dim>                      &b)
  {
    return std::any_of(cracks.begin(), cracks.end(), [&](const CrackGeometry<dim> &crack) {
      return crack.separates(a, b);
    });
  }


  namespace
  {
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
  } // namespace


  template <int dim>
  std::vector<Share<dim>> fit_own_side(const CellSearch<dim>                 &search,
                                       const typename CellSearch<dim>::Cell  &cell,
                                       const Point<dim>                      &point,
                                       const std::vector<CrackGeometry<dim>> &cracks)
  {
    return fit_linear(nodes_on_own_side(search, cell, point, cracks), point);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(parted);
  PERIDEAL_INSTANTIATE_FUNCTION(fit_own_side);
} // namespace PeriDeal
