// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/base/point_order.h>
#include <perideal/base/user_error.h>
#include <perideal/problems/check_sides.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What of the body is near a point. */
    template <int dim>
    struct Nearest
    {
      bool       inside   = false;                              // of the body
      double     distance = std::numeric_limits<double>::max(); // from the nearest vertex
      double     diameter = 0.;                                 // of the largest cell there
      Point<dim> vertex;
    };


    template <int dim>
    bool holds(const typename Triangulation<dim>::active_cell_iterator &cell, const Point<dim> &p)
    {
      constexpr double slack = 1e-6;
      if (!cell->bounding_box().point_inside(p, slack))
        return false;
      try
        {
          const Point<dim> unit = MappingQ1<dim>().transform_real_to_unit_cell(cell, p);
          return GeometryInfo<dim>::is_inside_unit_cell(unit, slack);
        }
      catch (const typename Mapping<dim>::ExcTransformationFailed &)
        {
          return false;
        }
    }


    /** The same on any number of processes. Collective. */
    template <int dim>
    Nearest<dim> nearest_in(const Triangulation<dim> &mesh, const Point<dim> &p)
    {
      Nearest<dim> own;
      const auto   take = [](Nearest<dim> &best, const Nearest<dim> &other) {
        const bool as_near = other.distance == best.distance;
        if (other.distance < best.distance || (as_near && comes_first(other.vertex, best.vertex)))
          {
            best.distance = other.distance;
            best.diameter = other.diameter;
            best.vertex   = other.vertex;
          }
        else if (as_near && other.vertex == best.vertex)
          best.diameter = std::max(best.diameter, other.diameter);
      };
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            own.inside = own.inside || holds<dim>(cell, p);
            for (const unsigned int v : cell->vertex_indices())
              if (const double distance = cell->vertex(v).distance(p); distance <= own.distance)
                take(own, {false, distance, cell->diameter(), cell->vertex(v)});
          }
      const MPI_Comm communicator = mesh.get_communicator();
      Nearest<dim>   all;
      all.inside = Utilities::MPI::max(own.inside ? 1 : 0, communicator) > 0;
      std::vector<double> numbers{own.distance, own.diameter};
      numbers.insert(numbers.end(), own.vertex.begin_raw(), own.vertex.end_raw());
      for (const std::vector<double> &of_one : Utilities::MPI::all_gather(communicator, numbers))
        {
          Nearest<dim> other{false, of_one[0], of_one[1], Point<dim>()};
          std::copy(of_one.begin() + 2, of_one.end(), other.vertex.begin_raw());
          take(all, other);
        }
      return all;
    }


    template <int dim>
    std::string text_of(const Point<dim> &p)
    {
      std::string text;
      for (unsigned int d = 0; d < dim; ++d)
        text += (d > 0 ? ", " : "(") + rounded_text(p[d], 6);
      return text + ")";
    }
  } // namespace


  template <int dim>
  void check_points_of_parts(const Scene<dim>         &scene,
                             const Triangulation<dim> &mesh,
                             std::vector<std::string> &notes)
  {
    constexpr double negligible = 1e-3; // of a cell: that of roundings and of polygons for circles
    for (const Part &part : scene.boundary_conditions.parts)
      {
        if (part.kind != Part::point)
          continue;
        const Point<dim>   p    = part.position<dim>();
        const Nearest<dim> near = nearest_in(mesh, p);
        if (near.inside || near.distance <= negligible * near.diameter)
          continue;
        const std::string where = scene.boundary_conditions.where("Parts") + ", part '" +
                                  part.name + "': the point " + text_of(p) +
                                  " lies outside the body, " + rounded_text(near.distance, 6) +
                                  " from the nearest corner of a cell, " + text_of(near.vertex);
        if (near.distance > near.diameter)
          AssertThrow(
            false,
            UserError(
              "Entry " + where +
              ". Move it into the body; a load on the rim of a hole is one on the side 'hole', "
              "or on a region around the point."));
        notes.push_back(where + ". The node nearest to it bears what is given there.");
      }
  }


  template void check_points_of_parts(const Scene<1> &,
                                      const Triangulation<1> &,
                                      std::vector<std::string> &);
  template void check_points_of_parts(const Scene<2> &,
                                      const Triangulation<2> &,
                                      std::vector<std::string> &);
  template void check_points_of_parts(const Scene<3> &,
                                      const Triangulation<3> &,
                                      std::vector<std::string> &);
} // namespace PeriDeal
