// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/operator.h>
#include <perideal/operators/parts/condition_faces.h>
#include <perideal/operators/parts/hanging_nodes.h>

#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What enters a body of finite elements from outside, by quadrature: the source s, and through
   * sides f + h (a - u) (SurfaceTransfer). All are positive into the body:
   *
   *   f_i = int s N_i + int_sides (f + h a) N_i,
   *
   * and sides add int h N_i N_j to K. Unknowns in regions and at points have their shares of the f
   * there. What hanging nodes have belongs to their masters.
   *
   * The arguments of the constructor must outlive this.
   */
  template <int dim>
  class HeatLoads
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

    /** Loads, or prescribed values of the conditions, change with time. Not collective. */
    bool depends_on_time() const
    {
      return varies || conditions.depends_on_time();
    }

    /** The unknowns in regions and at points. */
    const std::vector<PartUnknown<dim>> &part_unknowns() const
    {
      return of_parts;
    }

    /** f(t), which stays until the next call. Collective. */
    const Vector &at(const double t) const;

    /** Sum of this process's entries of the last at(). */
    double sum() const
    {
      return sum_of_loads;
    }

    /** Set the matrix of a cell to what transfer through its faces adds to it. */
    void find_transfer(const Cell &cell, dealii::FullMatrix<double> &matrix) const;

    /** What enters this process's unknowns where f and a are 0, per time. */
    double through_transfer(const Vector &u) const;

    /**
     * Add this process's share of what enters through sides and from sources, with the field u.
     * Collective.
     */
    void add_to(Balance &balance, const Vector &u, const double t) const;

    std::size_t memory_consumption() const
    {
      return loads.memory_consumption();
    }

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

    void assemble(const double t) const;
    void find_coefficients();

    const dealii::DoFHandler<dim>                       &dofs;
    const BoundaryConditions<dim>                       &conditions;
    const Expression                                    &source;
    const HangingNodes<dim>                             &hanging;
    const bool                                           any_source, varies;
    const ConditionFaces<dim>                            faces;
    const std::vector<PartUnknown<dim>>                  of_parts;
    mutable dealii::FEValues<dim>                        values;
    mutable dealii::FEFaceValues<dim>                    face_values;
    mutable std::vector<dealii::types::global_dof_index> indices;
    mutable Vector                                       loads;
    mutable double                                       sum_of_loads = 0.;

    // h times area of each owned unknown that has some.
    std::vector<std::pair<unsigned int, double>> coefficients;
  };
} // namespace PeriDeal
