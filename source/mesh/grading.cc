// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/mesh/grading.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Zone<dim> fine_part(const Scene<dim> &scene)
  {
    if (scene.domain.fine_by_formula)
      return Zone<dim>(scene.domain.fine);
    Zone<dim> zone(scene.coupling, scene.horizon());
    zone.set_cracks(scene.crack_history().pieces(scene.cracks.end_time));
    return zone;
  }


  template <int dim>
  bool is_too_coarse(const typename Triangulation<dim>::cell_iterator &cell,
                     const Zone<dim>                                  &fine,
                     const Domain<dim>                                &domain,
                     const unsigned int                                finest)
  {
    const unsigned int level = cell->level();
    if (level >= finest)
      return false;
    // Two cells of each finer size lie between this one and the fine part.
    double spacing = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      spacing = std::max(spacing, domain.spacing()[d]);
    constexpr double slack = 1e-6;
    const double     rim   = 2. * spacing * ((1u << (finest - level)) - 1. + slack),
                 half      = 0.5 * cell->diameter();
    return fine.distance(cell->center(), half + 2. * rim) < half + rim;
  }


  template <int dim>
  void refine_towards(Triangulation<dim> &mesh,
                      const Zone<dim>    &fine,
                      const Domain<dim>  &domain,
                      const unsigned int  finest)
  {
    // Where every process has all cells, each marks them all.
    const bool distributed =
      dynamic_cast<const parallel::DistributedTriangulationBase<dim> *>(&mesh) != nullptr;
    for (unsigned int pass = 0; pass < finest; ++pass)
      {
        for (const auto &cell : mesh.active_cell_iterators())
          if ((!distributed || cell->is_locally_owned()) &&
              is_too_coarse<dim>(cell, fine, domain, finest))
            cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
      }
  }


  template <int dim>
  CellWork<dim> work_of_cells(const Scene<dim> &scene)
  {
    const auto &models = scene.general.models;
    if (std::find(models.begin(), models.end(), Model::coupled) == models.end() ||
        scene.coupling.zone == ZoneKind::everywhere)
      return {};
    auto zone = std::make_shared<Zone<dim>>(scene.coupling, scene.horizon());
    zone->set_cracks(scene.crack_history().pieces(scene.cracks.end_time));
    unsigned int of_elements = models.size();
    for (unsigned int d = 0; d < dim; ++d)
      of_elements *= 3;
    const double horizon = scene.horizon();
    return [zone, of_elements, horizon](const typename Triangulation<dim>::cell_iterator &cell) {
      if (!zone->contains(cell->center()))
        return of_elements;
      const double ball[] = {2., std::acos(-1.), 4. / 3. * std::acos(-1.)};
      return of_elements +
             static_cast<unsigned int>(ball[dim - 1] * std::pow(horizon, dim) / cell->measure());
    };
  }


#define PERIDEAL_INSTANTIATE(dim)                                                               \
  template Zone<dim>     fine_part(const Scene<dim> &);                                         \
  template bool          is_too_coarse<dim>(const typename Triangulation<dim>::cell_iterator &, \
                                   const Zone<dim> &,                                  \
                                   const Domain<dim> &,                                \
                                   const unsigned int);                                \
  template void          refine_towards(Triangulation<dim> &,                                   \
                                        const Zone<dim> &,                                      \
                                        const Domain<dim> &,                                    \
                                        const unsigned int);                                    \
  template CellWork<dim> work_of_cells(const Scene<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
