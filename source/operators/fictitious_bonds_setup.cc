// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which bonds lead beyond the sides.

#include <perideal/base/interleaved.h>
#include <perideal/bonds/point_bins.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/fictitious_bonds.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FictitiousBonds<dim>::FictitiousBonds(const Families<dim>                   &families,
                                        const std::array<BeyondSide, 2 * dim> &beyond)
    : families(families)
    , extension(families, beyond)
  {
    const Nodes<dim> &nodes = families.nodes();
    int               reach = 0;
    for (const FamilyMember<dim> &member : families.weights().members())
      for (unsigned int d = 0; d < dim; ++d)
        reach = std::max(reach, member.offset[d]);
    starts.assign(1, 0);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        if (extension.distance(nodes.lattice()->index(nodes.position(i))) <= reach)
          find_bonds_of(i);
        if (images.size() > starts.back())
          list.push_back(i);
        starts.push_back(images.size());
      }
    image_of = {};
    make_room();
  }


  template <int dim>
  FictitiousBonds<dim>::FictitiousBonds(const Families<dim>                   &families,
                                        const std::vector<BoundaryImage<dim>> &beyond)
    : families(families)
    , extension(families, {})
  {
    const Nodes<dim> &nodes = families.nodes();
    PointBins<dim>    bins(families.weights().reach());
    for (unsigned int g = 0; g < beyond.size(); ++g)
      bins.add(beyond[g].place, g);
    std::vector<unsigned int> number_of(beyond.size(), numbers::invalid_unsigned_int);
    starts.assign(1, 0);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        find_bonds_of(i, beyond, bins, number_of);
        if (images.size() > starts.back())
          list.push_back(i);
        starts.push_back(images.size());
      }
    make_room();
  }


  template <int dim>
  void FictitiousBonds<dim>::make_room()
  {
    if (!parted.empty())
      state.resize(images.size());
    for (const std::size_t number : parted)
      state.mark(number, BondState::parted, 0.);
    parted = {};
    values.resize(dim * origins.size());
    image_forces.resize(values.size());
    passed.reinit(interleaved(*families.nodes().partitioner(), dim));
  }


  template <int dim>
  void FictitiousBonds<dim>::find_bonds_of(const unsigned int                     i,
                                           const std::vector<BoundaryImage<dim>> &beyond,
                                           const PointBins<dim>                  &bins,
                                           std::vector<unsigned int>             &number_of)
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
        // As on a lattice.
        const bool cut = !families.cracks().empty() &&
                         is_cut(i, image.terms, [&](const Term &) { return image.twice_planes; });
        if (cut &&
            !(image.terms.size() == 1 && is_separated(i, image.terms[0], image.twice_planes)))
          continue;
        if (number_of[g] == numbers::invalid_unsigned_int)
          {
            number_of[g] = origins.size();
            places.push_back(image.place);
            planes.push_back(image.planes);
            volumes.push_back(image.volume);
            origins.push_back(image.origin);
            terms.insert(terms.end(), image.terms.begin(), image.terms.end());
            term_starts.push_back(terms.size());
          }
        const double w =
          cut ? 0. : nodes.volume(i) * image.volume * families.weights().of_length(xi.norm());
        if (cut)
          parted.push_back(images.size());
        images.push_back(number_of[g]);
        moments.push_back(w * xi);
        springs.push_back(w * xi.norm_square());
      }
  }


  template <int dim>
  void FictitiousBonds<dim>::find_bonds_of(const unsigned int i)
  {
    const Nodes<dim>   &nodes      = families.nodes();
    const Lattice<dim> &lattice    = *nodes.lattice();
    const Index         center     = lattice.index(nodes.position(i));
    const bool          near_crack = families.near_crack(i);
    Site                site;
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        const Index index = center + member.offset;
        if (extension.is_inside(index) || !extension.find(index, site))
          continue;
        const unsigned int real   = families.neighbors().node_at(index);
        const double       inside = real == numbers::invalid_unsigned_int ? 0. : nodes.volume(real);
        const double       volume = site.volume - inside;
        if (volume <= 1e-9 * site.volume)
          continue;
        // What a crack cuts of a mirror image counts in the damage.
        const auto twice_planes = [&](const Term &term) {
          return Point<dim>(lattice.position(index) + (nodes.position(term.node) - Point<dim>()));
        };
        const bool cut = near_crack && is_cut(i, site.terms, twice_planes);
        if (cut && !(site.terms.size() == 1 &&
                     is_separated(i, site.terms[0], twice_planes(site.terms[0]))))
          continue;
        Tensor<1, dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = member.offset[d] * lattice.spacing[d];
        const double w = cut ? 0. : nodes.volume(i) * volume * member.weight;
        if (cut)
          parted.push_back(images.size());
        images.push_back(image_at(index, site, volume));
        moments.push_back(w * xi);
        springs.push_back(w * xi.norm_square());
      }
  }


  template <int dim>
  unsigned int FictitiousBonds<dim>::image_at(const Index &index,
                                              const Site  &site,
                                              const double volume)
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    std::size_t         key     = 0;
    for (unsigned int d = dim; d-- > 0;)
      {
        const std::size_t wide = 4 * static_cast<std::size_t>(lattice.n_sites[d]) + 4096;
        key                    = key * wide + (index[d] + wide / 2);
      }
    const auto [entry, is_new] = image_of.try_emplace(key, origins.size());
    if (is_new)
      {
        sites.push_back(index);
        places.push_back(lattice.position(index));
        std::array<types::boundary_id, dim> sides;
        for (unsigned int d = 0; d < dim; ++d)
          sides[d] = 2 * d + (2 * index[d] >= lattice.n_sites[d] - 1 ? 1 : 0);
        planes.push_back(sides);
        volumes.push_back(volume);
        origins.push_back(site.origin);
        terms.insert(terms.end(), site.terms.begin(), site.terms.end());
        term_starts.push_back(terms.size());
      }
    return entry->second;
  }


  template <int dim>
  bool FictitiousBonds<dim>::is_separated(const unsigned int i,
                                          const Term        &term,
                                          const Point<dim>  &twice_planes) const
  {
    // Instead of the cracks mirror the bond, about each set of planes of symmetry that it passes.
    const Nodes<dim> &nodes = families.nodes();
    for (unsigned int image = 0; image < (1u << dim); ++image)
      {
        if ((image & ~term.mirrored) != 0)
          continue;
        Point<dim> a = nodes.crack_point(i), b = nodes.crack_point(term.node);
        for (unsigned int d = 0; d < dim; ++d)
          if ((image >> d) & 1)
            a[d] = twice_planes[d] - a[d];
          else if ((term.mirrored >> d) & 1)
            b[d] = twice_planes[d] - b[d];
        if (families.cracks().separate(a, b))
          return true;
      }
    return false;
  }


  template <int dim>
  bool FictitiousBonds<dim>::is_cut(
    const unsigned int                             i,
    const std::vector<Term>                       &of_image,
    const std::function<Point<dim>(const Term &)> &twice_planes) const
  {
    for (const Term &term : of_image)
      {
        bool cut = false;
        if (term.mirrored != 0 || !families.nodes().lattice())
          cut = is_separated(i, term, twice_planes(term)); // beyond the reach, too
        else if (term.node != i)
          cut = families.cracks().cuts(i, term.node);
        if (cut)
          return true;
      }
    return false;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                          \
  template FictitiousBonds<dim>::FictitiousBonds(const Families<dim> &,                    \
                                                 const std::array<BeyondSide, 2 * dim> &); \
  template FictitiousBonds<dim>::FictitiousBonds(const Families<dim> &,                    \
                                                 const std::vector<BoundaryImage<dim>> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
