// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/simulation/simulation.h>

#include <set>
#include <sstream>

#include "result_record.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What is wrong with a coefficient of convection at a point, or nothing. */
    template <int dim>
    std::string negative_coefficient(const SideCondition &convection, const Point<dim> &p)
    {
      if (convection.coefficient.value(p) >= 0.)
        return "";
      std::ostringstream message;
      message << "'Convection' in section 'Boundary conditions', side '" << convection.name
              << "': the coefficient '" << convection.coefficient.text() << "' is negative at ("
              << p << "). It has to be 0 or more on the whole side.";
      return message.str();
    }
  } // namespace


  template <int dim>
  void Simulation<dim>::check_sides() const
  {
    const auto                  &conditions = scene.boundary_conditions;
    std::set<types::boundary_id> present;
    std::string                  message;
    for (const auto &cell : mesh->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            {
              const auto id = cell->face(f)->boundary_id();
              present.insert(id);
              const SideCondition *convection =
                BoundaryConditions<dim>::find(conditions.convection, id);
              if (convection != nullptr && message.empty())
                message = negative_coefficient<dim>(*convection, cell->face(f)->center());
            }
    throw_on_all_if_any(communicator, message);
    if (scene.domain.shape == Shape::box)
      return;
    present = Utilities::MPI::compute_set_union(present, communicator);
    present.erase(crack_boundary_id);
    std::vector<std::string> known;
    for (const auto id : present)
      known.push_back(std::to_string(id));
    const auto check =
      [&](const std::string &entry, const types::boundary_id id, const std::string &name) {
        AssertThrow(
          present.count(id) > 0,
          UserError("'" + entry + "' in section 'Boundary conditions' names the side '" + name +
                    (scene.domain.shape == Shape::mesh_file ?
                       "', which the mesh '" + scene.domain.mesh_file +
                         "' does not have. Its boundary ids are: " + join_names(known) + "." :
                       "', but the hole in section 'Domain' leaves nothing of it.")));
      };
    for (const SideCondition &condition : conditions.dirichlet)
      check("Dirichlet", condition.id, condition.name);
    for (const SideCondition &condition : conditions.flux)
      check("Flux", condition.id, condition.name);
    for (const SideCondition &condition : conditions.convection)
      check("Convection", condition.id, condition.name);
    for (const auto id : conditions.symmetry)
      check("Symmetry", id, name_of_side(id, scene.domain.shape != Shape::mesh_file));
  }

  template void Simulation<1>::check_sides() const;
  template void Simulation<2>::check_sides() const;
  template void Simulation<3>::check_sides() const;
} // namespace PeriDeal
