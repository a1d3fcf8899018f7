// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/mesh_builder.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/scene/scene.h>
#include <perideal/study/cracked_box.h>
#include <perideal/study/naming.h>

#include <string>
#include <type_traits>
#include <vector>

#include "checked_row.h"

namespace PeriDeal
{
  /** What maps have to know of a scene. */
  struct StabilityFacts
  {
    std::string            title, kernel, fraction, calibration, nodes;
    unsigned int           dim = 0, kernel_exponent = 0;
    double                 ratio   = 0.; // m
    bool                   deforms = false, moves = false, steady = false, is_box = false;
    bool                   breaks = false, depends_on_solution = false, lumped = true;
    std::vector<ModelKind> models;
    CellCounts             cells; // of the scene, and those with which maps are computed
    CellCounts             coarse;
    std::vector<double>    lower, upper; // corners of a box

    bool runs(const ModelKind model) const;
  };


  /** A scene of which maps are made, on a coarse lattice with the same m. */
  class StabilityScene
  {
  public:
    /** Throws UserError for a scene that is wrong. Collective. */
    StabilityScene(const std::string              &file,
                   const std::vector<std::string> &overrides,
                   const std::string              &folder,
                   const MPI_Comm                  communicator);

    const StabilityFacts facts;
    const MPI_Comm       communicator;
    const std::string    folder; // exists, for files that are needed in between

    /**
     * Build a model of the scene with these settings, which are stronger than those of the coarse
     * lattice, and call action(problem, scene). Throws UserError for settings that the scene cannot
     * have. Collective. Not within itself: one scene lives at a time.
     */
    template <typename Action>
    void with_problem(const ModelKind             model,
                      const std::vector<Setting> &settings,
                      const Action               &action) const
    {
      with_scene(text_with(model, settings),
                 [&](const auto &scene) { build(model, scene, action); });
    }

    /**
     * The same of a scene that these settings alone describe, of the dimension, and with the kernel
     * and the nodes, of this one: a body for a question, in which nothing else differs from theory.
     */
    template <typename Action>
    void with_body(const ModelKind             model,
                   const std::vector<Setting> &settings,
                   const Action               &action) const
    {
      with_scene(text_of_body(model, settings),
                 [&](const auto &scene) { build(model, scene, action); });
    }

    /** Why diffusion in a model does not occur here; or empty. */
    std::string no_diffusion_with(const ModelKind model) const;

  private:
    SceneText text_of_body(const ModelKind model, const std::vector<Setting> &settings) const;
    SceneText text_with(const ModelKind model, const std::vector<Setting> &settings) const;

    template <int dim, typename Action>
    void build(const ModelKind model, const Scene<dim> &scene, const Action &action) const
    {
      std::vector<std::string> notes;
      const auto               mesh = build_mesh(scene, communicator, notes);
      Model<dim>               body(model, *mesh);
      body.problem = problem_factory(scene).make_problem(body, scene);
      action(*body.problem, scene);
    }

    const std::string              file;
    const std::vector<std::string> overrides;
  };

  /** Call action(std::integral_constant<int, dim>()). */
  template <typename Action>
  void with_dimension(const unsigned int dim, const Action &action)
  {
    switch (dim)
      {
        case 1:
          return action(std::integral_constant<int, 1>());
        case 2:
          return action(std::integral_constant<int, 2>());
        default:
          return action(std::integral_constant<int, 3>());
      }
  }
} // namespace PeriDeal
