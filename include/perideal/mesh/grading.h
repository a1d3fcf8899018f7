// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/scene/scene.h>
#include <perideal/scene/zone.h>

#include <functional>

namespace PeriDeal
{
  /** The part of the body in which cells stay as fine as the lattice, for the cracks at the end of the run. */
  template <int dim>
  Zone<dim> fine_part(const Scene<dim> &scene);


  /**
   * Refine the cells of a box until those in the fine part, and at least two cells of each size beyond it, are of lattice size. The level of the
   * cells of lattice size is @p finest. Collective.
   */
  template <int dim>
  void refine_towards(dealii::Triangulation<dim> &mesh,
                      const Zone<dim>            &fine,
                      const Domain<dim>          &domain,
                      const unsigned int          finest);

  /**
   * Whether a cell has to be refined for that: the same on every process.
   */
  template <int dim>
  bool is_too_coarse(const typename dealii::Triangulation<dim>::cell_iterator &cell,
                     const Zone<dim>                                          &fine,
                     const Domain<dim>                                        &domain,
                     const unsigned int                                        finest);


  /** The work that an active cell makes. */
  template <int dim>
  using CellWork =
    std::function<unsigned int(const typename dealii::Triangulation<dim>::cell_iterator &cell)>;

  /**
   * The nonzeros of a node's row in all models of a scene, by the place of the cell: in a zone also those of its bonds. With a zone that follows
   * cracks it is the zone at the end of the run. Empty if all cells make the same.
   */
  template <int dim>
  CellWork<dim> work_of_cells(const Scene<dim> &scene);
} // namespace PeriDeal
