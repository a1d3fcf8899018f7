// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/base/progress.h>
#include <perideal/simulation/elastic_run.h>
#include <perideal/simulation/simulation.h>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  struct ResultRecord;
  template <int dim>
  class RunOutput;

  /**
   * Owns and wires the members of a run with `Physics = elasticity`: mesh, models, solvers, output,
   * and with `Temperature change = computed` the heat problem that each model solves with its own
   * nodes before it finds its equilibrium. All models of the scene are solved one after the other,
   * or move from one output time to the next together, and are compared. No discretisation here.
   * All functions are collective and throw UserError.
   */
  template <int dim>
  class ElasticSimulation
  {
  public:
    /**
     * @param scene parsed; @param text what it was read from; @param quiet no messages but errors
     */
    ElasticSimulation(const Scene<dim> &scene,
                      const SceneText  &text,
                      const MPI_Comm    communicator,
                      const bool        quiet);
    ~ElasticSimulation();

    /** Compute, write all files, summary.json last. */
    void run();

    /** Build everything, say what a run would need, compute and write nothing. */
    void dry_run();

  private:
    nlohmann::ordered_json            compute(); // the summary at the end
    void                              build();
    void                              build_heat();
    std::vector<const Problem<dim> *> problems() const;
    RunContext<dim>                   context();
    void                              describe_costs_of_run(const double memory_before);
    double                            time_of_motion(ElasticRun<dim> &model); // by its first steps
    void                              warm_until(const double t);
    void                              note_sudden_heat();
    std::vector<double>               times_of_output() const;

    /** From one time of output to the next. */
    void advance(const double now, const double t, const bool at_stops);

    /**
     * The share of the run that is done when the first n models have got from one time to the next
     * and the others are where they are now, as far as sizes tell it. Collective.
     */
    double share_done(const unsigned int n, const double from, const double to) const;
    void   add_totals(const double t);

    void                   write_output(const double t, const bool with_totals);
    void                   end_output(const double t);
    nlohmann::ordered_json summary_now(const bool at_the_end);

    const Scene<dim>                             &scene;
    const SceneText                              &text;
    MPI_Comm                                      communicator;
    const bool                                    quiet;
    mutable Progress                              progress;
    Timings                                       timings;
    std::shared_ptr<dealii::Triangulation<dim>>   mesh;
    std::vector<std::unique_ptr<ElasticRun<dim>>> models;
    std::unique_ptr<Simulation<dim>>              heat; // null: no temperature is computed
    std::unique_ptr<ResultRecord>                 record;
    std::unique_ptr<RunOutput<dim>>               output;
  };
} // namespace PeriDeal
