// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/material_ids.h>

#include <set>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void set_material_ids(const Triangulation<dim> &mesh, const Regions &regions)
  {
    if (!regions.need_mesh())
      return;
    using Entry = std::pair<BoundingBox<dim>, typename Triangulation<dim>::cell_iterator>;
    std::vector<Entry> boxes;
    std::set<int>      ids;
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      {
        BoundingBox<dim> box = cell->bounding_box();
        box.extend(1e-10 * cell->diameter());
        boxes.emplace_back(box, cell);
        ids.insert(static_cast<int>(cell->material_id()));
      }
    for (std::size_t k = 0; k < regions.regions.size(); ++k)
      if (const int id = regions.regions[k].mesh_id(); id >= 0 && ids.count(id) == 0)
        {
          std::string known;
          for (const int i : ids)
            known += (known.empty() ? "" : ", ") + std::to_string(i);
          AssertThrow(false,
                      UserError("Entry " + regions.where + ": the phase '" + regions.names[k] +
                                "' is mesh(" + std::to_string(id) +
                                "), but no cell of the mesh file has this material id. Its ids: " +
                                known + "."));
        }
    const auto tree     = std::make_shared<const RTree<Entry>>(pack_rtree(boxes));
    regions.mesh->id_at = [tree](const double *x) {
      Point<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] = x[d];
      int                found = -1;
      std::vector<Entry> near;
      tree->query(boost::geometry::index::intersects(p), std::back_inserter(near));
      for (const auto &[box, cell] : near)
        {
          const int id = static_cast<int>(cell->material_id());
          if ((found < 0 || id < found) && (near.size() == 1 || cell->point_inside(p)))
            found = id;
        }
      return found;
    };
  }

  PERIDEAL_INSTANTIATE_FUNCTION(set_material_ids);
} // namespace PeriDeal
