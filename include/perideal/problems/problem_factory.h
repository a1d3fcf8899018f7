// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/problem.h>
#include <perideal/scene/scene.h>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  using Problems = std::vector<std::unique_ptr<Problem<dim>>>;

  /** Throws UserError for what the physics of a scene cannot do yet. Not collective. */
  template <int dim>
  void require_computable(const Scene<dim> &scene);

  /** Components of the unknown at each node. Not collective. */
  template <int dim>
  unsigned int n_components_of(const Scene<dim> &scene);

  /** Each step may take more than one solution, as many as bonds go on breaking. */
  template <int dim>
  bool may_solve_again(const Scene<dim> &scene);

  /** Units and names for the summary. Not collective. */
  template <int dim>
  void describe_physics(const Scene<dim> &scene, nlohmann::ordered_json &summary);

  /** What the user should know of a scene before anything is built. Collective. */
  template <int dim>
  void note_scene(const Scene<dim>                 &scene,
                  const dealii::Triangulation<dim> &mesh,
                  std::vector<std::string>         &notes);

  /** The problem of a model, and the time that this takes in its timings. Collective. */
  template <int dim>
  std::unique_ptr<Problem<dim>> make_problem(const ModelKind                   model,
                                             const dealii::Triangulation<dim> &mesh,
                                             const Scene<dim>                 &scene);

  /**
   * What the problems of a scene need from others on their own nodes before they advance: none, or
   * one for each. They are not reported. Collective.
   */
  template <int dim>
  Problems<dim> make_companions(const Problems<dim>              &problems,
                                const dealii::Triangulation<dim> &mesh,
                                const Scene<dim>                 &scene,
                                std::vector<std::string>         &notes);
} // namespace PeriDeal
