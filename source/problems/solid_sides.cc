// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_sides.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>


namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Area and the integral of the displacement of each side of a mesh, by its boundary id, of this
     * process.
     */
    template <int dim>
    std::map<types::boundary_id, std::pair<double, Tensor<1, dim>>> integrals_over_sides(
      const SolidProblem<dim> &model)
    {
      const DoFHandler<dim> &dofs        = model.dofs();
      const bool             at_vertices = dofs.get_fe().n_dofs_per_vertex() > 0;
      std::vector<Vector>    u;
      for (unsigned int d = 0; d < dim; ++d)
        u.push_back(component_of(dofs, model.displacement, dim, d));
      std::map<types::boundary_id, std::pair<double, Tensor<1, dim>>> sides;
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned() && cell->at_boundary())
          for (const unsigned int f : cell->face_indices())
            {
              const auto face = cell->face(f);
              if (!face->at_boundary())
                continue;
              Tensor<1, dim>                       mean;
              const unsigned int                   n = GeometryInfo<dim>::vertices_per_face;
              std::vector<types::global_dof_index> of_cell(dofs.get_fe().n_dofs_per_cell());
              cell->get_dof_indices(of_cell);
              for (unsigned int v = 0; v < n; ++v)
                for (unsigned int d = 0; d < dim; ++d)
                  mean[d] +=
                    u[d](
                      of_cell[at_vertices ? GeometryInfo<dim>::face_to_cell_vertices(f, v) : 0]) /
                    n;
              double area = 1.; // of a point
              if constexpr (dim > 1)
                area = face->measure();
              auto &side = sides[face->boundary_id()];
              side.first += area;
              side.second += area * mean;
            }
      return sides;
    }


    /** (side, direction) of the largest component, a pull rather than a push that is its equal. */
    std::pair<std::string, unsigned int> largest_force(const ForceBalance &balance,
                                                       const double        scale)
    {
      constexpr double                     equal = 1e-6, round_off = 1e-9;
      std::pair<std::string, unsigned int> where;
      double                               most = round_off * scale;
      for (const auto &[side, force] : balance.sides)
        for (unsigned int d = 0; d < force.size(); ++d)
          if (const double size = std::abs(force[d]) * (force[d] > 0. ? 1. + equal : 1.);
              size > most)
            {
              most  = size;
              where = {side, d};
            }
      return where;
    }
  } // namespace


  template <int dim>
  std::vector<std::pair<std::string, Tensor<1, dim>>> displacements_of_sides(
    const SolidProblem<dim> &model,
    const Scene<dim>        &scene)
  {
    const auto                                          own = integrals_over_sides(model);
    std::vector<std::pair<std::string, Tensor<1, dim>>> result;
    const auto add = [&](const std::string &name, const types::boundary_id id) {
      for (const auto &[known, value] : result)
        if (known == name)
          return;
      std::vector<double> sums(dim + 1, 0.), all(dim + 1);
      if (const auto found = own.find(id); found != own.end())
        {
          sums[dim] = found->second.first;
          for (unsigned int d = 0; d < dim; ++d)
            sums[d] = found->second.second[d];
        }
      Utilities::MPI::sum(sums, model.dofs().get_communicator(), all);
      Tensor<1, dim> mean;
      for (unsigned int d = 0; d < dim; ++d)
        mean[d] = all[dim] > 0. ? all[d] / all[dim] : 0.;
      if (all[dim] > 0.)
        result.emplace_back(name, mean);
    };
    for (const VectorCondition &condition : scene.boundary_conditions.displacement)
      add(condition.name, condition.id);
    for (const VectorCondition &condition : scene.boundary_conditions.traction)
      add(condition.name, condition.id);
    return result;
  }


  void keep_largest_force(const ForceBalance     &balance,
                          const double            scale,
                          const double            t,
                          nlohmann::ordered_json &extremes)
  {
    const auto [side, direction] = largest_force(balance, scale);
    if (side.empty())
      return;
    const double value = balance.sides.at(side)[direction];
    if (!extremes.contains("largest force") ||
        std::abs(value) > std::abs(extremes["largest force"]["value"].get<double>()))
      extremes["largest force"] = {{"value", value},
                                   {"side", side},
                                   {"direction", std::string(1, "xyz"[direction])},
                                   {"time", t}};
  }


  std::string text_of_largest_force(const ForceBalance &balance, const double scale)
  {
    const auto [side, direction] = largest_force(balance, scale);
    if (side.empty())
      return "";
    std::ostringstream text;
    text << "force " << std::setprecision(4) << balance.sides.at(side)[direction] << " on " << side
         << " in "
         << "xyz"[direction];
    return text.str();
  }


#define PERIDEAL_INSTANTIATE(dim)                                                           \
  template std::vector<std::pair<std::string, Tensor<1, dim>>> displacements_of_sides<dim>( \
    const SolidProblem<dim> &,                                                              \
    const Scene<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
