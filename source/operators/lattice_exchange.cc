// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/lattice_exchange.h>

#include <algorithm>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  const typename LatticeExchange<dim>::SiteData *LatticeExchange<dim>::at(const Site &site) const
  {
    std::size_t key = 0;
    for (unsigned int d = dim; d-- > 0;)
      {
        const int x = site[d] - corner[d];
        if (x < 0 || x >= extent[d])
          return nullptr;
        key = key * extent[d] + x;
      }
    return key < sites.size() ? &sites[key] : nullptr;
  }


  template <int dim>
  typename LatticeExchange<dim>::SiteData &LatticeExchange<dim>::own(const Site &site)
  {
    return const_cast<SiteData &>(*at(site));
  }


  template <int dim>
  typename LatticeExchange<dim>::Site LatticeExchange<dim>::site_of(const unsigned int node) const
  {
    return bonds.nodes().lattice()->index(bonds.nodes().position(node));
  }


  template <int dim>
  double LatticeExchange<dim>::conductivity_on(const Offset &offset, const Site &start) const
  {
    if (plain)
      return bonds.conductivity(0);
    double lowest = std::numeric_limits<double>::max(), highest = 0.;
    for (const BondPiece<dim> &piece : offset.pieces)
      {
        bool inside = false;
        for (const Site &cell : piece.cells)
          if (const SiteData *data = at(start + cell); data != nullptr && data->cell)
            {
              inside  = true;
              lowest  = std::min(lowest, data->lowest);
              highest = std::max(highest, data->highest);
            }
        if (!inside)
          return 0.;
      }
    return highest > largest_contrast * lowest ? 0. : lowest;
  }


  template <int dim>
  void LatticeExchange<dim>::bonds_of(const unsigned int node, std::vector<Bond> &list) const
  {
    list.clear();
    const Site      site = site_of(node);
    const SiteData *own  = at(site);
    if (own == nullptr || !own->in_zone)
      return;
    for (const bool forward : {false, true})
      for (const Offset &offset : offsets)
        {
          Site start = site, other = site;
          for (unsigned int d = 0; d < dim; ++d)
            (forward ? other : start)[d] += (forward ? 1 : -1) * offset.site[d];
          const SiteData *neighbor = at(forward ? other : start);
          if (neighbor == nullptr || !neighbor->in_zone)
            continue;
          Bond bond;
          bond.neighbor = neighbor->node;
          bond.intact =
            conductivity_on(offset, start) * offset.weight * own->volume * neighbor->volume;
          if (bond.intact == 0.)
            continue;
          bond.weight = bond.intact * bonds.kept_fraction(node, bond.neighbor, bond.cut);
          list.push_back(bond);
        }
  }


  template <int dim>
  void LatticeExchange<dim>::possible_neighbors_of(const unsigned int         node,
                                                   std::vector<unsigned int> &neighbors) const
  {
    neighbors.clear();
    const Site      site = site_of(node);
    const SiteData *own  = at(site);
    if (own == nullptr || !own->may_join)
      return;
    for (const FamilyMember<dim> &member : bonds.lattice_members())
      if (const SiteData *other = at(site + member.offset); other != nullptr && other->may_join)
        neighbors.push_back(other->node);
  }


  template <int dim>
  bool LatticeExchange<dim>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    const Lattice<dim> &lattice = *bonds.nodes().lattice();
    if (cell->extent_in_direction(0) > 1.5 * lattice.spacing[0])
      return false;
    if (leaves_nothing(cell))
      {
        stiffness = 0.;
        return true;
      }
    constexpr unsigned int    n    = GeometryInfo<dim>::vertices_per_cell;
    const Site                site = lattice.index(cell->vertex(0));
    std::array<double, n * n> taken{};
    bool                      any = false;
    for (const Passage &passage : passages)
      {
        const Offset   &offset = offsets[passage.offset];
        const Site      start  = site + passage.start;
        const SiteData *a      = at(start);
        if (a == nullptr || !a->in_zone)
          continue;
        const SiteData *b = at(start + offset.site);
        if (b == nullptr || !b->in_zone)
          continue;
        const double kappa = conductivity_on(offset, start);
        if (kappa == 0.)
          continue;
        unsigned int n_around = 0;
        for (const Site &other : offset.pieces[passage.piece].cells)
          if (const SiteData *data = at(start + other); data != nullptr && data->cell)
            ++n_around;
        any                = true;
        const double share = kappa * offset.weight * a->volume * b->volume / n_around;
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j <= i; ++j)
            taken[i * n + j] += share * passage.change[i] * passage.change[j];
      }
    if (!any)
      return false;
    stiffness.add(at(site)->lowest, surplus);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        stiffness(i, j) -= taken[std::max(i, j) * n + std::min(i, j)];
    return true;
  }


  template <int dim>
  bool LatticeExchange<dim>::leaves_nothing(const Cell &cell) const
  {
    if (!plain || !zone.is_everywhere() || !calibrated)
      return false;
    // All bonds that pass a cell far from the body's sides are there, with whole volumes.
    const Lattice<dim> &lattice = *bonds.nodes().lattice();
    const Site          site    = lattice.index(cell->vertex(0));
    for (unsigned int d = 0; d < dim; ++d)
      if (site[d] < reach[d] || site[d] + 1 + reach[d] >= lattice.n_sites[d])
        return false;
    return true;
  }


  template <int dim>
  bool LatticeExchange<dim>::has_form() const
  {
    return plain && zone.is_everywhere();
  }


  template <int dim>
  std::unique_ptr<BondForm> LatticeExchange<dim>::make_form()
  {
    return form == OperatorForm::stored ? make_stored_form(bonds) : make_lattice_form(bonds);
  }


  template <int dim>
  void LatticeExchange<dim>::set_form_factors(std::vector<double> factors)
  {
    bonds.set_node_factors(std::move(factors), 1, true);
  }


  template <int dim>
  bool LatticeExchange<dim>::symmetric() const
  {
    return true;
  }


  template <int dim>
  std::vector<BoundingBox<dim>> LatticeExchange<dim>::joining_by(const double time) const
  {
    std::vector<BoundingBox<dim>> boxes;
    if (!zone.follows_cracks() || sites.empty())
      return boxes;
    const Lattice<dim> &lattice = *bonds.nodes().lattice();
    Zone<dim>           then    = zone;
    then.set_cracks(bonds.crack_history().pieces(time));
    for (BoundingBox<dim> wide : bonds.crack_history().changes(bonds.cracks_now(), time))
      {
        wide.extend(zone.width() + lattice.spacing.norm());
        Site first = lattice.index(wide.get_boundary_points().first),
             last  = lattice.index(wide.get_boundary_points().second);
        for (unsigned int d = 0; d < dim; ++d)
          {
            first[d] = std::max(first[d], corner[d]);
            last[d]  = std::min(last[d], corner[d] + extent[d] - 1);
          }
        for_each_site(first, last, [&](const Site &site) {
          const SiteData &data = *at(site);
          if (data.may_join && !data.in_zone && then.contains(lattice.position(site)))
            boxes.push_back({{lattice.position(site), lattice.position(site)}});
        });
      }
    return boxes;
  }


  template <int dim>
  void LatticeExchange<dim>::set_cracks_of(const double time)
  {
    for (const BoundingBox<dim> &box : joining_by(time))
      own(bonds.nodes().lattice()->index(box.get_boundary_points().first)).in_zone = true;
    bonds.set_cracks_of(time);
    zone.set_cracks(bonds.crack_history().pieces(time));
  }


  template <int dim>
  bool LatticeExchange<dim>::in_zone(const unsigned int node) const
  {
    const SiteData *data = at(site_of(node));
    return data != nullptr && data->in_zone;
  }

  template <int dim>
  const Families<dim> &LatticeExchange<dim>::families() const
  {
    return bonds;
  }

  template <int dim>
  std::size_t LatticeExchange<dim>::memory_consumption() const
  {
    return bonds.memory_consumption() + sites.capacity() * sizeof(SiteData) +
           passages.capacity() * sizeof(Passage);
  }


  template class LatticeExchange<1>;
  template class LatticeExchange<2>;
  template class LatticeExchange<3>;
} // namespace PeriDeal
