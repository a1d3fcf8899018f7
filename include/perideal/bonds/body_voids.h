// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/kernel_weights.h>
#include <perideal/mesh/nodes.h>
#include <perideal/scene/body_parameters.h>

#include <memory>

namespace PeriDeal
{
  /**
   * Which straight ways between two nodes leave the body: through holes, notches, empty parts of an
   * image, or past a reentrant side. No bond exists there. What only touches the boundary, runs
   * along it, or is a chord of a rim on meshes, stays in the body.
   */
  template <int dim>
  class BodyVoids
  {
  public:
    virtual ~BodyVoids() = default;

    /** Whether some way of that length from a node known here may leave the body. */
    virtual bool is_near(const unsigned int node, const double distance) const = 0;

    /**
     * Whether the way between two nodes, on meshes of at most two reaches, leaves it or leads from
     * one piece of a mesh to another that only touches it. The same in both directions.
     */
    virtual bool between(const unsigned int node, const unsigned int neighbor) const = 0;

    /**
     * On a lattice: whether the way from a node to a site beyond flat sides leaves the body and its
     * mirror images there.
     */
    virtual bool before_site(const unsigned int /*node*/,
                             const typename Lattice<dim>::Index & /*site*/) const
    {
      return false;
    }
  };


  /**
   * For a body whose bonds are to be cut there; nullptr for one that has no such ways, and with
   * `Bonds across voids = keep`. On lattices cells that do not exist are looked for, on other
   * meshes faces on the boundary, but for cracks that are cut into the mesh. Nodes, body and
   * weights have to outlive it, and the nodes have their halo. Collective.
   */
  template <int dim>
  std::unique_ptr<BodyVoids<dim>> make_body_voids(const Nodes<dim>          &nodes,
                                                  const BodyParameters<dim> &body,
                                                  const KernelWeights<dim>  &weights);
} // namespace PeriDeal
