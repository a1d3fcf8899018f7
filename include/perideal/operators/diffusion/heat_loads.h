// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/diffusion_loads.h>
#include <perideal/operators/parts/condition_faces.h>
#include <perideal/operators/parts/hanging_nodes.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Loads of a body of finite elements, by quadrature:
   *
   *   f_i = int s N_i + int_sides (f + h a) N_i,
   *
   * and sides add int h N_i N_j to K, as does a source that is a function of u (LoadTangents, at
   * the temperatures of the field at the quadrature points). Unknowns in regions and at points have
   * their shares of the f there. What hanging nodes have belongs to their masters.
   */
  template <int dim>
  class HeatLoads : public DiffusionLoads<dim>
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /**
     * @param layout of the vectors
     *
     * Throws UserError for parts of sides that are empty. Collective.
     */
    HeatLoads(const dealii::DoFHandler<dim>                                    &dofs,
              const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout,
              const BoundaryConditions<dim>                                    &conditions,
              const Expression                                                 &source,
              const HangingNodes<dim>                                          &hanging);

    /** The unknowns in regions and at points. */
    const std::vector<PartUnknown<dim>> &part_unknowns() const
    {
      return of_parts;
    }

    /** Set the matrix of a cell to what transfer through its faces adds to it, of lines in u. */
    void find_transfer(const Cell &cell, dealii::FullMatrix<double> &matrix) const;

    /** To what tangents add to it. Returns whether there are any in this cell. */
    bool find_tangents(const Cell &cell, dealii::FullMatrix<double> &matrix) const;

    void add_to(Balance &balance, const Vector &u, const double t) const override;

  private:
    /**
     * Call on_source(values) and on_side(transfer, values) with the quadrature points of each own
     * cell in turn, whose `indices` are set, and at last on_part(unknown, transfer).
     */
    template <typename OnSource, typename OnSide, typename OnPart>
    void for_each(const OnSource &on_source, const OnSide &on_side, const OnPart &on_part) const;

    /** Call visit(transfer, values) with the quadrature points on the sides of a cell. */
    template <typename Visit>
    void on_faces(const Cell &cell, const Visit &visit) const;

    /**
     * Call visit(values, q, h) with the quadrature points of a cell, whose `indices` are set, and
     * on its sides where there is a tangent.
     */
    template <typename Visit>
    void on_slopes(const Cell &cell, const Visit &visit) const;

    bool has_tangents(const Cell &cell) const;

    /** T at a quadrature point of the cell whose `indices` are set; 0 where nothing asks for it. */
    template <typename Values>
    double taken_at(const Values &points, const unsigned int q) const;

    /** Whether all there is to say of this source or transfer is known. */
    bool is_known(const bool is_curved) const
    {
      return !is_curved || this->tangents.taken_at_all();
    }

    void assemble(const double t) const override;
    void find_coefficients() override;

    using DiffusionLoads<dim>::conditions;
    using DiffusionLoads<dim>::source;
    using DiffusionLoads<dim>::any_source;
    using DiffusionLoads<dim>::loads;

    const dealii::DoFHandler<dim>                       &dofs;
    const HangingNodes<dim>                             &hanging;
    const ConditionFaces<dim>                            faces;
    const std::vector<PartUnknown<dim>>                  of_parts;
    mutable dealii::FEValues<dim>                        values;
    mutable dealii::FEFaceValues<dim>                    face_values;
    mutable std::vector<dealii::types::global_dof_index> indices;
  };
} // namespace PeriDeal
