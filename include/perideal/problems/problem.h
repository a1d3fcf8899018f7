// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/analysis/comparison.h>
#include <perideal/analysis/point_evaluator.h>
#include <perideal/analysis/recovery.h>
#include <perideal/base/archive.h>
#include <perideal/base/diverged.h>
#include <perideal/base/timing.h>
#include <perideal/mesh/nodes.h>
#include <perideal/operators/interface/operator.h>
#include <perideal/output/crack_writer.h>
#include <perideal/output/field_writer.h>

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  struct CouplingCertificate;
  class ExactSolution;
  struct ModelEstimate;
  struct ResultRecord;
  struct RunContext;

  /**
   * One physics of one model of a scene during a run: its unknowns on the shared mesh, its
   * operator, its results, and what they have cost so far. Functions are collective unless they
   * say otherwise.
   */
  template <int dim>
  class Problem
  {
  public:
    virtual ~Problem() = default;

    /** Of the model, as in scenes and output files. Not collective. */
    virtual std::string name() const = 0;

    /** Of the field of the solution, as in output files. Not collective. */
    virtual std::string field_name() const = 0;

    /** What a solution that does not depend on time is called. Not collective. */
    virtual std::string steady_name() const;

    /** One for each node, whatever number of components it has. Not collective. */
    virtual const dealii::DoFHandler<dim> &dofs() const = 0;

    /**
     * Nodes on a lattice, for reading values at points without a mesh search; nullptr for finite
     * elements. Not collective.
     */
    virtual const Nodes<dim> *nodes() const = 0;

    virtual Operator &op() const = 0;

    /** The solution, interleaved: so many numbers at each node. Not collective. */
    virtual const Vector &state() const        = 0;
    virtual unsigned int  n_components() const = 0;

    /** Place of an owned node. Not collective. */
    virtual dealii::Point<dim> position(const unsigned int node) const = 0;

    /**
     * What an owned node has of the body's volume; not of finite elements alone for diffusion.
     * Not collective.
     */
    virtual double volume(const unsigned int node) const = 0;

    /** Make what advances the problem: its start, a stepper. Throws UserError. */
    virtual void begin(const RunContext &context) = 0;

    /** The steady state, or the equilibrium from which slow loading begins, at time 0. */
    virtual void settle(const RunContext &context) = 0;

    /**
     * The times after @p from until @p to, which is the last, at which all problems of a run meet.
     */
    virtual std::vector<double> stops(const double from, const double to) const;

    /** Totals are told at each of these, not only where results are written. Not collective. */
    virtual bool tells_at_stops() const
    {
      return false;
    }

    /** What is done on the way to the k-th of n stops, the last at t. Not collective. */
    virtual std::string doing(const unsigned int k, const unsigned int n, const double t) const;

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

    /** How much work it is to advance by a time span, to be compared with that of others. */
    virtual double work_of(const double span) const = 0;

    /**
     * So many steps may be between two looks of the guards for those to cost at most some percent.
     * Not collective.
     */
    virtual unsigned int steps_between_looks() const
    {
      return 1;
    }

    /**
     * The oldest of what a solver has found wrong and has gone on from, which then is told; empty
     * if there is none. Not collective, but the same on all processes.
     */
    virtual Trip take_finding();

    /** What is wrong with the state at t, found by a look at it: one application at most. */
    virtual Trip watch(const double t);

    /**
     * What is wrong with the balances that add_totals() has just found. Not collective, but the
     * same on all processes.
     */
    virtual Trip watch_totals(const double t) const;

    /**
     * Add to what has been found, by watch() or by a solver that has thrown Diverged, a place where
     * there is none, and the cause: of what is known to bring that about the first that holds here,
     * with the numbers.
     */
    virtual void explain(Trip &trip);

    /** Before results of a time are written. Throws UserError where the state is no result. */
    virtual void examine(const double t);

    /** Rows of totals.csv, and what the summary says of a time. Throws UserError if not finite. */
    virtual void add_totals(const double t, const RunContext &context) = 0;

    /** Against what is known of the solution. */
    virtual Difference error(const ExactSolution &exact, const double t) const = 0;

    /**
     * Square of the error that the recovered flux shows in each cell, which guides the mesh. Only
     * where meshes are adapted, as the next three.
     */
    virtual RecoveryIndicators indicators() const;

    /** The initial state on the mesh as it is now. */
    virtual void start_anew();

    /** The mesh is about to be adapted: what the solution needs to move on. */
    virtual void before_remesh();

    /**
     * Unknowns, operator and solution on the mesh as it is now, with the cracks of time t. The heat
     * in the body stays what it was, unless steady.
     */
    virtual void after_remesh(const double t, const bool steady);

    /**
     * Unknowns and operator on the mesh as it is now, with the cracks of time t; the solution is
     * nothing, until it is loaded.
     */
    virtual void rebuild(const double t);

    /** After that: a stepper of the new operator, with the cost of the old one. */
    virtual void renew_stepper();

    /** Of a coarse lattice, before begin(): what steps or solutions take. */
    virtual void take_sample(const RunContext &context, ModelEstimate &estimate) = 0;

    /**
     * Seconds of processor time that the run until the last of some ascending times will take;
     * negative if not known. After begin(). @param says more of it in lines @param memory raised to
     * what that takes
     */
    virtual double time_of_run(const std::vector<double> &times,
                               const bool                 says,
                               const RunContext          &context,
                               double                    &memory) = 0;

    /** What the user should know at the end. */
    virtual void note_end(const RunContext &context) const;

    /** Steps, iterations: for the summary. */
    virtual nlohmann::ordered_json describe_solving() const = 0;

    /** What the summary says of this problem at the end of the run alone. */
    virtual void describe_end(nlohmann::ordered_json &entry, ResultRecord &record) const;

    /** What it says of the scene as this physics sees it: sides, loads. */
    virtual void describe_scene(nlohmann::ordered_json &summary, const bool at_the_end) const = 0;

    /** What probes.csv, line.csv and grid.csv have at each point. Not collective. */
    virtual std::vector<std::string> columns() const = 0;

    /** The values of these columns, of one point after the other; the state has current ghosts. */
    virtual std::vector<double> at_points(const PointEvaluator<dim>              &reader,
                                          const std::vector<std::vector<double>> &points) const = 0;

    /**
     * The values of these columns of a known solution; those that it does not tell are no numbers.
     * Not collective.
     */
    virtual std::vector<double> exact_row(const ExactSolution      &exact,
                                          const dealii::Point<dim> &point,
                                          const double              t) const = 0;

    /** All fields of files at a time, with current ghosts; the state has current ghosts. */
    virtual std::vector<OutputField> fields(const double t) const = 0;

    /** The surfaces of cracks that the problem has found itself, on all processes, for files. */
    virtual NewCracks new_cracks() const
    {
      return {};
    }

    /** Which cells of the mesh fields show; all if empty. */
    virtual typename FieldWriter<dim>::Choice shown() const
    {
      return {};
    }

    /** What was chosen, for the report: name and value. */
    virtual std::vector<std::pair<std::string, std::string>> settings() const = 0;

    /**
     * What the user should know of the chosen settings: where they are known to fail, and what to
     * choose instead. Not collective.
     */
    virtual std::vector<std::string> notes() const
    {
      return {};
    }

    /** What is known of a coupling, or nullptr. Not collective. */
    virtual const CouplingCertificate *examined() const
    {
      return nullptr;
    }

    Timings timings;
  };


  /**
   * One component of a vector with @p n of them at each node, as a vector of the nodes with the
   * ghosts of their cells. Collective.
   */
  template <int dim>
  Vector component_of(const dealii::DoFHandler<dim> &dofs,
                      const Vector                  &u,
                      const unsigned int             n,
                      const unsigned int             component);
} // namespace PeriDeal
