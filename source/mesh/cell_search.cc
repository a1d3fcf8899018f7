// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/numerics/rtree.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/cell_search.h>

#include <algorithm>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  struct CellSearch<dim>::Tree
  {
    using Entry = std::pair<BoundingBox<dim>, Cell>;
    RTree<Entry> entries;
  };


  template <int dim>
  CellSearch<dim>::CellSearch(const DoFHandler<dim> &dofs)
    : tree(std::make_unique<Tree>())
  {
    std::vector<typename Tree::Entry> entries;
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        {
          entries.emplace_back(cell->bounding_box(), cell);
          diameter = std::max(diameter, cell->diameter());
        }
    tree->entries = pack_rtree(entries);
  }


  template <int dim>
  CellSearch<dim>::~CellSearch() = default;


  template <int dim>
  void CellSearch<dim>::find(const std::vector<BoundingBox<dim>> &boxes,
                             const double                         distance,
                             std::vector<Cell>                   &cells) const
  {
    namespace index = boost::geometry::index;
    for (BoundingBox<dim> box : boxes)
      {
        box.extend(distance + 1e-6 * diameter);
        for (auto found = tree->entries.qbegin(index::intersects(box));
             found != tree->entries.qend();
             ++found)
          cells.push_back(found->second);
      }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  }


  PERIDEAL_INSTANTIATE_CLASS(class CellSearch);
} // namespace PeriDeal
