// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/crack_set.h>
#include <perideal/bonds/kernel_weights.h>
#include <perideal/bonds/neighbors.h>
#include <perideal/scene/body_parameters.h>

#include <functional>
#include <vector>

namespace PeriDeal
{
  /** The weights of a body's bonds between its nodes, before calibration off the lattice. */
  template <int dim>
  KernelWeights<dim> kernel_weights(const Nodes<dim> &nodes, const BodyParameters<dim> &body);

  /** How far the halo of a body's families has to reach. */
  template <int dim>
  double halo_reach(const Nodes<dim>          &nodes,
                    const BodyParameters<dim> &body,
                    const KernelWeights<dim>  &weights);


  /**
   * The families of the nodes: who is bonded to whom, with which weight, and which bonds the
   * current cracks cut. Diffusion and elasticity have them in common; neither knows the other's
   * material.
   */
  template <int dim>
  class Families
  {
  public:
    struct Member
    {
      unsigned int neighbor;
      double       weight; // V_i V_j w(xi)
      double       kept;   // what cracks leave of it, 0 to 1
    };

    /** Whether the node at a place has bonds at all, now or later. */
    using HasBonds = std::function<bool(const dealii::Point<dim> &)>;

    /**
     * Adds the halo to the nodes. Collective. Throws UserError for empty families and isolated
     * nodes.
     * @param has_bonds all nodes if empty. Off the lattice discrete calibration is the mean over
     *                  these, and no other has to have neighbours.
     */
    Families(Nodes<dim>                &nodes,
             const BodyParameters<dim> &body,
             const HaloAround           halo      = HaloAround::nodes,
             const HasBonds            &has_bonds = {});

    // Its parts refer to each other.
    Families(const Families &)            = delete;
    Families &operator=(const Families &) = delete;

    /** The family of any node known here, in its fixed order. @p members is overwritten. */
    void members_of(const unsigned int node, std::vector<Member> &members) const;

    /** A crack that is cut into the mesh lies between two nodes. */
    bool is_parted(const unsigned int node, const unsigned int neighbor) const;

    /** Some bond of this node may cross a crack. */
    bool near_crack(const unsigned int node) const;

    const Nodes<dim>     &nodes() const;
    const Neighbors<dim> &neighbors() const
    {
      return topology;
    }
    const KernelWeights<dim> &weights() const
    {
      return of_bonds;
    }

    /** The cracks as they are now. */
    const CrackSet<dim> &cracks() const
    {
      return crack_set;
    }
    CrackSet<dim> &cracks();

    std::size_t memory_consumption() const;

  private:
    void calibrate(const HasBonds &has_bonds);

    // Each refers to those above it.
    KernelWeights<dim> of_bonds;
    Neighbors<dim>     topology;

    std::unique_ptr<const BodyVoids<dim>> voids; // that bonds must not cross, if any

    CrackSet<dim> crack_set;
  };
} // namespace PeriDeal
