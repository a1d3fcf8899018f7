// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_strengths.h>
#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/operators/solid/solid_bonds.h>
#include <perideal/operators/solid/solid_loads.h>
#include <perideal/operators/solid/stretch_screen.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Bonds that break for good at a stretch e/x of the smallest critical value s of the materials on
   * their way (BondStrengths). It is given, or follows from the fracture energy: what crosses a
   * plane of the lattice, mean over the axes n, has stored, at this stretch while all else is at
   * rest, s^2 (b B + c d D) with
   *   B = 1/q sum over half the family of omega f V xi_n x^2,
   *   D = h_n sum over the layers on one side of (1/q sum over what crosses of omega f V x^2)^2.
   * q stays that of the body before.
   *
   * Which bonds are broken, and since when, stands in BondTable.
   */
  template <int dim>
  class BondBreaking
  {
  public:
    /** Bonds and scene have to outlive this object. Collective. Throws UserError. */
    BondBreaking(SolidBonds<dim>           &bonds,
                 const SolidLoads<dim>     &loads,
                 const BodyParameters<dim> &body);

    /**
     * Break what is stretched too far at u: of bonds inside the body and beyond its sides those
     * with at least a share of the largest stretch over critical stretch. Returns what has changed,
     * or nothing if there were none on any process. Collective.
     *
     * @param t      the time of u, kept with each bond
     * @param energy of the body as it is, or of nodes_at_work() alone; collective
     */
    std::optional<ChangeSet<dim>> break_bonds(const Vector                  &u,
                                              const double                   t,
                                              const double                   share,
                                              const std::function<double()> &energy);

    /** The owned nodes that lose a bond in this break_bonds(), or have done so in the last one. */
    const std::vector<unsigned int> &nodes_at_work() const
    {
      return losing;
    }

    /** As ElasticOperator::stretch_over_critical(). Collective. */
    double stretch_over_critical(const Vector &u);

    typename BondTable<dim>::Count n_marks() const
    {
      return {bonds.rows.body.state.n_marks(), bonds.rows.beyond.state.n_marks()};
    }

    /** Energy that what the bonds held has released beside. */
    void add_released(const double energy)
    {
      so_far.released += energy;
    }

    /**
     * What has broken or been cut, and since when. Collective.
     *
     * @param keys    of the owned nodes
     * @param n_first an earlier n_marks(), which is archived
     * @param at_first what is to be done to a body that is loaded as it was then, if it is another
     *                 now
     */
    void exchange(Archive                        &archive,
                  const NodeKeys                 &keys,
                  typename BondTable<dim>::Count &n_first,
                  const std::function<void()>    &at_first);

    /** As ElasticOperator::broken_since(). */
    std::vector<NodePair> broken_since(std::size_t &n_known) const;

    /** What has broken so far; null: bonds do not break. */
    const BreakHistory *history() const
    {
      return breaks ? &so_far : nullptr;
    }

    /** Of the owned nodes and their ghosts; empty where bonds do not break. */
    const std::vector<double> &critical_stretches() const
    {
      return critical.of_nodes();
    }

    /**
     * The fracture energy that the critical stretch of the first node here means on its lattice,
     * s^2 b B and the share of the dilatations, and with the B of the integral over a ball in place
     * of that of the lattice. Not collective.
     */
    std::pair<double, double> energies_of_first() const;

    /**
     * 1 - the volume of neighbours over unbroken bonds over that of the whole family, at the owned
     * nodes; bonds that cracks of the scene cut count as broken, those that voids cut as none.
     */
    std::vector<double> damage() const;

    /** BondForces::damage, for laws that know it, is that of the bonds as they are. Collective. */
    void tell_damage();

    std::size_t memory_consumption() const
    {
      return critical.memory_consumption() + loaded_side.capacity() * sizeof(unsigned int) +
             (screen ? screen->memory_consumption() : 0);
    }

  private:
    void                      find_critical_stretches();
    void                      watch_limits(); // of full kinematics
    std::pair<double, double> stretch_and_limit(const double         *u,
                                                const unsigned int    i,
                                                const SolidBond<dim> &bond) const; // times W x^2
    void                      find_inside(const double *u);
    void                      find_beyond(const double *u);
    void                      find_overstretched(const Vector &u, const double share);
    void                      find_losing();
    void                      keep_places(); // of what is overstretched
    void                      break_dependent(const unsigned int node, const double t);

    /** Returns the number of ends of bonds. */
    unsigned long long break_overstretched(const double t);

    SolidBonds<dim>           &bonds;
    const BodyParameters<dim> &body;
    const bool                 breaks, changes; // some bond may break, or be cut by a growing crack
    BondStrengths<dim>         critical;
    BreakHistory               so_far;
    std::vector<unsigned int>  loaded_side; // which in `Traction` is within a horizon of these
    // What is to break next: numbers of bonds, and how far each is stretched over the critical
    // stretch; and the nodes that lose them, in ascending order.
    std::vector<std::pair<std::size_t, double>> overstretched;
    std::vector<unsigned int>                   losing;
    std::unique_ptr<StretchScreen<dim>>         screen; // null: all bonds are looked at
  };
} // namespace PeriDeal
