// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/bonds/boundary_facets.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double alike = 0.8; // cosine of the angle between normals of one side

    /** The normal of a segment or triangle, as long as this is large. */
    Tensor<1, 2> area_vector(const std::array<Point<2>, 2> &corners)
    {
      const Tensor<1, 2> along = corners[1] - corners[0];
      return Point<2>(along[1], -along[0]);
    }

    Tensor<1, 3> area_vector(const std::array<Point<3>, 3> &corners)
    {
      return 0.5 * cross_product_3d(corners[1] - corners[0], corners[2] - corners[0]);
    }


    template <int dim>
    double part_along(const Point<dim> &p, const Point<dim> &a, const Point<dim> &b)
    {
      return std::clamp(((p - a) * (b - a)) / (b - a).norm_square(), 0., 1.);
    }

    /** Weights of the corners in the point of a segment or triangle that is nearest to p. */
    std::array<double, 2> weights_of_nearest(const Point<2>                &p,
                                             const std::array<Point<2>, 2> &corners)
    {
      const double t = part_along(p, corners[0], corners[1]);
      return {1. - t, t};
    }

    std::array<double, 3> weights_of_nearest(const Point<3>                &p,
                                             const std::array<Point<3>, 3> &corners)
    {
      const Tensor<1, 3>    normal = area_vector(corners);
      const double          square = 2. * normal.norm_square();
      std::array<double, 3> weights;
      bool                  inside = true;
      for (unsigned int k = 0; k < 3; ++k)
        {
          const Point<3> &a = corners[(k + 1) % 3], &b = corners[(k + 2) % 3];
          weights[k] = (cross_product_3d(b - a, p - a) * normal) / square;
          inside     = inside && weights[k] >= 0.;
        }
      if (inside)
        return weights;
      double smallest = std::numeric_limits<double>::max();
      for (unsigned int k = 0; k < 3; ++k)
        {
          const Point<3> &a = corners[k], &b = corners[(k + 1) % 3];
          const double    t      = part_along(p, a, b);
          const double    square = (a + t * (b - a) - p).norm_square();
          if (square < smallest)
            {
              smallest             = square;
              weights              = {};
              weights[k]           = 1. - t;
              weights[(k + 1) % 3] = t;
            }
        }
      return weights;
    }


    /** The corners of the segment or triangles that a face of a cell consists of. */
    template <int dim>
    const std::vector<std::array<unsigned int, dim>> &pieces_of_face()
    {
      static const std::vector<std::array<unsigned int, dim>> pieces = [] {
        std::vector<std::array<unsigned int, dim>> list;
        if constexpr (dim == 2)
          list = {{0, 1}};
        else
          list = {{0, 1, 2}, {1, 3, 2}};
        return list;
      }();
      return pieces;
    }
  } // namespace


  template <int dim>
  std::array<double, dim> BoundaryFacet<dim>::nearest_weights(const Point<dim> &p) const
  {
    return weights_of_nearest(p, corners);
  }

  template <int dim>
  Point<dim> BoundaryFacet<dim>::at(const std::array<double, dim> &weights) const
  {
    Point<dim> point;
    for (unsigned int k = 0; k < dim; ++k)
      point += weights[k] * corners[k];
    return point;
  }


  template <int dim>
  std::vector<BoundaryFacet<dim>> gather_boundary_facets(const Nodes<dim> &nodes)
  {
    const bool          on_vertices = nodes.dof_handler().get_fe().n_dofs_per_vertex() > 0;
    std::vector<double> numbers; // global indices are exact up to 2^53
    for (const auto &cell : nodes.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            for (std::array<unsigned int, dim> piece : pieces_of_face<dim>())
              {
                const auto                  face = cell->face(f);
                std::array<Point<dim>, dim> corners;
                for (unsigned int k = 0; k < dim; ++k)
                  corners[k] = face->vertex(piece[k]);
                if (area_vector(corners) * (face->center() - cell->center()) < 0.)
                  {
                    std::swap(corners[0], corners[1]);
                    std::swap(piece[0], piece[1]);
                  }
                numbers.push_back(face->boundary_id());
                for (unsigned int k = 0; k < dim; ++k)
                  {
                    numbers.push_back(on_vertices ? face->vertex_dof_index(piece[k], 0) : 0);
                    for (unsigned int d = 0; d < dim; ++d)
                      numbers.push_back(corners[k][d]);
                  }
              }
    std::vector<BoundaryFacet<dim>> facets;
    for (const auto &list : Utilities::MPI::all_gather(nodes.communicator(), numbers))
      for (std::size_t n = 0; n < list.size();)
        {
          BoundaryFacet<dim> facet;
          facet.side = static_cast<types::boundary_id>(list[n++]);
          for (unsigned int k = 0; k < dim; ++k)
            {
              facet.nodes[k] = static_cast<types::global_dof_index>(list[n++]);
              for (unsigned int d = 0; d < dim; ++d)
                facet.corners[k][d] = list[n++];
            }
          facet.normal = area_vector(facet.corners);
          facet.area   = facet.normal.norm();
          if (facet.area > 0.)
            {
              facet.normal /= facet.area;
              facets.push_back(facet);
            }
        }
    std::sort(facets.begin(), facets.end(), [](const auto &a, const auto &b) {
      for (unsigned int k = 0; k < dim; ++k)
        for (unsigned int d = 0; d < dim; ++d)
          if (a.corners[k][d] != b.corners[k][d])
            return a.corners[k][d] < b.corners[k][d];
      return false;
    });
    return facets;
  }


  template <int dim>
  BoundaryFacets<dim>::BoundaryFacets(const Nodes<dim>                                    &nodes,
                                      const std::vector<types::boundary_id>               &symmetry,
                                      const std::function<bool(const types::boundary_id)> &goes_on,
                                      const double                                         reach)
    : reach(reach)
    , bins(reach)
  {
    for (const BoundaryFacet<dim> &facet : gather_boundary_facets(nodes))
      facets.push_back({facet, goes_on(facet.side), {}});
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
  const std::vector<SymmetryPlane> &BoundaryFacets<dim>::planes() const
  {
    return symmetry_planes;
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
    const Point<dim> &p) const
  {
    std::vector<Foot> all, result;
    bins.visit_near(p, [&](const unsigned int f) {
      if (!facets[f].goes_on)
        return;
      const Foot foot = foot_on(p, f);
      if (foot.distance <= reach && is_lowest(p, foot))
        all.push_back(foot);
    });
    const double slack = 1e-9 * reach;
    std::sort(all.begin(), all.end(), [slack](const Foot &a, const Foot &b) {
      const long at_a = std::lround(a.distance / slack), at_b = std::lround(b.distance / slack);
      return at_a != at_b ? at_a < at_b : a.facet < b.facet;
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
  std::vector<typename BoundaryFacets<dim>::Foot> BoundaryFacets<dim>::at(const Point<dim> &p) const
  {
    std::vector<Foot> all, result;
    bins.visit_near(p, [&](const unsigned int f) {
      const Foot foot = foot_on(p, f);
      if (foot.distance < 1e-9 * reach)
        all.push_back(foot);
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
  bool BoundaryFacets<dim>::nearest(const Point<dim>     &p,
                                    const Tensor<1, dim> &normal,
                                    Foot                 &foot) const
  {
    bool         any   = false;
    const double slack = 1e-9 * reach;
    bins.visit_near(p, [&](const unsigned int f) {
      if (!facets[f].goes_on || facets[f].normal * normal <= alike)
        return;
      const Foot found = foot_on(p, f);
      if (!any || found.distance < foot.distance - slack ||
          (found.distance < foot.distance + slack && f < foot.facet))
        foot = found;
      any = true;
    });
    return any;
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


#define PERIDEAL_INSTANTIATE(dim)                                                           \
  template struct BoundaryFacet<dim>;                                                       \
  template std::vector<BoundaryFacet<dim>> gather_boundary_facets<dim>(const Nodes<dim> &); \
  template class BoundaryFacets<dim>;
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
