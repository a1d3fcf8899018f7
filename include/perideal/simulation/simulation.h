// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/analysis/exact_solution.h>
#include <perideal/base/progress.h>
#include <perideal/mesh/grading.h>
#include <perideal/simulation/model_run.h>

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <map>
#include <memory>

namespace PeriDeal
{
  struct ResultRecord;
  template <int dim>
  class RunOutput;

  /**
   * Owns and wires the members of a run: mesh, models, steppers, output. All models of the scene
   * advance together from one output time to the next, so that they can be compared. No
   * discretisation and no time stepping here. All functions are collective and throw UserError.
   */
  template <int dim>
  class Simulation
  {
  public:
    /**
     * @param scene parsed; @param text what it was read from; @param quiet no messages but errors
     */
    Simulation(const Scene<dim> &scene,
               const SceneText  &text,
               const MPI_Comm    communicator,
               const bool        quiet);
    ~Simulation();

    /** Compute, write all files, summary.json last. */
    void run();

    /** Build everything, say what a run would need, compute and write nothing. */
    void dry_run();

    /**
     * Build everything on a mesh of the same scene, which others use too, for advance_to(). Nothing
     * is written then.
     */
    void build_on(const std::shared_ptr<dealii::Triangulation<dim>> &given_mesh);

    /**
     * From the time reached so far, at first 0, to time t; where the scene is steady the steady
     * state, whatever t.
     */
    void advance_to(const double t);

    /** In the order of `Models`. Not collective. */
    const ModelRun<dim> &model(const unsigned int number) const;

    /** Of the fields of a model, as many as it writes at a time. Collective. */
    unsigned int components_written(const unsigned int number) const;

    /**
     * Seconds that the models of a run take once they are built, as far as that can be told before;
     * negative if not. Collective.
     */
    double time_of_run() const;

    /** What the user should know. Not collective. */
    const std::vector<std::string> &notes() const;

  private:
    void                              build();
    void                              build_mesh_of_run();
    void                              make_steppers();
    std::vector<const Problem<dim> *> problems() const;
    void                              solve_models();
    void                              prepare_adaptation();
    bool                              adapt(const double t);
    nlohmann::ordered_json            compute(); // the summary at the end
    void                              make_reference();
    void                              write_output(const double t);
    void                              write_start(); // the first frame of a film
    void                              add_errors(const double t);
    void                              write_fields(const double t);
    nlohmann::ordered_json            summary_now() const;
    void                              describe(const ModelRun<dim> &model) const;
    std::vector<double>               output_times() const;
    double                            time_of_run(const ModelRun<dim> &model) const;
    double                            time_of_application(const ModelRun<dim> &model) const;

    /**
     * The share of the run that is done when the first n models have got to @p t and the others are
     * where they are now, as far as sizes tell it. Collective.
     */
    double share_done(const unsigned int n, const double t) const;

    const Scene<dim>                           &scene;
    const SceneText                            &text;
    MPI_Comm                                    communicator;
    mutable Progress                            progress;
    Timings                                     timings;
    std::shared_ptr<dealii::Triangulation<dim>> mesh;
    std::vector<std::unique_ptr<ModelRun<dim>>> models;
    std::unique_ptr<ExactSolution>              exact;
    std::unique_ptr<ResultRecord>               record;
    std::unique_ptr<RunOutput<dim>>             output;
    std::unique_ptr<Grading<dim>>               grading; // only where the mesh is adapted
    bool                                        readers_fit   = true; // the mesh
    unsigned int                                n_adaptations = 0;
    double                                      now           = 0.;
  };
} // namespace PeriDeal
