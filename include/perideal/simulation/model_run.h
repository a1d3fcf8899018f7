// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/comparison.h>
#include <perideal/analysis/recovery.h>
#include <perideal/scene/scene.h>
#include <perideal/simulation/heat_ledger.h>
#include <perideal/simulation/problem.h>
#include <perideal/solvers/stepper.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** What diffuses, in one model of a scene. Functions are collective. */
  template <int dim>
  class ModelRun : public Problem<dim>
  {
  public:
    explicit ModelRun(const Scene<dim> &scene);

    void                   begin(const RunContext<dim> &context) override;
    void                   settle(const RunContext<dim> &context) override;
    void                   advance(const double                             from,
                                   const double                             to,
                                   const std::function<void(const double)> &report,
                                   const RunContext<dim>                   &context) override;
    double                 work_of(const double span) const override;
    void                   add_totals(const double t, const RunContext<dim> &context) override;
    nlohmann::ordered_json describe_solving() const override;

    /** The steady state. */
    void solve();

    /** Through the events of the cracks between two times. */
    void advance_through_events(const double t_begin, const double t_end);

    /** Make the stepper and begin the balance of heat. Throws UserError. */
    void begin_stepping();

    /** After the mesh has changed: a stepper of the new operator, with the cost of the old one. */
    void renew_stepper();

    /** Of the operator, until the last of some ascending times; not known if not positive. */
    double expected_applications(const std::vector<double> &times) const;

    DiffusionOperator &op() const override = 0;

    /** As Operator::update(). */
    virtual bool update(const double t) = 0;

    /** Initial value on the unknowns. */
    virtual void set_initial_value(Vector &u) const = 0;

    /**
     * Square of the error that the recovered flux shows in each cell (recovery_indicators()); u has
     * up-to-date ghosts.
     */
    virtual RecoveryIndicators indicators(const Vector &) const
    {
      Assert(false, dealii::ExcNotImplemented());
      return {};
    }

    /** The mesh is about to be adapted: what the solution needs to move on. */
    virtual void before_remesh()
    {
      Assert(false, dealii::ExcNotImplemented());
    }

    /**
     * Unknowns, operator and solution on the mesh as it is now, with the cracks of time t. The heat
     * in the body stays what it was, unless steady. Steppers of the old operator must not be used
     * any more.
     */
    virtual void after_remesh(const double, const bool)
    {
      Assert(false, dealii::ExcNotImplemented());
    }

    /** The name of the field of the solution. Not collective. */
    virtual std::string field_name() const = 0;

    /** Fields for output besides the solution; u has up-to-date ghosts. */
    virtual std::vector<OutputField> derived_fields(const Vector &u, const double t) const = 0;

    /**
     * Moisture: the sum of C_sat w V in the body; u need not have up-to-date ghosts. Collective.
     */
    virtual double weight(const Vector &u) const = 0;

    virtual Difference error(
      const Vector                                            &u,
      const std::function<double(const dealii::Point<dim> &)> &exact) const = 0;

    const Vector            &state() const override;
    unsigned int             n_components() const override;
    std::vector<std::string> columns() const override;
    std::vector<double>      at_points(const PointEvaluator<dim>              &reader,
                                       const std::vector<std::vector<double>> &points) const override;
    std::vector<OutputField> fields(const double t) const override;

    const Scene<dim>        &scene;
    Vector                   solution;
    std::unique_ptr<Stepper> stepper; // null if steady
    HeatLedger               ledger;  // of the run from the start, unless steady
    unsigned int             steady_iterations = 0;

  private:
    void make_stepper();
  };


  /** Give the solution the initial value of the scene, with the prescribed values of time 0. */
  template <int dim>
  void set_start(ModelRun<dim> &run);

  /** Builds a model's unknowns and operator. The time goes into the run's timings. */
  template <int dim>
  std::unique_ptr<ModelRun<dim>> make_model_run(const ModelKind                   model,
                                                const dealii::Triangulation<dim> &mesh,
                                                const Scene<dim>                 &scene);
} // namespace PeriDeal
