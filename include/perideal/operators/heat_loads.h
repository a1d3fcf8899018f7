// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/condition_faces.h>
#include <perideal/operators/hanging_nodes.h>
#include <perideal/operators/operator.h>

#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What enters a body of finite elements from outside, by quadrature: the source q, the flux g
   * through sides, and convection with the coefficient h to the ambient value a. All are positive
   * into the body:
   *
   *   f_i = int q N_i + int_flux g N_i + int_convection h a N_i,
   *
   * and convection adds int h N_i N_j to K. Unknowns in regions and at points have their shares of
   * the flux there. What hanging nodes have belongs to their masters.
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
    bool depends_on_time() const;

    /** The unknowns in regions and at points. */
    const std::vector<PartUnknown<dim>> &part_unknowns() const;

    /** f(t), which stays until the next call. Collective. */
    const Vector &at(const double t) const;

    /** Sum of this process's entries of the last at(). */
    double sum() const;

    /** Set the matrix of a cell to what convection through its faces adds to it. */
    void find_convection(const Cell &cell, dealii::FullMatrix<double> &matrix) const;

    /** What enters this process's unknowns by convection with the ambient value 0, per time. */
    double through_convection(const Vector &u) const;

    /**
     * Add this process's share of what enters through sides and from sources, with the field u.
     * Collective.
     */
    void add_to(Balance &balance, const Vector &u, const double t) const;

    std::size_t memory_consumption() const;

  private:
    /**
     * Call on_source(values), on_flux(condition, values) and on_convection(condition, values) with
     * the quadrature points of each own cell in turn, whose `indices` are set, and at last
     * on_part(unknown, flux).
     */
    template <typename OnSource, typename OnFlux, typename OnConvection, typename OnPart>
    void for_each(const OnSource     &on_source,
                  const OnFlux       &on_flux,
                  const OnConvection &on_convection,
                  const OnPart       &on_part) const;

    void assemble(const double t) const;
    void find_convection_sums();

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

    // Coefficient times area of each owned unknown that has some.
    std::vector<std::pair<unsigned int, double>> convection_sums;
  };
} // namespace PeriDeal
