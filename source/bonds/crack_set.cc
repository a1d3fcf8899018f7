// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/bonds/crack_set.h>
#include <perideal/laws/crack_conductance.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  CrackSet<dim>::CrackSet(const Neighbors<dim>    &neighbors,
                          const CrackHistory<dim> &history,
                          const bool               cut_at_tips,
                          const double             contact_conductance,
                          const BodyVoids<dim>    *voids,
                          const double             transmission_of_broken,
                          const bool               in_part_at_tips)
    : neighbors(neighbors)
    , past(history)
    , cut_at_tips(cut_at_tips)
    , contact_conductance(contact_conductance)
    , voids(voids)
    , time(past.representative(0.))
    , cracks(make_crack_geometries(past.pieces(time, cut_at_tips)))
    , transmission(past.transmission(time))
    , broken_bonds(transmission_of_broken)
  {
    if (in_part_at_tips)
      make_soft_cracks();
  }


  template <int dim>
  double CrackSet<dim>::spacing_along(const CrackPiece<dim> &piece) const
  {
    const Nodes<dim> &nodes = neighbors.nodes();
    if (!nodes.lattice())
      return nodes.smallest_spacing();
    Tensor<1, dim> along = piece.corners[1] - piece.corners[0];
    along /= along.norm();
    double most = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      most = std::max(most, std::abs(along[d]) / nodes.lattice()->spacing[d]);
    return 1. / most;
  }


  template <int dim>
  void CrackSet<dim>::make_soft_cracks()
  {
    // Where tips that are touched cut nothing, the sides of the crack are too soft, and it is as
    // good as longer by this part of a cell (doc/theory.md).
    const double                 shift  = cut_at_tips ? 0. : 0.2;
    std::vector<CrackPiece<dim>> pieces = past.pieces(time, false);
    const auto                   whole  = make_crack_geometries(pieces);
    for (std::size_t k = 0; k < pieces.size(); ++k)
      {
        widths.push_back(spacing_along(pieces[k]));
        const Tensor<1, dim> way = whole[k].corners()[1] - whole[k].corners()[0];
        for (unsigned int end = 0; end < 2; ++end)
          if (!whole[k].is_closed_near(whole[k].corners()[end]))
            pieces[k].corners[end] +=
              (end == 0 ? 1. : -1.) * std::min(0.25, shift * widths[k] / way.norm()) * way;
      }
    soft_cracks = make_crack_geometries(pieces);
  }


  template <int dim>
  bool CrackSet<dim>::is_near_soft(const std::size_t  k,
                                   const unsigned int node,
                                   const double       distance) const
  {
    // Bonds are cut up to half a spacing ahead of a tip.
    return soft_cracks[k].is_near(neighbors.position(node), distance + 0.5 * widths[k]);
  }


  template <int dim>
  double CrackSet<dim>::kept_part(const unsigned int node, const unsigned int neighbor) const
  {
    if (soft_cracks.empty() || !neighbors.is_real(neighbor))
      return cuts(node, neighbor) ? 0. : 1.;
    if (kept_of_broken(node, neighbor) < 1. || leaves_body(node, neighbor))
      return 0.;
    const Point<dim> &a = neighbors.nodes().crack_point(node),
                     &b = neighbors.nodes().crack_point(neighbor);
    double kept         = 1.;
    for (std::size_t k = 0; k < soft_cracks.size();)
      {
        // Several pieces of a crack are one crossing.
        double             part  = 0.;
        const unsigned int crack = soft_cracks[k].crack;
        for (; k < soft_cracks.size() && soft_cracks[k].crack == crack; ++k)
          if (is_near_soft(k, node, neighbors.weights().reach()))
            part = std::max(part, soft_cracks[k].cut_part(a, b, widths[k]));
        kept *= (1. - part) / (1. + 0.5 * part);
      }
    return kept;
  }


  template <int dim>
  template <typename Test>
  void CrackSet<dim>::test_images(const unsigned int         node,
                                  const FictitiousNode<dim> &fictitious,
                                  const Test                &test) const
  {
    // The body and its cracks are mirrored to the outside. Instead of the cracks mirror the bond,
    // about each set of the sides that it passes.
    const Lattice<dim> &lattice = *neighbors.nodes().lattice();
    const auto          origin  = lattice.index(neighbors.position(fictitious.mirror));
    for (unsigned int image = 0; image < (1u << dim); ++image)
      {
        auto a = lattice.index(neighbors.position(node)), b = fictitious.site;
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
  void CrackSet<dim>::test_crossings(const unsigned int        node,
                                     const unsigned int        neighbor,
                                     const CrackGeometry<dim> &crack,
                                     const Test               &test) const
  {
    const auto if_separated = [&](const Point<dim> &a, const Point<dim> &b) {
      if (crack.separates(a, b))
        test(a, b);
    };
    const Nodes<dim> &nodes = neighbors.nodes();
    if (neighbors.is_real(neighbor))
      if_separated(nodes.crack_point(node), nodes.crack_point(neighbor));
    else
      test_images(node, neighbors.outside()[neighbor - nodes.n_local()], if_separated);
  }


  template <int dim>
  double CrackSet<dim>::contact_fraction_of(
    const CrackGeometry<dim>                                 &crack,
    const Point<dim>                                         &a,
    const Point<dim>                                         &b,
    const std::function<std::pair<double, double>(double s)> &conductivities) const
  {
    const double across             = std::abs((b - a) * crack.normal());
    const auto [in_series, of_bond] = conductivities(std::abs(crack.signed_distance(a)) / across);
    return contact_fraction(contact_conductance, across, in_series) * (in_series / of_bond);
  }


  template <int dim>
  std::unordered_map<unsigned int, Point<dim>> CrackSet<dim>::side_points() const
  {
    const Nodes<dim> &nodes    = neighbors.nodes();
    const double      step     = 1e-6 * nodes.smallest_spacing();
    const double      last     = past.events().empty() ? time : past.events().back();
    const auto        all      = make_crack_geometries(past.pieces(last, cut_at_tips));
    const auto        moved_to = [&](const Point<dim> &p) {
      for (const CrackGeometry<dim> &crack : all)
        if (crack.is_near(p, step) && std::abs(crack.signed_distance(p)) < 1e-3 * step &&
            crack.covers(p))
          return p + step * crack.normal();
      return p;
    };
    std::unordered_map<unsigned int, Point<dim>> moved;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      if (const Point<dim> p = moved_to(nodes.crack_point(i)); p != nodes.position(i))
        moved.emplace(i, p); // nodes doubled by a crack in the mesh have a point of their own
    return moved;
  }


  template <int dim>
  double CrackSet<dim>::kept_fraction(const unsigned int             node,
                                      const unsigned int             neighbor,
                                      const BondConductivities<dim> &conductivities,
                                      bool                          &cut,
                                      const bool                     of_way) const
  {
    double kept                           = 1.;
    cut                                   = false;
    const std::vector<unsigned int> &near = cracks_near(node);
    for (auto k = near.begin(); k != near.end();)
      {
        // A bond may meet several pieces of a crack, or a piece and its mirror image where the
        // crack ends on a side: that is one crossing.
        double             fraction = 1.;
        const unsigned int number   = cracks[*k].crack;
        for (; k != near.end() && cracks[*k].crack == number; ++k)
          {
            const CrackGeometry<dim> &crack = cracks[*k];
            test_crossings(node, neighbor, crack, [&](const Point<dim> &a, const Point<dim> &b) {
              cut = true;
              fraction =
                std::min(fraction,
                         contact_conductance < 0. ?
                           transmission :
                           contact_fraction_of(crack, a, b, [&](const double s) {
                             const double in_series = conductivities.in_series(node, neighbor, s);
                             return std::make_pair(in_series,
                                                   of_way ? in_series :
                                                            conductivities.of_bond(node, neighbor));
                           }));
            });
          }
        kept *= fraction;
      }
    const double of_broken = kept_of_broken(node, neighbor);
    cut                    = cut || of_broken < 1.;
    kept *= of_broken;
    if (leaves_body(node, neighbor))
      {
        cut  = true;
        kept = 0.;
      }
    return kept;
  }


  template <int dim>
  bool CrackSet<dim>::cuts(const unsigned int node, const unsigned int neighbor) const
  {
    bool cut = false;
    for (const unsigned int k : cracks_near(node))
      if (!cut)
        test_crossings(node, neighbor, cracks[k], [&](const Point<dim> &, const Point<dim> &) {
          cut = true;
        });
    return cut || kept_of_broken(node, neighbor) < 1. || leaves_body(node, neighbor);
  }


  template <int dim>
  const std::vector<unsigned int> &CrackSet<dim>::cracks_near(const unsigned int node) const
  {
    if (near.node == node)
      return near.cracks;
    near.node = node;
    near.cracks.clear();
    for (unsigned int k = 0; k < cracks.size(); ++k)
      if (cracks[k].is_near(neighbors.position(node), neighbors.weights().reach()))
        near.cracks.push_back(k);
    return near.cracks;
  }


  template <int dim>
  bool CrackSet<dim>::separate(const Point<dim> &a, const Point<dim> &b) const
  {
    return std::any_of(cracks.begin(), cracks.end(), [&](const CrackGeometry<dim> &crack) {
      return crack.separates(a, b);
    });
  }


  template <int dim>
  bool CrackSet<dim>::empty() const
  {
    return cracks.empty() && broken_bonds.empty();
  }


  template <int dim>
  bool CrackSet<dim>::leaves_body(const unsigned int node, const unsigned int neighbor) const
  {
    if (voids == nullptr || !voids->is_near(node, neighbors.weights().reach()))
      return false;
    if (neighbors.is_real(neighbor))
      return voids->between(node, neighbor);
    return voids->before_site(node,
                              neighbors.outside()[neighbor - neighbors.nodes().n_local()].site);
  }


  template <int dim>
  bool CrackSet<dim>::leaves_body(const unsigned int                  node,
                                  const typename Lattice<dim>::Index &site) const
  {
    return voids != nullptr && voids->before_site(node, site);
  }


  template <int dim>
  void CrackSet<dim>::crossed_cracks(const unsigned int                         node,
                                     const unsigned int                         neighbor,
                                     std::vector<std::pair<unsigned int, int>> &crossed) const
  {
    crossed.clear();
    for (const unsigned int k : cracks_near(node))
      if (const CrackGeometry<dim> &crack = cracks[k];
          crossed.empty() || crossed.back().first != crack.crack)
        test_crossings(node, neighbor, crack, [&](const Point<dim> &a, const Point<dim> &) {
          if (crossed.empty() || crossed.back().first != crack.crack)
            crossed.emplace_back(crack.crack, crack.signed_distance(a) > 0. ? 1 : -1);
        });
  }


  template <int dim>
  void CrackSet<dim>::apply_change(const ChangeSet<dim> &change)
  {
    time         = change.to;
    cracks       = make_crack_geometries(past.pieces(time, cut_at_tips));
    transmission = past.transmission(time);
    near.node    = numbers::invalid_unsigned_int;
    broken_bonds.add(change.broken);
  }


  template <int dim>
  types::global_dof_index CrackSet<dim>::global(const unsigned int node) const
  {
    return neighbors.nodes().partitioner()->local_to_global(node);
  }


  template <int dim>
  double CrackSet<dim>::kept_of_broken(const unsigned int node, const unsigned int neighbor) const
  {
    return broken_bonds.empty() || !neighbors.is_real(neighbor) ?
             1. :
             broken_bonds.kept_fraction(global(node), global(neighbor));
  }


  template <int dim>
  bool CrackSet<dim>::is_near(const unsigned int node, const double distance) const
  {
    // Bonds that have broken are the node's own; who asks farther away has to look everywhere.
    const bool near_broken = !broken_bonds.empty() && (distance > neighbors.weights().reach() ||
                                                       broken_bonds.touch(global(node)));
    if (near_broken || (voids != nullptr && voids->is_near(node, distance)))
      return true;
    for (std::size_t k = 0; k < soft_cracks.size(); ++k)
      if (is_near_soft(k, node, distance))
        return true;
    return std::any_of(cracks.begin(), cracks.end(), [&](const CrackGeometry<dim> &crack) {
      return crack.is_near(neighbors.position(node), distance);
    });
  }


  PERIDEAL_INSTANTIATE_CLASS(class CrackSet);
} // namespace PeriDeal
