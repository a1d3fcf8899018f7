// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which bonds lead beyond the sides.

#include <perideal/bonds/point_bins.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/family_completion.h>
#include <perideal/operators/solid/fictitious_bonds.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  struct FictitiousBonds<dim>::Search
  {
    /** What lies at the site of a member, as a node sees it. */
    struct Member
    {
      unsigned int node;           // to which it has a bond, or none
      double       inside, beyond; // volumes of this, and beyond the sides
    };

    std::unordered_map<std::size_t, unsigned int>           image_at; // by the key of its site
    std::unordered_map<unsigned int, unsigned int>          image_of; // by the node itself
    std::unordered_map<unsigned int, unsigned int>          beside;   // by the image at its place
    std::vector<std::size_t>                                parted;   // bonds
    std::optional<FamilyCompletion<dim>>                    completion;
    std::vector<Member>                                     family; // of the node at work
    std::vector<double>                                     volumes;
    const FictitiousExtension<dim>                         *extension = nullptr;
    Site                                                    site;
    std::vector<UnitBond<dim>>                              units;
    std::map<std::pair<unsigned int, double>, unsigned int> number_of; // of units with a factor
    std::vector<unsigned int>                               unit_of;   // each bond, or gone

    static constexpr unsigned int gone = static_cast<unsigned int>(-1);
  };


  template <int dim>
  FictitiousBonds<dim>::FictitiousBonds(const Families<dim>                   &families,
                                        const std::array<BeyondSide, 2 * dim> &beyond,
                                        const bool                             completes,
                                        const bool                             may_pack)
    : families(families)
    , fictitious(families.nodes())
    , packs(may_pack)
  {
    const Nodes<dim>              &nodes   = families.nodes();
    const Lattice<dim>            &lattice = *nodes.lattice();
    const FictitiousExtension<dim> extension(families, beyond);
    Search                         search;
    search.extension  = &extension;
    search.units      = unit_bonds(families);
    int         reach = 0;
    std::size_t sites = 1;
    for (const FamilyMember<dim> &member : families.weights().members())
      for (unsigned int d = 0; d < dim; ++d)
        reach = std::max(reach, member.offset[d]);
    for (unsigned int d = 0; d < dim; ++d)
      sites *= lattice.n_sites[d];
    if (completes)
      search.completion.emplace(families.weights(), lattice);
    const bool all = completes && nodes.n_global() < sites;
    find_bonds(search, [&](const unsigned int i, Search &of_all) {
      const auto site = lattice.index(nodes.position(i));
      bool       near = all || extension.distance(site) <= reach;
      for (unsigned int d = 0; d < dim && completes; ++d)
        near = near || std::min(site[d], lattice.n_sites[d] - 1 - site[d]) <= reach;
      if (near)
        find_bonds_of(i, of_all);
    });
    pack(search);
  }


  template <int dim>
  FictitiousBonds<dim>::FictitiousBonds(const Families<dim>                   &families,
                                        const std::vector<BoundaryImage<dim>> &beyond)
    : families(families)
    , fictitious(families.nodes())
  {
    PointBins<dim> bins(families.weights().reach());
    for (unsigned int g = 0; g < beyond.size(); ++g)
      bins.add(beyond[g].place, g);
    std::vector<unsigned int> number_of(beyond.size(), numbers::invalid_unsigned_int);
    Search                    search;
    find_bonds(search, [&](const unsigned int i, Search &of_all) {
      find_bonds_of(i, beyond, bins, number_of, of_all);
    });
    moments.shrink_to_fit();
    springs.shrink_to_fit();
  }


  template <int dim>
  template <typename Find>
  void FictitiousBonds<dim>::find_bonds(Search &search, const Find &find)
  {
    starts.assign(1, 0);
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      {
        find(i, search);
        if (image_of_bond.size() == starts.back())
          continue;
        list.push_back(i);
        starts.push_back(image_of_bond.size());
      }
    if (!search.parted.empty())
      state.resize(image_of_bond.size());
    for (const std::size_t number : search.parted)
      state.mark(number, BondState::parted, 0.);
    for (auto *numbers : {&image_of_bond, &list})
      numbers->shrink_to_fit();
    starts.shrink_to_fit();
    fictitious.make_room();
  }


  template <int dim>
  void FictitiousBonds<dim>::pack(Search &search)
  {
    packs = packs && search.units.size() < BondCode::gone;
    if (packs)
      {
        codes.reserve(search.unit_of.size());
        for (const unsigned int unit : search.unit_of)
          codes.push_back(
            static_cast<BondCode::Code>(unit == Search::gone ? BondCode::gone : unit));
        units = std::move(search.units);
        return;
      }
    moments.reserve(search.unit_of.size());
    springs.reserve(search.unit_of.size());
    for (std::size_t place = 0; place < list.size(); ++place)
      for (std::size_t k = starts[place]; k < starts[place + 1]; ++k)
        {
          const bool           none = search.unit_of[k] == Search::gone;
          const UnitBond<dim> &unit = search.units[none ? 0 : search.unit_of[k]];
          const double         w =
            none ? 0. : families.nodes().volume(list[place]) * fictitious[image_of_bond[k]].volume;
          moments.push_back(w * unit.moment);
          springs.push_back(w * unit.weight);
        }
  }


  template <int dim>
  void FictitiousBonds<dim>::add_bond(const unsigned int    image,
                                      const Tensor<1, dim> &xi,
                                      const double          weight,
                                      const bool            cut,
                                      Search               &search)
  {
    const double w = cut ? 0. : weight;
    if (cut)
      search.parted.push_back(image_of_bond.size());
    image_of_bond.push_back(image);
    moments.push_back(w * xi);
    springs.push_back(w * xi.norm_square());
  }


  template <int dim>
  void FictitiousBonds<dim>::add_lattice_bond(const unsigned int image,
                                              const unsigned int member,
                                              const double       factor,
                                              const bool         cut,
                                              Search            &search)
  {
    if (cut)
      search.parted.push_back(image_of_bond.size());
    image_of_bond.push_back(image);
    unsigned int unit = cut ? Search::gone : member;
    if (!cut && factor != 1.)
      {
        const auto [entry, is_new] =
          search.number_of.try_emplace({member, factor}, search.units.size());
        unit = entry->second;
        if (is_new)
          {
            UnitBond<dim> more = search.units[member];
            more.moment *= factor;
            more.weight *= factor;
            search.units.push_back(more);
          }
      }
    search.unit_of.push_back(unit);
  }


  template <int dim>
  void FictitiousBonds<dim>::find_bonds_of(const unsigned int                     i,
                                           const std::vector<BoundaryImage<dim>> &beyond,
                                           const PointBins<dim>                  &bins,
                                           std::vector<unsigned int>             &number_of,
                                           Search                                &search)
  {
    const Nodes<dim> &nodes    = families.nodes();
    const Point<dim> &center   = nodes.position(i);
    const double      farthest = halo_of_images(families.weights().reach());
    std::vector<std::pair<Tensor<1, dim>, unsigned int>> around;
    bins.visit_near(center, [&](const unsigned int g) {
      const Tensor<1, dim> xi = beyond[g].place - center;
      if (xi.norm() > 1e-9 * families.weights().reach() &&
          families.weights().of_length(xi.norm()) > 0. &&
          std::all_of(beyond[g].term_places.begin(),
                      beyond[g].term_places.end(),
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
    for (const auto &[xi, g] : around)
      {
        const BoundaryImage<dim> &image = beyond[g];
        if (families.cracks().leaves_body(i, image.origin))
          continue;
        // As on a lattice.
        const bool cut = !families.cracks().empty() &&
                         is_cut(i, image.terms, [&](const Term &) { return image.twice_planes; });
        if (cut &&
            !(image.terms.size() == 1 && is_separated(i, image.terms[0], image.twice_planes)))
          continue;
        if (number_of[g] == numbers::invalid_unsigned_int)
          {
            typename FictitiousImages<dim>::Image fields{};
            fields.place  = image.place;
            fields.planes = image.planes;
            fields.volume = image.volume;
            fields.origin = image.origin;
            number_of[g]  = fictitious.add(fields, image.terms, &image.twice_planes);
          }
        const double weight = families.weights().of_length(xi.norm());
        add_bond(number_of[g], xi, nodes.volume(i) * image.volume * weight, cut, search);
      }
  }


  template <int dim>
  void FictitiousBonds<dim>::find_site(const unsigned int i,
                                       const unsigned int member,
                                       const bool         near_void,
                                       Search            &search) const
  {
    const Nodes<dim>   &nodes   = families.nodes();
    const Lattice<dim> &lattice = *nodes.lattice();
    const Index         index =
      lattice.index(nodes.position(i)) + families.weights().members()[member].offset;
    const unsigned int       real   = families.neighbors().node_at(index);
    typename Search::Member &result = search.family[member];
    result                          = {real, 0., 0.};
    if (real != numbers::invalid_unsigned_int)
      result.inside = nodes.volume(real);
    if (!search.extension->is_inside(index) && search.extension->find(index, search.site))
      result.beyond = search.site.volume - result.inside;
    if (result.beyond <= 1e-9 * search.site.volume ||
        (near_void && families.cracks().leaves_body(i, index)))
      result.beyond = 0.;
  }


  template <int dim>
  void FictitiousBonds<dim>::find_bonds_of(const unsigned int i, Search &search)
  {
    const Nodes<dim>   &nodes      = families.nodes();
    const Lattice<dim> &lattice    = *nodes.lattice();
    const bool          near_crack = families.near_crack(i);
    const auto         &members    = families.weights().members();
    search.family.resize(members.size());
    for (unsigned int m = 0; m < members.size(); ++m)
      find_site(i, m, near_crack, search);
    const std::vector<double> *factors = nullptr;
    if (search.completion)
      {
        const double whole = lattice.cell_volume();
        search.volumes.resize(members.size());
        bool any_missing = false;
        for (unsigned int m = 0; m < members.size(); ++m)
          {
            double volume = search.family[m].inside + search.family[m].beyond;
            if (std::abs(volume - whole) < 1e-9 * whole)
              volume = whole;
            any_missing       = any_missing || volume < whole;
            search.volumes[m] = volume;
          }
        for (unsigned int m = 0; m < members.size() && any_missing && near_crack; ++m)
          if (const auto &member = search.family[m];
              member.inside > 0. && families.cracks().leaves_body(i, member.node))
            search.volumes[m] = member.beyond;
        if (any_missing)
          factors = &search.completion->factors(search.volumes);
      }
    for (unsigned int m = 0; m < members.size(); ++m)
      {
        const auto   member = search.family[m];
        const double more   = factors != nullptr ? (*factors)[m] : 0.;
        if (member.beyond > 0.)
          add_bond_beyond(i, m, more, search);
        if (more > 0. && member.inside > 0. && search.volumes[m] > 0. &&
            !(near_crack && families.cracks().cuts(i, member.node)))
          add_lattice_bond(image_of(member.node, search), m, more, false, search);
      }
  }


  template <int dim>
  void FictitiousBonds<dim>::add_bond_beyond(const unsigned int i,
                                             const unsigned int member,
                                             const double       more,
                                             Search            &search)
  {
    const Nodes<dim>   &nodes   = families.nodes();
    const Lattice<dim> &lattice = *nodes.lattice();
    const Site         &site    = search.site;
    const Index         index =
      lattice.index(nodes.position(i)) + families.weights().members()[member].offset;
    search.extension->find(index, search.site);
    // What a crack cuts of a mirror image counts in the damage.
    const auto twice_planes = [&](const Term &term) {
      return Point<dim>(lattice.position(index) + (nodes.position(term.node) - Point<dim>()));
    };
    const bool cut = families.near_crack(i) && is_cut(i, site.terms, twice_planes);
    if (cut &&
        !(site.terms.size() == 1 && is_separated(i, site.terms[0], twice_planes(site.terms[0]))))
      return;
    const unsigned int image = image_at(index, site, search.family[member].beyond, search);
    // Of a bond that breaks by itself what completes the family is apart, as in the body.
    const bool breaks = site.terms.size() == 1;
    add_lattice_bond(image, member, breaks ? 1. : 1. + more, cut, search);
    if (!breaks || more <= 0. || cut)
      return;
    const auto [entry, is_new] = search.beside.try_emplace(image, fictitious.size());
    if (is_new)
      {
        auto fields    = fictitious[image];
        fields.is_real = true;
        fictitious.add(fields, site.terms);
      }
    add_lattice_bond(entry->second, member, more, false, search);
  }


  template <int dim>
  unsigned int FictitiousBonds<dim>::image_of(const unsigned int node, Search &search)
  {
    const auto [entry, is_new] = search.image_of.try_emplace(node, fictitious.size());
    if (!is_new)
      return entry->second;
    const Nodes<dim>                     &nodes = families.nodes();
    typename FictitiousImages<dim>::Image fields{};
    fields.planes.fill(numbers::invalid_boundary_id);
    fields.place   = nodes.position(node);
    fields.volume  = nodes.volume(node);
    fields.origin  = node;
    fields.site    = nodes.lattice()->index(fields.place);
    fields.is_real = true;
    return fictitious.add(fields, {Term{node, 0, 1.}});
  }


  template <int dim>
  unsigned int FictitiousBonds<dim>::image_at(const Index &index,
                                              const Site  &site,
                                              const double volume,
                                              Search      &search)
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    std::size_t         key     = 0;
    for (unsigned int d = dim; d-- > 0;)
      {
        const std::size_t wide = 4 * static_cast<std::size_t>(lattice.n_sites[d]) + 4096;
        key                    = key * wide + (index[d] + wide / 2);
      }
    const auto [entry, is_new] = search.image_at.try_emplace(key, fictitious.size());
    if (!is_new)
      return entry->second;
    typename FictitiousImages<dim>::Image fields{};
    for (unsigned int d = 0; d < dim; ++d)
      fields.planes[d] = 2 * d + (2 * index[d] >= lattice.n_sites[d] - 1 ? 1 : 0);
    fields.place  = lattice.position(index);
    fields.volume = volume;
    fields.origin = site.origin;
    fields.site   = index;
    return fictitious.add(fields, site.terms);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                         \
  template FictitiousBonds<dim>::FictitiousBonds(const Families<dim> &,                   \
                                                 const std::array<BeyondSide, 2 * dim> &, \
                                                 const bool,                              \
                                                 const bool);                             \
  template FictitiousBonds<dim>::FictitiousBonds(const Families<dim> &,                   \
                                                 const std::vector<BoundaryImage<dim>> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
