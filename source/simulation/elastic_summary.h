// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/simulation/elastic_run.h>

#include <nlohmann/json.hpp>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * Side -> what holds there in words: `displacement 0, free`, `traction 1, 0`, `symmetry`, several
   * separated by `; `, else `free`.
   */
  template <int dim>
  nlohmann::ordered_json describe_elastic_sides(const Scene<dim> &scene);

  /**
   * Side or part -> `displacement`, `traction` -> `at` (points spread over it) and `values` (at
   * time @p t, a list of components for each point; null: free), what arrows in a sketch are drawn
   * from. The points of what is no side of a box are those of @p places (places_of_conditions()).
   */
  template <int dim>
  nlohmann::ordered_json values_on_sides(const Scene<dim>             &scene,
                                         const dealii::Point<dim>     &lower,
                                         const dealii::Point<dim>     &upper,
                                         const double                  t,
                                         const nlohmann::ordered_json &places);

  /**
   * Why some model of a body at rest with whole bonds has no stress intensity factors at the ends
   * of its cracks, or nothing: there are no cracks,
   * or all models have them. @param models their entries in the summary
   */
  template <int dim>
  std::string no_stress_intensity(const Scene<dim> &scene, const nlohmann::ordered_json &models);

  /**
   * The size of forces in the body now, against which a sum of forces that should be zero is small
   * or not: what passes through it (@p throughput), and its mean Young modulus times the area of a
   * cube on its shortest edge times the strain by which displacements differ over that edge: a body
   * that is free to expand bears nothing but round-off, which is small against the latter.
   * Collective.
   */
  template <int dim>
  double find_force_scale(const ElasticRun<dim> &model,
                          const Scene<dim>      &scene,
                          const double           throughput);
} // namespace PeriDeal
