// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/domain.h>
#include <perideal/simulation/problem.h>

#include <vector>

#include "result_record.h"

namespace PeriDeal
{
  /**
   * One component of a vector with @p n of them at each node, as a vector of the nodes with the
   * ghosts of their cells. Collective.
   */
  template <int dim>
  Vector component_of(const dealii::DoFHandler<dim> &dofs,
                      const Vector                  &u,
                      const unsigned int             n,
                      const unsigned int             component);

  /**
   * Append to `relative l2` and `maximum` of the record's comparison the pair [t, value]:
   * peridynamics minus the interpolant of finite elements at its nodes. The norm of the difference,
   * for components the length, weighted by nodal volumes, over that of the finite elements; and the
   * largest one. Nothing where one of the models is absent. Likewise the coupled model minus each
   * of the others, as `coupled minus ...` of the comparisons. Collective.
   */
  template <int dim>
  void compare_models(const std::vector<const Problem<dim> *> &problems,
                      const Domain<dim>                       &domain,
                      const double                             t,
                      ResultRecord                            &record);

  /**
   * What compare_models() takes the norm of, component by component, at the nodes of peridynamics;
   * empty where one of the models is absent. Collective.
   */
  template <int dim>
  std::vector<Vector> difference_of_models(const std::vector<const Problem<dim> *> &problems);
} // namespace PeriDeal
