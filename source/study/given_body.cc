// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "given_body.h"

#include <perideal/base/instantiate.h>
#include <perideal/mesh/body_corners.h>
#include <perideal/mesh/given_mesh.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool all_on_faces(const CoarseMesh<dim> &mesh, const Cracks<dim> &cracks)
    {
      const std::vector<CrackGeometry<dim>> all = make_crack_geometries(cracks.pieces(0.));
      return std::all_of(all.begin(), all.end(), [&](const CrackGeometry<dim> &crack) {
        return lies_on_faces(mesh, crack);
      });
    }
  } // namespace


  template <int dim>
  GivenBody<dim>::GivenBody(const Scene<dim> &scene, const MPI_Comm communicator)
    : mesh(std::make_unique<Triangulation<dim>>())
  {
    const GivenMesh<dim> given = given_mesh(scene.domain, communicator);
    mesh->create_triangulation(given.coarse.vertices, given.coarse.cells, SubCellData());
    given.mark(*mesh);
    set_material_ids(*mesh, scene.material.phases.all());
    box           = BoundingBox<dim>(mesh->get_vertices());
    double volume = 0.;
    for (const auto &cell : mesh->active_cell_iterators())
      {
        volume += cell->measure();
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            for (const unsigned int v : face->vertex_indices())
              sides[face->boundary_id()].push_back(face->vertex(v));
      }
    std::vector<CellBox> boxes;
    for (const auto &cell : mesh->active_cell_iterators())
      boxes.emplace_back(cell->bounding_box(), cell);
    cells           = pack_rtree(boxes);
    spacing         = std::pow(volume / mesh->n_active_cells(), 1. / dim);
    is_round        = !given.manifolds.empty();
    has_corners     = !corners_of_body(scene, *mesh).empty();
    cracks_on_faces = !scene.cracks.cracks.empty() && !scene.cracks.change() &&
                      all_on_faces(given.coarse, scene.cracks);
  }


  template <int dim>
  bool GivenBody<dim>::contains(const Point<dim> &p) const
  {
    for (const auto &[around, cell] :
         cells | boost::geometry::index::adaptors::queried(boost::geometry::index::intersects(p)))
      if (cell->point_inside(p))
        return true;
    return false;
  }


  template <int dim>
  double GivenBody<dim>::fineness_on_side(
    const types::boundary_id                         side,
    const std::function<double(const Point<dim> &)> &function) const
  {
    constexpr unsigned int           n       = 32; // points along an edge
    constexpr double                 allowed = 0.2;
    std::vector<std::vector<double>> edges;
    const auto                       add = [&](const Point<dim> &a, const Point<dim> &b) {
      edges.emplace_back();
      for (unsigned int k = 0; k <= n; ++k)
        edges.back().push_back(function(a + static_cast<double>(k) / n * (b - a)));
    };
    if constexpr (dim > 1)
      for (const auto &cell : mesh->active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() == side)
            {
              if constexpr (dim == 2)
                add(face->vertex(0), face->vertex(1));
              else
                for (unsigned int l = 0; l < GeometryInfo<dim>::lines_per_face; ++l)
                  add(face->line(l)->vertex(0), face->line(l)->vertex(1));
            }
    double       mean = 0., variation = 0.;
    const double n_values = edges.size() * (n + 1.);
    for (const auto &edge : edges)
      for (const double value : edge)
        mean += value / n_values;
    for (const auto &edge : edges)
      for (const double value : edge)
        variation += (value - mean) * (value - mean);
    const auto [lower, upper] = box.get_boundary_points();
    double fineness           = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      fineness = std::max(fineness, (upper[d] - lower[d]) / spacing);
    if (!(variation > 1e-24 * n_values * (mean * mean + 1e-300)))
      return 1.;
    for (unsigned int stride = n; stride > 1; stride /= 2, fineness *= 2.)
      {
        double error = 0.;
        for (const auto &edge : edges)
          for (unsigned int k = 0; k < n; ++k)
            {
              const unsigned int low = k / stride * stride;
              const double       s   = static_cast<double>(k - low) / stride;
              error += std::pow(edge[k] - (1. - s) * edge[low] - s * edge[low + stride], 2);
            }
        if (error < allowed * allowed * variation)
          break;
      }
    return fineness;
  }


  template <int dim>
  SidePoints<dim> sides_of_box(const Scene<dim> &scene)
  {
    constexpr unsigned int n = 5;
    SidePoints<dim>        sides;
    for (types::boundary_id side = 0; side < 2 * dim; ++side)
      for (unsigned int k = 0, end = static_cast<unsigned int>(std::pow(n, dim - 1)); k < end; ++k)
        {
          Point<dim>   p;
          unsigned int rest = k;
          for (unsigned int d = 0; d < dim; ++d)
            {
              double s = side % 2;
              if (d != side / 2)
                {
                  s = static_cast<double>(rest % n) / (n - 1);
                  rest /= n;
                }
              p[d] = (1. - s) * scene.domain.lower[d] + s * scene.domain.upper[d];
            }
          sides[side].push_back(p);
        }
    return sides;
  }


#define PERIDEAL_TEMPLATES(dim)   \
  template struct GivenBody<dim>; \
  template SidePoints<dim> sides_of_box(const Scene<dim> &);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
