// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/solvers/step_span.h>

#include <memory>
#include <string>
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
  class WaveProblem : public PeriDeal::DiffusionProblem<dim>
  {
  public:
    using PeriDeal::DiffusionProblem<dim>::DiffusionProblem;

    // What moves in time.
    void   begin(const PeriDeal::RunContext &context) override;
    void   advance(const double                             from,
                   const double                             to,
                   const std::function<void(const double)> &report,
                   const PeriDeal::RunContext              &context) override;
    void   exchange(PeriDeal::Archive &archive) override;
    double work_of(const double span) const override;

    /** Not known. */
    void   take_sample(const PeriDeal::RunContext &context,
                       PeriDeal::ModelEstimate    &estimate) override;
    double time_of_run(const std::vector<double>  &times,
                       const bool                  says,
                       const PeriDeal::RunContext &context,
                       double                     &memory) override;

    // What is seen of it.
    PeriDeal::Trip watch(const double t) override;

    /** None of those that are for diffusion. */
    std::vector<std::string> notes() const override;

    /** Kinetic and potential energy, and their sum. */
    void add_totals(const double t, const PeriDeal::RunContext &context) override;

    nlohmann::ordered_json             describe_solving() const override;
    std::vector<PeriDeal::OutputField> fields(const double t) const override;

  private:
    using PeriDeal::DiffusionProblem<dim>::op;
    using PeriDeal::DiffusionProblem<dim>::scene;
    using PeriDeal::DiffusionProblem<dim>::solution;

    /** The acceleration of u at time t. */
    void accelerate(const double t);

    Vector             velocity, acceleration;
    PeriDeal::StepSpan span;
    double             longest_step = 0.;
    unsigned long long n_steps      = 0;
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
