// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/comparison.h>
#include <perideal/analysis/point_evaluator.h>
#include <perideal/base/archive.h>
#include <perideal/base/diverged.h>
#include <perideal/base/timing.h>
#include <perideal/operators/interface/operator.h>
#include <perideal/output/crack_writer.h>
#include <perideal/output/field_writer.h>
#include <perideal/problems/field.h>

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  class ExactSolution;
  struct ModelEstimate;
  struct ResultRecord;
  struct RunContext;
  struct StepperOptions;

  /** How a problem gets from one time to the next. Collective unless they say otherwise. */
  class ProblemSteps
  {
  public:
    virtual ~ProblemSteps() = default;

    /** Make what advances the problem: its start, a stepper. Throws UserError. */
    virtual void begin(const RunContext &context) = 0;

    /** The steady state, or the equilibrium from which slow loading begins, at time 0. */
    virtual void settle(const RunContext & /*context*/) {}

    /** What a solution that does not depend on time is called. Not collective. */
    virtual std::string steady_name() const
    {
      return "the steady state";
    }

    /** The times after @p from until @p to, the last, at which all problems of a run meet. */
    virtual std::vector<double> stops(const double /*from*/, const double to) const
    {
      return {to};
    }

    /** Totals are told at each of these, not only where results are written. Not collective. */
    virtual bool tells_at_stops() const
    {
      return false;
    }

    /** What is done on the way to the k-th of n stops, the last at t. Not collective. */
    virtual std::string doing(const unsigned int k, const unsigned int n, const double t) const = 0;

    /** @param report how far this has got, from 0 to 1 */
    virtual void advance(const double                             from,
                         const double                             to,
                         const std::function<void(const double)> &report,
                         const RunContext                        &context) = 0;

    /**
     * The state of the problem between the times at which all problems meet, or where
     * RunContext::after_step is asked. A problem that loads has been through begin(), on the same
     * mesh; advance() then goes on where that was. Throws UserError.
     */
    virtual void exchange(Archive &archive) = 0;

    /** How much work a time span is, to be compared with that of others. */
    virtual double work_of(const double span) const = 0;

    /** Of a coarse lattice, before begin(): what steps or solutions take. */
    virtual void take_sample(const RunContext & /*context*/, ModelEstimate & /*estimate*/) {}

    /**
     * Seconds of processor time until the last of some ascending times; negative if not known.
     * After begin(). @param says more of it in lines @param memory raised to what that takes
     */
    virtual double time_of_run(const std::vector<double> & /*times*/,
                               const bool /*says*/,
                               const RunContext & /*context*/,
                               double & /*memory*/)
    {
      return -1.;
    }
  };


  /** What guards look at on the way, and what notes tell. Collective unless they say otherwise. */
  class ProblemWatch
  {
  public:
    virtual ~ProblemWatch() = default;

    /** Steps between two looks of the guards, so that those are cheap. Not collective. */
    virtual unsigned int steps_between_looks() const
    {
      return 1;
    }

    /**
     * The oldest of what a solver has found wrong and has gone on from, which then is told; empty
     * if there is none. Not collective, but the same on all processes.
     */
    virtual Trip take_finding()
    {
      return {};
    }

    /** What is wrong with the state at t, found by a look at it: one application at most. */
    virtual Trip watch(const double t) = 0;

    /** What is wrong with the balances of the last add_totals(). The same on all processes. */
    virtual Trip watch_totals(const double /*t*/) const
    {
      return {};
    }

    /**
     * Add to what has been found, by watch() or by a solver that has thrown Diverged, a place where
     * there is none, and the cause: of what is known to bring that about the first that holds here,
     * with the numbers.
     */
    virtual void explain(Trip & /*trip*/) {}

    /** Before results of a time are written. Throws UserError where the state is no result. */
    virtual void examine(const double /*t*/) {}

    /** What the user should know of the chosen settings: where they are known to fail. */
    virtual std::vector<std::string> notes() const
    {
      return {};
    }

    /** What the user should know at the end. */
    virtual void note_end(const RunContext & /*context*/) const {}
  };


  /** What is seen of the solution: in files, in the report. Functions are collective. */
  template <int dim>
  class ProblemResults
  {
  public:
    virtual ~ProblemResults() = default;

    /** What probes.csv, line.csv and grid.csv have at each point. Not collective. */
    virtual std::vector<std::string> columns() const = 0;

    /** The values of these columns, of one point after the other; the state has current ghosts. */
    virtual std::vector<double> at_points(const PointEvaluator<dim>              &reader,
                                          const std::vector<std::vector<double>> &points) const = 0;

    /** The same of a known solution; what it does not tell is no number. Not collective. */
    virtual std::vector<double> exact_row(const ExactSolution      &exact,
                                          const dealii::Point<dim> &point,
                                          const double              t) const = 0;

    /** Against what is known of the solution. */
    virtual Difference error(const ExactSolution &exact, const double t) const = 0;

    /** All fields of files at a time, with current ghosts; the state has current ghosts. */
    virtual std::vector<OutputField> fields(const double t) const = 0;

    /** Which cells of the mesh they show; all if empty. */
    virtual typename FieldWriter<dim>::Choice shown() const
    {
      return {};
    }

    /** The surfaces of cracks that the problem has found itself, on all processes, for files. */
    virtual NewCracks new_cracks() const
    {
      return {};
    }

    /** Rows of totals.csv, and what the summary says of a time. Throws UserError if not finite. */
    virtual void add_totals(const double t, const RunContext &context) = 0;

    /** Steps, iterations: for the summary. */
    virtual nlohmann::ordered_json describe_solving() const = 0;

    /** What the summary says of the scene as this physics sees it: sides, loads. */
    virtual void describe_scene(nlohmann::ordered_json &summary, const bool at_the_end) const = 0;

    /** What it says of this problem at the end of the run alone. */
    virtual void describe_end(nlohmann::ordered_json & /*entry*/, ResultRecord & /*record*/) const
    {}
  };


  /**
   * One physics of one model of a scene during a run: a field on the nodes of the model, how it
   * advances, its results, and what they have cost so far.
   */
  template <int dim>
  class Problem : public ProblemSteps, public ProblemWatch, public ProblemResults<dim>
  {
  public:
    /** Takes the field over. */
    explicit Problem(std::unique_ptr<Field<dim>> of)
      : scene(of->scene)
      , timings(of->timings)
      , field(std::move(of))
    {}

    /** Of the model, as in scenes and output files. Not collective, as those down to settings(). */
    std::string name() const
    {
      return scene.general.name_of(field->on.kind);
    }

    /** Of the field of the solution, as in output files. */
    std::string field_name() const
    {
      return names_of(scene.general.physics).field;
    }

    /** One for each node, whatever number of components it has. */
    const dealii::DoFHandler<dim> &dofs() const
    {
      return field->handler;
    }

    unsigned int n_components() const
    {
      return field->n_components;
    }

    /** On a lattice, for reading values at points without a mesh search; nullptr for elements. */
    const Nodes<dim> *nodes() const
    {
      return field->on.kind == ModelKind::peridynamics ? field->node_set : nullptr;
    }

    Operator &op() const
    {
      return field->op();
    }

    const Vector &state() const
    {
      return field->solution;
    }

    /** As those of its field, as volume(). */
    dealii::Point<dim> position(const unsigned int node) const
    {
      return field->position(node);
    }

    double volume(const unsigned int node) const
    {
      return field->volume(node);
    }

    ChosenSettings settings() const
    {
      return field->settings();
    }

    /** What is known of a coupling, or nullptr. */
    const CouplingCertificate *examined() const
    {
      return field->certificate.get();
    }

    std::string doing(const unsigned int k, const unsigned int n, const double t) const override;

    /** That all values are finite. */
    Trip watch(const double t) override;

    void                     explain(Trip &trip) override;
    std::vector<std::string> notes() const override;

    const Scene<dim> &scene;
    Timings          &timings;

  protected:
    /** What of the steps or the material brings a trip about; empty if neither does. */
    virtual std::string own_cause(const Trip & /*trip*/)
    {
      return {};
    }

    StepperOptions stepper_options() const;

    const std::unique_ptr<Field<dim>> field;
  };
} // namespace PeriDeal
