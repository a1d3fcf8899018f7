// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/elastic_operator.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** What a solver of equilibria has to know of the scene. */
  struct StaticOptions
  {
    double       tolerance      = 1e-10;
    unsigned int max_iterations = 1000;
    unsigned int direct_up_to   = 2000; // as of MultigridPreconditioner
    bool         multigrid      = true; // preconditions the conjugate gradients
    // Of SlowLoading: bonds break in a motion between equilibria; loads are those of any time.
    bool breaks_in_motion = true, divides_steps = true;
    // Of SlowLoading: loads go back where bonds break (LoadControl), and a step of them dissipates
    // about this share of the largest strain energy so far; 0: they do not.
    double control_share = 0.;
    // The law is not asked for a step back to no displacement, in which forces are no loads.
    bool remembers = false;
  };


  /** Finds the displacement in which no free unknown has a force left: residual(u) = 0. */
  class StaticSolver
  {
  public:
    virtual ~StaticSolver() = default;

    /** The name used in scenes. */
    virtual std::string name() const = 0;

    /**
     * From u, distributed, to equilibrium at time t. Returns the number of iterations. Collective.
     * Throws UserError: the iterations do not suffice, or values are no longer finite.
     *
     * @param size stops at the tolerance times this l2 norm of the residual; 0: times that of the
     *             start
     */
    virtual unsigned int solve(Vector &u, const double t, const double size = 0.) = 0;

    /** K is no longer that of the last solution. Not collective. */
    virtual void operator_changed() {}

    /** The same, and K may have become stiffer than it has ever been. Not collective. */
    virtual void stiffness_changed()
    {
      operator_changed();
    }

    /** What the next solution depends on besides the operator, which has its state. Collective. */
    virtual void exchange(Archive &archive)
    {
      if (archive.loads())
        operator_changed();
    }
  };


  template <int dim>
  struct Scene;

  /** Throws UserError for a body that has no equilibrium, or more than one. Not collective. */
  template <int dim>
  void require_equilibrium(const Scene<dim> &scene);

  /** All names that a scene may give. */
  const std::vector<std::string> &static_solver_names();

  /**
   * The one factory. Throws UserError for `linear` where forces are not linear in the displacement.
   * Collective.
   */
  std::unique_ptr<StaticSolver> make_static_solver(const std::string   &name,
                                                   ElasticOperator     &op,
                                                   const StaticOptions &options);

  /**
   * The l2 norm of the residual that prescribed displacements and loads at time t leave in a body
   * that is undeformed but for these, with the stiffness K of the last linearize(); of loads those
   * of thermal strains are left out where it @p remembers (StaticOptions). @p u becomes
   * these displacements, @p residual the residual of the free unknowns, @p image is overwritten.
   * Collective.
   */
  double undeformed_residual(ElasticOperator &op,
                             Vector          &u,
                             Vector          &residual,
                             Vector          &image,
                             const double     t,
                             const bool       remembers);

  /**
   * The l2 norm of unbalanced forces on free unknowns, to which alone they are set. Where those on
   * others are a thousand times as large it is a thousandth of all of them: what supports bear
   * alone leaves round-off, as of a body that is held all around and warms up. Linear bodies have
   * the norm. Collective.
   */
  double size_of_unbalanced(const ElasticOperator &op, Vector &forces);

  /**
   * undeformed_residual(), by which residuals are measured, and the start of the iterations: the
   * prescribed displacements, and where forces are not linear the solution of small displacements
   * to three digits, since bonds that a jump at the side has turned over do not find back. @p u is
   * overwritten. Collective.
   */
  double start_statics(ElasticOperator     &op,
                       Vector              &u,
                       const double         t,
                       const StaticOptions &options);

  /**
   * From an equilibrium u, for which K is, to that at time t where forces are not linear, to three
   * digits of the linear solution. Collective.
   */
  void continue_statics(ElasticOperator     &op,
                        Vector              &u,
                        const double         t,
                        const StaticOptions &options);

  // One maker per method, each in its own file.
  std::unique_ptr<StaticSolver> make_linear_statics(ElasticOperator     &op,
                                                    const StaticOptions &options);
  std::unique_ptr<StaticSolver> make_newton(ElasticOperator &op, const StaticOptions &options);
  std::unique_ptr<StaticSolver> make_conjugate_gradients(ElasticOperator     &op,
                                                         const StaticOptions &options);
  std::unique_ptr<StaticSolver> make_dynamic_relaxation(ElasticOperator     &op,
                                                        const StaticOptions &options);
  std::unique_ptr<StaticSolver> make_adaptive_dynamic_relaxation(ElasticOperator     &op,
                                                                 const StaticOptions &options);


  /** When to stop: the residual of each iteration goes through it. */
  class ResidualGoal
  {
  public:
    ResidualGoal(const std::string &solver, const StaticOptions &options, const double size);

    /**
     * Whether the residual is small enough. Throws UserError if it is not finite or if the
     * iterations have been used up. Collective.
     */
    bool reached(const Vector &r, const unsigned int n_iterations);

  private:
    const std::string  solver;
    const double       tolerance;
    const unsigned int most;
    double             size;
  };


  /**
   * The largest l2 norm that round-off may leave of forces on free unknowns at u: machine epsilon
   * times the forces that balance each other at a node, for which the diagonal of K times the
   * displacement stands, and a factor of 16 for their number. No more than 1e-4 of what the
   * tolerance refers to: a part that nothing holds goes so far that round-off would allow anything.
   * Collective.
   */
  double round_off_of_forces(const ElasticOperator &op, const Vector &u, const double size);

  /**
   * A residual above the tolerance has been accepted, as round-off allows no less: its norm over
   * that which the tolerance refers to. Not collective.
   */
  void accept_residual(const double relative);

  /** The largest one that was accepted since this was asked last; 0: none. Not collective. */
  double take_accepted_residual();


  /**
   * When to stop above the tolerance: where residuals have not fallen by half within the last fifth
   * of the iterations, 100 at least, and are those of round_off_of_forces().
   */
  class RoundOffGoal
  {
  public:
    /** @param size as of ResidualGoal */
    RoundOffGoal(const ElasticOperator &op, const StaticOptions &options, const double size);

    /**
     * To be asked in each iteration n, before ResidualGoal, of the residual r at u. What is
     * accepted is told by accept_residual(). Collective.
     */
    bool reached(const Vector &r, const Vector &u, const unsigned int n);

  private:
    const ElasticOperator &op;
    const StaticOptions    options;
    double                 size, lowest = std::numeric_limits<double>::max(), before = lowest;
    unsigned int           next = 0;
  };
} // namespace PeriDeal
