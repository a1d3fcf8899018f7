// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/elastic_stress.h>
#include <perideal/analysis/phase_statistics.h>
#include <perideal/analysis/stress_intensity.h>
#include <perideal/bonds/bond_break.h>
#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/problems/problem.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/slow_loading.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  class CrackGrowth;
  template <int dim>
  class DamageOfSolid;
  template <int dim>
  class DiffusionProblem;
  template <int dim>
  class HeatOfDeformation;

  /** The displacement of an elastic body, on the nodes of a model. Functions are collective. */
  template <int dim>
  class SolidField : public Field<dim>
  {
  public:
    SolidField(Model<dim> &on, const Scene<dim> &scene)
      : Field<dim>(on, scene, dim)
    {}

    ElasticOperator &op() const override = 0;

    /** Of the bonds that may break; null: there are none. Not collective. */
    virtual const Families<dim> *families() const = 0;

    /** What has broken between nodes, by the process that owns a bond's first node. */
    virtual std::vector<BondBreak> breaks() const = 0;

    /** Of owned nodes, the share of their family that they have lost; empty without families. */
    virtual std::vector<double> damage() const = 0;

    /** The mean stress over the volume of the body: what the body as a whole carries. */
    virtual dealii::SymmetricTensor<2, 3> mean_stress() const = 0;

    /**
     * The integral of entropy_of_deformation() over each owned node's volume, as it deforms now at
     * these temperature changes of the nodes. What has lost all that holds it has none.
     */
    virtual std::vector<double> entropies_of_deformation(
      const Vector &temperature_change) const = 0;

    /** At the ends of cracks, where there is room for rings (crack_end_integrals()). */
    virtual std::vector<StressIntensity> stress_intensities(const double time) const = 0;

    /** The stress of each own node or cell, with its phase. */
    virtual std::vector<StressSample> stress_samples() const = 0;

    /** As those of ProblemResults. */
    virtual std::vector<double>      at_points(const PointEvaluator<dim>              &reader,
                                               const std::vector<std::vector<double>> &points) const = 0;
    virtual std::vector<OutputField> fields() const = 0;

    Vector velocity; // of a motion, once it has begun; else empty
  };


  /**
   * An elastic body in one model of a scene: dim unknowns at each node, interleaved. Functions
   * are collective.
   */
  template <int dim>
  class SolidProblem : public Problem<dim>
  {
  public:
    explicit SolidProblem(std::unique_ptr<SolidField<dim>> of);
    ~SolidProblem() override;

    void                begin(const RunContext &context) override;
    void                settle(const RunContext &context) override;
    std::string         steady_name() const override;
    std::vector<double> stops(const double from, const double to) const override;
    bool                tells_at_stops() const override;
    std::string  doing(const unsigned int k, const unsigned int n, const double t) const override;
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
    void         explain(Trip &trip) override;
    void         examine(const double t) override;
    void         note_end(const RunContext &context) const override;

    std::vector<std::string> columns() const override;
    std::vector<double>      at_points(const PointEvaluator<dim>              &reader,
                                       const std::vector<std::vector<double>> &points) const override;
    std::vector<double>      exact_row(const ExactSolution      &exact,
                                       const dealii::Point<dim> &point,
                                       const double              t) const override;
    Difference               error(const ExactSolution &exact, const double t) const override;
    std::vector<OutputField> fields(const double t) const override;
    typename FieldWriter<dim>::Choice shown() const override;
    NewCracks                         new_cracks() const override;
    void                   add_totals(const double t, const RunContext &context) override;
    nlohmann::ordered_json describe_solving() const override;
    void describe_scene(nlohmann::ordered_json &summary, const bool at_the_end) const override;
    void describe_end(nlohmann::ordered_json &entry, ResultRecord &record) const override;

    ElasticOperator &op() const
    {
      return body.op();
    }

    using Problem<dim>::scene;

    const SolidField<dim>         &body;
    DiffusionProblem<dim>         *heat = nullptr;   // what computes the temperature, if anything
    Vector                        &displacement;     // of the body, as the next one
    Vector                        &velocity;         // of a motion
    std::unique_ptr<MotionStepper> stepper;          // null in equilibrium
    std::unique_ptr<SlowLoading>   loading;          // null in motion
    double                         stable_step = 0.; // of a motion by verlet, at its start

  protected:
    std::string own_cause(const Trip &trip) override;

  private:
    /** A span of a motion in at most 50 parts of whole steps, with a report after each. */
    struct MotionParts
    {
      StepSpan span;
      double   n_steps = 0.; // planned, of the motion

      /** @param step of the motion, as long as it is now */
      static MotionParts between(const double from, const double to, const double step);

      /** The end of the part. With whole steps between two ends reports change no step. */
      double next() const;
    };

    /** Of slow loading: the time between two equilibria. Not collective. */
    double load_step() const;

    /** The initial state and the stepper of a motion. Throws UserError. */
    void begin_motion(const RunContext &context);
    void set_start();
    void take_temperature();
    void make_loading();
    void begin_loading(const RunContext &context);
    void solve_loading(const std::function<void()> &action);
    void move(const double                             from,
              const double                             to,
              const std::function<void(const double)> &report,
              const RunContext                        &context);

    double                 body_size(); // of its box, from corner to corner
    double                 time_of_equilibria(const double      n_steps,
                                              const RunContext &context,
                                              double           &memory) const;
    nlohmann::ordered_json add_energies(const double t, const RunContext &context) const;

    double       force_scale  = 0.; // the largest find_force_scale() so far
    double       force_lost   = 0.; // sum of all forces at the last totals
    unsigned int n_iterations = 0;
    double       size_of_body = 0.; // of body_size(); 0: not asked for yet
    MotionParts  moving;

    std::unique_ptr<CrackGrowth<dim>>       cracks;  // that run through breaking bonds
    std::unique_ptr<DamageOfSolid<dim>>     told;    // of damage, to the heat
    std::unique_ptr<HeatOfDeformation<dim>> warming; // null: that is not computed
  };


  /** As make_diffusion_field(), without values. */
  template <int dim>
  std::unique_ptr<SolidField<dim>> make_solid_field(Model<dim> &model, const Scene<dim> &scene);
} // namespace PeriDeal
