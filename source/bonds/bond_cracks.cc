// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The cracks along a bond, and what changes when they grow.

#include <perideal/bonds/families.h>
#include <perideal/laws/crack_conductance.h>
#include <perideal/mesh/lattice_sites.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  template <typename Test>
  void Families<dim>::test_images(const unsigned int         node,
                                  const FictitiousNode<dim> &fictitious,
                                  const Test                &test) const
  {
    // The body and its cracks are mirrored to the outside. Instead of the cracks mirror the bond,
    // about each set of the sides that it passes.
    const Lattice<dim> &lattice = *own_nodes->lattice();
    const auto          origin  = lattice.index(own_nodes->position(fictitious.mirror));
    for (unsigned int image = 0; image < (1u << dim); ++image)
      {
        auto a = lattice.index(own_nodes->position(node)), b = fictitious.site;
        bool mirrored = true;
        for (unsigned int d = 0; d < dim && mirrored; ++d)
          if ((image >> d) & 1)
            {
              // The sum of the sites of mirror images of each other is that of the mirror and the
              // fictitious node.
              mirrored        = origin[d] != fictitious.site[d];
              const int twice = origin[d] + fictitious.site[d];
              a[d]            = twice - a[d];
              b[d]            = twice - b[d];
            }
        if (mirrored)
          test(lattice.position(a), lattice.position(b));
      }
  }


  template <int dim>
  template <typename Test>
  void Families<dim>::test_crossings(const unsigned int        node,
                                     const unsigned int        neighbor,
                                     const CrackGeometry<dim> &crack,
                                     const Test               &test) const
  {
    const auto if_separated = [&](const Point<dim> &a, const Point<dim> &b) {
      if (crack.separates(a, b))
        test(a, b);
    };
    if (neighbor < own_nodes->n_local())
      if_separated(own_nodes->crack_point(node), own_nodes->crack_point(neighbor));
    else
      test_images(node, outside[neighbor - own_nodes->n_local()], if_separated);
  }


  template <int dim>
  double Families<dim>::kept_fraction(const unsigned int node,
                                      const unsigned int neighbor,
                                      bool              &cut) const
  {
    double kept = 1.;
    cut         = false;
    for (std::size_t k = 0; k < cracks.size();)
      {
        // A bond may meet several pieces of a crack, or a piece and its mirror image where the
        // crack ends on a side: that is one crossing.
        double             fraction = 1.;
        const unsigned int crack    = cracks[k].crack;
        for (; k < cracks.size() && cracks[k].crack == crack; ++k)
          {
            if (!cracks[k].is_near(own_nodes->position(node), farthest))
              continue;
            test_crossings(node,
                           neighbor,
                           cracks[k],
                           [&](const Point<dim> &a, const Point<dim> &b) {
                             cut = true;
                             fraction =
                               std::min(fraction,
                                        contact_conductance < 0. ?
                                          transmission :
                                          contact_fraction(contact_conductance,
                                                           std::abs((b - a) * cracks[k].normal()),
                                                           bond_conductivity(node, neighbor)));
                           });
          }
        kept *= fraction;
      }
    if (voids != nullptr && neighbor < own_nodes->n_local() &&
        voids->leaves_body(own_nodes->position(node), own_nodes->position(neighbor)))
      {
        cut  = true;
        kept = 0.;
      }
    return kept;
  }


  template <int dim>
  void Families<dim>::crossed_cracks(const unsigned int                         node,
                                     const unsigned int                         neighbor,
                                     std::vector<std::pair<unsigned int, int>> &crossed) const
  {
    crossed.clear();
    for (const CrackGeometry<dim> &crack : cracks)
      if (crack.is_near(own_nodes->position(node), farthest) &&
          (crossed.empty() || crossed.back().first != crack.crack))
        test_crossings(node, neighbor, crack, [&](const Point<dim> &a, const Point<dim> &) {
          if (crossed.empty() || crossed.back().first != crack.crack)
            crossed.emplace_back(crack.crack, crack.signed_distance(a) > 0. ? 1 : -1);
        });
  }


  template <int dim>
  std::vector<BoundingBox<dim>> Families<dim>::set_cracks_of(const double time)
  {
    const auto boxes = history.changes(cracks_of, time);
    cracks           = make_crack_geometries(history.pieces(time, cut_at_tips));
    transmission     = history.transmission(time);
    cracks_of        = time;
    return boxes;
  }


  template <int dim>
  std::vector<unsigned int> Families<dim>::nodes_near(const std::vector<BoundingBox<dim>> &boxes,
                                                      const double distance) const
  {
    std::vector<unsigned int> near;
    for (const BoundingBox<dim> &box : boxes)
      {
        BoundingBox<dim> wide = box;
        wide.extend(distance * (1. + 1e-6));
        if (on_lattice)
          sites_in(wide, near);
        else
          for (unsigned int i = 0; i < own_nodes->n_owned(); ++i)
            if (wide.point_inside(own_nodes->position(i)))
              near.push_back(i);
      }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
  }


  template <int dim>
  void Families<dim>::sites_in(const BoundingBox<dim> &box, std::vector<unsigned int> &found) const
  {
    const Lattice<dim>          &lattice = *own_nodes->lattice();
    typename Lattice<dim>::Index first{}, last{};
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double origin = lattice.position(typename Lattice<dim>::Index{})[d];
        const auto   site   = [&](const double x, const double low, const double high) {
          return static_cast<int>(
            std::clamp(std::floor((x - origin) / lattice.spacing[d]), low, high));
        };
        first[d] = site(box.lower_bound(d), corner[d], corner[d] + extent[d] - 1);
        last[d] =
          site(box.upper_bound(d) + lattice.spacing[d], corner[d], corner[d] + extent[d] - 1);
      }
    for_each_site(first, last, [&](const typename Lattice<dim>::Index &site) {
      if (const unsigned int i = node_of_site[site_key(site)]; i < own_nodes->n_owned())
        found.push_back(i);
    });
  }


  template <int dim>
  double Families<dim>::cracks_now() const
  {
    return cracks_of;
  }


  template <int dim>
  const CrackHistory<dim> &Families<dim>::crack_history() const
  {
    return history;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                                          \
  template double Families<dim>::kept_fraction(const unsigned int, const unsigned int, bool &)                             \
    const;                                                                                                                 \
  template void                          Families<dim>::crossed_cracks(const unsigned int,                                 \
                                              const unsigned int,                                 \
                                              std::vector<std::pair<unsigned int, int>> &) const; \
  template double                        Families<dim>::cracks_now() const;                                                \
  template std::vector<BoundingBox<dim>> Families<dim>::set_cracks_of(const double);                                       \
  template std::vector<unsigned int>     Families<dim>::nodes_near(                                                        \
    const std::vector<BoundingBox<dim>> &,                                                                             \
    const double) const;                                                                                               \
  template const CrackHistory<dim> &Families<dim>::crack_history() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
