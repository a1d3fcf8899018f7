// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/scene/body_parameters.h>

#include <map>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** A node of this process on a side or in a part of the body. A node on an edge is on two. */
  template <int dim>
  struct NodeOnSide
  {
    unsigned int               node; // local number
    dealii::types::boundary_id side;
    dealii::Point<dim>         position;
  };


  /**
   * Throws UserError for a layer behind sides of a list, `Displacement` or `Traction`, that are not
   * flat, or behind which the body is not as wide. Not collective.
   */
  template <int dim>
  void require_layer(const BodyParameters<dim>          &body,
                     const std::vector<VectorCondition> &list,
                     const std::string                  &name,
                     const double                        depth);

  /**
   * Which components of the displacement are not free: those that `Displacement` names, and the
   * normal one on sides of `Symmetry`. Where sides meet, each component is that of the side named
   * first; symmetry comes last. Unknowns are interleaved (ElasticOperator).
   */
  template <int dim>
  class DisplacementConditions
  {
  public:
    /** Throws UserError for a body with a layer in which nothing can be held. Not collective. */
    static void require(const BodyParameters<dim> &body);

    /**
     * @param nodes on the sides
     * @param positions of this process's own nodes, for those in `Displacement layer`
     * @param at_centers the nodes lie at the centres of cells; then none is held by a plane of
     *                   symmetry beyond which families go on
     *
     * Collective. Throws UserError for a side of symmetry that is not normal to an axis, and for
     * sides without nodes.
     */
    DisplacementConditions(const std::vector<NodeOnSide<dim>>    &nodes,
                           const std::vector<dealii::Point<dim>> &positions,
                           const BodyParameters<dim>             &body,
                           const bool                             at_centers,
                           const MPI_Comm                         communicator);

    /**
     * Hold the pins of the scene's islands. @param positions of this process's own nodes;
     * @param at_centers which pins are meant. Not collective.
     */
    void pin(const std::vector<dealii::Point<dim>> &positions,
             const BodyParameters<dim>             &body,
             const bool                             at_centers);

    /**
     * Let owned unknowns, ascending, follow from others (HangingNodes): no condition holds them,
     * and they are not free. Not collective.
     */
    void let_follow(std::vector<unsigned int> unknowns);

    /** Set the prescribed values of time t, times a factor. */
    void distribute(Vector &u, const double t, const double factor = 1.) const;

    /** Set what is not free to a value. */
    void mask(Vector &y, const double value = 0.) const;

    bool depends_on_time() const
    {
      return varies;
    }

    /**
     * How far prescribed velocities have moved their nodes. @param keys of the owned nodes.
     * Collective.
     */
    void exchange(Archive &archive, const NodeKeys &keys);

    /**
     * Add the components of a vector that belong to prescribed unknowns to the force of their side.
     * Not collective.
     */
    void add_reactions(const Vector                                                 &v,
                       std::map<dealii::types::boundary_id, dealii::Tensor<1, dim>> &forces) const;

  private:
    struct Prescribed
    {
      unsigned int               unknown;
      dealii::types::boundary_id side;
      const Expression          *value; // null: 0
      dealii::Point<dim>         position;
      bool                       rate = false;        // the value is a velocity
      mutable double             time = 0., way = 0.; // its integral up to the time
    };

    /** The integral of a velocity from time 0 on. Steps forward add to that of the last call. */
    double moved(const Prescribed &entry, const double t) const;

    std::vector<Prescribed>   prescribed; // first by conditions, then pinned ones
    std::vector<unsigned int> following;
    bool                      varies = false;
  };


  /**
   * The forces of all processes by the names of the sides: of those with displacements, symmetry or
   * tractions. What belongs to no side (dealii::numbers::internal_face_boundary_id) is the body
   * force. Collective.
   */
  template <int dim>
  ForceBalance gather_forces(
    const std::map<dealii::types::boundary_id, dealii::Tensor<1, dim>> &forces,
    const BodyParameters<dim>                                          &body,
    const MPI_Comm                                                      communicator);
} // namespace PeriDeal
