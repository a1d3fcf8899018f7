// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/fictitious_nodes.h>
#include <perideal/bonds/halo.h>
#include <perideal/bonds/kernel_weights.h>
#include <perideal/mesh/nodes.h>

#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Who is within the reach of whom: topology and halo. No material, no cracks; of weights only
   * that of a bond of unit conductivity between intact places. The search for nodes is that of the
   * nodes, the same for all who have bonds on them; fictitious nodes are those of one physics.
   *
   * Neighbours are numbered like the nodes: owned, ghosts, then fictitious nodes from n_local() on.
   * The order of a family is that of the lattice offsets (or of the relative positions), never of
   * local numbers, so that sums come out the same on any number of processes.
   */
  template <int dim>
  class Neighbors
  {
  public:
    using Index = typename Lattice<dim>::Index;

    /**
     * Adds the halo to the nodes unless they have it. Collective. Nodes and weights have to outlive
     * this object.
     * @param halo that is needed, at least the reach of the weights
     */
    Neighbors(Nodes<dim> &nodes, const KernelWeights<dim> &weights, const HaloNeed &halo);

    /** Fictitious nodes, once, before the first visit. Only with unique sites. */
    void add_outside(std::vector<FictitiousNode<dim>> nodes);

    /**
     * Visit (neighbour, w) of any node known here, w > 0, in the fixed order: on a lattice that of
     * the members, at a site the real node before fictitious ones; else that of relative positions,
     * and without the node itself and its twin across a crack.
     */
    template <typename Visit>
    void for_each(const unsigned int node, const Visit &visit) const;

    /** On a lattice only those one spacing away along an axis. */
    template <typename Visit>
    void for_each_nearest(const unsigned int node, const Visit &visit) const;

    /**
     * Off the lattice: the nodes within a distance of a point, unordered, with squared distances.
     * @p found is overwritten.
     */
    void within(const dealii::Point<dim>                     &p,
                const double                                  distance,
                std::vector<std::pair<unsigned int, double>> &found) const;

    /** Relative position of a neighbour. */
    dealii::Tensor<1, dim> bond_vector(const unsigned int node, const unsigned int neighbor) const;

    dealii::Point<dim> position(const unsigned int node) const;
    double             volume(const unsigned int node) const;

    /** The node itself, or the mirror of a fictitious one. */
    unsigned int real(const unsigned int node) const;
    bool         is_real(const unsigned int node) const;

    /**
     * Local number of the real node at a lattice site, or numbers::invalid_unsigned_int. Only
     * without doubled nodes.
     */
    unsigned int node_at(const Index &site) const;

    /** The nodes lie on a lattice, one per site. */
    bool has_unique_sites() const;

    /** Owned nodes within a distance of some box, in ascending order. */
    std::vector<unsigned int> nodes_near(const std::vector<dealii::BoundingBox<dim>> &boxes,
                                         const double distance) const;

    const Nodes<dim> &nodes() const
    {
      return own_nodes;
    }
    const std::vector<FictitiousNode<dim>> &outside() const
    {
      return beyond;
    }
    const KernelWeights<dim> &weights() const
    {
      return of_bonds;
    }

    std::size_t memory_consumption() const;

  private:
    template <typename Visit>
    void visit_sites(const unsigned int                    node,
                     const std::vector<FamilyMember<dim>> &offsets,
                     const Visit                          &visit) const;

    /** Off the lattice. */
    std::vector<std::pair<unsigned int, double>> family_of(const unsigned int node) const;

    const Nodes<dim>                                          &own_nodes;
    const KernelWeights<dim>                                  &of_bonds;
    std::shared_ptr<const NodeSearch<dim>>                     search;
    std::vector<FictitiousNode<dim>>                           beyond;
    std::unordered_map<std::size_t, std::vector<unsigned int>> outside_of_site;
  };


  template <int dim>
  template <typename Visit>
  void Neighbors<dim>::for_each(const unsigned int node, const Visit &visit) const
  {
    if (has_unique_sites())
      visit_sites(node, of_bonds.members(), visit);
    else
      for (const auto &[neighbor, w] : family_of(node))
        visit(neighbor, w);
  }


  template <int dim>
  template <typename Visit>
  void Neighbors<dim>::for_each_nearest(const unsigned int node, const Visit &visit) const
  {
    if (has_unique_sites())
      visit_sites(node, of_bonds.nearest_members(), visit);
    else
      for_each(node, visit);
  }


  template <int dim>
  template <typename Visit>
  void Neighbors<dim>::visit_sites(const unsigned int                    node,
                                   const std::vector<FamilyMember<dim>> &offsets,
                                   const Visit                          &visit) const
  {
    const Index site = own_nodes.lattice()->index(own_nodes.position(node));
    for (const FamilyMember<dim> &member : offsets)
      {
        Index other = site;
        for (unsigned int d = 0; d < dim; ++d)
          other[d] += member.offset[d];
        const std::size_t  key  = search->key(other);
        const unsigned int real = (*search)[key];
        if (real != dealii::numbers::invalid_unsigned_int)
          visit(real, member.weight);
        if (!beyond.empty())
          if (const auto found = outside_of_site.find(key); found != outside_of_site.end())
            for (const unsigned int neighbor : found->second)
              visit(neighbor, member.weight);
      }
  }


  template <int dim>
  inline bool Neighbors<dim>::is_real(const unsigned int node) const
  {
    return node < own_nodes.n_local();
  }


  template <int dim>
  inline dealii::Point<dim> Neighbors<dim>::position(const unsigned int node) const
  {
    return is_real(node) ? own_nodes.position(node) :
                           own_nodes.lattice()->position(beyond[node - own_nodes.n_local()].site);
  }


  template <int dim>
  inline dealii::Tensor<1, dim> Neighbors<dim>::bond_vector(const unsigned int node,
                                                            const unsigned int neighbor) const
  {
    return position(neighbor) - position(node);
  }


  template <int dim>
  inline double Neighbors<dim>::volume(const unsigned int node) const
  {
    return is_real(node) ? own_nodes.volume(node) : beyond[node - own_nodes.n_local()].volume;
  }


  template <int dim>
  inline unsigned int Neighbors<dim>::real(const unsigned int node) const
  {
    return is_real(node) ? node : beyond[node - own_nodes.n_local()].mirror;
  }

} // namespace PeriDeal
