// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/lattice_family.h>
#include <perideal/operators/diffusion/field_operator.h>
#include <perideal/problems/guards.h>
#include <perideal/problems/problem.h>
#include <perideal/solvers/stepper.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** The field of a diffusion problem on the nodes of a model. Functions are collective. */
  template <int dim>
  class DiffusionField : public Field<dim>
  {
  public:
    DiffusionField(Model<dim> &on, const Scene<dim> &scene)
      : Field<dim>(on, scene, 1)
    {}

    FieldOperator<dim> &op() const override = 0;

    /** Initial value on the unknowns. */
    virtual void set_initial_value(Vector &u) const = 0;

    /** Fields for output besides the solution u, which has up-to-date ghosts. */
    virtual std::vector<OutputField> derived_fields(const Vector &u, const double t) const = 0;

    /** Moisture: the sum of C_sat w V in the body; u need not have up-to-date ghosts. */
    virtual double weight(const Vector &u) const = 0;

    virtual Difference difference_to(
      const Vector                                            &u,
      const std::function<double(const dealii::Point<dim> &)> &exact) const = 0;

    /** As those of AdaptiveProblem, of which only elements know. */
    virtual RecoveryIndicators indicators() const
    {
      Assert(false, dealii::ExcNotImplemented());
      return {};
    }
    virtual void before_remesh() {}
    virtual void rebuild(const double /*t*/) {}

    /** After rebuild(): the solution. Returns the heat that has come from outside. */
    virtual double move_solution(const double /*t*/, const bool /*steady*/)
    {
      return 0.;
    }
  };


  /** Diffusion in one model of a scene. Functions are collective. */
  template <int dim>
  class DiffusionProblem : public Problem<dim>, public AdaptiveProblem
  {
  public:
    explicit DiffusionProblem(std::unique_ptr<DiffusionField<dim>> of);

    void         begin(const RunContext &context) override;
    void         settle(const RunContext &context) override;
    void         advance(const double                             from,
                         const double                             to,
                         const std::function<void(const double)> &report,
                         const RunContext                        &context) override;
    void         exchange(Archive &archive) override;
    double       work_of(const double span) const override;
    void         take_sample(const RunContext &context, ModelEstimate &estimate) override;
    double       time_of_run(const std::vector<double> &times,
                             const bool                 says,
                             const RunContext          &context,
                             double                    &memory) override;
    unsigned int steps_between_looks() const override;
    Trip         take_finding() override;
    Trip         watch(const double t) override;
    Trip         watch_totals(const double t) const override;
    void         add_totals(const double t, const RunContext &context) override;
    std::vector<std::string> notes() const override;
    void                     note_end(const RunContext &context) const override;
    nlohmann::ordered_json   describe_solving() const override;
    void describe_scene(nlohmann::ordered_json &summary, const bool at_the_end) const override;
    Difference               error(const ExactSolution &exact, const double t) const override;
    std::vector<double>      exact_row(const ExactSolution      &exact,
                                       const dealii::Point<dim> &point,
                                       const double              t) const override;
    std::vector<std::string> columns() const override;
    std::vector<double>      at_points(const PointEvaluator<dim>              &reader,
                                       const std::vector<std::vector<double>> &points) const override;
    std::vector<OutputField> fields(const double t) const override;

    RecoveryIndicators indicators() const override;
    void               start_anew() override;
    void               before_remesh() override;
    void               after_remesh(const double t, const bool steady) override;
    void               rebuild(const double t) override;
    void               renew_stepper() override;

    /**
     * Of a solid's temperature, beside the solid's own rows: what flows through the sides, and what
     * has entered and is stored since the start.
     */
    void add_totals_of_solid(const double t, const RunContext &context);

    /** The steady state. */
    void solve();

    /**
     * Through the events of the cracks until a time, from where the solution is, and whatever is
     * left of a span of the stepper first.
     */
    void advance_through_events(const double t_end, const AfterStep &after_step);

    /** Make the stepper and begin the balance of heat. Throws UserError. */
    void begin_stepping();

    FieldOperator<dim> &op() const
    {
      return body.op();
    }

    /** As FieldOperator::follow(), in between two advances. */
    void apply_change(const ChangeSet<dim> &damage);

    using Problem<dim>::scene;

    Vector                  &solution; // of the field
    std::unique_ptr<Stepper> stepper;  // null if steady
    HeatLedger               ledger;   // of the run from the start, unless steady
    unsigned int             steady_iterations = 0;
    bool                     heated_by_solid   = false; // that deforms: temperatures may leave
                                                        // the range of those that are given

  protected:
    std::string own_cause(const Trip &trip) override;

  private:
    void                   make_stepper();
    double                 expected_applications(const std::vector<double> &times) const;
    nlohmann::ordered_json add_since_start(const Balance     &balance,
                                           const std::string &imbalance,
                                           const double       t,
                                           const RunContext  &context);

    DiffusionField<dim> &body;
    double               reached = 0.; // the time of the solution, but for steps within a span
    double               time_of_start = 0.; // that for which the operator was made
    GrowthGuard          growth;
    StepGuard            steps;
  };


  /** Throws UserError for what its models cannot compute. Not collective. */
  template <int dim>
  void require_diffusion(const Scene<dim> &scene);

  /**
   * The field of diffusion in a model, with its initial value: builds the operator, and the model's
   * nodes if they have not been made. The time goes into its timings. Collective.
   */
  template <int dim>
  std::unique_ptr<DiffusionField<dim>> make_diffusion_field(Model<dim>       &model,
                                                            const Scene<dim> &scene);


  /*
   * Bounds beyond which a diffusion run says in a note what is wrong: for the notes, and for
   * studies that draw them.
   */

  /** Complete families conduct more or less than `Conductivity` by so much of it. */
  constexpr double tolerable_conductivity_error = 5e-3;

  /** Sides that cut families make the body narrower by so much of its width. */
  constexpr double tolerable_missing_share = 5e-3;

  /**
   * The width beside a side normal to an axis that conducts nothing of a linear field along the
   * side, in spacings: rows of nodes have less than a whole family.
   *
   * @param family    a whole one
   * @param first_row volume of the row on the side, in cells
   *
   * Not collective.
   */
  template <int dim>
  double missing_width(const std::vector<FamilyMember<dim>> &family,
                       const unsigned int                    axis,
                       const double                          first_row);
} // namespace PeriDeal
