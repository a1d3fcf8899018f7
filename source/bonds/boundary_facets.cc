// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/bonds/boundary_facets.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Cosine of the angle between normals of one side. */
    constexpr double alike = 0.8;
  } // namespace


  template <int dim>
  BoundaryFacets<dim>::BoundaryFacets(const Nodes<dim>                                    &nodes,
                                      const std::vector<types::boundary_id>               &symmetry,
                                      const std::function<bool(const types::boundary_id)> &goes_on,
                                      const double                                         reach)
    : reach(reach)
    , bins(reach)
  {
    for (const BoundaryFacet<dim> &facet : gather_boundary_facets(nodes.dof_handler()))
      facets.push_back({facet, goes_on(facet.side), {}, {}});
    take_out_planes(symmetry);
    bins = bins_of_facets<dim>(facets, reach);
    find_corner_normals();
  }


  template <int dim>
  void BoundaryFacets<dim>::take_out_planes(const std::vector<types::boundary_id> &symmetry)
  {
    std::vector<Facet> others;
    for (const Facet &facet : facets)
      {
        const types::boundary_id side = facet.side;
        if (std::find(symmetry.begin(), symmetry.end(), side) == symmetry.end())
          {
            others.push_back(facet);
            continue;
          }
        unsigned int axis = 0;
        for (unsigned int d = 1; d < dim; ++d)
          if (std::abs(facet.normal[d]) > std::abs(facet.normal[axis]))
            axis = d;
        if (std::none_of(symmetry_planes.begin(), symmetry_planes.end(), [&](const auto &plane) {
              return plane.axis == axis && plane.above == (facet.normal[axis] > 0.) &&
                     std::abs(plane.at - facet.corners[0][axis]) < 1e-9 * reach;
            }))
          symmetry_planes.push_back({axis, facet.corners[0][axis], facet.normal[axis] > 0., side});
      }
    facets.swap(others);
  }


  template <int dim>
  void BoundaryFacets<dim>::find_corner_normals()
  {
    std::map<types::global_dof_index, std::vector<unsigned int>> at_node;
    for (unsigned int f = 0; f < facets.size(); ++f)
      for (const auto node : facets[f].nodes)
        at_node[node].push_back(f);
    touching.resize(facets.size());
    for (unsigned int f = 0; f < facets.size(); ++f)
      {
        Facet &facet = facets[f];
        for (unsigned int k = 0; k < dim; ++k)
          {
            Tensor<1, dim> sum;
            for (const unsigned int g : at_node[facet.nodes[k]])
              {
                touching[f].push_back(g);
                if (facets[g].normal * facet.normal > alike)
                  sum += facets[g].area * facets[g].normal;
              }
            sum /= sum.norm();
            // In a plane of symmetry the mirrored half of the side counts, too.
            for (const SymmetryPlane &plane : symmetry_planes)
              if (std::abs(facet.corners[k][plane.axis] - plane.at) < 1e-9 * reach &&
                  std::abs(sum[plane.axis]) < 0.6)
                sum[plane.axis] = 0.;
            facet.corner_normals[k] = sum / sum.norm();
          }
        std::sort(touching[f].begin(), touching[f].end());
        touching[f].erase(std::unique(touching[f].begin(), touching[f].end()), touching[f].end());
      }
  }


  template <int dim>
  double BoundaryFacets<dim>::extent() const
  {
    Point<dim> lower, upper;
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] = std::numeric_limits<double>::max();
        upper[d] = -lower[d];
      }
    for (const Facet &facet : facets)
      for (const Point<dim> &corner : facet.corners)
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower[d] = std::min(lower[d], corner[d]);
            upper[d] = std::max(upper[d], corner[d]);
          }
    Tensor<1, dim> size = upper - lower;
    for (const SymmetryPlane &plane : symmetry_planes)
      size[plane.axis] *= 2.;
    return *std::max_element(size.begin_raw(), size.end_raw());
  }


  template <int dim>
  bool BoundaryFacets<dim>::is_hollow(const unsigned int facet, const double length) const
  {
    constexpr double far  = 25.;
    const Facet     &own  = facets[facet];
    double           bent = 0., size = 0.; // of the edges: the radius is the one over the other
    for (unsigned int k = 1; k < dim; ++k)
      {
        const Tensor<1, dim> edge = own.corners[k] - own.corners[0];
        bent -= (own.corner_normals[k] - own.corner_normals[0]) * edge;
        size += edge.norm_square();
      }
    return bent * far * length > size;
  }


  template <int dim>
  std::pair<double, double> BoundaryFacets<dim>::opposite(const unsigned int facet,
                                                          const double       most) const
  {
    constexpr double slack  = 1e-3;
    const Facet     &own    = facets[facet];
    Point<dim>       middle = own.corners[0];
    for (unsigned int k = 1; k < dim; ++k)
      middle += (own.corners[k] - middle) / (k + 1.);
    std::pair<double, double> found{std::numeric_limits<double>::infinity(), 0.};
    for (double passed = 0.; passed < most + reach && found.first > passed; passed += reach)
      {
        // Beyond a plane of symmetry the way goes on in the body's mirror image: it is folded.
        Point<dim>     start = middle;
        Tensor<1, dim> way   = -own.normal;
        for (const SymmetryPlane &plane : symmetry_planes)
          if ((start[plane.axis] + passed * way[plane.axis] - plane.at) * (plane.above ? 1. : -1.) >
              0.)
            {
              start[plane.axis] = 2. * plane.at - start[plane.axis];
              way[plane.axis] *= -1.;
            }
        bins.visit_near(start + passed * way, [&](const unsigned int f) {
          const double slope = facets[f].normal * way;
          if (slope < 1e-6)
            return;
          const double     length = facets[f].normal * (facets[f].corners[0] - start) / slope;
          const Point<dim> at     = start + length * way;
          if (length > slack * reach && length < found.first &&
              foot_on(at, f).distance < slack * reach)
            found = {length, slope};
        });
      }
    return found.first < most ? found : std::make_pair(std::numeric_limits<double>::infinity(), 0.);
  }


  template <int dim>
  void BoundaryFacets<dim>::go_on_in_part(ThinParts &parts)
  {
    constexpr double  of_hollow = 0.6, facing = 0.75, parallel = 0.97, slack = 1e-6;
    const double      widest = extent() / 2.;
    std::vector<bool> is_thin(facets.size(), false);
    for (unsigned int f = 0; f < facets.size(); ++f)
      if (parts.are_free(facets[f].side))
        {
          const double most             = (is_hollow(f, parts.most) ? of_hollow : 1.) * parts.most;
          const auto [thickness, slope] = opposite(f, (1. - slack) * std::min(most, widest));
          is_thin[f]                    = slope > facing;
          parts.any                     = parts.any || (is_thin[f] && facets[f].goes_on);
          if (slope > parallel)
            parts.thinnest = std::min(parts.thinnest, thickness);
        }
    // Of a node the mean of its facets, so that it does not matter on which of them feet are.
    for (unsigned int f = 0; f < facets.size(); ++f)
      for (unsigned int k = 0; k < dim; ++k)
        {
          double thin = 0., all = 0.;
          for (const unsigned int g : touching[f])
            if (facets[g].normal * facets[f].normal > alike && ends_at(g, facets[f].nodes[k]))
              {
                all += facets[g].area;
                thin += is_thin[g] ? facets[g].area : 0.;
              }
          facets[f].thin[k] = thin / all;
        }
  }


  template <int dim>
  types::global_dof_index BoundaryFacets<dim>::node(const unsigned int facet,
                                                    const unsigned int k) const
  {
    return facets[facet].nodes[k];
  }

  template <int dim>
  const Point<dim> &BoundaryFacets<dim>::corner(const unsigned int facet,
                                                const unsigned int k) const
  {
    return facets[facet].corners[k];
  }

  template <int dim>
  const Tensor<1, dim> &BoundaryFacets<dim>::normal(const unsigned int facet) const
  {
    return facets[facet].normal;
  }


  template <int dim>
  typename BoundaryFacets<dim>::Foot BoundaryFacets<dim>::foot_on(const Point<dim>  &p,
                                                                  const unsigned int facet) const
  {
    Foot foot;
    foot.facet    = facet;
    foot.weights  = facets[facet].nearest_weights(p);
    foot.point    = facets[facet].at(foot.weights);
    foot.distance = foot.point.distance(p);
    return foot;
  }


  template <int dim>
  bool BoundaryFacets<dim>::is_lowest(const Point<dim> &p, const Foot &foot) const
  {
    const double          slack  = 1e-9 * reach;
    const Tensor<1, dim> &normal = facets[foot.facet].normal;
    const double          height = normal * (foot.point - p);
    if (height < -slack)
      return false; // of a side beyond a gap
    // At an end of the side straight below p another side may come nearer.
    const bool is_straight = height > foot.distance - slack;
    for (const unsigned int g : touching[foot.facet])
      if ((!is_straight || facets[g].normal * normal > alike) &&
          foot_on(p, g).distance < foot.distance - slack && foot_on(foot.point, g).distance < slack)
        return false;
    return true;
  }


  template <int dim>
  std::vector<typename BoundaryFacets<dim>::Foot> BoundaryFacets<dim>::feet(
    const Point<dim>             &p,
    const types::global_dof_index node,
    const Tensor<1, dim>         &inwards) const
  {
    std::vector<Foot> all, result;
    const double      slack = 1e-9 * reach;
    bins.visit_near(p, [&](const unsigned int f) {
      if (!facets[f].goes_on)
        return;
      const Foot foot = foot_on(p, f);
      if (foot.distance <= reach && is_lowest(p, foot) &&
          (foot.distance > slack || ends_at(f, node)))
        all.push_back(foot);
    });
    // Where two pieces of the body touch at the foot, on the node's own one: from well inside it is
    // nearer.
    const Point<dim> inside = p + 1e5 * inwards;
    std::sort(all.begin(), all.end(), [&](const Foot &a, const Foot &b) {
      const auto key = [&](const Foot &foot) {
        const double other = inwards.norm_square() > 0. ? foot_on(inside, foot.facet).distance : 0.;
        return std::make_tuple(std::lround(foot.distance / slack),
                               std::lround(other / slack),
                               foot.facet);
      };
      return key(a) < key(b);
    });
    for (const Foot &foot : all)
      if (std::none_of(result.begin(), result.end(), [&](const Foot &other) {
            return facets[other.facet].normal * facets[foot.facet].normal > alike ||
                   (foot.distance > slack && foot.point.distance(other.point) < slack);
          }))
        result.push_back(foot);
    return result;
  }


  template <int dim>
  bool BoundaryFacets<dim>::are_alike(const Tensor<1, dim> &a, const Tensor<1, dim> &b)
  {
    return a * b > alike;
  }


  template <int dim>
  bool BoundaryFacets<dim>::ends_at(const unsigned int            facet,
                                    const types::global_dof_index node) const
  {
    const auto &own = facets[facet].nodes;
    return std::find(own.begin(), own.end(), node) != own.end();
  }


  template <int dim>
  std::vector<typename BoundaryFacets<dim>::Foot> BoundaryFacets<dim>::at(
    const Point<dim>             &p,
    const types::global_dof_index node) const
  {
    std::vector<Foot> all, result;
    bins.visit_near(p, [&](const unsigned int f) {
      if (ends_at(f, node))
        all.push_back(foot_on(p, f));
    });
    std::sort(all.begin(), all.end(), [](const Foot &a, const Foot &b) {
      return a.facet < b.facet;
    });
    for (const Foot &foot : all)
      if (std::none_of(result.begin(), result.end(), [&](const Foot &other) {
            return are_alike(normal(other.facet), normal(foot.facet));
          }))
        result.push_back(foot);
    return result;
  }


  template <int dim>
  typename BoundaryFacets<dim>::Foot BoundaryFacets<dim>::nearest(const Point<dim>  &p,
                                                                  const unsigned int facet) const
  {
    Foot                      foot  = foot_on(p, facet);
    const double              slack = 1e-9 * reach;
    std::vector<unsigned int> side{facet};
    std::set<unsigned int>    seen{facet};
    for (std::size_t k = 0; k < side.size(); ++k)
      for (const unsigned int f : touching[side[k]])
        if (facets[f].goes_on && are_alike(facets[f].normal, facets[facet].normal) &&
            seen.insert(f).second)
          if (const Foot found = foot_on(p, f); found.distance < 2. * reach)
            {
              side.push_back(f);
              if (found.distance < foot.distance - slack ||
                  (found.distance < foot.distance + slack && f < foot.facet))
                foot = found;
            }
    return foot;
  }


  template <int dim>
  double BoundaryFacets<dim>::share(const std::vector<Foot> &through) const
  {
    constexpr double in_part = 0.15;
    double           whole = 1., one = 0.; // no facet is thin, one of them is
    for (const Foot &foot : through)
      {
        double thin = 0.;
        for (unsigned int k = 0; k < dim; ++k)
          thin += foot.weights[k] * facets[foot.facet].thin[k];
        one = one * (1. - thin) + whole * thin;
        whole *= 1. - thin;
      }
    return whole + (through.size() > 1 ? 0.5 : 1.) * in_part * one;
  }


  template <int dim>
  bool BoundaryFacets<dim>::is_nearer(const Point<dim> &p, const double distance) const
  {
    bool any = false;
    bins.visit_near(p,
                    [&](const unsigned int f) { any = any || foot_on(p, f).distance < distance; });
    return any;
  }


  template <int dim>
  double BoundaryFacets<dim>::growth(const Foot &foot) const
  {
    const Facet &facet = facets[foot.facet];
    const auto   area  = [&](const double distance) {
      std::array<Point<dim>, dim> corners = facet.corners;
      for (unsigned int k = 0; k < dim; ++k)
        corners[k] += distance * facet.corner_normals[k];
      return area_vector(corners) * facet.normal;
    };
    const double     outside = area(foot.distance), inside = area(-foot.distance);
    constexpr double most = 3.;
    return outside <= 0. || foot.distance == 0. ? (outside > 0. ? 1. : 0.) :
           inside * most <= outside             ? most :
                                                  outside / inside;
  }


  PERIDEAL_INSTANTIATE_CLASS_2_3(class BoundaryFacets);
} // namespace PeriDeal
