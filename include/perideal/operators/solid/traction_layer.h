// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/nodes.h>
#include <perideal/scene/body_parameters.h>

#include <vector>

namespace PeriDeal
{
  /**
   * What an owned node carries of the traction of a side: an area times the traction at a place on
   * the side.
   */
  template <int dim>
  struct TractionShare
  {
    unsigned int               node;
    dealii::types::boundary_id side;
    double                     area;
    dealii::Point<dim>         place;
  };


  /**
   * The part of the interval from lower to upper that is no farther than depth from 0, over its
   * length. Not negative.
   */
  double part_within(const double lower, const double upper, const double depth);


  /** Throws UserError for a body in which `Traction layer` is not possible. Not collective. */
  template <int dim>
  void require_traction_layer(const BodyParameters<dim> &body);

  /**
   * The shares of all sides in `Traction`. Without a layer those of the nodes on the side. With one
   * the area of each column of nodes behind the side, that of its nodes on the side, is distributed
   * over the nodes of the column by the part of their volume within the depth of the layer. So each
   * column carries what it carries without a layer, to round-off, whatever the depth, and moments
   * of normal tractions about axes in the side stay; normalised for the side as a whole they would
   * not where columns end at a hole, as they do here, and nothing beyond it is pulled. The traction
   * is that at the column's node on the side. Collective.
   */
  template <int dim>
  std::vector<TractionShare<dim>> traction_shares(const Nodes<dim>              &nodes,
                                                  const BoundaryConditions<dim> &conditions);
} // namespace PeriDeal
