// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/comparison.h>
#include <perideal/analysis/recovery.h>
#include <perideal/problems/heat_ledger.h>
#include <perideal/problems/model.h>
#include <perideal/problems/problem.h>
#include <perideal/scene/scene.h>
#include <perideal/solvers/stepper.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  class DiffusionGuards;

  /** Diffusion in one model of a scene. Functions are collective. */
  template <int dim>
  class DiffusionProblem : public Problem<dim>
  {
  public:
    explicit DiffusionProblem(const Scene<dim> &scene);
    ~DiffusionProblem() override;

    void                   begin(const RunContext &context) override;
    void                   settle(const RunContext &context) override;
    void                   advance(const double                             from,
                                   const double                             to,
                                   const std::function<void(const double)> &report,
                                   const RunContext                        &context) override;
    void                   exchange(Archive &archive) override;
    double                 work_of(const double span) const override;
    unsigned int           steps_between_looks() const override;
    Trip                   take_finding() override;
    Trip                   watch(const double t) override;
    Trip                   watch_totals(const double t) const override;
    void                   explain(Trip &trip) override;
    void                   add_totals(const double t, const RunContext &context) override;
    void                   note_end(const RunContext &context) const override;
    nlohmann::ordered_json describe_solving() const override;
    void describe_scene(nlohmann::ordered_json &summary, const bool at_the_end) const override;
    Difference               error(const ExactSolution &exact, const double t) const override;
    std::vector<double>      exact_row(const ExactSolution      &exact,
                                       const dealii::Point<dim> &point,
                                       const double              t) const override;
    std::vector<std::string> notes() const override;
    void   take_sample(const RunContext &context, ModelEstimate &estimate) override;
    double time_of_run(const std::vector<double> &times,
                       const bool                 says,
                       const RunContext          &context,
                       double                    &memory) override;

    /** notes(), which begin with the name of the model. */
    virtual std::vector<std::string> own_notes() const
    {
      return {};
    }

    /** The steady state. */
    void solve();

    /**
     * Through the events of the cracks until a time, from where the solution is, and whatever is
     * left of a span of the stepper first.
     */
    void advance_through_events(const double t_end, const AfterStep &after_step);

    /** Make the stepper and begin the balance of heat. Throws UserError. */
    void begin_stepping();

    void start_anew() override;
    void renew_stepper() override;

    /** Of the operator, until the last of some ascending times; not known if not positive. */
    double expected_applications(const std::vector<double> &times) const;

    DiffusionOperator &op() const override = 0;

    /** As Operator::update(). */
    virtual bool update(const double t) = 0;

    /** As DiffusionOperatorBase::follow(). */
    virtual bool follow(const ChangeSet<dim> &damage) = 0;

    /** follow() in between two advances. Collective. */
    void apply_change(const ChangeSet<dim> &damage);

    /** Initial value on the unknowns. */
    virtual void set_initial_value(Vector &u) const = 0;

    /** Fields for output besides the solution; u has up-to-date ghosts. */
    virtual std::vector<OutputField> derived_fields(const Vector &u, const double t) const = 0;

    /**
     * Moisture: the sum of C_sat w V in the body; u need not have up-to-date ghosts. Collective.
     */
    virtual double weight(const Vector &u) const = 0;

    virtual Difference difference_to(
      const Vector                                            &u,
      const std::function<double(const dealii::Point<dim> &)> &exact) const = 0;

    const Vector &state() const override
    {
      return solution;
    }
    unsigned int n_components() const override
    {
      return 1;
    }
    std::vector<std::string> columns() const override;
    std::vector<double>      at_points(const PointEvaluator<dim>              &reader,
                                       const std::vector<std::vector<double>> &points) const override;
    std::vector<OutputField> fields(const double t) const override;

    const Scene<dim>        &scene;
    Vector                   solution;
    std::unique_ptr<Stepper> stepper; // null if steady
    HeatLedger               ledger;  // of the run from the start, unless steady
    unsigned int             steady_iterations = 0;
    bool                     heated_by_solid   = false; // that deforms: temperatures may leave
                                                        // the range of those that are given

  protected:
    double reached       = 0.; // the time of the solution, but for steps within a span
    double time_of_start = 0.; // that for which the operator was made

  private:
    void make_stepper();
    void repeat_changes();

    std::unique_ptr<DiffusionGuards<dim>> guards;
  };


  /** Give the solution the initial value of the scene, with the prescribed values of time 0. */
  template <int dim>
  void set_start(DiffusionProblem<dim> &run);

  /** Throws UserError for what its models cannot compute. Not collective. */
  template <int dim>
  void require_diffusion(const Scene<dim> &scene);

  /**
   * Builds the operator, and the model's nodes if they have not been made. The time goes into the
   * run's timings.
   */
  template <int dim>
  std::unique_ptr<DiffusionProblem<dim>> make_diffusion_problem(Model<dim>       &model,
                                                                const Scene<dim> &scene);
} // namespace PeriDeal
