// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/base/archive.h>
#include <perideal/scene/scene.h>
#include <perideal/scene/zone.h>

#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Which cells of a box have to be as fine as its lattice, and how large the others may be: at
   * least two cells of each size lie between the fine part and cells twice as large. The fine part
   * is the zone of section `Coupling` around the cracks as they will be: at the end of the run, or,
   * with `Zone = adaptive`, at the time when the mesh is adapted next; and that of `Fine where`,
   * which alone counts for finite elements alone. The same on every process; nothing is collective
   * unless stated.
   */
  template <int dim>
  class Grading
  {
  public:
    using Cell = typename dealii::Triangulation<dim>::cell_iterator;

    /** @param mesh that of the scene, or its coarse cells; on every process */
    Grading(const Scene<dim> &scene, const dealii::Triangulation<dim> &mesh);

    /**
     * `Zone = adaptive`: the time after t at which the mesh has to follow the cracks or the
     * solution; infinity if it never has to.
     */
    double next_adaptation(const double t) const;

    /** Make the fine part that of time t. */
    void set_time(const double t);

    /** A cell that is larger than the fine part allows. */
    bool is_too_coarse(const Cell &cell) const;

    /** Refine until no cell is too coarse. Collective. */
    void refine(dealii::Triangulation<dim> &mesh) const;

    /**
     * Mark cells to be refined and coarsened: those too coarse are refined, and those with an
     * indicator above @p target; those with a far smaller one are merged where the fine part allows
     * it. @p indicators are squares, by active cell index. Returns whether any mark was set. Only
     * for a mesh that p4est distributes. Collective.
     */
    bool mark(dealii::Triangulation<dim> &mesh,
              const std::vector<double>  &indicators,
              const double                target) const;

  private:
    double distance(const dealii::Point<dim> &p, const double farthest) const;

    Zone<dim>           zone, named; // of section `Coupling`, of `Fine where`
    bool                by_zone, by_name;
    CrackHistory<dim>   history;
    std::vector<double> adaptations; // times, ascending
    unsigned int finest, coarsest;   // levels of the cells of lattice size and of the largest ones
    double       spacing = 0., end;
  };


  /** The work that an active cell makes. */
  template <int dim>
  using CellWork =
    std::function<unsigned int(const typename dealii::Triangulation<dim>::cell_iterator &cell)>;

  /**
   * The nonzeros of a node's row in all models of a scene, by the place of the cell: in a zone also
   * those of its bonds. With a zone that follows cracks it is the zone at the end of the run. Empty
   * if all cells make the same.
   */
  template <int dim>
  CellWork<dim> work_of_cells(const Scene<dim> &scene);


  /** How an adapted mesh has become what it is, so that it can be made once more. */
  class MeshHistory
  {
  public:
    /** Keep the marks that the mesh is about to be adapted by. Collective. */
    template <int dim>
    void record(const dealii::Triangulation<dim> &mesh);

    /** Adapt a mesh as it was from its beginning on all that have been recorded. Collective. */
    template <int dim>
    void repeat(dealii::Triangulation<dim> &mesh) const;

    unsigned int n_adaptations() const
    {
      return marks.size();
    }

    void exchange(Archive &archive);

  private:
    std::vector<std::string> marks; // cells to be refined; cells to be coarsened
  };
} // namespace PeriDeal
