// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/exact_solution.h>
#include <perideal/problems/computable.h>
#include <perideal/problems/problem.h>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** How the problems of one physics are made, and what is to be known of them before. */
  template <int dim>
  class ProblemFactory
  {
  public:
    virtual ~ProblemFactory() = default;

    /**
     * Throws UserError for what its problems cannot compute, as their components say (their
     * functions `require...`). Not collective.
     */
    virtual void require_computable(const Scene<dim> & /*scene*/) const {}

    /** Components of the unknown at each node. Not collective. */
    virtual unsigned int n_components() const
    {
      return 1;
    }

    /** Each step may take more than one solution, as many as bonds go on breaking. */
    virtual bool may_solve_again(const Scene<dim> & /*scene*/) const
    {
      return false;
    }

    /** What the user should know of a scene before anything is built. Collective. */
    virtual void note_scene(const Scene<dim> & /*scene*/,
                            const dealii::Triangulation<dim> & /*mesh*/,
                            std::vector<std::string> & /*notes*/) const
    {}

    /** The problem of a model, and the time that this takes in its timings. Collective. */
    virtual std::unique_ptr<Problem<dim>> make_problem(Model<dim>       &model,
                                                       const Scene<dim> &scene) const = 0;

    /**
     * Give the models, which have their problems, what these need from others on the same nodes
     * before they advance: none, or one for each. They are not reported. Collective.
     */
    virtual void add_companions(const Models<dim> & /*models*/,
                                const Scene<dim> & /*scene*/,
                                std::vector<std::string> & /*notes*/) const
    {}
  };


  /** That of a physics. Throws UserError if it has none. Not collective. */
  template <int dim>
  const ProblemFactory<dim> &problem_factory(const Physics physics);

  template <int dim>
  const ProblemFactory<dim> &problem_factory(const Scene<dim> &scene)
  {
    return problem_factory<dim>(scene.general.physics);
  }

  /**
   * For a physics that a program brings (add_physics()): how its problems are made. To be called
   * once, before a scene of it is read. Not collective.
   */
  template <int dim>
  void set_problem_factory(const Physics physics, std::unique_ptr<ProblemFactory<dim>> factory);

  /** Units and names for the summary. Not collective. */
  template <int dim>
  void describe_physics(const Scene<dim> &scene, nlohmann::ordered_json &summary);

  /** The solution that a scene knows (section `Reference`), or nullptr. Throws UserError. */
  template <int dim>
  std::unique_ptr<ExactSolution> make_reference(const Scene<dim> &scene);
} // namespace PeriDeal
