// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_fields.h"

#include <perideal/laws/elasticity.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::vector<std::string> solid_columns(const Scene<dim> &scene)
  {
    std::vector<std::string> columns;
    switch (dim)
      {
        case 1:
          columns = {"ux", "sxx", "von_mises"};
          break;
        case 2:
          columns = {"ux", "uy", "sxx", "syy", "szz", "sxy", "von_mises"};
          break;
        default:
          columns = {"ux", "uy", "uz", "sxx", "syy", "szz", "sxy", "sxz", "syz", "von_mises"};
      }
    if (scene.elasticity.computes_temperature)
      columns.push_back("temperature");
    if (!scene.elasticity.is_static())
      for (unsigned int d = 0; d < dim; ++d)
        columns.push_back(std::string("v") + "xyz"[d]);
    return columns;
  }


  template <int dim>
  std::vector<std::vector<double>> velocities_at_points(const Scene<dim>          &scene,
                                                        const PointEvaluator<dim> &reader,
                                                        const Vector              &velocity)
  {
    std::vector<std::vector<double>> components;
    if (scene.elasticity.is_static())
      return components;
    Vector with_ghosts(velocity);
    with_ghosts.update_ghost_values();
    for (unsigned int d = 0; d < dim; ++d)
      components.push_back(reader.evaluate(with_ghosts, dim, d));
    return components;
  }


  void append_row(const double                *displacement,
                  const SymmetricTensor<2, 3> &stress,
                  const unsigned int           dim,
                  std::vector<double>         &rows)
  {
    rows.insert(rows.end(), displacement, displacement + dim);
    rows.push_back(stress[0][0]);
    if (dim > 1)
      rows.insert(rows.end(), {stress[1][1], stress[2][2], stress[0][1]});
    if (dim > 2)
      rows.insert(rows.end(), {stress[0][2], stress[1][2]});
    rows.push_back(von_mises(stress));
  }


  template std::vector<std::string>         solid_columns(const Scene<1> &);
  template std::vector<std::string>         solid_columns(const Scene<2> &);
  template std::vector<std::string>         solid_columns(const Scene<3> &);
  template std::vector<std::vector<double>> velocities_at_points(const Scene<1> &,
                                                                 const PointEvaluator<1> &,
                                                                 const Vector &);
  template std::vector<std::vector<double>> velocities_at_points(const Scene<2> &,
                                                                 const PointEvaluator<2> &,
                                                                 const Vector &);
  template std::vector<std::vector<double>> velocities_at_points(const Scene<3> &,
                                                                 const PointEvaluator<3> &,
                                                                 const Vector &);
} // namespace PeriDeal
