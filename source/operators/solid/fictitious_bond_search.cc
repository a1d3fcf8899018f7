// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/mesh/point_bins.h>
#include <perideal/operators/solid/fictitious_bond_search.h>
#include <perideal/operators/solid/fictitious_cuts.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "least_additions.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** In how many orders these may stand, equal ones being the same. */
    double n_orders(std::array<unsigned int, 4> components)
    {
      std::sort(components.begin(), components.end());
      unsigned int n = 1;
      while (std::next_permutation(components.begin(), components.end()))
        ++n;
      return n;
    }
  } // namespace


  template <int dim>
  FictitiousBondSearch<dim>::FictitiousBondSearch(const Families<dim>   &families,
                                                  FictitiousImages<dim> &images)
    : families(families)
    , images(images)
  {}


  template <int dim>
  FictitiousBondList<dim> FictitiousBondSearch<dim>::on_lattice(
    const std::array<BeyondSide, 2 * dim> &beyond,
    const bool                             completes)
  {
    const Nodes<dim>   &nodes   = families.nodes();
    const Lattice<dim> &lattice = *nodes.lattice();
    extension.emplace(families, beyond);
    list.units        = unit_bonds(families);
    int         reach = 0;
    std::size_t sites = 1;
    for (const FamilyMember<dim> &member : families.weights().members())
      for (unsigned int d = 0; d < dim; ++d)
        reach = std::max(reach, member.offset[d]);
    for (unsigned int d = 0; d < dim; ++d)
      sites *= lattice.n_sites[d];
    if (completes)
      completion.emplace(families.weights(), lattice);
    const bool all = completes && nodes.n_global() < sites;
    return find_all([&](const unsigned int i) {
      const auto index = lattice.index(nodes.position(i));
      bool       near  = all || extension->distance(index) <= reach;
      for (unsigned int d = 0; d < dim && completes; ++d)
        near = near || std::min(index[d], lattice.n_sites[d] - 1 - index[d]) <= reach;
      if (near)
        find_on_lattice(i);
    });
  }


  /** Images beyond sides of a mesh, by place, and their numbers among those that are used. */
  template <int dim>
  struct FictitiousBondSearch<dim>::MeshImages
  {
    MeshImages(const std::vector<BoundaryImage<dim>> &list, const double reach)
      : list(list)
      , bins(reach)
      , number_of(list.size(), numbers::invalid_unsigned_int)
    {
      for (unsigned int g = 0; g < list.size(); ++g)
        bins.add(list[g].place, g);
    }

    const std::vector<BoundaryImage<dim>> &list;
    PointBins<dim>                         bins;
    std::vector<unsigned int>              number_of;
  };


  template <int dim>
  struct FictitiousBondSearch<dim>::MeshBond
  {
    Tensor<1, dim> xi;
    unsigned int   image; // in the list
    double         w;     // 0 where a crack cuts it
  };


  template <int dim>
  FictitiousBondList<dim> FictitiousBondSearch<dim>::on_mesh(
    const std::vector<BoundaryImage<dim>> &beyond,
    const std::vector<BoundaryImage<dim>> &everywhere)
  {
    MeshImages       with_nodes(beyond, families.weights().reach());
    const MeshImages all(everywhere, families.weights().reach());
    return find_all([&](const unsigned int i) {
      const std::vector<MeshBond> bonds = bonds_to(i, with_nodes);
      for (const MeshBond &bond : bonds)
        add(image_on_mesh(bond.image, with_nodes), bond);
      if (!everywhere.empty())
        complete_on_mesh(i, bonds, with_nodes, bonds_to(i, all));
    });
  }


  template <int dim>
  template <typename Find>
  FictitiousBondList<dim> FictitiousBondSearch<dim>::find_all(const Find &find)
  {
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      {
        find(i);
        if (list.images.size() == list.starts.back())
          continue;
        list.nodes.push_back(i);
        list.starts.push_back(list.images.size());
      }
    images.make_room();
    return std::move(list);
  }


  template <int dim>
  void FictitiousBondSearch<dim>::add(const unsigned int image,
                                      const unsigned int member,
                                      const double       factor,
                                      const bool         cut)
  {
    if (cut)
      list.cut.push_back(list.images.size());
    list.images.push_back(image);
    unsigned int unit = cut ? FictitiousBondList<dim>::gone : member;
    if (!cut && factor != 1.)
      {
        const auto [entry, is_new] = unit_with.try_emplace({member, factor}, list.units.size());
        unit                       = entry->second;
        if (is_new)
          {
            UnitBond<dim> more = list.units[member];
            more.moment *= factor;
            more.weight *= factor;
            list.units.push_back(more);
          }
      }
    list.unit_of.push_back(unit);
  }


  template <int dim>
  std::vector<typename FictitiousBondSearch<dim>::MeshBond> FictitiousBondSearch<dim>::bonds_to(
    const unsigned int i,
    const MeshImages  &beyond) const
  {
    const Nodes<dim> &nodes    = families.nodes();
    const Point<dim> &center   = nodes.position(i);
    const double      farthest = halo_of_images(families.weights().reach());
    std::vector<std::pair<Tensor<1, dim>, unsigned int>> around;
    beyond.bins.visit_near(center, [&](const unsigned int g) {
      const Tensor<1, dim> xi = beyond.list[g].place - center;
      if (xi.norm() > 1e-9 * families.weights().reach() &&
          families.weights().of_length(xi.norm()) > 0. &&
          std::all_of(beyond.list[g].term_places.begin(),
                      beyond.list[g].term_places.end(),
                      [&](const Point<dim> &p) { return center.distance(p) < farthest; }))
        around.emplace_back(xi, g);
    });
    // In the order of the relative position; images at one place come in the order in which they
    // were found.
    std::sort(around.begin(), around.end(), [](const auto &a, const auto &b) {
      for (unsigned int d = dim; d-- > 0;)
        if (a.first[d] != b.first[d])
          return a.first[d] < b.first[d];
      return a.second < b.second;
    });
    std::vector<MeshBond> bonds;
    for (const auto &[xi, g] : around)
      {
        const BoundaryImage<dim> &image = beyond.list[g];
        if (families.cracks().leaves_body(image.origin, i)) // the origin is near a side
          continue;
        // As on a lattice.
        const bool cut = !families.cracks().empty() &&
                         is_cut<dim>(families, i, image.terms, image.twice_planes);
        if (cut && !(image.terms.size() == 1 &&
                     is_separated(families, i, image.terms[0], image.twice_planes)))
          continue;
        bonds.push_back(
          {xi,
           g,
           cut ? 0. : nodes.volume(i) * image.volume * families.weights().of_length(xi.norm())});
      }
    return bonds;
  }


  template <int dim>
  unsigned int FictitiousBondSearch<dim>::image_on_mesh(const unsigned int g, MeshImages &beyond)
  {
    unsigned int &number = beyond.number_of[g];
    if (number == numbers::invalid_unsigned_int)
      {
        const BoundaryImage<dim>             &image = beyond.list[g];
        typename FictitiousImages<dim>::Image fields{};
        fields.place  = image.place;
        fields.planes = image.planes;
        fields.volume = image.volume;
        fields.origin = image.origin;
        number        = images.add(fields, image.terms, &image.twice_planes);
      }
    return number;
  }


  template <int dim>
  void FictitiousBondSearch<dim>::add(const unsigned int image, const MeshBond &bond)
  {
    if (bond.w == 0.)
      list.cut.push_back(list.images.size());
    list.images.push_back(image);
    list.moments.push_back(bond.w * bond.xi);
    list.squares.push_back(bond.w * bond.xi.norm_square());
  }


  /**
   * The products n_a n_b n_c n_d, a <= b <= c <= d, of n = xi/x, each times the root of how often
   * it occurs in the tensor: their squares sum to its norm, however the body is turned.
   */
  template <int dim>
  typename FictitiousBondSearch<dim>::FourthMoments FictitiousBondSearch<dim>::fourth_moments(
    const Tensor<1, dim> &xi)
  {
    const Tensor<1, dim> n = xi / xi.norm();
    FourthMoments        all;
    unsigned int         k = 0;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        for (unsigned int c = b; c < dim; ++c)
          for (unsigned int d = c; d < dim; ++d)
            all[k++] = std::sqrt(n_orders({a, b, c, d})) * n[a] * n[b] * n[c] * n[d];
    return all;
  }


  template <int dim>
  void FictitiousBondSearch<dim>::complete_on_mesh(const unsigned int           i,
                                                   const std::vector<MeshBond> &bonds,
                                                   MeshImages                  &beyond,
                                                   const std::vector<MeshBond> &everywhere)
  {
    // What images beyond the other sides would have of sum w x^2 n_a n_b n_c n_d.
    FourthMoments gap{};
    double        size       = 0.;
    const auto    add_to_gap = [&](const std::vector<MeshBond> &some, const double sign) {
      for (const MeshBond &bond : some)
        if (bond.w > 0.)
          {
            const FourthMoments moments = fourth_moments(bond.xi);
            const double        square  = bond.w * bond.xi.norm_square();
            size += square;
            for (unsigned int k = 0; k < gap.size(); ++k)
              gap[k] += sign * square * moments[k];
          }
    };
    add_to_gap(everywhere, 1.);
    add_to_gap(bonds, -1.);
    if (std::all_of(gap.begin(), gap.end(), [&](const double g) {
          return std::abs(g) <= 1e-9 * size;
        }))
      return;
    // The bonds that there are: in the body, and to images, which in a body that is mirrored stand
    // for bonds of the whole.
    std::vector<typename Families<dim>::Member> members;
    std::vector<MeshBond>                       own;
    std::vector<FourthMoments>                  moments;
    std::vector<double>                         squares;
    families.members_of(i, members);
    for (const auto &member : members)
      own.push_back({families.neighbors().bond_vector(i, member.neighbor),
                     member.neighbor,
                     member.weight * member.kept});
    own.insert(own.end(), bonds.begin(), bonds.end());
    for (const MeshBond &bond : own)
      {
        moments.push_back(fourth_moments(bond.xi));
        squares.push_back(bond.w * bond.xi.norm_square());
      }
    const std::vector<double> additions = least_additions(moments, squares, gap, 1e-6);
    constexpr double          least     = 1e-6; // what is less may be round-off
    for (unsigned int k = 0; k < own.size(); ++k)
      if (additions[k] > least && own[k].w > 0.)
        add(k < members.size() ? image_of(own[k].image) : beside_on_mesh(own[k].image, beyond),
            {own[k].xi, own[k].image, own[k].w * additions[k]});
  }


  template <int dim>
  unsigned int FictitiousBondSearch<dim>::beside_on_mesh(const unsigned int g, MeshImages &beyond)
  {
    const unsigned int image = image_on_mesh(g, beyond);
    if (!images.is_mirrored_alone(image))
      return image; // does not break by itself
    return beside_of(image, beyond.list[g].terms, &beyond.list[g].twice_planes);
  }


  template <int dim>
  unsigned int FictitiousBondSearch<dim>::beside_of(const unsigned int       image,
                                                    const std::vector<Term> &terms,
                                                    const Point<dim>        *twice_planes)
  {
    const auto [entry, is_new] = beside.try_emplace(image, images.size());
    if (is_new)
      {
        auto fields    = images[image];
        fields.is_real = true;
        images.add(fields, terms, twice_planes);
      }
    return entry->second;
  }


  template <int dim>
  void FictitiousBondSearch<dim>::find_site(const unsigned int i, const unsigned int member)
  {
    const Nodes<dim>   &nodes   = families.nodes();
    const Lattice<dim> &lattice = *nodes.lattice();
    const Index         index =
      lattice.index(nodes.position(i)) + families.weights().members()[member].offset;
    const unsigned int real   = families.neighbors().node_at(index);
    Member            &result = family[member];
    result                    = {real, 0., 0.};
    if (real != numbers::invalid_unsigned_int)
      result.inside = nodes.volume(real);
    if (!extension->is_inside(index) && extension->find(index, site))
      result.beyond = site.volume - result.inside;
    if (result.beyond <= 1e-9 * site.volume ||
        (families.near_crack(i) && families.cracks().leaves_body(i, index)))
      result.beyond = 0.;
  }


  template <int dim>
  const std::vector<double> *FictitiousBondSearch<dim>::completing_factors(const unsigned int i)
  {
    if (!completion)
      return nullptr;
    const double whole       = families.nodes().lattice()->cell_volume();
    bool         any_missing = false;
    volumes.resize(family.size());
    for (unsigned int m = 0; m < family.size(); ++m)
      {
        double volume = family[m].inside + family[m].beyond;
        if (std::abs(volume - whole) < 1e-9 * whole)
          volume = whole;
        any_missing = any_missing || volume < whole;
        volumes[m]  = volume;
      }
    if (!any_missing)
      return nullptr;
    for (unsigned int m = 0; m < family.size() && families.near_crack(i); ++m)
      if (family[m].inside > 0. && families.cracks().leaves_body(i, family[m].node))
        volumes[m] = family[m].beyond;
    return &completion->factors(volumes);
  }


  template <int dim>
  void FictitiousBondSearch<dim>::find_on_lattice(const unsigned int i)
  {
    family.resize(families.weights().members().size());
    for (unsigned int m = 0; m < family.size(); ++m)
      find_site(i, m);
    const std::vector<double> *const factors = completing_factors(i);
    for (unsigned int m = 0; m < family.size(); ++m)
      {
        const Member member = family[m];
        const double more   = factors != nullptr ? (*factors)[m] : 0.;
        if (member.beyond > 0.)
          add_beyond(i, m, more);
        if (more > 0. && member.inside > 0. && volumes[m] > 0. &&
            !(families.near_crack(i) && families.cracks().cuts(i, member.node)))
          add(image_of(member.node), m, more, false);
      }
  }


  template <int dim>
  void FictitiousBondSearch<dim>::add_beyond(const unsigned int i,
                                             const unsigned int member,
                                             const double       more)
  {
    const Nodes<dim>   &nodes   = families.nodes();
    const Lattice<dim> &lattice = *nodes.lattice();
    const Index         index =
      lattice.index(nodes.position(i)) + families.weights().members()[member].offset;
    extension->find(index, site);
    const Point<dim> place = lattice.position(index);
    const bool       alone = site.terms.size() == 1; // then it breaks by itself
    const bool       cut   = families.near_crack(i) && is_cut<dim>(families, i, site.terms, place);
    // What a crack cuts of a mirror image counts in the damage.
    if (cut && !(alone && is_separated(families, i, site.terms[0], place)))
      return;
    const unsigned int image = image_at(index, family[member].beyond);
    // What completes the family is apart from a bond that breaks, as in the body.
    add(image, member, alone ? 1. : 1. + more, cut);
    if (!alone || more <= 0. || cut)
      return;
    add(beside_of(image, site.terms, nullptr), member, more, false);
  }


  template <int dim>
  unsigned int FictitiousBondSearch<dim>::image_of(const unsigned int node)
  {
    const auto [entry, is_new] = of_node.try_emplace(node, images.size());
    if (!is_new)
      return entry->second;
    const Nodes<dim>                     &nodes = families.nodes();
    typename FictitiousImages<dim>::Image fields{};
    fields.planes.fill(numbers::invalid_boundary_id);
    fields.place   = nodes.position(node);
    fields.volume  = nodes.volume(node);
    fields.origin  = node;
    fields.is_real = true;
    if (nodes.lattice())
      fields.site = nodes.lattice()->index(fields.place);
    const Point<dim> no_planes;
    return images.add(fields, {Term{node, 0, 1.}}, nodes.lattice() ? nullptr : &no_planes);
  }


  template <int dim>
  unsigned int FictitiousBondSearch<dim>::image_at(const Index &index, const double volume)
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    std::size_t         key     = 0;
    for (unsigned int d = dim; d-- > 0;)
      {
        const std::size_t wide = 4 * static_cast<std::size_t>(lattice.n_sites[d]) + 4096;
        key                    = key * wide + (index[d] + wide / 2);
      }
    const auto [entry, is_new] = at_site.try_emplace(key, images.size());
    if (!is_new)
      return entry->second;
    typename FictitiousImages<dim>::Image fields{};
    for (unsigned int d = 0; d < dim; ++d)
      fields.planes[d] = 2 * d + (2 * index[d] >= lattice.n_sites[d] - 1 ? 1 : 0);
    fields.place  = lattice.position(index);
    fields.volume = volume;
    fields.origin = site.origin;
    fields.site   = index;
    return images.add(fields, site.terms);
  }


  PERIDEAL_INSTANTIATE_CLASS(class FictitiousBondSearch);
} // namespace PeriDeal
