// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/problems/check_sides.h>

#include <set>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What is wrong with a coefficient at a point, or nothing. */
    template <int dim>
    std::string negative_coefficient(const SurfaceTransfer &transfer, const Point<dim> &p)
    {
      try
        {
          if (transfer.coefficient.value(p) >= 0.)
            return "";
        }
      catch (const UserError &error) // of a formula that is no number here, on this process alone
        {
          return error.message();
        }
      std::ostringstream message;
      message << "'" << transfer.kind->entry << "' in section 'Boundary conditions', side '"
              << transfer.name << "': the coefficient '" << transfer.coefficient.text()
              << "' is negative at (" << p << "). It has to be 0 or more on the whole side.";
      return message.str();
    }


    /** The boundary ids of the body on all processes, without those of cracks. Collective. */
    template <int dim>
    std::set<types::boundary_id> sides_of(const Scene<dim> &scene, const Triangulation<dim> &mesh)
    {
      std::set<types::boundary_id> present;
      std::string                  message;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary())
              {
                const auto id = cell->face(f)->boundary_id();
                present.insert(id);
                for (const SurfaceTransfer &transfer : scene.boundary_conditions.transfers)
                  if (transfer.id == id && message.empty())
                    message = negative_coefficient<dim>(transfer, cell->face(f)->center());
              }
      throw_on_all_if_any(mesh.get_communicator(), message);
      present = Utilities::MPI::compute_set_union(present, mesh.get_communicator());
      present.erase(crack_boundary_id);
      return present;
    }
  } // namespace


  template <int dim>
  void check_sides(const Scene<dim> &scene, const Triangulation<dim> &mesh)
  {
    const std::set<types::boundary_id> present = sides_of(scene, mesh);
    check_overlaps(scene, mesh);
    if (scene.domain.shape == Shape::box)
      return;
    const bool               from_file = !scene.domain.has_lattice();
    std::vector<std::string> known;
    for (const auto id : present)
      known.push_back(scene.boundary_conditions.name_of(id));
    const auto check =
      [&](const std::string &entry, const types::boundary_id id, const std::string &name) {
        AssertThrow(
          id >= first_part_id || present.count(id) > 0,
          UserError(
            "'" + entry + "' in section 'Boundary conditions' names the side '" + name +
            (from_file ?
               "', which the mesh '" + scene.domain.mesh_file +
                 "' does not have. Its boundary ids and names are: " :
               "', but the hole in section 'Domain' leaves nothing of it. Sides that there are: ") +
            join_names(known) + "."));
      };
    const auto &conditions = scene.boundary_conditions;
    conditions.for_each([&](const std::string &entry, const auto &condition) {
      check(entry, condition.id, condition.name);
    });
    for (const auto id : conditions.symmetry)
      check("Symmetry", id, conditions.name_of(id));
    for (const Part &part : conditions.parts)
      if (part.kind == Part::of_side)
        check("Parts", part.side, conditions.name_of(part.side));
  }


  template void check_sides(const Scene<1> &, const Triangulation<1> &);
  template void check_sides(const Scene<2> &, const Triangulation<2> &);
  template void check_sides(const Scene<3> &, const Triangulation<3> &);
} // namespace PeriDeal
