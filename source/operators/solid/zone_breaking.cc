// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/base/place_text.h>
#include <perideal/operators/coupling/nodal_family.h>
#include <perideal/operators/solid/zone_breaking.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <typename T>
    std::vector<T> gather(const std::vector<T> &own, const MPI_Comm communicator)
    {
      if (Utilities::MPI::sum(static_cast<unsigned long long>(own.size()), communicator) == 0)
        return {};
      std::vector<T> all;
      for (const auto &list : Utilities::MPI::all_gather(communicator, own))
        all.insert(all.end(), list.begin(), list.end());
      return all;
    }


    /**
     * Which cells have lit nothing yet, by their first corners; limits are lost where a body is
     * loaded.
     */
    template <int dim>
    void exchange_cells(Archive             &archive,
                        const NodeKeys      &keys,
                        const Nodes<dim>    &nodes,
                        StretchedCells<dim> &cells)
    {
      using Corners = typename StretchedCells<dim>::Corners;
      Vector open(nodes.partitioner());
      cells.set_limits([&](const Corners &corners) {
        open.local_element(corners[0]) = archive.loads() ? 0. : 1.;
        return 0.; // so that all are visited
      });
      open.compress(VectorOperation::add);
      archive.exchange("cells that have lit nothing", open, keys);
      if (!archive.loads())
        return;
      open.update_ghost_values();
      cells.visit_stretched(
        Vector(interleaved(*nodes.partitioner(), dim)),
        [&](const Corners &corners) { return open.local_element(corners[0]) == 0.; });
    }


    /** A pair with two numbers. */
    struct Numbered
    {
      double   first, second;
      NodePair pair;

      template <class BoostArchive>
      void serialize(BoostArchive &archive, const unsigned int)
      {
        archive &first &second &pair;
      }
    };


    /**
     * Archive pairs with two numbers each, by the key of their first node and the place of the
     * second one in its row, which is that of all members of the family: the same on all processes.
     * Where a body is loaded they are those of all processes, in ascending order.
     */
    template <int dim>
    void exchange_pairs(Archive               &archive,
                        const std::string     &name,
                        const NodeKeys        &keys,
                        const Families<dim>   &families,
                        std::vector<Numbered> &list)
    {
      const auto                                 &layout = *families.nodes().partitioner();
      std::vector<typename Families<dim>::Member> family;
      KeyedPairs                                  pairs;
      for (const auto &[first, second, pair] : list)
        if (!archive.loads() && layout.in_local_range(pair[0]))
          {
            const unsigned int a = layout.global_to_local(pair[0]),
                               b = layout.global_to_local(pair[1]);
            families.members_of(a, family);
            std::uint64_t place = 0;
            while (family[place].neighbor != b)
              ++place;
            pairs.keys.push_back({keys[a], place});
            pairs.values.insert(pairs.values.end(), {second, first});
          }
      archive.exchange(name, pairs, keys);
      if (!archive.loads())
        return;
      std::unordered_map<std::uint64_t, unsigned int> node_of;
      for (unsigned int i = 0; i < keys.size(); ++i)
        node_of[keys[i]] = i;
      std::vector<Numbered> own;
      for (std::size_t k = 0; k < pairs.keys.size(); ++k)
        {
          const unsigned int a = node_of.at(pairs.keys[k][0]);
          families.members_of(a, family);
          NodePair pair{layout.local_to_global(a),
                        layout.local_to_global(family[pairs.keys[k][1]].neighbor)};
          std::sort(pair.begin(), pair.end());
          own.push_back({pairs.values[2 * k + 1], pairs.values[2 * k], pair});
        }
      list = gather(own, families.nodes().communicator());
      std::sort(list.begin(), list.end(), [](const auto &a, const auto &b) {
        return std::tie(a.first, a.second, a.pair) < std::tie(b.first, b.second, b.pair);
      });
    }
  } // namespace


  template <int dim>
  ZoneBreaking<dim>::ZoneBreaking(Coupling<dim>                    &coupling,
                                  std::unique_ptr<ZoneBonds<dim>> &&of_zone,
                                  const DoFHandler<dim>            &dofs,
                                  const BodyParameters<dim>        &body)
    : BondDamage<dim>(coupling.breakable()->families_of_bonds(),
                      body,
                      of_zone->crossing_energies(body))
    , own_bonds(std::move(of_zone))
    , bonds(*own_bonds)
    , zone(*coupling.breakable())
    , nodes(zone.families_of_bonds().nodes())
    , share_of_zone(body.coupling.follows_stretches() ? body.coupling.zone_share : 0.)
  {
    if (share_of_zone > 0.)
      find_cells(dofs);
  }


  template <int dim>
  std::optional<unsigned int> ZoneBreaking<dim>::known(const types::global_dof_index node) const
  {
    const auto &layout = *nodes.partitioner();
    if (!layout.in_local_range(node) && !layout.is_ghost_entry(node))
      return {};
    return layout.global_to_local(node);
  }


  template <int dim>
  template <typename Take>
  void ZoneBreaking<dim>::visit_measures(const Vector &u, const Take &take) const
  {
    for (const unsigned int i : bonds.nodes())
      bonds.for_each(i, [&](const auto &bond, const Tensor<1, dim> &xi) {
        const unsigned int j = bond.neighbor;
        if (bond.strength == 0. || !bonds.starts(bond))
          return;
        double change = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          change += xi[d] * (u.local_element(dim * j + d) - u.local_element(dim * i + d));
        double stretch = change / xi.norm_square();
        if (!thermal.empty())
          stretch -= 0.5 * (thermal[i] + thermal[j]);
        take(i, j, xi, criterion->measure(i, j, stretch, 1.));
      });
  }


  template <int dim>
  void ZoneBreaking<dim>::add_tensions(CrackPaths<dim> &paths, const Vector &u) const
  {
    const double reach = paths.reach() + 0.5 * zone.families_of_bonds().weights().horizon();
    for (const unsigned int i : bonds.nodes())
      if (paths.any_tip_near(nodes.position(i), reach))
        bonds.for_each(i, [&](const auto &bond, const Tensor<1, dim> &xi) {
          if (bond.strength == 0.)
            return;
          double change = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            change +=
              xi[d] * (u.local_element(dim * bond.neighbor + d) - u.local_element(dim * i + d));
          paths.add(nodes.position(i) + 0.5 * xi,
                    xi,
                    bonds.spring(i, bond) * bond.strength * change * xi.norm_square());
        });
  }


  template <int dim>
  std::vector<DamagedBond> ZoneBreaking<dim>::find_overstretched(const Vector &u,
                                                                 const double  t,
                                                                 const double  share)
  {
    if (!criterion)
      return {};
    if (criterion->take_time(t, this->temperatures))
      set_limits_of_cells();
    const auto &layout = *nodes.partitioner();
    const auto  add =
      [&](const auto i, const auto j, const Tensor<1, dim> &xi, const BondMeasure &found) {
        const BondSoftness before = criterion->softens() ? zone.softness(i, j) : BondSoftness();
        if (!(found.exceeds() || before.reached > 1.) || !zone.may_break(i, j))
          return;
        const bool ascends = layout.local_to_global(i) < layout.local_to_global(j);
        const typename BondDamage<dim>::Overstretched bond{0,
                                                           ascends ? i : j,
                                                           ascends ? j : i,
                                                           2,
                                                           found.over_limit()};
        if (criterion->softens())
          this->judge_softening(bond, bond.neighbor, xi.norm(), before);
        else
          overstretched.push_back(bond);
      };
    this->find_all([&] { visit_measures(u, add); }, [&](auto &paths) { add_tensions(paths, u); });
    if (!this->select(criterion->softens() ? 0. : share))
      return {};
    std::vector<DamagedBond> own;
    for (const auto &bond : overstretched)
      own.push_back({{layout.local_to_global(bond.node), layout.local_to_global(bond.neighbor)},
                     {bond.ratio, 1. - bond.integrity}});
    std::vector<DamagedBond> all = gather(own, nodes.communicator());
    std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) { return a.pair < b.pair; });
    return all;
  }


  template <int dim>
  double ZoneBreaking<dim>::stretch_over_critical(const Vector &u, const double t)
  {
    if (!criterion)
      return 0.;
    if (criterion->take_time(t, this->temperatures))
      set_limits_of_cells();
    double most = 0.;
    u.update_ghost_values();
    this->turn_paths([&](auto &paths) { add_tensions(paths, u); });
    visit_measures(u, [&](const auto i, const auto j, const auto &, const BondMeasure &found) {
      if (!found.exceeds(most) || !zone.may_break(i, j))
        return;
      const double before = std::max(1., zone.softness(i, j).reached);
      most                = std::max(most, found.over_limit() / before);
    });
    if (share_of_zone > 0.)
      cells.visit_stretched(u, [&](const std::array<unsigned int, n_corners> &corners) {
        most = std::max(most, largest_strain(corners, u, 1.));
        return false;
      });
    u.set_ghost_state(false);
    return Utilities::MPI::max(most, nodes.communicator());
  }


  template <int dim>
  std::vector<BoundingBox<dim>> ZoneBreaking<dim>::parted_by(
    const std::vector<DamagedBond> &list) const
  {
    std::vector<BoundingBox<dim>> boxes;
    for (const auto &[pair, now] : list)
      if (const auto a = known(pair[0]), b = known(pair[1]); a && b && now.lost == 1.)
        {
          const Point<dim> &p = nodes.position(*a), &q = nodes.position(*b);
          bool              is_short = true;
          for (unsigned int d = 0; d < dim; ++d)
            is_short = is_short && std::abs(p[d] - q[d]) < 1.5 * nodes.lattice()->spacing[d];
          if (is_short)
            boxes.emplace_back(std::vector<Point<dim>>{p, q});
        }
    return boxes;
  }


  template <int dim>
  std::vector<unsigned int> ZoneBreaking<dim>::rows_of(const std::vector<DamagedBond> &list) const
  {
    std::vector<unsigned int> ends;
    for (const DamagedBond &bond : list)
      for (const auto node : bond.pair)
        if (const auto end = known(node))
          ends.push_back(*end);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    return bonds.rows_at(ends);
  }


  template <int dim>
  std::vector<unsigned int> ZoneBreaking<dim>::take(const std::vector<DamagedBond> &list,
                                                    const double                    t)
  {
    std::vector<unsigned int> softer;
    for (const auto &[pair, now] : list)
      {
        const bool breaks = now.lost == 1.;
        if (breaks)
          {
            broken.push_back({pair, t});
            ++so_far.n_broken;
          }
        const auto a = known(pair[0]), b = known(pair[1]);
        if (!a || !b)
          continue;
        zone.set_softness(*a, *b, now);
        for (const auto &[node, other] : {std::make_pair(*a, *b), std::make_pair(*b, *a)})
          if (node < nodes.n_owned() && breaks)
            bonds.release(node, other);
          else if (node < nodes.n_owned())
            softer.push_back(node);
      }
    std::sort(softer.begin(), softer.end());
    softer.erase(std::unique(softer.begin(), softer.end()), softer.end());
    return softer;
  }


  template <int dim>
  std::pair<double, double> ZoneBreaking<dim>::limit_of(
    const std::array<unsigned int, n_corners> &corners) const
  {
    double limit = 1e100, warm = 0.; // where none is known: its square is a number
    for (const unsigned int i : corners)
      {
        limit = std::min(limit, criterion->least_stretches()[i]);
        warm += thermal.empty() ? 0. : thermal[i] / n_corners;
      }
    return {limit, warm};
  }


  template <int dim>
  double ZoneBreaking<dim>::largest_strain(const std::array<unsigned int, n_corners> &corners,
                                           const Vector                              &u,
                                           const double at_least) const
  {
    const Tensor<1, dim> size = nodes.position(corners[n_corners - 1]) - nodes.position(corners[0]);
    Tensor<2, dim>       gradient;
    for (unsigned int v = 0; v < n_corners; ++v)
      for (unsigned int e = 0; e < dim; ++e)
        {
          const double slope = ((v >> e) & 1 ? 2. : -2.) / (n_corners * size[e]);
          for (unsigned int d = 0; d < dim; ++d)
            gradient[d][e] += slope * u.local_element(dim * corners[v] + d);
        }
    const auto [limit, warm]             = limit_of(corners);
    const SymmetricTensor<2, dim> strain = symmetrize(gradient);
    if (strain.norm() * (1. + 1e-12) - warm < at_least * limit)
      return 0.;
    return (eigenvalues(strain)[0] - warm) / limit;
  }


  template <int dim>
  std::vector<Point<dim>> ZoneBreaking<dim>::find_places_to_join(const Vector &u)
  {
    if (share_of_zone == 0.)
      return {};
    std::vector<Point<dim>> own;
    const auto              is_lit = [&](const std::array<unsigned int, n_corners> &corners) {
      if (!(largest_strain(corners, u, share_of_zone) >= share_of_zone))
        return false;
      const Point<dim> &first = nodes.position(corners[0]);
      own.push_back(first + 0.5 * (nodes.position(corners[n_corners - 1]) - first));
      return true;
    };
    cells.visit_stretched(u, is_lit);
    for (; n_followed < broken.size(); ++n_followed)
      for (const auto node : broken[n_followed].pair)
        if (nodes.partitioner()->in_local_range(node))
          own.push_back(nodes.position(nodes.partitioner()->global_to_local(node)));
    return gather(own, nodes.communicator());
  }


  template <int dim>
  std::pair<unsigned long long, std::string> ZoneBreaking<dim>::stretched_outside(
    const Vector          &u,
    const DoFHandler<dim> &dofs) const
  {
    if (!criterion)
      return {};
    unsigned long long                         n = 0;
    std::vector<std::pair<double, Point<dim>>> worst;
    u.update_ghost_values();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          std::array<unsigned int, n_corners> corners;
          bool                                inside = true;
          for (const unsigned int v : cell->vertex_indices())
            {
              corners[v] = nodes.partitioner()->global_to_local(cell->vertex_dof_index(v, 0));
              inside     = inside && zone.is_free(corners[v]);
            }
          if (inside)
            continue;
          const double strain = largest_strain(corners, u, 1.);
          if (!(strain > 1.))
            continue;
          ++n;
          if (worst.empty() || strain > worst[0].first)
            worst.assign(1, {strain, cell->center()});
        }
    u.set_ghost_state(false);
    const auto all = gather(worst, nodes.communicator());
    if (all.empty())
      return {};
    const auto most = std::max_element(all.begin(), all.end(), [](const auto &a, const auto &b) {
      return a.first < b.first;
    });
    return {Utilities::MPI::sum(n, nodes.communicator()), place_text(most->second)};
  }


  template <int dim>
  std::vector<typename ZoneBreaking<dim>::Joining> ZoneBreaking<dim>::joining(
    const std::vector<Point<dim>> &places) const
  {
    constexpr double     none = -std::numeric_limits<double>::infinity();
    std::vector<double>  largest(nodes.n_local(), none);
    std::vector<Joining> list;
    for (const Point<dim> &place : places)
      {
        list.clear();
        zone.find_joining(place, list);
        for (const Joining &joins : list)
          largest[joins.node] = std::max(largest[joins.node], joins.weight);
      }
    list.clear();
    for (unsigned int i = 0; i < largest.size(); ++i)
      if (largest[i] > none)
        list.push_back({i, largest[i]});
    return list;
  }


  template <int dim>
  std::vector<double> ZoneBreaking<dim>::damage() const
  {
    std::vector<double>                         result(nodes.n_owned());
    std::vector<typename Families<dim>::Member> family;
    // Pressed or not.
    const auto lost_by = [this](const unsigned int i, const unsigned int j, const double length) {
      const double reached = zone.softness(i, j).reached;
      return reached > 1. ? 1. - criterion->integrity(i, j, length, reached) : 0.;
    };
    for (const unsigned int i : bonds.nodes())
      {
        double lost = 0., all = 0.;
        bonds.for_each(i, [&](const auto &bond, const auto &xi) {
          lost += (bond.strength == 0. ? 1. : lost_by(i, bond.neighbor, xi.norm())) *
                  nodes.volume(bond.neighbor);
        });
        if (lost == 0.)
          continue;
        zone.families_of_bonds().members_of(i, family);
        for (const auto &member : family)
          all += nodes.volume(member.neighbor);
        result[i] = lost / all;
      }
    return result;
  }


  template <int dim>
  std::vector<NodePair> ZoneBreaking<dim>::broken_since(std::size_t &n_known) const
  {
    std::vector<NodePair> pairs;
    for (; n_known < broken.size(); ++n_known)
      if (nodes.partitioner()->in_local_range(broken[n_known].pair[0]))
        pairs.push_back(broken[n_known].pair);
    return pairs;
  }


  template <int dim>
  void ZoneBreaking<dim>::keep_zone()
  {
    kept_zone.n_broken = broken.size();
    kept_zone.weights.resize(nodes.n_owned());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      kept_zone.weights[i] = zone.weight_of(i);
  }


  template <int dim>
  void ZoneBreaking<dim>::exchange(Archive                     &archive,
                                   const NodeKeys              &keys,
                                   const std::function<void()> &at_first)
  {
    std::size_t &n_first = kept_zone.n_broken;
    this->exchange_history(archive);
    unsigned long long n_kept = n_first;
    archive.exchange("broken at first", n_kept);
    Vector now(nodes.partitioner()), at_first_zone(now);
    for (unsigned int i = 0; i < nodes.n_owned() && !archive.loads(); ++i)
      {
        now.local_element(i)           = zone.weight_of(i);
        at_first_zone.local_element(i) = kept_zone.weights.empty() ? 0. : kept_zone.weights[i];
      }
    archive.exchange("zone", now, keys);
    archive.exchange("zone at first", at_first_zone, keys);
    if (share_of_zone > 0.)
      {
        exchange_cells(archive, keys, nodes, cells);
        set_limits_of_cells();
      }

    std::vector<Numbered> all, softened; // numbers: order, time; lost, reached
    for (std::size_t k = 0; k < broken.size(); ++k)
      all.push_back({static_cast<double>(k), broken[k].time, broken[k].pair});
    exchange_pairs(archive, "broken pairs", keys, this->families, all);
    zone.for_each_damaged([&](const auto a, const auto b, const BondSoftness &now) {
      NodePair pair{nodes.partitioner()->local_to_global(a),
                    nodes.partitioner()->local_to_global(b)};
      std::sort(pair.begin(), pair.end());
      if (now.lost < 1.)
        softened.push_back({now.lost, now.reached, pair});
    });
    if (criterion && criterion->softens())
      exchange_pairs(archive, "softened pairs", keys, this->families, softened);
    if (!archive.loads())
      return;
    now.update_ghost_values();
    at_first_zone.update_ghost_values();
    const unsigned long long n_broken  = so_far.n_broken;
    const auto               take_from = [&](const std::size_t first, const std::size_t last) {
      for (std::size_t k = first; k < last; ++k)
        take({{all[k].pair, {0., 1.}}}, all[k].second);
    };
    const auto join_all = [&](const Vector &weights) {
      std::vector<Joining> list;
      for (unsigned int i = 0; i < nodes.n_local(); ++i)
        if (weights.local_element(i) > 0.)
          list.push_back({i, weights.local_element(i)});
      zone.join_nodes(list);
    };
    n_first = n_kept;
    join_all(at_first_zone);
    take_from(0, n_first);
    at_first();
    join_all(now);
    take_from(n_first, all.size());
    for (const Numbered &bond : softened)
      take({{bond.pair, {bond.second, bond.first}}}, 0.);
    so_far.n_broken = n_broken;
    n_followed      = broken.size();
  }


  template <int dim>
  std::size_t ZoneBreaking<dim>::memory_consumption() const
  {
    return bonds.memory_consumption() + (criterion ? criterion->memory_consumption() : 0) +
           thermal.capacity() * sizeof(double) + cells.memory_consumption() +
           broken.capacity() * sizeof(Break);
  }


  namespace
  {
    /** What bonds of a blending that break need. */
    template <int dim>
    void require_families(const BodyParameters<dim> &body, const std::string &entry)
    {
      const CouplingControl &coupling = body.coupling;
      body.peridynamics.refuse(
        body.peridynamics.completes_families(),
        "Surface correction",
        "'fictitious nodes' is not for 'Scheme = blending' with bonds that break ('" + entry +
          "' in section 'Material'); use 'none', or 'Models = peridynamics'.");
      coupling.refuse(
        coupling.is_near_cracks() && coupling.width < 2.,
        "Zone",
        "found '" + coupling.zone_text() + "'; with 'Scheme = blending' bonds break ('" + entry +
          "' in section 'Material') where their families are alone, and a zone of less than two horizons holds too few. Use 'follow', or 'cracks: 2' or more.");
      body.elasticity.refuse(
        body.elasticity.computes_temperature && body.elasticity.broken_bonds_conduct < 1.,
        "Broken bonds conduct",
        "broken bonds of 'Scheme = blending' in section 'Coupling' insulate nothing. Use 1, or 'Scheme = exchange'.");
    }
  } // namespace


  template <int dim>
  void ZoneBreaking<dim>::require(const BodyParameters<dim> &body)
  {
    const CouplingControl &coupling = body.coupling;
    const Material        &material = body.material;
    const bool             breaks   = material.breaks();
    const std::string      entry    = breaks ? name_of_limit(material) : "Law";
    coupling.refuse(
      coupling.follows_stretches() && !breaks,
      "Zone",
      "'follow' is for bonds that may break: give section 'Material' a 'Fracture energy' or a 'Critical stretch', or use 'cracks: 1'.");
    if (!lists_bonds(body) || has_nodal_law(body))
      return;
    if (!breaks)
      {
        material.refuse(
          !body.domain.has_lattice() || body.cracks.on_faces(),
          "Law",
          "'" + material.text("Law") +
            "' with 'Models = coupled' is for lattices of equal cells, and cracks that are not on faces of the mesh; use 'Models = peridynamics'.");
        body.peridynamics.refuse(
          body.peridynamics.completes_families() && !coupling.exchanges(),
          "Surface correction",
          "'fictitious nodes' is not for 'Scheme = blending' with a 'Law' (section 'Material') that is not linear; use 'none', or 'Models = peridynamics'.");
        return;
      }
    material.refuse(
      material.law.breaking.criterion != BreakCriterion::stretch,
      "Criterion",
      "found '" + material.text("Criterion") +
        "', which is for 'Models = peridynamics'; bonds beside elements ('coupled') break by 'stretch'.");
    coupling.refuse(
      coupling.splices(),
      "Scheme",
      "'splice' has forces without an energy that breaking bonds could release, but section 'Material' has a '" +
        entry + "'. Use 'exchange' or 'blending', or 'Models = peridynamics'.");
    if (!coupling.exchanges())
      require_families(body, entry);
    coupling.refuse(
      coupling.is_near_cracks() && coupling.width < 1.,
      "Zone",
      "found '" + coupling.zone_text() + "'; where bonds may break ('" + entry +
        "' in section 'Material') they would join through broken cells in a zone of less than one horizon. Use 'follow', or 'cracks: 1' or more.");
    material.refuse(
      !body.domain.has_lattice() || body.cracks.on_faces(),
      entry,
      !body.domain.has_lattice() ?
        "is for lattices of equal cells with 'Models = coupled'; on meshes of other cells bonds break in 'Models = peridynamics'." :
        "is not for 'Mesh = faces' in section 'Cracks' with 'Models = coupled'; use 'removed'.");
  }


  template <int dim>
  void ZoneBreaking<dim>::find_cells(const DoFHandler<dim> &dofs)
  {
    std::vector<typename StretchedCells<dim>::Corners> list;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() &&
          cell->extent_in_direction(0) <= 1.5 * nodes.lattice()->spacing[0])
        {
          list.emplace_back();
          for (const unsigned int v : cell->vertex_indices())
            list.back()[v] = nodes.partitioner()->global_to_local(cell->vertex_dof_index(v, 0));
        }
    cells.set(std::move(list), nodes.lattice()->spacing);
    set_limits_of_cells();
  }


  template <int dim>
  void ZoneBreaking<dim>::set_limits_of_cells()
  {
    cells.set_limits([&](const std::array<unsigned int, n_corners> &corners) {
      const auto [limit, warm] = limit_of(corners);
      return share_of_zone * limit + warm;
    });
  }


  PERIDEAL_INSTANTIATE_CLASS(class ZoneBreaking);
} // namespace PeriDeal
