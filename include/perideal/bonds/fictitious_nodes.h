// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/nodes.h>
#include <perideal/scene/body_parameters.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Fictitious nodes outside the flat sides of a box, over the whole reach of a family. Each has
   * the value
   *
   *   T = sign * T(mirror) + sum_k coefficient_k * T*_k(foot_k, t),
   *
   * with the mirror node inside the body: sign -1 and coefficient 2 on sides with a Dirichlet value
   * (mirror treatment), sign 0 and coefficient 1 (constant treatment), sign +1 on symmetry sides.
   * At edges and corners one side after the other is mirrored, in the order left, right, bottom,
   * top, back, front. Vertices are mirrored about the side's own row: the row's missing half or
   * quarter volumes lie outside and are fictitious nodes at the row's own place.
   */
  template <int dim>
  struct FictitiousNode
  {
    /** Part of the prescribed value: coefficient times the Dirichlet value of a side at a point. */
    struct Term
    {
      const SideCondition *condition;
      dealii::Point<dim>   foot;
      double               coefficient;
    };

    typename Lattice<dim>::Index site;
    unsigned int                 mirror; // local index of a real node
    double                       sign, volume;
    dealii::types::boundary_id   side; // the side it belongs to: that of the last reflection
    std::vector<Term>            terms;

    /** The prescribed part at time t. */
    double constant(const double t) const
    {
      double sum = 0.;
      for (const Term &term : terms)
        sum += term.coefficient * term.condition->value.value(term.foot, t);
      return sum;
    }
  };


  /**
   * All fictitious nodes that local nodes of this process may be bonded to.
   * @param reach largest offset of a family in each direction, in lattice spacings
   * Throws UserError if a side that needs such a layer is not flat or if the body is narrower than
   * the reach. Not collective.
   */
  template <int dim>
  std::vector<FictitiousNode<dim>> make_fictitious_nodes(const Nodes<dim>              &nodes,
                                                         const BoundaryConditions<dim> &conditions,
                                                         const BoundaryTreatment        treatment,
                                                         const NodalVolume nodal_volume,
                                                         const typename Lattice<dim>::Index &reach);
} // namespace PeriDeal
