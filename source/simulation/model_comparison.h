// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/problem.h>
#include <perideal/problems/result_record.h>
#include <perideal/scene/domain.h>

#include <vector>

namespace PeriDeal
{
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

  /**
   * Of the fields that a problem writes at a time, with the difference of two models if it is one
   * of so many. Collective.
   */
  template <int dim>
  double components_written(const Problem<dim> &problem, const std::size_t n_problems);

  /** Whether fields show the difference of models: of a single number at each node. */
  template <int dim>
  bool shows_difference(const Problem<dim> &problem);
} // namespace PeriDeal
