// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/point_order.h>
#include <perideal/operators/solid/bond_breaking.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "critical_stretches.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  BondBreaking<dim>::BondBreaking(SolidBonds<dim>           &bonds,
                                  const SolidLoads<dim>     &loads,
                                  const BodyParameters<dim> &body)
    : bonds(bonds)
    , body(body)
    , breaks(body.material.fracture_energy || body.material.critical_stretch)
    , changes(breaks || bonds.families.cracks().history().changes_ever())
  {
    if (changes)
      bonds.rows.body.state.resize(bonds.rows.body.size());
    if (!breaks)
      return;
    find_critical_stretches();
    if (bonds.sums.has_lattice())
      screen = std::make_unique<StretchScreen<dim>>(bonds.families, critical.least_at_nodes());
    if (bonds.kinematics.is_full())
      watch_limits();
    loaded_side = loads.sides_nearby(bonds.families);
  }


  template <int dim>
  void BondBreaking<dim>::watch_limits()
  {
    std::vector<double> limits(bonds.families.nodes().n_owned());
    for (unsigned int i = 0; i < limits.size(); ++i)
      {
        limits[i] = critical.of_nodes()[i];
        bonds.rows.for_each_stored(i, [&](const auto &bond) {
          limits[i] = std::min(limits[i], critical.of_bond(i, bond.neighbor));
        });
        limits[i] *= 1. - 1e-9; // what is found by other operations differs by round-off
      }
    bonds.forces.watch(std::move(limits));
  }


  template <int dim>
  void BondBreaking<dim>::find_critical_stretches()
  {
    critical.set(bonds.families,
                 body.material,
                 critical_stretches_of_families(
                   bonds.families,
                   body,
                   [&](const unsigned int i) -> const StateLaw & { return bonds.laws[i]; },
                   bonds.laws.volumetric));
  }


  template <int dim>
  std::pair<double, double> BondBreaking<dim>::energies_of_first() const
  {
    const CrossingSums sums   = crossing_sums(bonds.families);
    const StateLaw    &law    = bonds.laws[0];
    const double       square = critical.of_nodes()[0] * critical.of_nodes()[0];
    const double       shared =
      bonds.laws.volumetric ? law.volumetric * law.dilatation * sums.dilatations : 0.;
    const double ball =
      crossing_of_ball<dim>(body.peridynamics, bonds.families.weights().horizon());
    return {square * (law.extension * sums.bonds + shared),
            square * (law.extension * ball + shared)};
  }


  template <int dim>
  std::pair<double, double> BondBreaking<dim>::stretch_and_limit(const double         *u,
                                                                 const unsigned int    i,
                                                                 const SolidBond<dim> &bond) const
  {
    // W x e and W x^2; the same digits at both ends of a bond.
    const BondKinematics<dim> &kinematics = bonds.kinematics;
    const Tensor<1, dim>       xi         = bonds.ends.vector(i, bond.neighbor);
    const double               all = kinematics.is_full() ? kinematics.length(bond) * xi.norm() :
                                                            bond.moment * xi;
    return {kinematics.extension_moment(u, i, bond),
            all * critical.of_bond(i, bonds.ends.origin(bond.neighbor))};
  }


  template <int dim>
  void BondBreaking<dim>::find_inside(const double *u)
  {
    BondTable<dim> &rows = bonds.rows;
    losing.clear();
    const auto look_at_row = [&](const unsigned int i) {
      rows.for_each_stored(i, [&](const auto &bond) {
        if (!rows.is_whole(bond.number))
          return;
        if (const auto [found, limit] = stretch_and_limit(u, i, bond); found > limit)
          overstretched.emplace_back(bond.number, found / limit);
      });
    };
    const unsigned char *const exceeds = bonds.forces.exceeding(u);
    for (unsigned int i = 0; !screen && i < bonds.families.nodes().n_owned(); ++i)
      if (exceeds == nullptr || exceeds[i] != 0)
        look_at_row(i);
    const double least_strain = bonds.thermal.least();
    for (const unsigned int i : screen ? screen->suspects(u, least_strain) : losing)
      {
        if (rows.is_on_lattice(i))
          {
            bool any = false;
            if (screen->may_reach(i, u, least_strain))
              rows.for_each_in_body(i, [&](const auto &bond) {
                const auto [found, limit] = stretch_and_limit(u, i, bond);
                any                       = any || found > limit;
              });
            if (!any)
              continue;
            rows.store_row(i);
            rows.body.state.resize(rows.body.size());
          }
        if (rows.may_exceed(i, u, screen->least_critical() + least_strain))
          look_at_row(i);
      }
  }


  template <int dim>
  void BondBreaking<dim>::find_beyond(const double *u)
  {
    if (!bonds.ends.images || !bonds.ends.images->any_mirrored_alone())
      return;
    bonds.ends.find(u);
    for (const unsigned int i : bonds.rows.beyond.nodes)
      bonds.rows.for_each_beyond(i, [&](const auto &bond) {
        if (!bonds.ends.may_break(bond.neighbor))
          return;
        if (const auto [found, limit] = stretch_and_limit(u, i, bond); found > limit)
          overstretched.emplace_back(bond.number, found / limit);
      });
  }


  template <int dim>
  void BondBreaking<dim>::find_overstretched(const Vector &u, const double share)
  {
    overstretched.clear();
    u.update_ghost_values();
    find_inside(u.begin());
    find_beyond(u.begin());
    u.set_ghost_state(false);
    if (share <= 0.)
      return;
    double most = 0.;
    for (const auto &[number, ratio] : overstretched)
      most = std::max(most, ratio);
    const double at_least =
      share * Utilities::MPI::max(most, bonds.families.nodes().communicator());
    overstretched.erase(std::remove_if(overstretched.begin(),
                                       overstretched.end(),
                                       [&](const auto &bond) { return bond.second < at_least; }),
                        overstretched.end());
  }


  template <int dim>
  double BondBreaking<dim>::stretch_over_critical(const Vector &u)
  {
    if (!breaks)
      return 0.;
    Assert(!screen, ExcMessage("All bonds are to be stored."));
    double most = 0.;
    u.update_ghost_values();
    bonds.ends.find(u.begin());
    for (unsigned int i = 0; i < bonds.families.nodes().n_owned(); ++i)
      bonds.rows.for_each(i, [&](const auto &bond) {
        if (!bonds.rows.is_whole(bond.number) || !bonds.ends.may_break(bond.neighbor))
          return;
        if (const auto [found, limit] = stretch_and_limit(u.begin(), i, bond); found > most * limit)
          most = found / limit;
      });
    u.set_ghost_state(false);
    return Utilities::MPI::max(most, bonds.families.nodes().communicator());
  }


  template <int dim>
  void BondBreaking<dim>::keep_places()
  {
    BreakPlaces &places = so_far.places;
    if (places.elsewhere)
      return;
    const bool        is_first = places.first.empty();
    const Nodes<dim> &nodes    = bonds.families.nodes();
    const auto       &list     = body.boundary_conditions.traction;
    // Ends of bonds beside each side, and of those elsewhere.
    std::vector<double>                        n_ends(list.size() + 1, 0.), all(n_ends);
    std::vector<std::pair<double, Point<dim>>> broken; // stretch over the critical one, middle
    const auto                                 add =
      [&](const unsigned int i, const unsigned int j, const double n, const double ratio) {
        const unsigned int side = std::min(loaded_side[i], loaded_side[j]);
        n_ends[side == numbers::invalid_unsigned_int ? list.size() : side] += n;
        if (is_first)
          broken.emplace_back(ratio,
                              nodes.position(i) + 0.5 * (nodes.position(j) - nodes.position(i)));
      };
    for (const auto &[number, ratio] : overstretched)
      {
        const unsigned int i = bonds.rows.node_of(number), j = bonds.rows.neighbor(number);
        add(i, bonds.ends.is_fictitious(j) ? i : j, bonds.ends.n_ends(i, j), ratio);
      }
    const MPI_Comm communicator = nodes.communicator();
    Utilities::MPI::sum(n_ends, communicator, all);
    places.elsewhere = all.back() > 0.;
    for (unsigned int side = 0; side < list.size() && !places.elsewhere; ++side)
      if (all[side] > 0.)
        places.beside_loads[list[side].name] += static_cast<unsigned long long>(0.5 * all[side]);
    if (!is_first)
      return;
    // Of bonds that are stretched alike, but for round-off, the first in space.
    double most = 0.;
    for (const auto &[ratio, middle] : broken)
      most = std::max(most, ratio);
    most = (1. - 1e-6) * Utilities::MPI::max(most, communicator);
    std::vector<Point<dim>> first;
    for (const auto &[ratio, middle] : broken)
      if (ratio >= most && (first.empty() || comes_first(middle, first[0])))
        first.assign(1, middle);
    Point<dim> found;
    bool       any = false;
    for (const std::vector<Point<dim>> &of_one : Utilities::MPI::all_gather(communicator, first))
      if (!of_one.empty() && (!any || comes_first(of_one[0], found)))
        {
          found = of_one[0];
          any   = true;
        }
    places.first.assign(found.begin_raw(), found.end_raw());
  }


  template <int dim>
  void BondBreaking<dim>::find_losing()
  {
    for (const auto &[number, ratio] : overstretched)
      losing.push_back(bonds.rows.node_of(number));
    std::sort(losing.begin(), losing.end());
    losing.erase(std::unique(losing.begin(), losing.end()), losing.end());
  }


  /** Those bonds to fictitious nodes that others of a node, broken by now, would have to hold. */
  template <int dim>
  void BondBreaking<dim>::break_dependent(const unsigned int node, const double t)
  {
    std::vector<unsigned int> lost, lost_images;
    bonds.rows.for_each(node, [&](const auto &bond) {
      if (!bonds.rows.is_whole(bond.number) && bonds.ends.may_break(bond.neighbor))
        (bonds.ends.is_fictitious(bond.neighbor) ? lost_images : lost).push_back(bond.neighbor);
    });
    bonds.rows.for_each_beyond(node, [&](const auto &bond) {
      if (!bonds.rows.is_whole(bond.number))
        return;
      const FictitiousImages<dim> &images = *bonds.ends.images;
      const unsigned int           image  = bonds.ends.image(bond.neighbor);
      bool                         any    = false;
      images.for_each_term(image, [&](const auto &term) {
        // Images of other nodes that are gone: what is continued from them is, too.
        any = any ||
              (term.mirrored == 0 ?
                 std::find(lost.begin(), lost.end(), term.node) != lost.end() :
                 std::any_of(lost_images.begin(), lost_images.end(), [&](const unsigned int j) {
                   return images.are_images_of_one(bonds.ends.image(j), image, term);
                 }));
      });
      if (any)
        bonds.rows.mark(bond.number, BondState::dependent, t);
    });
  }


  template <int dim>
  unsigned long long BondBreaking<dim>::break_overstretched(const double t)
  {
    unsigned long long n_ends = 0;
    for (const auto &[number, ratio] : overstretched)
      {
        n_ends += bonds.ends.n_ends(bonds.rows.node_of(number), bonds.rows.neighbor(number));
        bonds.rows.mark(number, BondState::broken, t);
      }
    for (const unsigned int i : losing)
      break_dependent(i, t);
    return n_ends;
  }


  template <int dim>
  std::optional<ChangeSet<dim>> BondBreaking<dim>::break_bonds(
    const Vector                  &u,
    const double                   t,
    const double                   share,
    const std::function<double()> &energy)
  {
    if (!breaks)
      return {};
    find_overstretched(u, share);
    const MPI_Comm           all     = bonds.families.nodes().communicator();
    const unsigned long long n_found = overstretched.size();
    if (Utilities::MPI::sum(n_found, all) == 0)
      return {};
    keep_places();
    find_losing();
    const double   before = energy();
    ChangeSet<dim> change;
    change.since  = t;
    change.damage = true;
    change.nodes  = losing;
    so_far.n_broken += Utilities::MPI::sum(break_overstretched(t), all) / 2;
    so_far.released += before - energy();
    return change;
  }


  template <int dim>
  std::vector<NodePair> BondBreaking<dim>::broken_since(std::size_t &n_known) const
  {
    const auto           &layout = *bonds.families.nodes().partitioner();
    const BondRows<dim>  &rows   = bonds.rows.body;
    std::vector<NodePair> pairs;
    for (const auto &[number, time] : rows.state.marked_since(n_known))
      {
        const NodePair pair{layout.local_to_global(rows.node_of(number)),
                            layout.local_to_global(rows.neighbors[number])};
        if (rows.state.is_broken(number) && pair[0] < pair[1])
          pairs.push_back(pair);
      }
    return pairs;
  }


  template <int dim>
  void BondBreaking<dim>::exchange(Archive                        &archive,
                                   const NodeKeys                 &keys,
                                   typename BondTable<dim>::Count &n_first,
                                   const std::function<void()>    &at_first)
  {
    if (!changes)
      return;
    if (breaks)
      so_far.exchange(archive);
    const std::vector<BondState::Kept> list = bonds.rows.exchange(archive, keys, n_first);
    if (!archive.loads())
      return;
    const auto take = [&](const bool first) {
      for (const BondState::Kept &kept : list)
        if (kept.is_first == first)
          bonds.rows.mark(kept.number, kept.mark, kept.time);
    };
    take(true);
    n_first                         = n_marks();
    const unsigned long long n_kept = list.size();
    if (Utilities::MPI::sum(n_kept - n_first[0] - n_first[1],
                            bonds.families.nodes().communicator()) > 0)
      at_first();
    take(false);
  }


  template <int dim>
  void BondBreaking<dim>::tell_damage()
  {
    if (!bonds.law.any() || !bonds.law->knows_damage())
      return;
    Vector                    of_nodes(bonds.families.nodes().partitioner());
    const std::vector<double> owned = damage();
    std::copy(owned.begin(), owned.end(), of_nodes.begin());
    of_nodes.update_ghost_values();
    bonds.forces.damage.assign(of_nodes.begin(),
                               of_nodes.begin() + bonds.families.nodes().n_local());
  }


  template <int dim>
  std::vector<double> BondBreaking<dim>::damage() const
  {
    const Nodes<dim>                           &nodes = bonds.families.nodes();
    std::vector<typename Families<dim>::Member> family;
    std::vector<std::pair<unsigned int, int>>   crossed;
    std::vector<double>                         result(nodes.n_owned());
    const BondRows<dim>                        &rows = bonds.rows.body;
    for (std::size_t row = 0; row < rows.nodes.size(); ++row) // others have no bond cut
      {
        // Bonds are stored in the order of the family, those left out that cracks cut at first.
        const unsigned int i = rows.nodes[row];
        bonds.families.members_of(i, family);
        double      all = 0., left = 0.;
        std::size_t k = rows.starts[row];
        for (const auto &bond : family)
          {
            const double volume = nodes.volume(bond.neighbor);
            const bool   stored = k < rows.starts[row + 1] && rows.neighbors[k] == bond.neighbor &&
                                bond.weight != 0.;
            if (!stored)
              {
                bonds.families.cracks().crossed_cracks(i, bond.neighbor, crossed);
                if (!crossed.empty() || bonds.families.is_parted(i, bond.neighbor))
                  all += volume;
                continue;
              }
            all += volume;
            left += rows.state.is_whole(k) ? bond.kept * volume : 0.;
            ++k;
          }
        bonds.rows.for_each_beyond(i, [&](const auto &bond) {
          if (!bonds.ends.may_break(bond.neighbor))
            return;
          all += bonds.ends.volume(bond.neighbor);
          left += bonds.rows.is_whole(bond.number) ? bonds.ends.volume(bond.neighbor) : 0.;
        });
        result[i] = all > 0. ? 1. - left / all : 0.;
      }
    return result;
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondBreaking);
} // namespace PeriDeal
