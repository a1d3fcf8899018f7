// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/elastic_stress.h>
#include <perideal/analysis/phase_statistics.h>
#include <perideal/analysis/stress_intensity.h>
#include <perideal/bonds/bond_break.h>
#include <perideal/bonds/families.h>
#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/problems/model.h>
#include <perideal/problems/motion_parts.h>
#include <perideal/problems/problem.h>
#include <perideal/scene/scene.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/slow_loading.h>

#include <nlohmann/json_fwd.hpp>

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

  /**
   * An elastic body in one model of a scene: dim unknowns at each node, interleaved. Functions
   * are collective.
   */
  template <int dim>
  class SolidProblem : public Problem<dim>
  {
  public:
    explicit SolidProblem(const Scene<dim> &scene);
    ~SolidProblem() override;

    std::string field_name() const override
    {
      return "displacement";
    }

    std::string steady_name() const override
    {
      return "the equilibrium";
    }

    const Vector &state() const override
    {
      return displacement;
    }

    unsigned int n_components() const override
    {
      return dim;
    }
    std::vector<std::string> columns() const override;
    Difference               error(const ExactSolution &exact, const double t) const override;
    std::vector<double>      exact_row(const ExactSolution      &exact,
                                       const dealii::Point<dim> &point,
                                       const double              t) const override;
    typename FieldWriter<dim>::Choice shown() const override;

    void                begin(const RunContext &context) override;
    void                settle(const RunContext &context) override;
    std::vector<double> stops(const double from, const double to) const override;
    bool                tells_at_stops() const override;
    std::string  doing(const unsigned int k, const unsigned int n, const double t) const override;
    void         advance(const double                             from,
                         const double                             to,
                         const std::function<void(const double)> &report,
                         const RunContext                        &context) override;
    void         exchange(Archive &archive) override;
    double       work_of(const double span) const override;
    unsigned int steps_between_looks() const override;
    Trip         take_finding() override;
    Trip         watch(const double t) override;
    Trip         watch_totals(const double t) const override;
    void         explain(Trip &trip) override;
    void         examine(const double t) override;
    void         add_totals(const double t, const RunContext &context) override;
    void         note_end(const RunContext &context) const override;
    nlohmann::ordered_json describe_solving() const override;
    void   describe_end(nlohmann::ordered_json &entry, ResultRecord &record) const override;
    void   describe_scene(nlohmann::ordered_json &summary, const bool at_the_end) const override;
    void   take_sample(const RunContext &context, ModelEstimate &estimate) override;
    double time_of_run(const std::vector<double> &times,
                       const bool                 says,
                       const RunContext          &context,
                       double                    &memory) override;

    /** Of slow loading: the time between two equilibria. Not collective. */
    double load_step() const;

    /** The initial state and the stepper of a motion. Throws UserError. */
    void begin_motion(const RunContext &context);

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
    virtual std::vector<StressIntensity> stress_intensities(const double /*time*/) const
    {
      return {};
    }

    /** The stress of each own node or cell, with its phase. */
    virtual std::vector<StressSample> stress_samples() const = 0;

    /** Heat that deforming the body has released since the start; null: that is not computed. */
    const HeatOfDeformation<dim> *heat_of_deformation() const
    {
      return warming.get();
    }

    /** Surfaces of what has broken, for files, on all processes. */
    NewCracks new_cracks() const override;

    const Scene<dim>              &scene;
    DiffusionProblem<dim>         *heat = nullptr; // what computes the temperature, if anything
    Vector                         displacement;
    Vector                         velocity;          // of a motion
    std::unique_ptr<MotionStepper> stepper;           // null in equilibrium
    std::unique_ptr<SlowLoading>   loading;           // null in motion
    double                         stable_step  = 0.; // of a motion by verlet, at its start
    double                         force_scale  = 0.; // the largest find_force_scale() so far
    double                         force_lost   = 0.; // sum of all forces at the last totals
    unsigned int                   n_iterations = 0;

  private:
    void set_start();
    void take_temperature();

    StepperOptions stepper_options() const;
    void           make_loading();
    void           begin_loading(const RunContext &context);
    void           solve_loading(const std::function<void()> &action);
    void           move(const double                             from,
                        const double                             to,
                        const std::function<void(const double)> &report,
                        const RunContext                        &context);

    double body_size(); // of its box, from corner to corner

    double                              size_of_body = 0.; // of body_size(); 0: not asked for yet
    MotionParts                         moving;
    std::unique_ptr<CrackGrowth<dim>>   cracks; // that run through breaking bonds
    std::unique_ptr<DamageOfSolid<dim>> told;   // of damage, to the heat

    std::unique_ptr<HeatOfDeformation<dim>> warming;
  };


  /**
   * ux, uy, uz, then the components of the stress and `von_mises`, and a computed `temperature`:
   * the columns of probes.csv and line.csv.
   */
  template <int dim>
  std::vector<std::string> solid_columns(const Scene<dim> &scene);

  /** As make_diffusion_problem(). */
  template <int dim>
  std::unique_ptr<SolidProblem<dim>> make_solid_problem(Model<dim> &model, const Scene<dim> &scene);
} // namespace PeriDeal
