// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <perideal/mesh/cell_search.h>
#include <perideal/operators/parts/crack_side_factors.h>
#include <perideal/operators/parts/cut_cells.h>
#include <perideal/operators/solid/solid_bonds_beside_elements.h>
#include <perideal/operators/solid/stress_cells.h>
#include <perideal/scene/body_parameters.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * The cells of finite elements Qp of a solid, one at a time: K_ab = int lambda grad_a (x) grad_b
   * + mu (grad_b (x) grad_a + grad_a . grad_b I), in 2D with the lambda of plane stress or plane
   * strain, in 1D with Young's modulus, and what a coupling and cracks leave of it. Material and
   * thermal strain are those at quadrature points, a temperature at nodes is interpolated there.
   * The thermal strain alpha dT (in plane strain (1 + nu) alpha dT) makes the load
   * int grad_a (dim lambda + 2 mu) alpha dT. With a law of stresses (StressCells) K_ab is its
   * tangent before anything has happened.
   *
   * Cells that a crack cuts carry nothing (`Mesh = removed`), unless the crack is cut into the
   * mesh. Beside cracks they have the mean of the crack-side factors of their vertices. Not
   * collective unless stated.
   */
  template <int dim>
  class ElasticCells
  {
  public:
    using Cell  = typename dealii::DoFHandler<dim>::active_cell_iterator;
    using Boxes = std::vector<dealii::BoundingBox<dim>>;

    /** The cell that is looked at. Rows and columns are interleaved like the unknowns. */
    struct Data
    {
      explicit Data(const dealii::FiniteElement<dim> &fe);

      /** At a state u, whose ghosts are up to date. */
      double energy(const Vector &u) const;

      /** What an unknown has of K u, thermal loads apart. */
      double force(const unsigned int unknown, const Vector &u) const;

      dealii::FEValues<dim>      values;
      dealii::FullMatrix<double> stiffness, shear; // the part that the shear modulus multiplies
      dealii::Vector<double>     thermal, mass, diagonal, volume; // diagonal: of the mass
      double                     thermal_energy = 0.;
      std::vector<dealii::types::global_dof_index> indices, unknowns;
    };

    /**
     * All have to outlive this object.
     * @param bonds        null: finite elements alone
     * @param temperatures the changes at nodes, ghosts up to date; empty: the formula of the scene
     */
    ElasticCells(const dealii::DoFHandler<dim>       &dofs,
                 const BodyParameters<dim>           &body,
                 const SolidBondsBesideElements<dim> *bonds,
                 const Vector                        &temperatures);

    const dealii::DoFHandler<dim> &dof_handler() const
    {
      return dofs;
    }

    /** Call visit(cell, data) for the own ones of some cells, as bonds and cracks leave them. */
    template <typename Cells, typename Visit>
    void for_each(const Cells &of, const Visit &visit) const
    {
      for_each_whole(of, [&](const Cell &cell, Data &of_cell) {
        change(cell);
        visit(cell, of_cell);
      });
    }

    /** The same for all own cells. */
    template <typename Visit>
    void for_each(const Visit &visit) const
    {
      for_each(dofs.active_cell_iterators(), visit);
    }

    /** The same without bonds and cracks. */
    template <typename Cells, typename Visit>
    void for_each_whole(const Cells &of, const Visit &visit) const
    {
      for (const auto &cell : of)
        if (cell->is_locally_owned())
          {
            assemble(cell);
            visit(cell, data);
          }
    }

    template <typename Visit>
    void for_each_whole(const Visit &visit) const
    {
      for_each_whole(dofs.active_cell_iterators(), visit);
    }

    /** The unknowns of a cell, until another one is looked at. */
    const std::vector<dealii::types::global_dof_index> &unknowns_of(const Cell &cell) const;

    /** Cells of this process and ghosts within a distance of boxes, ascending. */
    std::vector<Cell> near(const Boxes &boxes, const double distance);

    /** There are crack-side factors. */
    bool scales_beside_cracks() const
    {
      return bonds && body.peridynamics.scales_beside_cracks() && !body.cracks.cracks.empty();
    }

    /** Find the factors of nodes. @p layout of nodes. Collective. */
    void find_factors(const Vector &layout);

    /** Some cells may have been parted by bonds that break. @p of null: all. */
    void note_parted(const std::vector<Cell> *of = nullptr);

    /** Cells that cracks cut or breaking bonds part, by active cell index. */
    const std::vector<bool> &cut() const
    {
      return parted.empty() ? by_cracks.flags() : parted;
    }

    /** As ElasticElements::lowest_remainder(), of own cells. */
    double lowest_remainder() const;

    /** As StressCells::throw_faults(). Collective. */
    void throw_faults() const
    {
      if (stresses)
        stresses->throw_faults();
    }

    /** Deformations are large. */
    bool is_full() const
    {
      return stresses && stresses->is_full();
    }

    /** Data::shear is to be made. */
    bool with_shear = false;

    CutCells<dim>    by_cracks;
    CrackSideFactors factors; // empty: none

    const std::unique_ptr<StressCells<dim>> stresses; // null: the linear law

  private:
    void assemble(const Cell &cell) const;
    void change(const Cell &cell) const;

    const dealii::DoFHandler<dim>             &dofs;
    const BodyParameters<dim>                 &body;
    const SolidBondsBesideElements<dim> *const bonds;
    const Vector                              &temperatures;
    mutable Data                               data;
    std::unique_ptr<CellSearch<dim>>           search; // once something has changed
    std::vector<bool>                          parted; // empty before
  };
} // namespace PeriDeal
