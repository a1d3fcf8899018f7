// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_break.h>
#include <perideal/operators/coupling/breakable_zone.h>
#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/solid/bond_damage.h>
#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/operators/solid/stretched_cells.h>
#include <perideal/operators/solid/zone_bonds.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** A bond by the global numbers of its nodes, which ascend, and what it bears from now on. */
  struct DamagedBond
  {
    NodePair     pair;
    BondSoftness now;

    template <class BoostArchive>
    void serialize(BoostArchive &archive, const unsigned int)
    {
      archive &pair &now.reached &now.lost;
    }
  };


  /**
   * Bonds of a coupled solid that break for good or soften, and a zone that follows (`Zone =
   * follow`).
   *
   * A bond breaks or softens by its stretch (xi . (u_j - u_i))/x^2 - alpha dT, dT the mean of its
   * ends (DamageCriterion), where the zone lets it (BreakableZone::may_break()). In an exchange a
   * cell between whose vertices a bond has broken keeps nothing (BreakableZone::parts()); bonds
   * soften in a blending alone, in whose zone nothing is left of elements.
   *
   * The zone grows around the centre of a cell whose largest principal strain, thermal strain taken
   * off, has reached a share of the critical stretch (that at which bonds begin to soften), and
   * around the ends of broken bonds: in an exchange by the nodes within one horizon, in a blending
   * as FamilyZone says. All functions are
   * collective unless stated, and leave the same on all processes.
   */
  template <int dim>
  class ZoneBreaking : public BondDamage<dim>
  {
  public:
    using Joining = typename BreakableZone<dim>::Joining;

    /** Throws UserError for bodies whose bonds cannot break beside elements. Not collective. */
    static void require(const BodyParameters<dim> &body);

    /** Others have to outlive this object. Throws UserError: faults of the criterion. */
    ZoneBreaking(Coupling<dim>                    &coupling,
                 std::unique_ptr<ZoneBonds<dim>> &&of_zone,
                 const dealii::DoFHandler<dim>    &dofs,
                 const BodyParameters<dim>        &body);

    /**
     * Thermal strains of all nodes known here; empty: none. Not collective.
     * @param change ElasticOperator::temperature_change()
     */
    void set_thermal(std::vector<double> strains, const Vector &change)
    {
      thermal = std::move(strains);
      this->take_temperature_change(change);
      set_limits_of_cells();
    }

    const std::vector<double> &thermal_strains() const
    {
      return thermal;
    }

    /**
     * The bonds that are stretched too far at u, those with at least a share of the largest stretch
     * over critical stretch; of those that soften all whose stiffness changes. In ascending order
     * of their nodes. Ghosts of u are up to date.
     */
    std::vector<DamagedBond> find_overstretched(const Vector &u,
                                                const double  t,
                                                const double  share);

    /**
     * As ElasticOperator::stretch_over_critical(); cells that are stretched so much that bonds are
     * to appear there count by their largest principal strain.
     */
    double stretch_over_critical(const Vector &u, const double t);

    /** Of those that break the boxes around bonds between vertices of a cell, which is parted. */
    std::vector<dealii::BoundingBox<dim>> parted_by(const std::vector<DamagedBond> &list) const;

    /** The owned nodes whose forces change with them, ascending. Not collective. */
    std::vector<unsigned int> rows_of(const std::vector<DamagedBond> &list) const;

    /**
     * They break for good or soften at time t. Returns the owned nodes whose rows are to be set,
     * those of bonds that soften. Not collective.
     */
    std::vector<unsigned int> take(const std::vector<DamagedBond> &list, const double t);

    /**
     * Around what the zone is to grow at u, all or none of it in vain: centres of stretched cells
     * and ends of bonds that have broken since this was called last. Ghosts as above.
     */
    std::vector<dealii::Point<dim>> find_places_to_join(const Vector &u);

    /** As ElasticOperator::stretched_outside(). */
    std::pair<unsigned long long, std::string> stretched_outside(
      const Vector                  &u,
      const dealii::DoFHandler<dim> &dofs) const;

    /** Nodes known here that are to join around these places, ascending. Not collective. */
    std::vector<Joining> joining(const std::vector<dealii::Point<dim>> &places) const;

    std::vector<double> damage() const override;

    /** As ElasticOperator::broken_since(). Not collective. */
    std::vector<NodePair> broken_since(std::size_t &n_known) const;

    /** All that have broken, each on the process that owns its first node. Not collective. */
    std::vector<BondBreak> breaks() const
    {
      const auto            &layout = *nodes.partitioner();
      std::vector<BondBreak> list;
      for (const auto &[pair, time] : broken)
        if (layout.in_local_range(pair[0]))
          list.push_back({layout.global_to_local(pair[0]), layout.global_to_local(pair[1]), time});
      return list;
    }

    /** The zone is as it is when the latest preconditioner is made. Not collective. */
    void keep_zone();

    /**
     * What has broken, and the zone. Where a body is loaded, marks and zone are set; rows are left.
     * @param at_first to be called when it is as at the last keep_zone(), if that is another state
     */
    void exchange(Archive &archive, const NodeKeys &keys, const std::function<void()> &at_first);

    std::size_t memory_consumption() const;

  private:
    std::unique_ptr<ZoneBonds<dim>> own_bonds;

  public:
    ZoneBonds<dim> &bonds;

  private:
    using BondDamage<dim>::criterion;
    using BondDamage<dim>::so_far;
    using BondDamage<dim>::overstretched;

    static constexpr unsigned int n_corners = dealii::GeometryInfo<dim>::vertices_per_cell;

    struct Break
    {
      NodePair pair;
      double   time;
    };

    void add_tensions(CrackPaths<dim> &paths, const Vector &u) const;

    /** take(i, j, xi, measure) for the whole bonds that start at owned nodes. */
    template <typename Take>
    void visit_measures(const Vector &u, const Take &take) const;

    void find_cells(const dealii::DoFHandler<dim> &dofs);
    void set_limits_of_cells();
    /** The least stretch at which bonds of the corners may break, and the mean thermal strain. */
    std::pair<double, double> limit_of(const std::array<unsigned int, n_corners> &corners) const;
    /**
     * Thermal strain taken off, over the limit of the corners; 0 where its bound, the norm of the
     * strain, is not @p at_least so much.
     */
    double largest_strain(const std::array<unsigned int, n_corners> &corners,
                          const Vector                              &u,
                          const double                               at_least) const;

    /** Local number of a node, or none. */
    std::optional<unsigned int> known(const dealii::types::global_dof_index node) const;

    BreakableZone<dim> &zone;
    const Nodes<dim>   &nodes;
    const double        share_of_zone; // 0: the zone stays
    std::vector<double> thermal;
    StretchedCells<dim> cells;          // whose centres have lit nothing yet
    std::vector<Break>  broken;         // in the order of breaking
    std::size_t         n_followed = 0; // of those, by the zone
    /** Of keep_zone(). */
    struct
    {
      std::vector<double> weights; // of owned nodes
      std::size_t         n_broken = 0;
    } kept_zone;
  };
} // namespace PeriDeal
