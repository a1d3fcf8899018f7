// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

#include <perideal/base/types.h>
#include <perideal/operators/parts/node_subset.h>

#include <functional>
#include <vector>

namespace PeriDeal
{
  /** A bond of a family, as contact sees it. */
  template <int dim>
  struct FacingBond
  {
    unsigned int           neighbor; // local number
    dealii::Tensor<1, dim> xi;
    double                 stiffness; // k of the half k e^2/2 of its energy, e its extension
    bool                   is_lost;
  };


  /**
   * Normals of the faces of cracks at nodes that have lost bonds, towards the other side. With k
   * the stiffness of bond xi,
   *
   *   p_i = sum over lost bonds of k xi less their share of that over all,
   *   n_i the eigenvector of the largest eigenvalue of sum over the family of p p/|p|^2, along p_i.
   *
   * p is normal to a plane crack; where a crack follows the rows of the lattice its directions at
   * single nodes are off by ten or twenty degrees, which the mean over a family smooths. No normal
   * is known where bonds are lost in many directions, as in fragments and where cracks meet.
   */
  template <int dim>
  class CrackNormals
  {
  public:
    using Layout = NodeSubset::Layout;

    /**
     * The bonds of an owned node, whole ones included, in the order of all processes; none at all
     * if none is lost.
     */
    using FamilyOf = std::function<void(const unsigned int, std::vector<FacingBond<dim>> &)>;

    /** @param nodes layout; ghosts are all neighbours */
    CrackNormals(const FamilyOf &family_of, const Layout &nodes);

    /**
     * Renew normals where these owned nodes have lost or got bonds. Returns the owned nodes whose
     * normals may have changed, in ascending order. Where some are whole again all nodes have to be
     * renewed. Collective.
     */
    std::vector<unsigned int> renew(const std::vector<unsigned int> &of_nodes);

    /** Nodes that have lost bonds, or had. */
    const NodeSubset &parted() const
    {
      return nodes;
    }

    /** Of the node at a place of parted(); ghosts are known, too. Zero where there is none. */
    dealii::Tensor<1, dim> normal(const unsigned int place) const;

    std::size_t memory_consumption() const;

  private:
    void                      find_lost(const std::vector<unsigned int> &of_nodes);
    std::vector<unsigned int> beside(const std::vector<unsigned int> &of_nodes) const;
    dealii::Tensor<1, dim>    smoothed(const unsigned int place) const;

    const FamilyOf                         family_of;
    NodeSubset                             nodes;
    Vector                                 directions, normals; // p/|p|, n
    std::vector<std::vector<unsigned int>> neighbors; // by place; none: all bonds are whole
    std::vector<FacingBond<dim>>           family;    // of the node that is looked at
  };
} // namespace PeriDeal
