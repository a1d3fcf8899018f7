// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which bonds lead beyond the sides.

#include <perideal/bonds/point_bins.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/fictitious_bonds.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FictitiousBonds<dim>::FictitiousBonds(const Families<dim>                   &families,
                                        const std::array<BeyondSide, 2 * dim> &beyond,
                                        const bool                             may_pack)
    : families(families)
    , fictitious(families.nodes())
  {
    const Nodes<dim>              &nodes = families.nodes();
    const FictitiousExtension<dim> extension(families, beyond);
    int                            reach = 0;
    for (const FamilyMember<dim> &member : families.weights().members())
      for (unsigned int d = 0; d < dim; ++d)
        reach = std::max(reach, member.offset[d]);
    if (may_pack)
      units = unit_bonds(families);
    packs = !units.empty() && units.size() < BondCode::gone;
    find_bonds([&](const unsigned int i, Search &search) {
      if (extension.distance(nodes.lattice()->index(nodes.position(i))) <= reach)
        find_bonds_of(i, extension, search);
    });
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
    find_bonds([&](const unsigned int i, Search &search) {
      find_bonds_of(i, beyond, bins, number_of, search);
    });
  }


  template <int dim>
  template <typename Find>
  void FictitiousBonds<dim>::find_bonds(const Find &find)
  {
    Search search;
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
    codes.shrink_to_fit();
    moments.shrink_to_fit();
    springs.shrink_to_fit();
    fictitious.make_room();
  }


  template <int dim>
  void FictitiousBonds<dim>::add_bond(const unsigned int    image,
                                      const Tensor<1, dim> &xi,
                                      const double          weight,
                                      const bool            cut,
                                      const unsigned int    member,
                                      Search               &search)
  {
    const double w = cut ? 0. : weight;
    if (cut)
      search.parted.push_back(image_of_bond.size());
    image_of_bond.push_back(image);
    if (packs)
      {
        codes.push_back(static_cast<BondCode::Code>(cut ? BondCode::gone : member));
        return;
      }
    moments.push_back(w * xi);
    springs.push_back(w * xi.norm_square());
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
        add_bond(number_of[g], xi, nodes.volume(i) * image.volume * weight, cut, 0, search);
      }
  }


  template <int dim>
  void FictitiousBonds<dim>::find_bonds_of(const unsigned int              i,
                                           const FictitiousExtension<dim> &extension,
                                           Search                         &search)
  {
    const Nodes<dim>   &nodes      = families.nodes();
    const Lattice<dim> &lattice    = *nodes.lattice();
    const Index         center     = lattice.index(nodes.position(i));
    const bool          near_crack = families.near_crack(i);
    Site                site;
    const auto         &members = families.weights().members();
    for (unsigned int m = 0; m < members.size(); ++m)
      {
        const FamilyMember<dim> &member = members[m];
        const Index              index  = center + member.offset;
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
        if (near_crack && families.cracks().leaves_body(i, index))
          continue;
        const bool cut = near_crack && is_cut(i, site.terms, twice_planes);
        if (cut && !(site.terms.size() == 1 &&
                     is_separated(i, site.terms[0], twice_planes(site.terms[0]))))
          continue;
        Tensor<1, dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = member.offset[d] * lattice.spacing[d];
        add_bond(image_at(index, site, volume, search),
                 xi,
                 nodes.volume(i) * volume * member.weight,
                 cut,
                 m,
                 search);
      }
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


  template <int dim>
  void FictitiousBonds<dim>::part(const unsigned int node, const double t)
  {
    std::vector<Term> terms;
    for_each_of(node, [&](const Bond &bond) {
      if (!bond.whole)
        return;
      terms.clear();
      fictitious.for_each_term(bond.image, [&](const Term &term) { terms.push_back(term); });
      const bool cut = is_cut(node, terms, [&](const Term &term) {
        if (!families.nodes().lattice())
          return fictitious.twice_planes(bond.image);
        return Point<dim>(fictitious[bond.image].place +
                          (families.nodes().position(term.node) - Point<dim>()));
      });
      if (cut)
        break_bond(bond.number, BondState::parted, t);
    });
  }


  template <int dim>
  bool FictitiousBonds<dim>::is_parted(const unsigned int node) const
  {
    bool any = false;
    for_each_of(node, [&](const Bond &bond) {
      // What was cut from the start has never had a weight.
      any = any || (state.is_parted(bond.number) && squares[bond.number] > 0.);
    });
    return any;
  }


  template <int dim>
  double FictitiousBonds<dim>::weight_left(const unsigned int node) const
  {
    double sum = 0.;
    for_each_of(node, [&](const Bond &bond) {
      if (!state.is_parted(bond.number))
        sum += squares[bond.number] / families.nodes().volume(node);
    });
    return sum;
  }


  template <int dim>
  void FictitiousBonds<dim>::renew_springs(const unsigned int node, const NodeLaws<dim> &of_nodes)
  {
    for_each_of(node, [&](const Bond &bond) {
      if (bond.whole)
        springs[bond.number] = of_nodes.stiffness(node) / squares[bond.number];
    });
  }


  template <int dim>
  void FictitiousBonds<dim>::add_weights(Vector &q) const
  {
    for_each([&](const Bond &bond) {
      q.local_element(bond.node) += bond.spring / families.nodes().volume(bond.node); // W x^2
    });
  }


  template <int dim>
  void FictitiousBonds<dim>::find_springs(const NodeLaws<dim> &of_nodes, const bool full)
  {
    laws = &of_nodes;
    if (packs)
      return;
    if (families.cracks().history().changes_ever())
      squares = springs;
    for_each([&](const Bond &bond) {
      springs[bond.number] = bond.whole ? laws->stiffness(bond.node) / bond.spring : 0.;
    });
    if (!full)
      return;
    across.resize(springs.size(), 0.);
    for (const Tensor<1, dim> &p : moments)
      lengths.push_back(p.norm());
  }


  template <int dim>
  void FictitiousBonds<dim>::set_thermal_strains(const ThermalStrains &strain)
  {
    strains.resize(image_of_bond.size());
    for_each([&](const Bond &bond) {
      // What a temperature linear in space does to a free body is no linear displacement. The bond
      // has no force then if its extension is that of what the image follows from, at r_k from the
      // node: e = sum f_k (s_k M.r_k - r_k^2/2 ds/dM), the mean of both ends for a mirror image.
      const Point<dim>     at  = families.nodes().position(bond.node);
      const Tensor<1, dim> xi  = bond_vector(bond);
      double               own = strain[bond.node], other = 0., mean = 0., half = 0., rest = 1.;
      fictitious.for_each_term(bond.image, [&](const Term &term) {
        Tensor<1, dim> r = families.nodes().position(term.node) - at;
        for (unsigned int d = 0; d < dim; ++d)
          r[d] = (term.mirrored >> d) & 1 ? xi[d] : r[d];
        const double f = term.factor / xi.norm_square(), s = strain[term.node];
        other += term.factor * s;
        mean += f * s * (r * xi);
        half += 0.5 * f * r.norm_square();
        rest -= f * (r * xi);
      });
      // A body narrower than a family mirrors and continues along one axis: no such sum.
      mean -= half * (other - own);
      strains[bond.number] = std::abs(rest) > 1e-6 ? 0.5 * (own + other) : mean;
    });
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                 \
  template FictitiousBonds<dim>::FictitiousBonds(const Families<dim> &,                           \
                                                 const std::array<BeyondSide, 2 * dim> &,         \
                                                 const bool);                                     \
  template FictitiousBonds<dim>::FictitiousBonds(const Families<dim> &,                           \
                                                 const std::vector<BoundaryImage<dim>> &);        \
  template void   FictitiousBonds<dim>::part(const unsigned int, const double);                   \
  template bool   FictitiousBonds<dim>::is_parted(const unsigned int) const;                      \
  template double FictitiousBonds<dim>::weight_left(const unsigned int) const;                    \
  template void   FictitiousBonds<dim>::renew_springs(const unsigned int, const NodeLaws<dim> &); \
  template void   FictitiousBonds<dim>::add_weights(Vector &) const;                              \
  template void   FictitiousBonds<dim>::find_springs(const NodeLaws<dim> &, const bool);          \
  template void   FictitiousBonds<dim>::set_thermal_strains(const ThermalStrains &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
