// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/quadrature_lib.h>
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

    explicit Tree(const std::vector<NearCell> &cells)
    {
      std::vector<Entry> list;
      for (unsigned int c = 0; c < cells.size(); ++c)
        {
          dealii::BoundingBox<dim> box(cells[c].corners);
          double                   size = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            size = std::max(size, box.side_length(d));
          box.extend(1e-6 * size);
          boxes.push_back(box);
          list.emplace_back(box, c);
          // Gauss points are exact for the determinant of the mapping.
          const dealii::QGauss<dim> points(2);
          double                    volume = 0.;
          for (unsigned int q = 0; q < points.size(); ++q)
            volume += points.weight(q) * volume_element(cells[c].corners, points.point(q));
          volumes.push_back(volume);
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

    bool box_holds(const unsigned int c, const dealii::Point<dim> &p) const
    {
      return boxes[c].point_inside(p);
    }

    double volume(const unsigned int c) const
    {
      return volumes[c];
    }

  private:
    dealii::RTree<Entry>                  entries;
    std::vector<dealii::BoundingBox<dim>> boxes;
    std::vector<double>                   volumes;
  };
} // namespace PeriDeal
