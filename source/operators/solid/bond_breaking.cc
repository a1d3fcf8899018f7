// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/bond_breaking.h>
#include <perideal/operators/solid/bond_softness.h>
#include <perideal/operators/solid/solid_tensors.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "crossing_sums.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Numbers in ascending order, each once. */
    void unite(std::vector<unsigned int> &all, const std::vector<unsigned int> &more)
    {
      std::vector<unsigned int> both;
      std::set_union(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(both));
      all = std::move(both);
    }
  } // namespace


  template <int dim>
  BondBreaking<dim>::BondBreaking(SolidBonds<dim>           &bonds,
                                  const SolidLoads<dim>     &loads,
                                  const BodyParameters<dim> &body)
    : BondDamage<dim>(bonds.families,
                      body,
                      crossing_energies(
                        bonds.families,
                        [&laws = bonds.laws](const unsigned int i) { return laws[i]; },
                        bonds.laws.volumetric))
    , bonds(bonds)
    , changes(criterion || bonds.families.cracks().history().changes_ever())
  {
    if (changes)
      bonds.rows.body.state.resize(bonds.rows.body.size());
    if (!criterion)
      return;
    if (bonds.rows.body.leaves_out() ||
        (criterion->softens() && !body.elasticity.is_static() && !bonds.kinematics.is_full() &&
         bonds.families.neighbors().has_unique_sites()))
      screen = std::make_unique<StretchScreen<dim>>(bonds.families, criterion->least_stretches());
    if (bonds.kinematics.is_full() && !criterion->softens())
      watch_limits();
    if (const auto &factor = body.material.law.breaking.rate_factor)
      rates = std::make_unique<StretchRates<dim>>(bonds.families.nodes(),
                                                  bonds.ends,
                                                  *factor,
                                                  bonds.kinematics.is_full());
    loaded_side = loads.sides_nearby(bonds.families);
  }


  template <int dim>
  void BondBreaking<dim>::watch_limits()
  {
    const std::vector<double> &least = criterion->least_stretches();
    std::vector<double> limits(least.begin(), least.begin() + bonds.families.nodes().n_owned());
    for (unsigned int i = 0; i < limits.size(); ++i)
      {
        bonds.rows.for_each_stored(i, [&](const auto &bond) {
          limits[i] = std::min(limits[i], least[bond.neighbor]);
        });
        limits[i] *= 1. - 1e-9; // what is found by other operations differs by round-off
      }
    bonds.forces.watch(std::move(limits));
  }


  template <int dim>
  void BondBreaking<dim>::follow_body(const Vector &u, const double t)
  {
    if (rates)
      rates->take(u, t);
    const NodeQuantity asked   = criterion->asks_for();
    bool               changed = criterion->take_time(t, this->temperatures);
    if (asked != NodeQuantity::none)
      {
        criterion->take_state(asked == NodeQuantity::stresses ?
                                nodal_stress_components(bonds, this->body, u) :
                                nodal_tensions(bonds, u));
        changed = true;
      }
    if (!changed)
      return;
    if (screen)
      screen->find_limits();
    if (bonds.kinematics.is_full() && !criterion->softens())
      watch_limits();
  }


  template <int dim>
  std::pair<double, double> BondBreaking<dim>::energies_of_first() const
  {
    const CrossingSums sums   = crossing_sums(bonds.families);
    const StateLaw    &law    = bonds.laws[0];
    const double       square = criterion->of_nodes()[0] * criterion->of_nodes()[0];
    const double       shared =
      bonds.laws.volumetric ? law.volumetric * law.dilatation * sums.dilatations : 0.;
    const double ball =
      crossing_of_ball<dim>(this->body.peridynamics, bonds.families.weights().horizon());
    return {square * (law.extension * sums.bonds + shared),
            square * (law.extension * ball + shared)};
  }


  template <int dim>
  BondMeasure BondBreaking<dim>::measure(const double         *u,
                                         const unsigned int    i,
                                         const SolidBond<dim> &bond) const
  {
    // The same digits at both ends of a bond.
    const BondKinematics<dim> &kinematics = bonds.kinematics;
    const Tensor<1, dim>       xi         = bonds.ends.vector(i, bond.neighbor);
    BondMeasure                found      = criterion->measure(
      i,
      bonds.ends.origin(bond.neighbor),
      kinematics.extension_moment(u, i, bond),
      kinematics.is_full() ? kinematics.length(bond) * xi.norm() : bond.moment * xi);
    if (rates && found.exceeds())
      found.limit *= rates->factor(i, bond.neighbor);
    return found;
  }


  template <int dim>
  void BondBreaking<dim>::judge(const double *u, const unsigned int i, const SolidBond<dim> &bond)
  {
    const unsigned int  j     = bond.neighbor;
    const BondMeasure   found = measure(u, i, bond);
    const Overstretched of_bond{bond.number,
                                i,
                                bonds.ends.is_fictitious(j) ? i : j,
                                bonds.ends.n_ends(i, j),
                                found.over_limit()};
    if (criterion->softens())
      this->judge_softening(of_bond,
                            bonds.ends.origin(j),
                            bonds.ends.vector(i, j).norm(),
                            softness_of(bonds.rows, bond.number));
    else if (found.exceeds())
      overstretched.push_back(of_bond);
  }


  template <int dim>
  void BondBreaking<dim>::find_inside(const double *u)
  {
    BondTable<dim> &rows = bonds.rows;
    losing.clear();
    const auto look_at_row = [&](const unsigned int i) {
      rows.for_each_stored(i, [&](const auto &bond) {
        if (rows.is_whole(bond.number))
          judge(u, i, bond);
      });
    };
    const unsigned char *const exceeds = bonds.forces.exceeding(u);
    for (unsigned int i = 0; !screen && i < bonds.families.nodes().n_owned(); ++i)
      if (exceeds == nullptr || exceeds[i] != 0)
        look_at_row(i);
    const double                     least_strain = bonds.thermal.least();
    const std::vector<unsigned int> &suspects = screen ? screen->suspects(u, least_strain) : losing;
    for (const unsigned int i : suspects)
      {
        if (rows.is_on_lattice(i))
          {
            bool any = false;
            if (screen->may_reach(i, u, least_strain))
              rows.for_each_in_body(i, [&](const auto &bond) {
                any = any || measure(u, i, bond).exceeds();
              });
            if (!any)
              continue;
            rows.store_row(i);
            rows.body.state.resize(rows.body.size());
          }
        if (rows.may_exceed(i, u, screen->least_critical() + least_strain))
          look_at_row(i);
      }
    // The bound of the screen is on what is stretched: one that has softened may be pressed.
    if (screen)
      for (const unsigned int i : softened)
        if (!std::binary_search(suspects.begin(), suspects.end(), i))
          look_at_row(i);
  }


  template <int dim>
  void BondBreaking<dim>::find_beyond(const double *u)
  {
    if (!bonds.ends.images || !bonds.ends.images->any_mirrored_alone())
      return;
    bonds.ends.find(u);
    for (const unsigned int i : bonds.rows.beyond.nodes)
      bonds.rows.for_each_beyond(i, [&](const auto &bond) {
        if (bonds.ends.may_break(bond.neighbor))
          judge(u, i, bond);
      });
  }


  template <int dim>
  void BondBreaking<dim>::add_tensions(CrackPaths<dim> &paths, const double *u) const
  {
    const Nodes<dim> &nodes = bonds.families.nodes();
    const double      reach = paths.reach() + 0.5 * bonds.families.weights().horizon();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (paths.any_tip_near(nodes.position(i), reach))
        bonds.rows.for_each_in_body(i, [&](const auto &bond) {
          if (!bonds.rows.is_whole(bond.number))
            return;
          const Tensor<1, dim> xi = bonds.ends.vector(i, bond.neighbor);
          paths.add(nodes.position(i) + 0.5 * xi,
                    xi,
                    bonds.rows.stiffnesses(i, bond.neighbor) *
                      bonds.kinematics.extension_moment(u, i, bond));
        });
  }


  template <int dim>
  double BondBreaking<dim>::stretch_over_critical(const Vector &u, const double t)
  {
    if (!criterion)
      return 0.;
    follow_body(u, t);
    Assert(!bonds.rows.body.leaves_out(), ExcMessage("All bonds are to be stored."));
    double most = 0.;
    u.update_ghost_values();
    bonds.ends.find(u.begin());
    this->turn_paths([&](auto &paths) { add_tensions(paths, u.begin()); });
    for (unsigned int i = 0; i < bonds.families.nodes().n_owned(); ++i)
      bonds.rows.for_each(i, [&](const auto &bond) {
        if (!bonds.rows.is_whole(bond.number) || !bonds.ends.may_break(bond.neighbor))
          return;
        const BondMeasure found = measure(u.begin(), i, bond);
        const double      before =
          criterion->softens() ? std::max(1., softness_of(bonds.rows, bond.number).reached) : 1.;
        if (found.exceeds(most * before))
          most = found.over_limit() / before;
      });
    u.set_ghost_state(false);
    return Utilities::MPI::max(most, bonds.families.nodes().communicator());
  }


  /**
   * Bonds to extrapolated fictitious nodes of a node bear as little as that of its bonds to the
   * nodes which these follow from that bears least.
   */
  template <int dim>
  void BondBreaking<dim>::soften_dependent(const unsigned int node)
  {
    std::vector<std::pair<unsigned int, double>> lost;
    bonds.rows.for_each_in_body(node, [&](const auto &bond) {
      const double part =
        bonds.rows.is_whole(bond.number) ? softness_of(bonds.rows, bond.number).lost : 0.;
      if (part > 0.)
        lost.emplace_back(bond.neighbor, part);
    });
    bonds.rows.for_each_beyond(node, [&](const auto &bond) {
      if (!bonds.rows.is_whole(bond.number) || bonds.ends.may_break(bond.neighbor))
        return;
      double most = 0.;
      bonds.ends.images->for_each_term(bonds.ends.image(bond.neighbor), [&](const auto &term) {
        for (const auto &[neighbor, part] : lost)
          if (neighbor == term.node)
            most = std::max(most, part);
      });
      if (most != softness_of(bonds.rows, bond.number).lost)
        weaken(bonds.rows, bond.number, {0., most});
    });
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
  std::optional<ChangeSet<dim>> BondBreaking<dim>::break_bonds(
    const Vector                  &u,
    const double                   t,
    const double                   share,
    const std::function<double()> &energy)
  {
    if (!criterion)
      return {};
    follow_body(u, t);
    u.update_ghost_values();
    this->find_all(
      [&] {
        find_inside(u.begin());
        find_beyond(u.begin());
      },
      [&](auto &paths) { add_tensions(paths, u.begin()); });
    u.set_ghost_state(false);
    // Those that soften do so a little each.
    if (!this->select(criterion->softens() ? 0. : share))
      return {};
    for (const auto &bond : overstretched)
      losing.push_back(bond.node);
    std::sort(losing.begin(), losing.end());
    losing.erase(std::unique(losing.begin(), losing.end()), losing.end());
    const double   before = energy();
    ChangeSet<dim> change;
    change.since              = t;
    change.damage             = true;
    change.nodes              = losing;
    unsigned long long n_ends = 0, n_gone = 0;
    for (const auto &bond : overstretched)
      {
        n_ends += bond.n_ends;
        n_gone += bond.integrity > 0. ? 0 : bond.n_ends;
        if (bond.integrity > 0.)
          weaken(bonds.rows, bond.number, {bond.ratio, 1. - bond.integrity});
        else
          bonds.rows.mark(bond.number, BondState::broken, t);
      }
    for (const unsigned int i : losing)
      {
        if (n_gone > 0)
          break_dependent(i, t);
        if (criterion->softens())
          soften_dependent(i);
      }
    if (criterion->softens())
      unite(softened, losing);
    n_changed = Utilities::MPI::sum(n_ends, bonds.families.nodes().communicator()) / 2;
    so_far.n_broken += Utilities::MPI::sum(n_gone, bonds.families.nodes().communicator()) / 2;
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
    if (criterion)
      this->exchange_history(archive);
    if (rates)
      rates->exchange(archive, keys);
    const std::vector<BondState::Kept> list = bonds.rows.exchange(archive, keys, n_first);
    if (criterion && criterion->softens())
      exchange_histories(bonds.rows, archive, keys, BondSoftness::n);
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
    if (criterion && criterion->softens())
      take_softness();
  }


  /** Histories are those of an archive, bonds are as they were at first. */
  template <int dim>
  void BondBreaking<dim>::take_softness()
  {
    std::vector<unsigned int> of_nodes;
    for (BondRows<dim> *rows : {&bonds.rows.body, &bonds.rows.beyond})
      for (std::size_t k = 0; k < rows->size(); ++k)
        {
          const double *const history = rows->nonlinear.history.data() + BondSoftness::n * k;
          if (history[0] > 1. && rows == &bonds.rows.body)
            of_nodes.push_back(rows->node_of(k));
          if (history[1] > 0. && rows->state.is_whole(k))
            rows->weaken(k, 1. - history[1]);
        }
    of_nodes.erase(std::unique(of_nodes.begin(), of_nodes.end()), of_nodes.end());
    unite(softened, of_nodes);
  }


  template <int dim>
  void BondBreaking<dim>::tell_damage()
  {
    if (bonds.law.any() && bonds.law->knows_damage())
      bonds.forces.damage = this->damage_with_ghosts();
  }


  /** 1 but for bonds that have softened, pressed or not. */
  template <int dim>
  double BondBreaking<dim>::left_of(const unsigned int node, const std::size_t number) const
  {
    if (!criterion || !criterion->softens())
      return 1.;
    const double       reached = softness_of(bonds.rows, number).reached;
    const unsigned int j       = bonds.rows.neighbor(number);
    return reached > 1. ? criterion->integrity(node,
                                               bonds.ends.origin(j),
                                               bonds.ends.vector(node, j).norm(),
                                               reached) :
                          1.;
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
            left += rows.state.is_whole(k) ? bond.kept * volume * left_of(i, k) : 0.;
            ++k;
          }
        bonds.rows.for_each_beyond(i, [&](const auto &bond) {
          if (!bonds.ends.may_break(bond.neighbor))
            return;
          all += bonds.ends.volume(bond.neighbor);
          left += bonds.rows.is_whole(bond.number) ?
                    bonds.ends.volume(bond.neighbor) * left_of(i, bond.number) :
                    0.;
        });
        result[i] = all > 0. ? 1. - left / all : 0.;
      }
    return result;
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondBreaking);
} // namespace PeriDeal
