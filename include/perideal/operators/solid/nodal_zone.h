// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/solid/node_laws.h>
#include <perideal/operators/solid/relaxing_families.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * The nodes of correspondence that a coupling blends with finite elements, where their law is not
   * linear or relaxes, so that no matrix has their families: the forces are those of
   * Correspondence, each energy by its share (NodeFamilies::share_of()). Nodes whose family does
   * not reach the zone store no bonds.
   *
   * Displacements need no ghosts, and keep those they have. All functions are collective unless
   * stated.
   */
  template <int dim>
  class NodalZone
  {
  public:
    /** Both have to outlive this object. Throws UserError as Correspondence does. */
    NodalZone(const Coupling<dim> &coupling, const BodyParameters<dim> &body);

    /** Add K x of the tangent at the last linearize(). */
    void add_product(Vector &y, const Vector &x) const;

    /** Add -F at u and time t. */
    void add_forces(Vector &y, const Vector &u, const double t) const;

    double energy(const Vector &u) const;

    /** As FamilyForces::accept(). */
    double accept(const Vector &u, const double t);

    void linearize(const Vector &u);

    /** As NodeStresses. Collective. */
    bool have_symmetric_tangents() const
    {
      return nodal->stresses.have_symmetric_tangents();
    }

    void exchange(Archive &archive, const NodeKeys &keys)
    {
      by_family->exchange(archive, keys);
    }

    /** Of K before anything has happened. */
    void add_diagonal(Vector &diagonal) const;

    /** Add to bounds of the rows of that K. */
    void add_row_sums(std::vector<double> &sums) const;

    /** Of this process, those with other processes counted half. Not collective. */
    double n_bonds() const
    {
      return n_in_zone;
    }

    /** Not collective. */
    std::size_t memory_consumption() const
    {
      return laws.memory_consumption() + rows.memory_consumption() +
             by_family->memory_consumption() + found.memory_consumption();
    }

  private:
    /** Owned nodes in whose family a node has a share. */
    static std::vector<bool> reaching(const Coupling<dim> &coupling);

    NodeLaws<dim>       laws;
    const BondEnds<dim> ends;
    BondTable<dim>      rows;

    std::unique_ptr<FamilyForces<dim>> by_family;
    Correspondence<dim>               *nodal;

    double         n_in_zone = 0.;
    mutable Vector found; // memory
  };
} // namespace PeriDeal
