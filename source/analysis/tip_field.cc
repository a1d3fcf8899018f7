// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/tip_field.h>
#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  SymmetricTensor<2, 2> near_stress(const unsigned int mode, const double r, const double angle)
  {
    const double          s = std::sin(0.5 * angle), c = std::cos(0.5 * angle);
    const double          s3 = std::sin(1.5 * angle), c3 = std::cos(1.5 * angle);
    SymmetricTensor<2, 2> stress;
    if (mode == 0)
      {
        stress[0][0] = c * (1. - s * s3);
        stress[1][1] = c * (1. + s * s3);
        stress[0][1] = c * s * c3;
      }
    else
      {
        stress[0][0] = -s * (2. + c * c3);
        stress[1][1] = s * c * c3;
        stress[0][1] = c * (1. - s * s3);
      }
    return stress / std::sqrt(2. * numbers::PI * r);
  }


  Tensor<1, 2> near_slope(const unsigned int mode,
                          const double       r,
                          const double       angle,
                          const double       kappa,
                          const double       shear)
  {
    const double s = std::sin(0.5 * angle), c = std::cos(0.5 * angle);
    // u = sqrt(r/(2 pi))/(2 mu) f(angle); f and its derivative.
    Tensor<1, 2> f, df;
    if (mode == 0)
      {
        f[0]  = c * (kappa - 1. + 2. * s * s);
        f[1]  = s * (kappa + 1. - 2. * c * c);
        df[0] = -0.5 * s * (kappa - 1. + 2. * s * s) + 2. * c * s * c;
        df[1] = 0.5 * c * (kappa + 1. - 2. * c * c) + 2. * s * c * s;
      }
    else
      {
        f[0]  = s * (kappa + 1. + 2. * c * c);
        f[1]  = -c * (kappa - 1. - 2. * s * s);
        df[0] = 0.5 * c * (kappa + 1. + 2. * c * c) - 2. * s * c * s;
        df[1] = 0.5 * s * (kappa - 1. - 2. * s * s) + 2. * c * s * c;
      }
    return (0.5 * std::cos(angle) * f - std::sin(angle) * df) /
           (2. * shear * std::sqrt(2. * numbers::PI * r));
  }


  double smooth_step(const double s)
  {
    const double x = std::clamp(s, 0., 1.);
    return 1. - x * x * x * (10. - 15. * x + 6. * x * x);
  }


  double slope_of_smooth_step(const double s)
  {
    return s <= 0. || s >= 1. ? 0. : -30. * s * s * (1. - s) * (1. - s);
  }


  template <int dim>
  double distance_to_parts(const Scene<dim> &scene, const Point<dim> &p)
  {
    const auto          &conditions = scene.boundary_conditions;
    const Domain<dim>   &domain     = scene.domain;
    const Tensor<1, dim> h          = domain.spacing();
    double               nearest    = std::numeric_limits<double>::max();
    unsigned long long   n_places   = 1;
    for (unsigned int d = 0; d < dim; ++d)
      n_places *= 2 * domain.cells[d] + 1;
    for (const Part &part : conditions.parts)
      {
        const bool used = find_condition(conditions.displacement, part.id) != nullptr ||
                          find_condition(conditions.traction, part.id) != nullptr;
        if (!used || part.kind == Part::of_side)
          continue;
        if (part.kind == Part::point)
          {
            nearest = std::min(nearest, p.distance(part.position<dim>()));
            continue;
          }
        for (unsigned long long k = 0; k < n_places; ++k)
          {
            Point<dim>         place;
            unsigned long long left = k;
            for (unsigned int d = 0; d < dim; ++d)
              {
                place[d] = domain.lower[d] + 0.5 * (left % (2 * domain.cells[d] + 1)) * h[d];
                left /= 2 * domain.cells[d] + 1;
              }
            if (p.distance(place) < nearest && part.holds(place))
              nearest = p.distance(place);
          }
      }
    return nearest;
  }


  PERIDEAL_INSTANTIATE_FUNCTION_2_3(distance_to_parts);
} // namespace PeriDeal
