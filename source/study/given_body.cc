// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "given_body.h"

#include <perideal/base/instantiate.h>
#include <perideal/mesh/body_corners.h>
#include <perideal/mesh/given_mesh.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

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
    spacing     = std::pow(volume / mesh->n_active_cells(), 1. / dim);
    is_round    = !given.manifolds.empty();
    has_corners = !corners_of_body(scene, *mesh).empty();
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
