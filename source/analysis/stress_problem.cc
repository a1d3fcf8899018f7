// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "stress_problem.h"

#include <perideal/base/instantiate.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  typename HookeAt<dim>::Matrix HookeAt<dim>::stress(const Matrix &gradient) const
  {
    Matrix result = shear * (gradient + gradient.transpose());
    result.diagonal().array() += lambda * gradient.trace() - (dim * lambda + 2. * shear) * strain;
    return result;
  }


  template <int dim>
  double HookeAt<dim>::complementary(const Matrix &stress) const
  {
    const double trace = stress.trace();
    return (stress.squaredNorm() - ratio() * trace * trace) / (2. * shear);
  }


  template <int dim>
  StressProblem<dim>::StressProblem(const BodyParameters<dim> &body,
                                    const DoFHandler<dim>     &dofs,
                                    const double               time)
    : body(body)
    , time(time)
  {
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial() && cell->at_boundary() &&
          !body.boundary_conditions.symmetry.empty())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            {
              const auto  side     = cell->face(f)->boundary_id();
              const auto &symmetry = body.boundary_conditions.symmetry;
              if (std::find(symmetry.begin(), symmetry.end(), side) == symmetry.end())
                continue;
              // These sides are normal to an axis.
              const auto   corners = corners_of<dim>(cell);
              unsigned int axis    = 0;
              double       least   = std::numeric_limits<double>::max();
              for (unsigned int d = 0; d < dim; ++d)
                {
                  double width = 0.;
                  for (unsigned int j = 1; j < GeometryInfo<dim>::vertices_per_cell / 2; ++j)
                    width = std::max(width,
                                     std::abs(corners[corner_of_face<dim>(f, j)][d] -
                                              corners[corner_of_face<dim>(f, 0)][d]));
                  if (width < least)
                    {
                      least = width;
                      axis  = d;
                    }
                }
              mirrors[side] = axis;
            }
    const auto &warm  = body.elasticity.temperature_change;
    const auto &alpha = body.material.thermal_expansion;
    const auto &force = body.initial_and_source.body_force;
    uniform           = body.material.uniform_moduli() && warm.is_constant() && alpha.is_constant();
    constant_force =
      std::all_of(force.begin(), force.end(), [](const Expression &f) { return f.is_constant(); });
    if (uniform)
      everywhere = find_law(Point<dim>());
  }


  template <int dim>
  HookeAt<dim> StressProblem<dim>::find_law(const Point<dim> &p) const
  {
    const Moduli moduli = body.moduli(p);
    return {lambda_of(moduli, dim, body.elasticity.plane),
            moduli.shear,
            thermal_strain(body, p, body.elasticity.temperature_change.value(p))};
  }


  template <int dim>
  HookeAt<dim> StressProblem<dim>::law(const Point<dim> &p) const
  {
    return uniform ? everywhere : find_law(p);
  }


  template <int dim>
  GivenValue<dim> StressProblem<dim>::displacement(const unsigned int component) const
  {
    return [this, component](const types::boundary_id side,
                             const Point<dim>        &p) -> std::optional<double> {
      const auto &conditions = body.boundary_conditions;
      for (const VectorCondition &condition : conditions.displacement)
        if (conditions.side_of(condition.id) == side && condition.values[component] &&
            conditions.holds_at(condition.id, p) && condition.holds(component, p))
          return condition.values[component]->value(p, time);
      const auto mirror = mirrors.find(side);
      if (mirror != mirrors.end() && mirror->second == component)
        return 0.;
      return {};
    };
  }


  template <int dim>
  double StressProblem<dim>::traction(const unsigned int       component,
                                      const types::boundary_id side,
                                      const Point<dim>        &p) const
  {
    const auto &conditions = body.boundary_conditions;
    double      sum        = 0.;
    for (const VectorCondition &condition : conditions.traction)
      if (conditions.side_of(condition.id) == side && conditions.holds_at(condition.id, p))
        sum += condition.values[component]->value(p, time);
    return sum;
  }


  template <int dim>
  bool StressProblem<dim>::traction_ends(const types::boundary_id side,
                                         const MappedPoints<dim> &at) const
  {
    const auto &conditions = body.boundary_conditions;
    return std::any_of(
      conditions.traction.begin(),
      conditions.traction.end(),
      [&](const VectorCondition &given) {
        if (conditions.side_of(given.id) != side)
          return false;
        const auto n = std::count_if(at.points.begin(), at.points.end(), [&](const Point<dim> &p) {
          return conditions.holds_at(given.id, p);
        });
        return n > 0 && n < static_cast<long>(at.points.size());
      });
  }


  PERIDEAL_INSTANTIATE_CLASS_2_3(struct HookeAt);
  PERIDEAL_INSTANTIATE_CLASS_2_3(class StressProblem);
} // namespace PeriDeal
