// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_error.h"

#include <perideal/laws/elasticity.h>

#include <cmath>
#include <limits>

#include "solid_fields.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::array<double, dim> coordinates_of(const Point<dim> &p)
    {
      std::array<double, dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = p[d];
      return x;
    }


    /** In three dimensions, without heating; no numbers where it is not known. */
    template <int dim>
    SymmetricTensor<2, 3> exact_stress(const Scene<dim>    &scene,
                                       const ExactSolution &exact,
                                       const Point<dim>    &point,
                                       const double         t)
    {
      SymmetricTensor<2, 3> full;
      Tensor<2, dim>        slopes;
      for (unsigned int c = 0; c < dim; ++c)
        {
          double g[dim];
          if (!exact.gradient(coordinates_of(point).data(), t, c, g))
            {
              for (unsigned int a = 0; a < 3; ++a)
                for (unsigned int b = a; b < 3; ++b)
                  full[a][b] = std::numeric_limits<double>::quiet_NaN();
              return full;
            }
          for (unsigned int d = 0; d < dim; ++d)
            slopes[c][d] = g[d];
        }
      const Moduli                  moduli = scene.material.moduli(point);
      const PlaneState              plane  = scene.elasticity.plane;
      const SymmetricTensor<2, dim> found  = stress<dim>(moduli, plane, symmetrize(slopes));
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          full[a][b] = found[a][b];
      if constexpr (dim == 2)
        full[2][2] = stress_zz(moduli, plane, found);
      return full;
    }
  } // namespace


  template <int dim>
  Difference error_of_displacement(const SolidProblem<dim> &problem,
                                   const ExactSolution     &exact,
                                   const double             t)
  {
    const Vector &u = problem.displacement;
    Vector        expected(u.get_partitioner());
    for (unsigned int i = 0; i < u.locally_owned_size() / dim; ++i)
      {
        const auto x     = coordinates_of(problem.position(i));
        const bool shown = problem.scene.domain.shows(problem.position(i));
        for (unsigned int c = 0; c < dim; ++c)
          {
            const double value = exact.value(x.data(), t, c);
            expected.local_element(dim * i + c) =
              std::isnan(value) || !shown ? u.local_element(dim * i + c) : value;
          }
      }
    return nodal_difference(u, expected, [&](const unsigned int i) {
      return problem.volume(i / dim);
    });
  }


  template <int dim>
  std::vector<double> exact_row_of_solid(const Scene<dim>    &scene,
                                         const ExactSolution &exact,
                                         const Point<dim>    &point,
                                         const double         t)
  {
    std::array<double, dim> u;
    for (unsigned int c = 0; c < dim; ++c)
      u[c] = exact.value(coordinates_of(point).data(), t, c);
    std::vector<double> row;
    append_row(u.data(), exact_stress(scene, exact, point, t), dim, row);
    row.resize(solid_columns(scene).size(), std::numeric_limits<double>::quiet_NaN());
    return row;
  }


#define PERIDEAL_INSTANTIATE(dim)                                               \
  template Difference          error_of_displacement(const SolidProblem<dim> &, \
                                                     const ExactSolution &,     \
                                                     const double);             \
  template std::vector<double> exact_row_of_solid(const Scene<dim> &,           \
                                                  const ExactSolution &,        \
                                                  const Point<dim> &,           \
                                                  const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
