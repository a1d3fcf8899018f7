// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/point_order.h>
#include <perideal/operators/solid/bond_damage.h>
#include <perideal/operators/solid/bond_energies.h>
#include <perideal/operators/solid/bond_strengths.h>
#include <perideal/operators/solid/mean_tension_criterion.h>
#include <perideal/operators/solid/softening_strengths.h>
#include <perideal/operators/solid/stress_criterion.h>
#include <perideal/operators/solid/unbreakable_ends.h>

#include <algorithm>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The one list of criteria, each by its entries; null: no bonds break. */
    template <int dim>
    std::unique_ptr<DamageCriterion<dim>> breakable_criterion(const BreakableBonds<dim> &bonds,
                                                              const BodyParameters<dim> &body)
    {
      if (bonds.material.law.softens())
        return std::make_unique<SofteningStrengths<dim>>(bonds);
      if (bonds.material.breaks() && body.elasticity.text("Crack direction") == "mean tension")
        return std::make_unique<MeanTensionCriterion<dim>>(bonds, body.cracks.cracks);
      if (bonds.material.breaks() && bonds.material.law.breaking.by_stress())
        return std::make_unique<StressCriterion<dim>>(bonds);
      if (bonds.material.breaks() &&
          bonds.material.law.breaking.criterion == BreakCriterion::energy)
        return std::make_unique<BondEnergies<dim>>(bonds,
                                                   body.peridynamics.sampling.volume_fraction);
      if (bonds.material.breaks())
        return std::make_unique<BondStrengths<dim>>(bonds);
      return nullptr;
    }


    template <int dim>
    std::unique_ptr<DamageCriterion<dim>> criterion_of(const BreakableBonds<dim> &bonds,
                                                       const BodyParameters<dim> &body)
    {
      std::unique_ptr<DamageCriterion<dim>> found = breakable_criterion(bonds, body);
      if (found && bonds.material.law.breaking.unbreakable)
        return std::make_unique<UnbreakableEnds<dim>>(bonds, std::move(found));
      return found;
    }


    /** Given temperatures of owned nodes and ghosts; empty where they are not, or not known yet. */
    template <int dim>
    std::vector<double> given_temperatures(const BodyParameters<dim> &body,
                                           const Nodes<dim>          &nodes,
                                           const bool                 asked)
    {
      std::vector<double> list;
      for (unsigned int i = 0;
           i < nodes.n_local() && asked && !body.elasticity.computes_temperature;
           ++i)
        list.push_back(body.elasticity.reference_temperature +
                       body.elasticity.temperature_change.value(nodes.position(i)));
      return list;
    }
  } // namespace


  template <int dim>
  BondDamage<dim>::BondDamage(const Families<dim>                          &families,
                              const BodyParameters<dim>                    &body,
                              std::function<CrossingEnergy(unsigned int)> &&crossing_energy)
    : families(families)
    , body(body)
    , knows_temperature(body.material.breaks() &&
                        limit_of_bonds(body.material).depends_on_temperature())
    , temperatures(given_temperatures(body, families.nodes(), knows_temperature))
    , criterion(
        criterion_of<dim>({families, body.material, std::move(crossing_energy), temperatures},
                          body))
  {}


  template <int dim>
  void BondDamage<dim>::judge_softening(Overstretched       bond,
                                        const unsigned int  other,
                                        const double        length,
                                        const BondSoftness &state)
  {
    constexpr double slack        = 1e-3; // of limits
    const double     most         = std::max(1., state.reached);
    const bool       grows        = bond.ratio > (1. + slack) * most;
    const bool       is_pressed   = bond.ratio < -slack;
    const bool       has_softened = state.reached > 1.;
    if (!grows && !(has_softened && (is_pressed ? state.lost > 0. : state.lost == 0.)))
      return;
    if (!grows && !is_pressed && bond.ratio < 0.)
      return;
    bond.ratio     = std::max(bond.ratio, most);
    bond.integrity = is_pressed ? 1. : criterion->integrity(bond.node, other, length, bond.ratio);
    overstretched.push_back(bond);
  }


  template <int dim>
  bool BondDamage<dim>::select(const double share)
  {
    double most = 0.;
    for (const Overstretched &bond : overstretched)
      most = std::max(most, bond.ratio);
    most = Utilities::MPI::max(most, families.nodes().communicator());
    if (most == 0.)
      return false;
    overstretched.erase(
      std::remove_if(overstretched.begin(),
                     overstretched.end(),
                     [&](const Overstretched &bond) { return bond.ratio < share * most; }),
      overstretched.end());
    if (!so_far.places.elsewhere)
      keep_places(most);
    lead_paths_on();
    return true;
  }


  template <int dim>
  void BondDamage<dim>::lead_paths_on()
  {
    CrackPaths<dim> *const paths = criterion->paths();
    if (!paths)
      return;
    const Nodes<dim>                           &nodes = families.nodes();
    std::vector<typename CrackPaths<dim>::Ends> ends;
    for (const Overstretched &bond : overstretched)
      ends.emplace_back(nodes.position(bond.node), nodes.position(bond.neighbor));
    paths->advance(ends, nodes.communicator());
  }


  template <int dim>
  void BondDamage<dim>::keep_places(const double most)
  {
    BreakPlaces      &places = so_far.places;
    const Nodes<dim> &nodes  = families.nodes();
    const auto       &list   = body.boundary_conditions.traction;
    const auto        side   = [&](const unsigned int node) {
      return loaded_side.empty() ? numbers::invalid_unsigned_int : loaded_side[node];
    };
    // Ends of bonds beside each side, and of those elsewhere.
    std::vector<double> n_ends(list.size() + 1, 0.), all(n_ends);
    for (const Overstretched &bond : overstretched)
      n_ends[std::min<std::size_t>({side(bond.node), side(bond.neighbor), list.size()})] +=
        bond.n_ends;
    Utilities::MPI::sum(n_ends, nodes.communicator(), all);
    places.elsewhere = all.back() > 0.;
    for (unsigned int k = 0; k < list.size() && !places.elsewhere; ++k)
      if (all[k] > 0.)
        places.beside_loads[list[k].name] += static_cast<unsigned long long>(0.5 * all[k]);
    if (!places.first.empty())
      return;
    // Of bonds that are stretched alike, but for round-off, the first in space.
    std::vector<Point<dim>> first;
    const auto              keep = [](std::vector<Point<dim>> &found, const Point<dim> &p) {
      if (found.empty() || comes_first(p, found[0]))
        found.assign(1, p);
    };
    for (const Overstretched &bond : overstretched)
      if (bond.ratio >= (1. - 1e-6) * most)
        {
          const Point<dim> &a = nodes.position(bond.node);
          keep(first, a + 0.5 * (nodes.position(bond.neighbor) - a));
        }
    for (const auto &of_one : Utilities::MPI::all_gather(nodes.communicator(), first))
      for (const Point<dim> &p : of_one)
        keep(first, p);
    places.first.assign(first[0].begin_raw(), first[0].end_raw());
  }


  template <int dim>
  std::vector<double> BondDamage<dim>::damage_with_ghosts() const
  {
    Vector                    of_nodes(families.nodes().partitioner());
    const std::vector<double> owned = damage();
    std::copy(owned.begin(), owned.end(), of_nodes.begin());
    of_nodes.update_ghost_values();
    return {of_nodes.begin(), of_nodes.begin() + families.nodes().n_local()};
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondDamage);
} // namespace PeriDeal
