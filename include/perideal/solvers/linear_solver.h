// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/solver_control.h>

#include <perideal/base/archive.h>
#include <perideal/operators/interface/diffusion_operator.h>

#include <memory>

namespace PeriDeal
{
  /**
   * Approximate inverse of a C + b K: algebraic multigrid (Trilinos ML) on the operator's surrogate
   * matrix, plus, where that is not K itself, the inverse diagonal. Multigrid on the nearest
   * neighbours' graph takes care of what varies slowly; on what varies fast it is too stiff by the
   * number of bonds in a family, and there K is its diagonal. Symmetric positive definite.
   */
  class MultigridPreconditioner
  {
  public:
    /** @param direct_up_to the most unknowns of a level that is solved directly */
    MultigridPreconditioner(const Operator &op, const unsigned int direct_up_to);
    ~MultigridPreconditioner();

    /** Set up for a C + b K. Collective. */
    void initialize(const double capacity_factor, const double stiffness_factor);

    /** The operator's surrogate. */
    const dealii::TrilinosWrappers::SparseMatrix &surrogate() const;

    /** y = P^{-1} x; entries that are not free are zero. Collective. */
    void vmult(Vector &y, const Vector &x) const;

  private:
    struct Data;

    const Operator       &op;
    const unsigned int    direct_up_to;
    std::unique_ptr<Data> data;
  };


  /**
   * Solves (a C + b K) x = rhs on the free unknowns: CG if K is symmetric, else restarted GMRES,
   * with the multigrid preconditioner. The preconditioner is kept while b/a stays within a factor
   * of three of what it was made for and, when K has changed, while it needs hardly more iterations
   * than before.
   */
  class LinearSolver
  {
  public:
    /**
     * @param tolerance    relative residual. Throws UserError, naming the entries of section
     *                     'Solver', if it is not reached.
     * @param direct_up_to as of MultigridPreconditioner
     */
    LinearSolver(const Operator    &op,
                 const double       tolerance,
                 const unsigned int max_iterations,
                 const unsigned int direct_up_to = 2000);

    /**
     * Returns the number of iterations. x is the start on entry; its entries that are not free must
     * be zero. Collective.
     *
     * @param size stops at the tolerance times this l2 norm of the residual; 0: times that of rhs
     * @param more added to the diagonal of the system; nullptr: nothing
     */
    unsigned int solve(const double  capacity_factor,
                       const double  stiffness_factor,
                       Vector       &x,
                       const Vector &rhs,
                       const double  size = 0.,
                       const Vector *more = nullptr);

    /** K is no longer what the preconditioner was made for. Not collective. */
    void operator_changed();

    /**
     * What the preconditioner was made for, so that a run that goes on has the same: made with the
     * next solution, when the operator has been loaded, too, from what Operator::surrogate() gives
     * then. Collective.
     */
    void exchange(Archive &archive);

    /** The operator's surrogate matrix, from which the preconditioner is made. */
    const dealii::TrilinosWrappers::SparseMatrix &surrogate() const;

  private:
    void prepare(const double capacity_factor, const double stiffness_factor);
    void judge(const dealii::SolverControl &control);

    const Operator                          &op;
    const double                             tolerance;
    const unsigned int                       max_iterations, direct_up_to;
    std::unique_ptr<MultigridPreconditioner> preconditioner;
    double                                   built_capacity = -1., built_stiffness = -1.;
    bool                                     outdated = false, remake = false; // after loading
    double                                   first_rate = 0.; // iterations for a digit, when new
    bool                                     is_slow    = false;
  };


  template <int dim>
  struct Scene;

  /** Throws UserError for a scene of diffusion that has no steady state. Not collective. */
  template <int dim>
  void require_steady_state(const Scene<dim> &scene);

  /**
   * The steady state f(t) = K u; u holds the start on entry. Returns the number of iterations.
   * Throws UserError if nothing fixes the level of the solution in the body or in a part that
   * cracks have cut off. Collective.
   */
  unsigned int solve_steady(DiffusionOperator &op,
                            Vector            &u,
                            const double       t,
                            const double       tolerance,
                            const unsigned int max_iterations,
                            const unsigned int direct_up_to = 2000);
} // namespace PeriDeal
