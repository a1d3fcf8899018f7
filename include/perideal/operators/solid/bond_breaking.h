// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_damage.h>
#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/operators/solid/solid_bonds.h>
#include <perideal/operators/solid/solid_loads.h>
#include <perideal/operators/solid/stretch_rates.h>
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
   * Bonds of peridynamics alone that break for good (DamageCriterion). What crosses a plane of the
   * lattice, mean over the axes n, has stored, at a stretch s of all of it while all else is at
   * rest, s^2 (b B + c d D) with
   *   B = 1/q sum over half the family of omega f V xi_n x^2,
   *   D = h_n sum over the layers on one side of (1/q sum over what crosses of omega f V x^2)^2.
   * q stays that of the body before.
   *
   * Which bonds are broken, and since when, stands in BondTable.
   */
  template <int dim>
  class BondBreaking : public BondDamage<dim>
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

    /** How many bonds the last break_bonds() that found any has changed, of all processes. */
    unsigned long long n_last() const
    {
      return n_changed;
    }

    /** Bonds soften: the largest part of the fracture energy that they store before; else 0. */
    double stored_at_onset() const
    {
      return criterion ? criterion->stored_at_onset() : 0.;
    }

    /** The owned nodes that lose a bond in this break_bonds(), or have done so in the last one. */
    const std::vector<unsigned int> &nodes_at_work() const
    {
      return losing;
    }

    /** As ElasticOperator::stretch_over_critical(). Collective. */
    double stretch_over_critical(const Vector &u, const double t);

    typename BondTable<dim>::Count n_marks() const
    {
      return {bonds.rows.body.state.n_marks(), bonds.rows.beyond.state.n_marks()};
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

    /**
     * The fracture energy that the critical stretch of the first node here means on its lattice,
     * s^2 b B and the share of the dilatations, and with the B of the integral over a ball in place
     * of that of the lattice. Not collective.
     */
    std::pair<double, double> energies_of_first() const;

    /** Bonds that voids cut are none. */
    std::vector<double> damage() const override;

    /** BondForces::damage, for laws that know it, is that of the bonds as they are. Collective. */
    void tell_damage();

    std::size_t memory_consumption() const
    {
      return (criterion ? criterion->memory_consumption() : 0) +
             loaded_side.capacity() * sizeof(unsigned int) +
             (rates ? rates->memory_consumption() : 0) +
             (screen ? screen->memory_consumption() : 0);
    }

  private:
    using typename BondDamage<dim>::Overstretched;
    using BondDamage<dim>::criterion;
    using BondDamage<dim>::so_far;
    using BondDamage<dim>::overstretched;
    using BondDamage<dim>::loaded_side;

    void        add_tensions(CrackPaths<dim> &paths, const double *u) const;
    void        watch_limits();                               // of full kinematics
    void        follow_body(const Vector &u, const double t); // of the criterion
    BondMeasure measure(const double         *u,
                        const unsigned int    i,
                        const SolidBond<dim> &bond) const; // e times W x
    void        judge(const double *u, const unsigned int i, const SolidBond<dim> &bond);
    double      left_of(const unsigned int node, const std::size_t number) const;
    void        take_softness();
    void        soften_dependent(const unsigned int node);
    void        find_inside(const double *u);
    void        find_beyond(const double *u);
    void        break_dependent(const unsigned int node, const double t);

    SolidBonds<dim>                    &bonds;
    const bool                          changes; // some bond may break, or a growing crack cut it
    unsigned long long                  n_changed = 0;
    std::vector<unsigned int>           losing;   // bonds, in ascending order
    std::vector<unsigned int>           softened; // nodes with bonds that are, ascending
    std::unique_ptr<StretchScreen<dim>> screen;   // null: all bonds are looked at
    std::unique_ptr<StretchRates<dim>>  rates;    // null: no limit depends on them
  };
} // namespace PeriDeal
