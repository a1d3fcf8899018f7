// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/fe/fe_values.h>

#include <perideal/operators/parts/condition_faces.h>
#include <perideal/scene/body_parameters.h>

#include <functional>
#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * Mechanical loads on finite elements: int N_a b over cells, int N_a t over faces and what parts
   * of sides take of them, with b the body force and t the tractions, and on regions and points a
   * traction as it is, shared by their nodes.
   *
   * One scalar DoFHandler numbers the nodes; each has dim unknowns, interleaved.
   */
  template <int dim>
  class ElementLoads
  {
  public:
    using Layout = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;

    /** Whether an unknown, by global number, follows from others. */
    using IsHanging = std::function<bool(const dealii::types::global_dof_index)>;

    /** @param side what the load is on; of body forces numbers::internal_face_boundary_id */
    using Visit = std::function<void(const dealii::types::boundary_id      side,
                                     const dealii::types::global_dof_index unknown,
                                     const unsigned int                    component,
                                     const double                          value)>;

    /**
     * All have to outlive this object. Throws UserError for parts that are empty. Collective.
     * @param nodes layout of vectors with one number for each node
     */
    ElementLoads(const dealii::DoFHandler<dim> &dofs,
                 const BodyParameters<dim>     &body,
                 const Layout                  &nodes,
                 const IsHanging               &is_hanging);

    /** What is added to unknowns by own cells and nodes at time t. Not collective. */
    void for_each(const double t, const Visit &visit) const;

    /** Own ones in regions and at points. */
    const std::vector<PartUnknown<dim>> &part_unknowns() const
    {
      return of_parts;
    }

  private:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    template <typename Values, typename Formula>
    void visit_points(const Values                    &values,
                      const Formula                   &formula,
                      const double                     t,
                      const dealii::types::boundary_id side,
                      const Visit                     &visit) const;
    void visit_faces(const Cell &cell, const double t, const Visit &visit) const;

    const dealii::DoFHandler<dim>                       &dofs;
    const BodyParameters<dim>                           &body;
    const Layout                                         nodes;
    const ConditionFaces<dim>                            condition_faces;
    const std::vector<PartUnknown<dim>>                  of_parts;
    mutable dealii::FEValues<dim>                        cell_values;
    mutable dealii::FEFaceValues<dim>                    face_values;
    mutable std::vector<dealii::types::global_dof_index> indices; // of a cell
  };
} // namespace PeriDeal
