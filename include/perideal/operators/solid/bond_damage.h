// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <perideal/base/types.h>
#include <perideal/bonds/bond_state.h>
#include <perideal/operators/solid/break_history.h>
#include <perideal/operators/solid/damage_criterion.h>
#include <perideal/scene/body_parameters.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * What breaks of a solid's bonds, wherever they stand (BondBreaking, ZoneBreaking): those beyond
   * a DamageCriterion with at least a share of the largest measure over its limit; where the first
   * ones were, and what all have released.
   */
  template <int dim>
  class BondDamage
  {
  public:
    virtual ~BondDamage() = default;

    /** What has broken so far; null: bonds do not break. */
    const BreakHistory *history() const
    {
      return criterion ? &so_far : nullptr;
    }

    bool any_broken() const
    {
      return so_far.n_broken > 0;
    }

    /** Energy that bonds which broke, or what they held, have released. */
    void add_released(const double energy)
    {
      so_far.released += energy;
    }

    /** Of the owned nodes and their ghosts; empty where bonds do not break. */
    const std::vector<double> &critical_stretches() const
    {
      static const std::vector<double> none;
      return criterion ? criterion->of_nodes() : none;
    }

    std::string name_of_limit() const
    {
      return criterion ? criterion->name_of_limit() : "";
    }

    /**
     * Temperatures are by so much above the reference, at owned nodes and ghosts; empty: they are
     * those of the scene.
     */
    void take_temperature_change(const Vector &change)
    {
      if (!knows_temperature || change.size() == 0)
        return;
      temperatures.resize(families.nodes().n_local());
      for (unsigned int i = 0; i < temperatures.size(); ++i)
        temperatures[i] = body.elasticity.reference_temperature + change.local_element(i);
    }

    /**
     * The volume of neighbours over broken bonds over that of the whole family, at the owned nodes;
     * bonds that cracks of the scene cut count as broken. Not collective.
     */
    virtual std::vector<double> damage() const = 0;

    /** Of the owned nodes and their ghosts. Collective. */
    std::vector<double> damage_with_ghosts() const;

  protected:
    /** A bond beyond its limit, at an owned node. */
    struct Overstretched
    {
      std::size_t  number; // of who asks
      unsigned int node, neighbor;
      unsigned int n_ends;         // so many are counted here
      double       ratio;          // of its measure to the limit
      double       integrity = 0.; // what it bears from now on (DamageCriterion)
    };

    /**
     * All have to outlive this object. Collective. Throws UserError.
     * @param crossing_energy as in BreakableBonds
     */
    BondDamage(const Families<dim>                          &families,
               const BodyParameters<dim>                    &body,
               std::function<CrossingEnergy(unsigned int)> &&crossing_energy);

    /**
     * Add a bond that softens to BondDamage::overstretched where what it bears changes: one that
     * is stretched farther than ever bears less; one that has softened bears all when it is
     * pressed, and what it did when it is pulled again.
     *
     * @param bond its integrity is set here @param other the neighbour or the origin of its image
     */
    void judge_softening(Overstretched       bond,
                         const unsigned int  other,
                         const double        length,
                         const BondSoftness &state);

    /**
     * Leave what breaks now in BondDamage::overstretched, and keep the places. Returns whether
     * there is any on any process. Collective.
     */
    bool select(const double share);

    /**
     * Leave all bonds beyond their limits in BondDamage::overstretched. Ways of cracks are turned
     * first where there are some. Collective.
     *
     * @param find adds those of this process @param add_tensions of whole bonds to CrackPaths
     */
    template <typename Find, typename AddTensions>
    void find_all(const Find &find, const AddTensions &add_tensions)
    {
      overstretched.clear();
      find();
      const double any = overstretched.empty() ? 0. : 1.;
      if (!criterion->paths() ||
          dealii::Utilities::MPI::max(any, families.nodes().communicator()) == 0.)
        return;
      turn_paths(add_tensions);
      overstretched.clear();
      find();
    }

    /** What has broken and the ways of cracks. Collective. */
    void exchange_history(Archive &archive)
    {
      so_far.exchange(archive);
      if (criterion && criterion->paths())
        criterion->paths()->exchange(archive);
    }

    /** Ways of cracks, if there are any, look across the tension. Collective. */
    template <typename AddTensions>
    void turn_paths(const AddTensions &add_tensions)
    {
      CrackPaths<dim> *const paths = criterion->paths();
      if (!paths)
        return;
      paths->begin();
      add_tensions(*paths);
      paths->turn(families.nodes().communicator());
    }

    const Families<dim>                  &families;
    const BodyParameters<dim>            &body;
    const bool                            knows_temperature; // limits depend on T
    std::vector<double>                   temperatures; // of owned nodes and ghosts; empty: none
    std::unique_ptr<DamageCriterion<dim>> criterion;    // null: nothing breaks
    BreakHistory                          so_far;
    std::vector<Overstretched>            overstretched;
    std::vector<unsigned int>             loaded_side; // SolidLoads::sides_nearby(); empty: none

  private:
    void lead_paths_on();
    void keep_places(const double most);
  };
} // namespace PeriDeal
