// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/boundary_facet.h>

#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  Tensor<1, 2> area_vector(const std::array<Point<2>, 2> &corners)
  {
    const Tensor<1, 2> along = corners[1] - corners[0];
    return Point<2>(along[1], -along[0]);
  }

  Tensor<1, 3> area_vector(const std::array<Point<3>, 3> &corners)
  {
    return 0.5 * cross_product_3d(corners[1] - corners[0], corners[2] - corners[0]);
  }


  namespace
  {
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
  std::vector<BoundaryFacet<dim>> gather_boundary_facets(const DoFHandler<dim> &dof_handler)
  {
    const bool          on_vertices = dof_handler.get_fe().n_dofs_per_vertex() > 0;
    std::vector<double> numbers; // global indices are exact up to 2^53
    for (const auto &cell : dof_handler.active_cell_iterators())
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
                    numbers.push_back(on_vertices ? face->vertex_dof_index(piece[k], 0) :
                                                    face->vertex_index(piece[k]));
                    for (unsigned int d = 0; d < dim; ++d)
                      numbers.push_back(corners[k][d]);
                  }
              }
    std::vector<BoundaryFacet<dim>> facets;
    for (const auto &list : Utilities::MPI::all_gather(dof_handler.get_communicator(), numbers))
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
  std::vector<bool> nodes_on_other_facets(const DoFHandler<dim> &dof_handler,
                                          const double           tolerance)
  {
    const IndexSet                       &owned  = dof_handler.locally_owned_dofs();
    const std::vector<BoundaryFacet<dim>> facets = gather_boundary_facets(dof_handler);
    const PointBins<dim>                  bins   = bins_of_facets<dim>(facets, tolerance);
    std::vector<bool>                     found(owned.n_elements(), false);
    for (const BoundaryFacet<dim> &own : facets)
      for (unsigned int k = 0; k < dim; ++k)
        if (const auto node = own.nodes[k]; owned.is_element(node))
          {
            const Point<dim> &p = own.corners[k];
            bins.visit_near(p, [&](const unsigned int f) {
              const BoundaryFacet<dim> &other = facets[f];
              if (std::find(other.nodes.begin(), other.nodes.end(), node) == other.nodes.end() &&
                  other.at(other.nearest_weights(p)).distance(p) < tolerance)
                found[owned.index_within_set(node)] = true;
            });
          }
    return found;
  }


  PERIDEAL_INSTANTIATE_CLASS_2_3(struct BoundaryFacet);
  PERIDEAL_INSTANTIATE_FUNCTION_2_3(gather_boundary_facets);
  PERIDEAL_INSTANTIATE_FUNCTION_2_3(nodes_on_other_facets);
} // namespace PeriDeal
