// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The zone of a coupling as its breaking bonds see it: where they may break, which of them have,
   * and how it grows. Not collective.
   */
  template <int dim>
  class BreakableZone
  {
  public:
    /** A node known here, and the weight of peridynamics that it is to have at least. */
    struct Joining
    {
      unsigned int node;
      double       weight;
    };

    virtual ~BreakableZone() = default;

    virtual const Families<dim> &families_of_bonds() const = 0;

    /** What peridynamics has at a node known here: 0 outside of the zone, 1 where it is alone. */
    virtual double weight_of(const unsigned int node) const = 0;

    /**
     * Elements hold nothing together that a broken bond at this node, owned or a corner of an own
     * cell, parts.
     */
    virtual bool is_free(const unsigned int node) const = 0;

    /** Nor what the bond between an owned node and another one parts. */
    virtual bool may_break(const unsigned int node, const unsigned int neighbor) const = 0;

    /** The bond between two nodes known here has broken for good. */
    virtual void mark_broken(const unsigned int a, const unsigned int b)     = 0;
    virtual bool is_broken(const unsigned int a, const unsigned int b) const = 0;

    /** Add to a list the nodes that are to join where the body is about to break at a place. */
    virtual void find_joining(const dealii::Point<dim> &place,
                              std::vector<Joining>     &list) const = 0;

    virtual void join_nodes(const std::vector<Joining> &list) = 0;
  };
} // namespace PeriDeal
