// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/analysis/exact_solution.h>
#include <perideal/base/progress.h>
#include <perideal/mesh/grading.h>
#include <perideal/problems/problem.h>
#include <perideal/scene/scene.h>

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

    /** Compute, write all files, summary.json last. */
    void run();

    /** Build everything, say what a run would need, compute and write nothing. */
    void dry_run();

  private:
    using List = std::vector<std::unique_ptr<Problem<dim>>>;

    RunContext                        context() const;
    std::vector<const Problem<dim> *> reported() const;
    std::vector<double>               output_times() const;

    void build();
    void check_mesh();
    void prepare_adaptation();

    nlohmann::ordered_json compute(); // the summary at the end
    void                   begin();
    void                   settle();
    bool                   tells_at_stops() const;
    void                   advance_to(const double t);
    void                   find_steady_state();
    std::vector<double>    stops_until(const double t) const;

    /** To a time on the way to t, the given one of some stops. */
    void advance_all(const double       to,
                     const unsigned int stop,
                     const unsigned int n_stops,
                     const double       t);

    /**
     * The share of the run that is done when the first n problems have got to @p t and the others
     * are where they are now, as far as sizes tell it. Collective.
     */
    double share_done(const unsigned int n, const double t) const;
    bool   adapt(const double t);

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
    List                                        companions, problems; // advanced in this order
    std::unique_ptr<ExactSolution>              exact;
    std::unique_ptr<ResultRecord>               record;
    std::unique_ptr<RunOutput<dim>>             output;
    std::unique_ptr<Grading<dim>>               grading; // only where the mesh is adapted
    bool                                        readers_fit   = true; // the mesh
    unsigned int                                n_adaptations = 0;
    double                                      now           = 0.;
  };
} // namespace PeriDeal
