// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/nodes.h>
#include <perideal/operators/solid/solid_contact.h>

#include <functional>
#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * Contact of bodies and fragments wherever they go: nodes without a bond between them repel each
   * other in the deformed body, as in Silling and Askari (2005), Comput. Struct. 83. With r their
   * distance there, xi that in the undeformed body and h the spacing,
   *
   *   energy k (d - r)^2/2 where r < d,   d = min(0.9 |xi|, 1.35 h),
   *
   * k the smaller one of both nodes' stiffnesses, h the mean of both. Forces are central: momentum
   * and angular momentum are conserved.
   *
   * Asked are nodes at the body's boundary and those that have lost a bond. Of two nodes that have
   * all of their bonds no pair is taken that have a neighbour in common, in the undeformed body: a
   * convex body that is whole feels nothing until it is pressed to 0.4 of its size (horizon 2 h).
   *
   * Pairs up to a skin beyond d are found anew when some node has moved by half of that. Forces are
   * sums over those nearer than d in the order of places, and do not depend on when that was: the
   * same digits on any number of processes, and for a body that is loaded.
   */
  template <int dim>
  class ShortRangeContact : public SolidContact
  {
  public:
    /**
     * The neighbours, by local number, to which an owned node has bonds now; returns whether these
     * are all of its family.
     */
    using BondsOf = std::function<bool(const unsigned int, std::vector<unsigned int> &)>;

    /**
     * @param nodes       with their halo; they have to outlive this object
     * @param horizon     no family reaches farther
     * @param stiffnesses of the owned nodes. Collective.
     */
    ShortRangeContact(const Nodes<dim>          &nodes,
                      const double               horizon,
                      const BondsOf             &bonds_of,
                      const std::vector<double> &stiffnesses);

    /**
     * To be called before anything else is asked for at u. Energy is gained where nodes have come
     * to be asked between others, by bonds that they have lost. Returns whether nodes were nearer
     * than d at the last add_forces(): what touches may change with any u then.
     */
    bool   update(const Vector &u, double &gained) override;
    double change(const std::vector<unsigned int> &of_nodes, const Vector &u) override;
    void   renew() override
    {
      is_found = false;
    }

    void        linearize(const Vector &u) override;
    void        add_tangent(Vector &y, const Vector &x) const override;
    double      row_bound(const unsigned int node) const override;
    double      energy(const Vector &u) const override;
    std::size_t memory_consumption() const override;

  protected:
    void find_forces(const Vector &u) const override;

  private:
    /** Of an owned node. */
    struct Own
    {
      double stiffness, spacing;
      bool   is_asked = false, is_whole = false;
    };

    /** What a node is known by to all processes; see flattened(). */
    struct Place
    {
      dealii::types::global_dof_index number;
      double                          spacing, stiffness;
      bool                            is_whole; // it has all bonds of its family
      dealii::Point<dim>              undeformed, now;
    };

    struct Partner
    {
      unsigned int           node; // in the layout of places
      double                 stiffness, distance;
      dealii::Tensor<1, dim> direction;   // of the tangent; zero: they do not touch
      double                 across = 0.; // of the tangent: force/r
    };

    struct Row
    {
      unsigned int         node;
      std::vector<Partner> partners;
    };

    void                                   find_asked();
    void                                   search(const Vector &u);
    std::vector<Place>                     gathered(const Vector &u) const;
    std::vector<std::vector<unsigned int>> pairs(const std::vector<Place> &places,
                                                 const std::size_t         first) const;
    bool                                   may_touch(const Place                     &a,
                                                     const Place                     &b,
                                                     const std::vector<unsigned int> &bonds_of_a) const;
    double                                 distance_of(const Place &a, const Place &b) const;
    double              farthest_move(const Vector &u, const std::vector<double> &since) const;
    std::vector<double> values_of_asked(const Vector &u) const;

    /** Call visit(row, partner, difference of both places or values) for all pairs of the rows. */
    template <typename Rows, typename Visit>
    void for_each_pair(Rows         &of,
                       const Vector &values,
                       const bool    deformed,
                       const Visit  &visit) const;

    const Nodes<dim>         &nodes;
    const double              horizon;
    const BondsOf             bonds_of;
    std::vector<Own>          own;                // of owned nodes
    std::vector<unsigned int> asked;              // of these
    std::vector<double>       at_search, at_loss; // u of these; the latter empty: none since
    std::vector<Row>          rows;               // in the order of nodes
    bool                      is_found = false, any_pairs = false;
    mutable bool              touch_here = false;      // of the owned nodes, at last
    double                    skin       = 0., finest; // smallest spacing of all
    mutable Vector            places; // of the nodes that touch, and their partners
  };
} // namespace PeriDeal
