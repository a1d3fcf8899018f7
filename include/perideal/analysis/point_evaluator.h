// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>
#include <perideal/mesh/nodes.h>
#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/cracks.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Values of a field at given points: the Q1 (or Qp) interpolant for vertex dofs, the nearest
   * node's value for cell centres. Points exactly on a crack are read on its left side. On a
   * lattice the result is the same to the last bit on any number of processes.
   */
  template <int dim>
  class PointEvaluator
  {
  public:
    /** What becomes of points outside the body. */
    enum class Outside
    {
      refuse,
      leave_gaps // their values are NaN; one point at least has to be in the body
    };

    /** What is read in cells that a crack cuts. */
    enum class BesideCracks
    {
      interpolate, // across the crack
      // The linear function that fits the nodes around the point which no crack parts from it best.
      own_side
    };

    /**
     * @param nodes the lattice the dofs lie on, or nullptr to look points up in the mesh (finite
     *              elements, mesh files).
     * Throws UserError naming @p entry for points outside the body, where they are refused, or if
     * all are. Collective.
     */
    PointEvaluator(const dealii::DoFHandler<dim>          &dofs,
                   const Nodes<dim>                       *nodes,
                   const Cracks<dim>                      &cracks,
                   const std::vector<std::vector<double>> &points,
                   const std::string                      &entry,
                   const Outside                           outside = Outside::refuse,
                   const BesideCracks                      beside  = BesideCracks::interpolate);

    /**
     * One value per point, on all processes, of a component of a vector with several at each node,
     * interleaved. Needs no ghosts. Collective.
     */
    std::vector<double> evaluate(const Vector      &u,
                                 const unsigned int n_components = 1,
                                 const unsigned int component    = 0) const;

    /**
     * Add to the owned unknowns of a field with one at each node what they count in the value at a
     * point: the value is the product of weights and field. Not collective.
     */
    void add_weights(const unsigned int point, Vector &weights) const;

    /**
     * The gradient of the interpolant, by the cell that holds the point. Only if points were looked
     * up in the mesh; else all zero. Collective.
     */
    std::vector<dealii::Tensor<1, dim>> gradients(const Vector      &u,
                                                  const unsigned int n_components = 1,
                                                  const unsigned int component    = 0) const;

    /**
     * Whether a point lies outside the body, so that it has no value. The same on all processes.
     */
    bool is_gap(const unsigned int point) const
    {
      return gaps[point];
    }

    /**
     * The points; those that were looked up in the mesh moved a little towards the middle of the
     * cell, in whose material they are.
     */
    const std::vector<dealii::Point<dim>> &inner_points() const
    {
      return inner;
    }

  private:
    struct Part
    {
      unsigned int slot; // of the gathered numbers
      unsigned int dof;  // local index of an owned dof
      double       weight;

      dealii::Tensor<1, dim> slope; // of the shape function, where points are looked up in the mesh
    };

    /**
     * Sums over the parts of each point; every slot has one contributor, so that they are the same
     * on any number of processes.
     */
    template <typename Factor>
    std::vector<double> sum_parts(const Vector      &u,
                                  const unsigned int n_components,
                                  const unsigned int component,
                                  const Factor      &factor) const;

    void locate_on_lattice(const Nodes<dim> &nodes, const std::vector<dealii::Point<dim>> &points);
    void locate_in_mesh(const dealii::DoFHandler<dim>             &dofs,
                        const std::vector<dealii::Point<dim>>     &points,
                        const std::vector<dealii::Tensor<1, dim>> &ways,
                        const std::vector<CrackGeometry<dim>>     &cracks);
    void locate_nearest(const dealii::DoFHandler<dim>         &dofs,
                        const Nodes<dim>                      &nodes,
                        const std::vector<dealii::Point<dim>> &points);
    void find_gaps(const std::vector<std::vector<double>> &points,
                   const std::string                      &entry,
                   const Outside                           outside);

    MPI_Comm          communicator;
    unsigned int      n_points, n_slots;
    std::vector<Part> parts;
    std::vector<bool> gaps;

    std::vector<dealii::Point<dim>> inner;
  };
} // namespace PeriDeal
