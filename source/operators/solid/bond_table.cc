// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which bonds are stored, and which the lattice knows.

#include <perideal/base/instantiate.h>
#include <perideal/base/make_room.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/lattice/bond_form.h>
#include <perideal/operators/solid/bond_softness.h>
#include <perideal/operators/solid/law_steps.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "../lattice/state_lattice.h"
#include "change_along.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool may_leave_out_bonds(const Families<dim> &families, const BodyParameters<dim> &body)
    {
      const std::string reason = families.neighbors().has_unique_sites() ?
                                   StateLattice<dim>::obstacle(body) :
                                   "the nodes are not on a lattice with one node per site";
      // Bonds of bars take little, and differences of displacements round less than convolutions.
      return takes_lattice_form(body.peridynamics.form, reason, dim > 1);
    }


    /** Owned nodes whose bonds growing cracks change, or those of their neighbours. */
    template <int dim>
    std::vector<bool> find_changing(const Families<dim> &families, const BodyParameters<dim> &scene)
    {
      constexpr unsigned int   n_spans = 64; // boxes around parts of a crooked way take in less
      const CrackHistory<dim> &history = families.cracks().history();
      std::vector<bool>        changing(families.nodes().n_owned(), false);
      if (!history.changes_ever())
        return changing;
      // q of a node whose bonds are cut changes the springs of its neighbours.
      const double distance = 2. * families.weights().reach();
      const double end      = scene.cracks.end_time;
      for (unsigned int k = 0; k < n_spans; ++k)
        for (const unsigned int i : families.neighbors().nodes_near(
               history.changes(end * k / n_spans, end * (k + 1) / n_spans),
               distance))
          changing[i] = true;
      return changing;
    }


    /** Cut or not. */
    template <int dim>
    bool has_complete_family(const Families<dim> &families, const unsigned int i)
    {
      const Nodes<dim> &nodes  = families.nodes();
      const double      volume = nodes.lattice()->cell_volume();
      if (nodes.volume(i) != volume)
        return false;
      const auto site = nodes.lattice()->index(nodes.position(i));
      for (const FamilyMember<dim> &member : families.weights().members())
        {
          const unsigned int j = families.neighbors().node_at(site + member.offset);
          if (j == numbers::invalid_unsigned_int || nodes.volume(j) != volume)
            return false;
        }
      return true;
    }
  } // namespace


  template <int dim>
  BondTable<dim>::BondTable(const Families<dim>       &families,
                            NodeLaws<dim>             &laws,
                            const BondEnds<dim>       &ends,
                            const BodyParameters<dim> &scene,
                            const std::vector<bool>   &of_nodes)
    : families(families)
    , laws(laws)
    , ends(ends)
  {
    const Nodes<dim> &nodes     = families.nodes();
    const bool        leave_out = of_nodes.empty() && may_leave_out_bonds(families, scene);
    Family            family;
    std::string       message;
    std::vector<bool> changing;
    row_of.assign(nodes.n_owned(), no_row);
    if (nodes.lattice())
      for (const FamilyMember<dim> &member : families.weights().members())
        complete_weighted += nodes.lattice()->cell_volume() * member.weight * member.r * member.r;
    if (!leave_out && of_nodes.empty() && families.neighbors().has_unique_sites())
      {
        // More than enough, in one go: what is not written to takes no memory.
        const std::size_t n = families.weights().members().size() * nodes.n_owned();
        body.neighbors.reserve(n);
        body.moments.reserve(n);
        body.springs.reserve(n);
      }
    if (leave_out)
      {
        body.units    = unit_bonds(families);
        body.may_pack = !scene.elasticity.is_correspondence();
        changing      = find_changing(families, scene);
      }
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        if (!of_nodes.empty() && !of_nodes[i])
          {
            add_row(i, {});
            laws.weighted.local_element(i) = complete_weighted;
            continue;
          }
        const bool complete = leave_out && has_complete_family(families, i);
        bool       stored   = !leave_out;
        if (complete && !families.near_crack(i) && !changing[i])
          n_bonds += 0.5 * static_cast<double>(body.units.size()); // at each end
        else
          {
            families.members_of(i, family);
            stored = stored || changing[i] ||
                     std::any_of(family.begin(), family.end(), [](const auto &bond) {
                       return bond.kept < 1. || bond.weight == 0.;
                     });
            n_bonds += 0.5 * static_cast<double>(
                               std::count_if(family.begin(), family.end(), [](const auto &bond) {
                                 return bond.kept * bond.weight != 0.;
                               }));
            laws.weighted.local_element(i) = laws.weight_of(families, i, family, message);
          }
        if (stored)
          add_row(i, family);
        else if (complete)
          laws.weighted.local_element(i) = complete_weighted; // to the last bit
      }
    if (!leave_out)
      row_of.clear(); // all rows, in the order of their nodes
    throw_on_all_if_any(nodes.communicator(), message);
  }


  template <int dim>
  void BondTable<dim>::add_row(const unsigned int i, const Family &family)
  {
    const Nodes<dim>                 &nodes = families.nodes();
    const std::vector<UnitBond<dim>> &units = body.units;
    const bool                        packs = body.is_packed();
    typename Lattice<dim>::Index      site;
    if (packs)
      {
        make_room(body.neighbors, family.size());
        make_room(body.codes, family.size());
        site = nodes.lattice()->index(nodes.position(i));
      }
    std::size_t m = 0; // of the unit bonds
    for (const auto &bond : family)
      {
        while (packs && families.neighbors().node_at(site + units[m].offset) != bond.neighbor)
          ++m;
        const double weight = bond.kept * bond.weight;
        if (weight == 0.)
          continue;
        if (packs)
          {
            if (bond.kept < 1.)
              body.parts.emplace_back(body.size(), bond.kept);
            body.codes.push_back(
              static_cast<BondCode::Code>(m | (bond.kept < 1. ? BondCode::in_part : 0)));
          }
        else
          {
            const Tensor<1, dim> xi = families.neighbors().bond_vector(i, bond.neighbor);
            body.moments.push_back(weight * xi);
            body.springs.push_back(weight * xi.norm_square());
          }
        body.neighbors.push_back(bond.neighbor);
      }
    row_of[i] = static_cast<std::uint32_t>(body.nodes.size());
    body.end_row(i);
  }


  template <int dim>
  void BondTable<dim>::go_on_beyond(FictitiousBondList<dim> &&found, const bool may_pack)
  {
    const Nodes<dim> &nodes = families.nodes();
    constexpr auto    gone  = FictitiousBondList<dim>::gone;
    beyond.nodes            = std::move(found.nodes);
    beyond.starts           = std::move(found.starts);
    beyond.moments          = std::move(found.moments);
    beyond.springs          = std::move(found.squares);
    beyond.neighbors.reserve(found.images.size());
    for (const unsigned int image : found.images)
      beyond.neighbors.push_back(ends.node_of_image(image));
    if (may_pack && found.units.size() < BondCode::gone)
      {
        beyond.units = std::move(found.units);
        beyond.codes.reserve(found.unit_of.size());
        for (const unsigned int unit : found.unit_of)
          beyond.codes.push_back(unit == gone ? BondCode::gone : static_cast<BondCode::Code>(unit));
      }
    else if (!found.units.empty())
      for (std::size_t row = 0; row < beyond.nodes.size(); ++row)
        for (std::size_t k = beyond.starts[row]; k < beyond.starts[row + 1]; ++k)
          {
            const bool           none = found.unit_of[k] == gone;
            const UnitBond<dim> &unit = found.units[none ? 0 : found.unit_of[k]];
            const double         w =
              none ? 0. : nodes.volume(beyond.nodes[row]) * ends.volume(beyond.neighbors[k]);
            beyond.moments.push_back(w * unit.moment);
            beyond.springs.push_back(w * unit.weight);
          }
    beyond.nodes.shrink_to_fit();
    beyond.starts.shrink_to_fit();
    beyond.neighbors.shrink_to_fit();
    beyond.moments.shrink_to_fit();
    beyond.springs.shrink_to_fit();
    if (!found.cut.empty())
      beyond.state.resize(beyond.size());
    for (const std::size_t k : found.cut)
      beyond.state.mark(k, BondState::parted, 0.);
    for (std::size_t row = 0; row < beyond.nodes.size(); ++row)
      {
        const unsigned int i = beyond.nodes[row];
        for (std::size_t k = beyond.starts[row]; k < beyond.starts[row + 1]; ++k)
          {
            double square = 0.;
            if (!beyond.is_packed())
              square = beyond.springs[k];
            else if (beyond.codes[k] != BondCode::gone)
              square = volumes_of(beyond, i, k) * beyond.units[beyond.codes[k]].weight;
            laws.weighted.local_element(i) += square / nodes.volume(i);
          }
      }
  }


  template <int dim>
  void BondTable<dim>::store_row(const unsigned int i)
  {
    Assert(is_on_lattice(i), ExcInternalError());
    Family            family;
    const std::size_t begin = body.size();
    families.members_of(i, family);
    add_row(i, family);
    for (std::size_t k = begin; !body.is_packed() && k < body.size(); ++k)
      body.springs[k] =
        LinearPeridynamicSolid::spring(stiffnesses(i, body.neighbors[k]), body.springs[k]);
  }


  template <int dim>
  void BondTable<dim>::mark(const std::size_t number, const BondState::Mark mark, const double t)
  {
    if ((number & of_beyond) != 0)
      beyond.mark(place(number), mark, t);
    else
      {
        body.mark(number, mark, t);
        n_bonds -= 0.5;
      }
  }


  template <int dim>
  void weaken(BondTable<dim> &bonds, const std::size_t number, const BondSoftness &now)
  {
    BondRows<dim>    &rows = (number & BondTable<dim>::of_beyond) != 0 ? bonds.beyond : bonds.body;
    const std::size_t k    = bonds.place(number);
    const double      before = softness_of(bonds, number).lost;
    if (now.lost != before)
      rows.weaken(k, (1. - now.lost) / (1. - before));
    rows.nonlinear.history[BondSoftness::n * k]     = now.reached;
    rows.nonlinear.history[BondSoftness::n * k + 1] = now.lost;
  }


  namespace
  {
    template <int dim, typename FirstOf>
    BondState::Numbering numbering(const BondRows<dim> &rows, const FirstOf &first_of)
    {
      return {[&rows](const std::size_t k) -> std::size_t { return rows.node_of(k); },
              first_of,
              [&rows]() { return rows.size(); }};
    }


    template <int dim>
    BondState::Numbering numbering_beyond(const BondRows<dim> &rows)
    {
      return numbering(rows, [&rows](const std::size_t node) -> std::size_t {
        const auto &nodes = rows.nodes;
        return rows.starts[std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin()];
      });
    }
  } // namespace


  template <int dim>
  std::vector<BondState::Kept> BondTable<dim>::exchange(Archive        &archive,
                                                        const NodeKeys &keys,
                                                        const Count    &n_first)
  {
    // Nodes that are asked for when an archive is loaded store their bonds.
    const auto first_in_body = [&](const std::size_t node) -> std::size_t {
      if (archive.loads() && is_on_lattice(node))
        store_row(node);
      return body.starts[row_in_body(node)];
    };
    std::vector<BondState::Kept> all =
      body.state.exchange(archive, numbering(body, first_in_body), keys, n_first[0]);
    if (!ends.images)
      return all;
    const Archive::Part part(archive, "fictitious nodes");
    for (BondState::Kept &kept :
         beyond.state.exchange(archive, numbering_beyond(beyond), keys, n_first[1]))
      {
        kept.number |= of_beyond;
        all.push_back(kept);
      }
    return all;
  }


  template <int dim>
  void exchange_histories(BondTable<dim>    &bonds,
                          Archive           &archive,
                          const NodeKeys    &keys,
                          const unsigned int n)
  {
    const auto first = [&](const std::size_t node) {
      return bonds.body.starts[bonds.row_in_body(node)];
    };
    exchange_history(archive, numbering(bonds.body, first), keys, n, bonds.body.nonlinear.history);
    const Archive::Part part(archive, "fictitious nodes");
    exchange_history(archive,
                     numbering_beyond(bonds.beyond),
                     keys,
                     n,
                     bonds.beyond.nonlinear.history);
  }


  template <int dim>
  void BondTable<dim>::find_springs(const bool full, const unsigned int n_history)
  {
    if (families.cracks().history().changes_ever())
      beyond.squares = beyond.springs;
    for (BondRows<dim> *rows : {&body, &beyond})
      {
        for (std::size_t row = 0; !rows->is_packed() && row < rows->nodes.size(); ++row)
          for (std::size_t k = rows->starts[row]; k < rows->starts[row + 1]; ++k)
            rows->springs[k] =
              rows->state.is_whole(k) ?
                LinearPeridynamicSolid::spring(stiffnesses(rows->nodes[row], rows->neighbors[k]),
                                               rows->springs[k]) :
                0.;
        if (full)
          rows->keep_lengths();
        rows->nonlinear.history.resize(n_history * rows->size(), 0.);
      }
  }


  template <int dim>
  bool BondTable<dim>::may_exceed(const unsigned int i, const double *u, const double stretch) const
  {
    if (!body.is_packed() || !(stretch > 0.))
      return true;
    const double limit = (1. - 1e-9) * stretch;
    bool         any   = false;
    for (std::size_t k = body.starts[row_of[i]]; k < body.starts[row_of[i] + 1]; ++k)
      if (body.codes[k] != BondCode::gone)
        {
          const UnitBond<dim> &unit = body.units[BondCode::number(body.codes[k])];
          any = any || change_along(unit.moment, u + dim * i, u + dim * body.neighbors[k]) >
                         limit * unit.weight;
        }
    return any;
  }


  template <int dim>
  std::size_t BondTable<dim>::memory_consumption() const
  {
    return body.memory_consumption() + beyond.memory_consumption() +
           row_of.capacity() * sizeof(std::uint32_t);
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondTable);
  PERIDEAL_INSTANTIATE_FUNCTION(weaken);
  PERIDEAL_INSTANTIATE_FUNCTION(exchange_histories);
} // namespace PeriDeal
