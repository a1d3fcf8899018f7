// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/coupling/lattice_bonds.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  LatticeBonds<dim>::LatticeBonds(Nodes<dim>                &nodes,
                                  const BodyParameters<dim> &body,
                                  const Zone<dim>           &zone,
                                  const CellStiffness<dim>  &stiffness)
    : Coupling<dim>(nodes, body, zone)
    , stiffness(stiffness)
    , last(body.cracks.end_time)
  {
    uniform = stiffness.uniform;
    plain   = uniform && body.domain.is_box() && !nodes.is_graded();
    if (uniform && nodes.n_local() > 0)
      uniform_stiffness = stiffness.at_first(nodes.position(0));
    find_offsets();
    find_sites(body);
    find_cells(body);
  }


  template <int dim>
  Tensor<1, dim> LatticeBonds<dim>::vector_of(const Offset &offset) const
  {
    Tensor<1, dim> xi = own_families.nodes().lattice()->spacing;
    for (unsigned int d = 0; d < dim; ++d)
      xi[d] *= offset.site[d];
    return xi;
  }


  template <int dim>
  void LatticeBonds<dim>::find_offsets()
  {
    for (const FamilyMember<dim> &member : own_families.weights().members())
      {
        for (unsigned int d = 0; d < dim; ++d)
          reach[d] = std::max(reach[d], member.offset[d]);
        // One of each pair of opposite offsets.
        unsigned int last = dim;
        while (last > 0 && member.offset[last - 1] == 0)
          --last;
        if (member.offset[last - 1] > 0)
          offsets.push_back({member.offset, member.weight, bond_pieces<dim>(member.offset)});
      }
    for (unsigned int k = 0; k < offsets.size(); ++k)
      for (unsigned int p = 0; p < offsets[k].pieces.size(); ++p)
        {
          const BondPiece<dim> &piece = offsets[k].pieces[p];
          for (unsigned int c = 0; c < piece.cells.size(); ++c)
            {
              Passage passage{k, p, piece.cells[c], piece.change[c]};
              for (int &x : passage.start)
                x = -x;
              for (double &x : passage.change)
                x /= std::sqrt(piece.length);
              passages.push_back(passage);
            }
        }
  }


  template <int dim>
  void LatticeBonds<dim>::set_table_around(const std::vector<bool> &candidates)
  {
    Site low{}, high{};
    bool any = false;
    for (unsigned int i = 0; i < candidates.size(); ++i)
      if (candidates[i])
        {
          const Site site = site_of(i);
          for (unsigned int d = 0; d < dim; ++d)
            {
              low[d]  = any ? std::min(low[d], site[d]) : site[d];
              high[d] = any ? std::max(high[d], site[d]) : site[d];
            }
          any = true;
        }
    if (!any)
      return;
    // One more site on each side: cells around the outermost bonds.
    std::size_t n_sites = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        corner[d] = low[d] - 1;
        extent[d] = high[d] - low[d] + 3;
        n_sites *= extent[d];
      }
    sites.resize(n_sites);
  }


  template <int dim>
  void LatticeBonds<dim>::find_sites(const BodyParameters<dim> &body)
  {
    const Nodes<dim>   &nodes   = own_families.nodes();
    const Lattice<dim> &lattice = *nodes.lattice();
    const Zone<dim>     at_end  = this->zone_at(last);
    // Diffusion takes broken bonds out of its cells, and needs no more bonds for it.
    const bool              follows = zone.follows_stretches() && body.deforms;
    const std::vector<bool> hanging = hanging_nodes(nodes);
    std::vector<bool>       candidates(nodes.n_local());
    double                  n_in_zone = 0.;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        // Beside larger cells a node has more volume than a cell of the lattice.
        candidates[i] = !hanging[i] && nodes.volume(i) < lattice.cell_volume() * (1. + 1e-9) &&
                        (follows || at_end.contains(nodes.position(i)));
        n_in_zone += i < nodes.n_owned() && candidates[i];
      }
    // A mesh that follows the cracks may have no fine cell before the first of them; a body without
    // cracks has no bonds before it is stretched.
    if (!body.coupling.is_adaptive() && !zone.follows_stretches())
      throw_if_zone_empty(n_in_zone, nodes.communicator());
    set_table_around(candidates);
    stays = true;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      if (at(site_of(i)) != nullptr)
        {
          SiteData &site = own(site_of(i));
          site.node      = i;
          site.volume    = nodes.volume(i);
          site.may_join  = candidates[i];
          site.in_zone   = site.may_join && zone.contains(nodes.position(i));
          stays          = stays && site.in_zone == site.may_join;
        }
  }


  template <int dim>
  void LatticeBonds<dim>::find_cells(const BodyParameters<dim> &body)
  {
    if (sites.empty())
      return;
    const Lattice<dim> &lattice = *own_families.nodes().lattice();
    Site                last    = corner;
    for (unsigned int d = 0; d < dim; ++d)
      last[d] += extent[d] - 2;
    for_each_site(corner, last, [&](const Site &site) {
      SiteData &data = own(site);
      data.cell      = true;
      for (unsigned int v = 0; v < GeometryInfo<dim>::vertices_per_cell; ++v)
        {
          Site other = site;
          for (unsigned int d = 0; d < dim; ++d)
            other[d] += (v >> d) & 1;
          data.cell = data.cell && at(other)->node != numbers::invalid_unsigned_int;
        }
      data.cell = data.cell &&
                  body.domain.has_cell_at(lattice.position(site) + 0.5 * lattice.spacing);
      if (!data.cell)
        return;
      if (uniform)
        {
          data.lowest = data.highest = uniform_stiffness;
          return;
        }
      find_range(site, nullptr);
    });
  }


  template <int dim>
  void LatticeBonds<dim>::find_range(const Site &cell, const Vector *const u)
  {
    CellCorners<dim>                          corners;
    typename CellStiffness<dim>::CornerValues temperatures{};
    for (unsigned int v = 0; v < corners.size(); ++v)
      {
        Site site = cell;
        for (unsigned int d = 0; d < dim; ++d)
          site[d] += (v >> d) & 1;
        corners[v] = own_families.nodes().lattice()->position(site);
        if (u != nullptr)
          temperatures[v] = u->local_element(at(site)->node);
      }
    const auto range  = stiffness.range(corners, u != nullptr ? &temperatures : nullptr);
    own(cell).lowest  = range.lowest;
    own(cell).highest = range.highest;
  }


  template <int dim>
  void LatticeBonds<dim>::take_conductivities_at(const Vector &u)
  {
    if (sites.empty() || !stiffness.depends_on_temperature())
      return;
    Site last = corner;
    for (unsigned int d = 0; d < dim; ++d)
      last[d] += extent[d] - 2;
    for_each_site(corner, last, [&](const Site &site) {
      if (at(site)->cell)
        find_range(site, &u);
    });
  }


  template <int dim>
  typename LatticeBonds<dim>::SiteData &LatticeBonds<dim>::own(const Site &site)
  {
    return const_cast<SiteData &>(*at(site));
  }


  template <int dim>
  typename LatticeBonds<dim>::Site LatticeBonds<dim>::site_of(const unsigned int node) const
  {
    return own_families.nodes().lattice()->index(own_families.nodes().position(node));
  }


  template <int dim>
  void LatticeBonds<dim>::possible_neighbors_of(const unsigned int         node,
                                                std::vector<unsigned int> &neighbors) const
  {
    neighbors.clear();
    if (stays && !stiffness.depends_on_temperature())
      {
        for_each_bond(node,
                      [&](const unsigned int neighbor, const auto &, const double, const bool) {
                        neighbors.push_back(neighbor);
                      });
        return;
      }
    const Site      site = site_of(node);
    const SiteData *own  = at(site);
    if (own == nullptr || !own->may_join)
      return;
    for (const FamilyMember<dim> &member : own_families.weights().members())
      if (const SiteData *other = at(site + member.offset); other != nullptr && other->may_join)
        neighbors.push_back(other->node);
  }


  template <int dim>
  std::vector<BoundingBox<dim>> LatticeBonds<dim>::joining_by(const double time) const
  {
    std::vector<BoundingBox<dim>> boxes;
    if (!zone.follows_cracks() || sites.empty())
      return boxes;
    const Lattice<dim> &lattice = *own_families.nodes().lattice();
    const Zone<dim>     then    = this->zone_at(time);
    for (BoundingBox<dim> wide :
         own_families.cracks().history().changes(own_families.cracks().now(), time))
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
  void LatticeBonds<dim>::join(const double time)
  {
    for (const BoundingBox<dim> &box : joining_by(time))
      own(own_families.nodes().lattice()->index(box.get_boundary_points().first)).in_zone = true;
    zone = this->zone_at(time);
  }


  template <int dim>
  void LatticeBonds<dim>::find_joining(const Point<dim> &place, std::vector<Joining> &list) const
  {
    if (sites.empty())
      return;
    const Lattice<dim> &lattice = *own_families.nodes().lattice();
    const double        within  = own_families.weights().horizon() * (1. + 1e-9);
    Site                first, last;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double middle = (place[d] - lattice.position(Site{})[d]) / lattice.spacing[d],
                     half   = within / lattice.spacing[d];
        first[d]            = std::max<int>(std::ceil(middle - half), corner[d]);
        last[d]             = std::min<int>(std::floor(middle + half), corner[d] + extent[d] - 1);
      }
    for_each_site(first, last, [&](const Site &site) {
      const SiteData &data = *at(site);
      if (data.may_join && !data.in_zone && lattice.position(site).distance(place) <= within)
        list.push_back({data.node, 1.});
    });
  }


  template <int dim>
  void LatticeBonds<dim>::join_nodes(const std::vector<Joining> &list)
  {
    for (const Joining &joining : list)
      own(site_of(joining.node)).in_zone = true;
  }


  template <int dim>
  bool LatticeBonds<dim>::is_of_lattice(const Cell &cell) const
  {
    return cell->extent_in_direction(0) <= 1.5 * own_families.nodes().lattice()->spacing[0];
  }


  template <int dim>
  double LatticeBonds<dim>::stiffness_of(const Site &cell) const
  {
    return at(cell)->lowest;
  }


  template <int dim>
  bool LatticeBonds<dim>::in_zone(const unsigned int node) const
  {
    const SiteData *data = at(site_of(node));
    return data != nullptr && data->in_zone;
  }


  template <int dim>
  std::size_t LatticeBonds<dim>::memory_consumption() const
  {
    return own_families.memory_consumption() + sites.capacity() * sizeof(SiteData) +
           this->memory_of_marks() + passages.capacity() * sizeof(Passage);
  }


  PERIDEAL_INSTANTIATE_CLASS(class LatticeBonds);
} // namespace PeriDeal
