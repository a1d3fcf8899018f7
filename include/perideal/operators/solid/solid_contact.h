// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/types.h>

#include <functional>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What nodes do to each other across what is parted, and between bodies. This class is the
   * contact of a solid whose parts pass through each other.
   *
   * What may touch at a u is found by update() and stays until the next one. Functions that take
   * displacements are collective, whatever their ghosts are, and leave these as they were.
   */
  class SolidContact
  {
  public:
    virtual ~SolidContact() = default;

    /**
     * Find what touches at u. Returns whether energy may not be kept: what touches has changed.
     * @param gained energy that contact has got by being found at this u
     */
    virtual bool update(const Vector & /*u*/, double &gained)
    {
      gained = 0.;
      return false;
    }

    /**
     * These owned nodes, in ascending order, have lost or got bonds at u. Returns the energy that
     * contact has released by it.
     */
    virtual double change(const std::vector<unsigned int> & /*of_nodes*/, const Vector & /*u*/)
    {
      return 0.;
    }

    /** Bonds of any nodes are others: cracks have grown, or a body is loaded. Collective. */
    virtual void renew() {}

    /** There are thermal strains at nodes, or none (empty). Not collective. */
    virtual void set_strains(const std::function<double(const unsigned int)> & /*strain_at*/) {}

    /** y += a multiple of -F(u), F the forces on nodes. */
    void add_forces(Vector &y, const Vector &u, const double multiple) const
    {
      find_forces(u);
      add_last_forces(y, multiple);
    }

    /** Add a multiple of what add_forces() gave at last, since update(). Not collective. */
    void add_last_forces(Vector &y, const double multiple) const
    {
      for (const auto &[unknown, force] : forces)
        y.local_element(unknown) += multiple * force;
    }

    /** Make add_tangent() that at u, where it is not the same at any u. */
    virtual void linearize(const Vector & /*u*/) {}

    /** y += K x. */
    virtual void add_tangent(Vector & /*y*/, const Vector & /*x*/) const {}

    /**
     * At least the sum of the norms of the blocks that an owned node has of K, beyond those of the
     * bonds that it has lost. Not collective.
     */
    virtual double row_bound(const unsigned int /*node*/) const
    {
      return 0.;
    }

    virtual double energy(const Vector & /*u*/) const
    {
      return 0.;
    }

    /** What has to be known besides the bonds. Collective. */
    virtual void exchange(Archive & /*archive*/, const NodeKeys & /*keys*/) {}

    virtual std::size_t memory_consumption() const
    {
      return 0;
    }

    /** Called with local unknowns of a row and a column, and what is added there. */
    using EntryAction =
      std::function<void(const unsigned int row, const unsigned int column, const double value)>;

    /**
     * Entries of springs about as stiff as K, for a preconditioner; some are in rows of other
     * processes. Not collective.
     * @param anew of what touches now, else of what did so when this was asked last
     */
    virtual void add_to_surrogate(const EntryAction & /*add*/, const bool /*anew*/) {}

  protected:
    /** Set the forces to -F(u). */
    virtual void find_forces(const Vector & /*u*/) const {}

    mutable std::vector<std::pair<unsigned int, double>> forces; // by owned unknowns; at last
  };
} // namespace PeriDeal
