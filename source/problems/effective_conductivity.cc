// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "effective_conductivity.h"

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::optional<double> effective_conductivity(const Scene<dim> &scene, const Balance &balance)
  {
    const BoundaryConditions<dim> &bc = scene.boundary_conditions;
    if ((scene.domain.shape != Shape::box && scene.domain.shape != Shape::image) ||
        bc.dirichlet.size() != 2 || !is_zero(scene.initial_and_source.source) ||
        !std::all_of(bc.transfers.begin(), bc.transfers.end(), [](const SurfaceTransfer &side) {
          return side.insulates();
        }))
      return {};
    const SideCondition &a = bc.dirichlet[0], &b = bc.dirichlet[1];
    if (a.id >= 2 * dim || a.id / 2 != b.id / 2 || a.id == b.id || !a.value.is_constant() ||
        !b.value.is_constant())
      return {};
    const double difference = a.value.value(Point<dim>()) - b.value.value(Point<dim>());
    if (difference == 0.)
      return {};
    double length_over_area = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double length = scene.domain.extra.body_upper[d] - scene.domain.extra.body_lower[d];
        length_over_area    = d == a.id / 2 ? length_over_area * length : length_over_area / length;
      }
    const double heat = 0.5 * (balance.sides.at(a.name) - balance.sides.at(b.name));
    return heat * length_over_area / difference;
  }

  template std::optional<double> effective_conductivity(const Scene<1> &, const Balance &);
  template std::optional<double> effective_conductivity(const Scene<2> &, const Balance &);
  template std::optional<double> effective_conductivity(const Scene<3> &, const Balance &);
} // namespace PeriDeal
