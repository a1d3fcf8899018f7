// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/operators/mesh_exchange.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** Finds the cells that a bond may pass. */
  template <int dim>
  struct MeshExchange<dim>::Tree
  {
    using Entry = std::pair<dealii::BoundingBox<dim>, unsigned int>;

    /** Knows the cells that reach into a box. */
    Tree(const std::vector<NearCell> &cells, const dealii::BoundingBox<dim> &around)
      : boxes(cells.size())
    {
      std::vector<Entry> list;
      for (unsigned int c = 0; c < cells.size(); ++c)
        {
          dealii::BoundingBox<dim> box(cells[c].corners);
          double                   size = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            size = std::max(size, box.side_length(d));
          box.extend(1e-6 * size);
          bool apart = false;
          for (unsigned int d = 0; d < dim; ++d)
            apart = apart || box.lower_bound(d) > around.upper_bound(d) ||
                    box.upper_bound(d) < around.lower_bound(d);
          if (apart)
            continue;
          boxes[c] = box;
          list.emplace_back(box, c);
        }
      entries = dealii::pack_rtree(list);
    }

    void find(const dealii::Point<dim>  &a,
              const dealii::Point<dim>  &b,
              std::vector<unsigned int> &found) const
    {
      namespace index = boost::geometry::index;
      found.clear();
      const dealii::BoundingBox<dim> box(std::vector<dealii::Point<dim>>{a, b});
      for (auto entry = entries.qbegin(index::intersects(box)); entry != entries.qend(); ++entry)
        found.push_back(entry->second);
      std::sort(found.begin(), found.end());
    }

    /** Whether the sphere around a cell's box meets the line through a. @p along has length 1. */
    bool is_near_line(const unsigned int            c,
                      const dealii::Point<dim>     &a,
                      const dealii::Tensor<1, dim> &along) const
    {
      const auto &[low, high]                = boxes[c].get_boundary_points();
      const dealii::Tensor<1, dim> to_middle = 0.5 * ((low - a) + (high - a));
      const double                 ahead     = to_middle * along;
      return to_middle.norm_square() - ahead * ahead < 0.2501 * (high - low).norm_square();
    }

    bool box_holds(const unsigned int c, const dealii::Point<dim> &p) const
    {
      const auto &[low, high] = boxes[c].get_boundary_points();
      for (unsigned int d = 0; d < dim; ++d)
        if (p[d] < low[d] || p[d] > high[d])
          return false;
      return true;
    }

  private:
    dealii::RTree<Entry>                  entries;
    std::vector<dealii::BoundingBox<dim>> boxes;
  };
} // namespace PeriDeal
