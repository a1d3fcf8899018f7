// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/analysis/exact_solution.h>
#include <perideal/base/own_archive.h>
#include <perideal/base/progress.h>
#include <perideal/mesh/grading.h>
#include <perideal/output/result_folder.h>
#include <perideal/problems/problem.h>
#include <perideal/scene/scene.h>

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  class CheckpointClock;
  class RunFiles;
  template <int dim>
  class RunGuards;
  struct ResultRecord;
  template <int dim>
  class RunOutput;

  /**
   * Owns and wires the members of a run, whatever it computes: mesh, problems, output. All problems
   * of the scene advance together from one output time to the next, so that they can be compared.
   * No physics, no discretisation and no time stepping here. All functions are collective and throw
   * UserError.
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

    /**
     * Compute, write all files, summary.json last. @param mode what becomes of the results that lie
     * in the output directory
     */
    void run(const RunMode mode = RunMode::begin);

    /** Build everything, say what a run would need, compute and write nothing. */
    void dry_run();

    /**
     * Find the solution and write nothing, for programs that look at it first: problem(), found(),
     * then write() or nothing. The states at the times at which results would be written are kept
     * for that, unless cracks or the mesh change on the way.
     * @param see called with these times, each as it is reached
     */
    void solve(const std::function<void(const double)> &see = {});

    /** That of the first model. After solve(). Not collective. */
    const Problem<dim> &problem() const
    {
      return *problems[0];
    }

    /** What summary.json would have, after solve(). */
    nlohmann::ordered_json found();

    /** Whether write() may follow solve(); else it stands in place of it, and computes. */
    bool has_kept() const
    {
      return scene.time.steady || !kept.empty();
    }

    /**
     * Write all files, summary.json last.
     * @param files of this run, of which nothing has been written but what is known at the start
     * @param more  what the summary has besides
     * @param tell  says notes, what was found and where the results are
     */
    void write(std::unique_ptr<RunFiles>     files,
               const nlohmann::ordered_json &more,
               const Progress               &tell);

  private:
    using List = std::vector<Problem<dim> *>;

    /** How far the run is, at and between the times at which all problems meet. */
    struct Place
    {
      double              now    = 0.; // at which all have been
      unsigned int        output = 0;  // of the output times the next
      std::vector<double> stops;       // all on the way to it, from the last one on
      unsigned int        stop    = 0; // of these the next
      unsigned int        problem = 0; // companions first: the one on its way to the next meeting
      double              wall_time_before = 0.; // the run was resumed

      void exchange(Archive &archive);
    };

    /** Of a mesh that follows the solution. */
    struct Adaptation
    {
      std::unique_ptr<Grading<dim>> grading; // null: the mesh stays as it is
      MeshHistory                   history;
      double                        last_time   = 0.;
      bool                          readers_fit = true; // the mesh
    };

    RunContext                        context();
    std::vector<const Problem<dim> *> reported() const;
    List                              companions() const; // advance before the problems
    List                              all_problems() const;
    Problem<dim>                     &problem_under_way() const;
    std::vector<double>               output_times() const;

    void build();
    void check_mesh();
    void prepare_adaptation();

    nlohmann::ordered_json compute(const nlohmann::ordered_json &more, const Progress &tell);
    nlohmann::ordered_json finish(const nlohmann::ordered_json &more, const Progress &tell);
    void                   begin();
    void                   start();
    void                   pass_output_times();
    void                   settle();
    bool                   tells_at_stops() const;
    void                   advance_to(const double t);
    void                   find_steady_state();

    /** Stops that have been passed, and those of the whole run, where problems tell of them. */
    std::pair<unsigned int, unsigned int> count_stops() const;

    /** To a time on the way to the next stop. */
    void advance_all(const double to);

    /**
     * The share of the run that is done when the first n problems have got to @p t and the others
     * are where they are now, as far as sizes tell it. Collective.
     */
    double share_done(const unsigned int n, const double t) const;
    bool   adapt(const double t);

    /** The state of the run: the mesh, then, after begin(), all else. */
    void exchange_mesh(Archive &archive);
    void exchange(Archive &archive);

    bool resumes() const; // and has not done so yet
    void resume();
    void find_next_output();

    /** After a step of the problem that is on its way: its guards, then offer_checkpoint(). */
    void after_step(const double t);

    /** Where the state can be kept: keeps it if that is due, and stops if it has to. */
    void offer_checkpoint(const double t);

    /** @param failure of keeping the state */
    [[noreturn]] void stop(const double t, const std::string &failure) const;

    void                   write_output(const double t);
    void                   write_fields(const double t);
    void                   add_totals(const double t);
    void                   add_errors(const double t);
    void                   end_output(const double t);
    nlohmann::ordered_json summary_now(const bool at_the_end) const;

    const Scene<dim>                           &scene;
    const SceneText                            &text;
    MPI_Comm                                    communicator;
    mutable Progress                            progress;
    Timings                                     timings;
    std::shared_ptr<dealii::Triangulation<dim>> mesh;
    Models<dim>                                 models;
    List                                        problems; // of the models, those that are reported
    std::unique_ptr<ExactSolution>              exact;
    std::unique_ptr<ResultRecord>               record;
    std::unique_ptr<RunOutput<dim>>             output;
    std::unique_ptr<RunGuards<dim>>             guards;
    Adaptation                                  adaptation;
    Place                                       place;
    std::unique_ptr<CheckpointClock>            clock; // unless steady
    std::list<OwnArchive>                       kept;  // by solve(): at the start and output times
  };
} // namespace PeriDeal
