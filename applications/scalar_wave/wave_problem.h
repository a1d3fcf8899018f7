// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/solvers/step_span.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace ScalarWave
{
  using PeriDeal::Vector;

  /**
   * Waves of a scalar u, as of a membrane: c u_tt = div(k grad u), c the product of `Density` and
   * `Heat capacity`, k the `Conductivity`, at rest at first. Unknowns, operator and fields are
   * those of diffusion with the same k and c, in whatever model the scene names: C u_tt = -K u.
   *
   * Steps are central differences. A field of one frequency w then moves with the frequency W,
   * sin(W dt/2) = w dt/2, to round-off.
   */
  template <int dim>
  class WaveProblem : public PeriDeal::Problem<dim>
  {
  public:
    WaveProblem(PeriDeal::Model<dim> &model, const PeriDeal::Scene<dim> &scene);

    // What moves in time.
    void   begin(const PeriDeal::RunContext &context) override;
    void   advance(const double                             from,
                   const double                             to,
                   const std::function<void(const double)> &report,
                   const PeriDeal::RunContext              &context) override;
    void   exchange(PeriDeal::Archive &archive) override;
    double work_of(const double span) const override;

    /** Kinetic and potential energy, and their sum. */
    void add_totals(const double t, const PeriDeal::RunContext &context) override;

    nlohmann::ordered_json describe_solving() const override;

    /** Waves settle at nothing: refused before (WaveFactory). */
    void settle(const PeriDeal::RunContext &context) override;

    /** Not known. */
    double time_of_run(const std::vector<double>  &times,
                       const bool                  says,
                       const PeriDeal::RunContext &context,
                       double                     &memory) override;
    void   take_sample(const PeriDeal::RunContext &context,
                       PeriDeal::ModelEstimate    &estimate) override;

    // What is that of the field.
    std::string                    name() const override;
    std::string                    field_name() const override;
    const dealii::DoFHandler<dim> &dofs() const override;
    const PeriDeal::Nodes<dim>    *nodes() const override;
    PeriDeal::Operator            &op() const override;
    const Vector                  &state() const override;
    unsigned int                   n_components() const override;
    dealii::Point<dim>             position(const unsigned int node) const override;
    double                         volume(const unsigned int node) const override;
    PeriDeal::Difference error(const PeriDeal::ExactSolution &exact, const double t) const override;
    void describe_scene(nlohmann::ordered_json &summary, const bool at_the_end) const override;
    std::vector<std::string>           columns() const override;
    std::vector<double>                at_points(const PeriDeal::PointEvaluator<dim>    &reader,
                                                 const std::vector<std::vector<double>> &points) const override;
    std::vector<double>                exact_row(const PeriDeal::ExactSolution &exact,
                                                 const dealii::Point<dim>      &point,
                                                 const double                   t) const override;
    std::vector<PeriDeal::OutputField> fields(const double t) const override;
    std::vector<std::pair<std::string, std::string>> settings() const override;

  private:
    /** The acceleration of u at time t. */
    void accelerate(const double t);

    const PeriDeal::Scene<dim>                      &scene;
    std::unique_ptr<PeriDeal::DiffusionProblem<dim>> field; // has u
    Vector                                           velocity, acceleration;
    PeriDeal::StepSpan                               span;
    double                                           longest_step = 0.;
    unsigned long long                               n_steps      = 0;
  };


  /** What the run has to know of waves before there is one. */
  template <int dim>
  class WaveFactory : public PeriDeal::ProblemFactory<dim>
  {
  public:
    /**
     * Throws UserError unless the scene is one in time, in which the sides are at rest or free and
     * nothing acts from outside, so that energy is conserved.
     */
    void require_computable(const PeriDeal::Scene<dim> &scene) const override;

    std::unique_ptr<PeriDeal::Problem<dim>> make_problem(
      PeriDeal::Model<dim>       &model,
      const PeriDeal::Scene<dim> &scene) const override;
  };
} // namespace ScalarWave
