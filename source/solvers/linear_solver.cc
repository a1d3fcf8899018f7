// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/diverged.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/step_break.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/scene.h>
#include <perideal/solvers/floating_part.h>
#include <perideal/solvers/linear_solver.h>

#include <Epetra_MultiVector.h>
#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * The inverse diagonal overlaps with multigrid on wavelengths near the horizon, where with a
     * factor of one the sum of both would be nearly twice the inverse of K. Half of it needs 17 to
     * 18 iterations where one needs 22 (residual 1e-10, m = 6.5), 0.3 and 0.8 need 19 and 20.
     */
    constexpr double share_of_diagonal = 0.5;

    /**
     * Entries below this share of sqrt(K_ii K_jj) do not join an aggregate. Bonds that are longer
     * than a cell are such entries beside a crack; taken for strong ones they make aggregates too
     * large there: 11 to 14 iterations of the coupled model (m = 3, 21^2 to 321^2 cells) where
     * these need 10 to 12, and finite elements 10 to 11 with either. All entries of square and
     * cubic elements are above it.
     */
    constexpr double weakest_link = 0.02;

    /**
     * Of the diagonal, added to it: fragments that nothing holds any more make the surrogate
     * singular, and its factorization without it would be that of round-off. (The lowest modes of
     * a slender body are above 1e-8.)
     */
    constexpr double hold_of_fragments = 1e-10;
  } // namespace


  struct MultigridPreconditioner::Data
  {
    TrilinosWrappers::SparseMatrix    surrogate, shifted;
    TrilinosWrappers::PreconditionAMG multigrid;
    Vector                            inverse_diagonal;
    mutable Vector                    scratch;
  };


  MultigridPreconditioner::MultigridPreconditioner(const Operator    &op,
                                                   const unsigned int direct_up_to)
    : op(op)
    , direct_up_to(direct_up_to)
    , data(std::make_unique<Data>())
  {
    op.surrogate(data->surrogate);
    op.initialize_vector(data->inverse_diagonal);
    op.initialize_vector(data->scratch);
  }


  MultigridPreconditioner::~MultigridPreconditioner() = default;


  void MultigridPreconditioner::initialize(const double a, const double b)
  {
    const Vector &capacity = op.lumped_capacity();
    const Vector &diagonal = op.surrogate_diagonal();
    Vector        is_free;
    op.initialize_vector(is_free);
    is_free = 1.;
    op.clear_constrained(is_free);

    data->shifted.copy_from(data->surrogate);
    data->shifted *= b;
    const double held = 1. + (a == 0. && !op.surrogate_is_exact() ? hold_of_fragments : 0.);
    for_each_entry(data->shifted, [&](const unsigned int i, const auto column, double &value) {
      if (column == capacity.get_partitioner()->local_to_global(i))
        value = is_free.local_element(i) == 0. ? 1. : held * value + a * capacity.local_element(i);
    });
    for (unsigned int i = 0; i < capacity.locally_owned_size(); ++i)
      data->inverse_diagonal.local_element(i) =
        is_free.local_element(i) == 0. ?
          0. :
          share_of_diagonal / (a * capacity.local_element(i) + b * diagonal.local_element(i));

    TrilinosWrappers::PreconditionAMG::AdditionalData options;
    options.elliptic              = true;
    options.higher_order_elements = false;
    // Smoothing is for what varies fast: there the inverse diagonal does the work unless the
    // surrogate is the operator itself.
    options.smoother_sweeps       = op.surrogate_is_exact() ? 2 : 1;
    options.aggregation_threshold = weakest_link;
    Teuchos::ParameterList              list;
    std::unique_ptr<Epetra_MultiVector> constant_modes; // of a scalar operator none of their own
    options.set_parameters(list, constant_modes, data->shifted);
    list.set("coarse: max size", static_cast<int>(direct_up_to));
    // ML reads the modes while it sets up.
    const std::vector<Vector> modes  = op.near_null_space();
    const unsigned int        n_rows = capacity.locally_owned_size();
    std::vector<double>       values;
    for (const Vector &mode : modes)
      values.insert(values.end(), mode.begin(), mode.begin() + n_rows);
    if (!modes.empty())
      {
        list.set("PDE equations", static_cast<int>(op.n_components()));
        list.set("null space: type", "pre-computed");
        list.set("null space: dimension", static_cast<int>(modes.size()));
        list.set("null space: vectors", values.data());
        list.set("null space: add default vectors", false);
      }
    data->multigrid.initialize(data->shifted, list);
  }


  const TrilinosWrappers::SparseMatrix &MultigridPreconditioner::surrogate() const
  {
    return data->surrogate;
  }


  void MultigridPreconditioner::vmult(Vector &y, const Vector &x) const
  {
    data->multigrid.vmult(y, x);
    if (!op.surrogate_is_exact())
      {
        data->scratch = x;
        data->scratch.scale(data->inverse_diagonal);
        y += data->scratch;
      }
    op.clear_constrained(y);
  }


  namespace
  {
    /** a C + b K as deal.II's solvers want it. */
    struct System
    {
      System(const Operator &op, const double a, const double b, const Vector *const more)
        : op(op)
        , a(a)
        , b(b)
        , more(more)
      {
        if (a != 0.)
          op.initialize_vector(image);
      }

      void vmult(Vector &y, const Vector &x) const
      {
        leave_step_if_asked(x.get_mpi_communicator());
        op.apply(y, x);
        if (b != 1.)
          y *= b;
        if (a != 0.)
          {
            op.apply_capacity(image, x);
            op.clear_constrained(image);
            y.add(a, image);
          }
        if (more != nullptr)
          for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
            y.local_element(i) += more->local_element(i) * x.local_element(i);
      }

      const Operator &op;
      const double    a, b;
      const Vector   *more;
      mutable Vector  image;
    };
  } // namespace


  LinearSolver::LinearSolver(const Operator    &op,
                             const double       tolerance,
                             const unsigned int max_iterations,
                             const unsigned int direct_up_to)
    : op(op)
    , tolerance(tolerance)
    , max_iterations(max_iterations)
    , direct_up_to(direct_up_to)
    , preconditioner(std::make_unique<MultigridPreconditioner>(op, direct_up_to))
  {}


  void LinearSolver::operator_changed()
  {
    outdated = true;
  }


  void LinearSolver::prepare(const double a, const double b)
  {
    if (remake)
      {
        preconditioner = std::make_unique<MultigridPreconditioner>(op, direct_up_to);
        if (built_stiffness >= 0.)
          preconditioner->initialize(built_capacity, built_stiffness);
        remake = false;
      }
    // An outdated preconditioner makes iterations slower, never wrong: making one costs as much as
    // dozens of iterations.
    const bool worn = outdated && (is_slow || built_stiffness < 0.); // slow, or not used yet
    if (worn)
      {
        preconditioner = std::make_unique<MultigridPreconditioner>(op, direct_up_to);
        outdated       = false;
      }
    const bool   one_only = a == 0. || b == 0.; // C or K alone: built for the same one or not
    const double ratio =
      one_only ?
        ((built_capacity == 0.) == (a == 0.) && (built_stiffness == 0.) == (b == 0.) ? 1. : 0.) :
        (b / a) / (built_stiffness / built_capacity);
    if (!worn && ratio > 1. / 3. && ratio < 3. && built_stiffness >= 0.)
      return;
    preconditioner->initialize(a, b);
    built_capacity  = a;
    built_stiffness = b;
    first_rate      = 0.;
    is_slow         = false;
  }


  unsigned int LinearSolver::solve(const double  a,
                                   const double  b,
                                   Vector       &x,
                                   const Vector &rhs,
                                   const double  wanted,
                                   const Vector *more)
  {
    // Also where nothing converges to: the 2-norm of what is not a number is 0.
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(rhs.l1_norm()))
      throw Diverged(
        "The loads are not finite. Check the material, the sources or loads, and the boundary values.",
        "finite values",
        none,
        none);
    const double size = wanted > 0. ? wanted : rhs.l2_norm();
    if (size == 0.)
      {
        x = 0.;
        return 0;
      }
    prepare(a, b);
    SolverControl control(max_iterations, tolerance * size);
    const System  system(op, a, b, more);
    try
      {
        if (op.symmetric())
          SolverCG<Vector>(control).solve(system, x, rhs, *preconditioner);
        else
          SolverGMRES<Vector>(control, SolverGMRES<Vector>::AdditionalData(60, true))
            .solve(system, x, rhs, *preconditioner);
      }
    catch (const SolverControl::NoConvergence &failure)
      {
        if (outdated)
          {
            is_slow = true;
            x       = 0.; // what has diverged is no guess
            return control.last_step() + solve(a, b, x, rhs, wanted, more);
          }
        std::ostringstream message;
        message
          << "The linear solver stopped after " << failure.last_step
          << " iterations at a relative residual of " << failure.last_residual / size
          << ", above 'Tolerance' = " << tolerance
          << " in section 'Solver'. Raise 'Tolerance' or 'Maximum iterations' there, or check for parts of the body that nothing holds, for instance because cracks have cut them off.";
        throw Diverged(message.str(), "solver", failure.last_residual / size, tolerance);
      }
    judge(control);
    return control.last_step();
  }


  /** By iterations for a digit: solutions may be as rough as they like. */
  void LinearSolver::judge(const SolverControl &control)
  {
    constexpr double fewest = 0.5, slower = 4. / 3., more = 3.;
    const double     digits = std::log10(control.initial_value() / control.last_value());
    const double     steps  = control.last_step();
    if (!(digits > fewest)) // nothing to do, or not a number
      return;
    if (first_rate == 0.)
      first_rate = steps / digits;
    is_slow = steps > slower * first_rate * digits + more;
  }


  void LinearSolver::exchange(Archive &archive)
  {
    const Archive::Part part(archive, "linear solver");
    archive.exchange("capacity", built_capacity);
    archive.exchange("stiffness", built_stiffness);
    archive.exchange("first rate", first_rate);
    archive.exchange("slow", is_slow);
    archive.exchange("outdated", outdated);
    remake = remake || archive.loads();
  }


  const TrilinosWrappers::SparseMatrix &LinearSolver::surrogate() const
  {
    return preconditioner->surrogate();
  }


  template <int dim>
  void require_steady_state(const Scene<dim> &scene)
  {
    const BoundaryConditions<dim> &bc = scene.boundary_conditions;
    const auto                     refuse =
      [](const Expression &expression, const SceneSection &section, const std::string &entry) {
        section.refuse(expression.depends_on_time(),
                       entry,
                       "'" + expression.text() +
                         "' depends on t, but 'Steady' in section 'Time' is true.");
      };
    if (!scene.cracks.tips.empty())
      scene.cracks.tip_error(scene.cracks.tips.front(),
                             "moves, but 'Steady' in section 'Time' is true.");
    refuse(scene.initial_and_source.source, scene.initial_and_source, "Source");
    refuse(scene.cracks.transmission, scene.cracks, "Transmission");
    for (const SideCondition &condition : bc.dirichlet)
      refuse(condition.value, bc, "Dirichlet");
    for (const SurfaceTransfer &transfer : bc.transfers)
      for (const Expression &formula : transfer.formulas)
        refuse(formula, bc, transfer.kind->entry);
    scene.time.refuse(bc.dirichlet.empty() && !bc.transfers_fix_level(),
                      "Steady",
                      "without a side in " + entries_that_fix_level() +
                        " (section 'Boundary conditions') the steady state is not determined.");
  }


  unsigned int solve_steady(DiffusionOperator &op,
                            Vector            &u,
                            const double       t,
                            const double       tolerance,
                            const unsigned int max_iterations,
                            const unsigned int direct_up_to)
  {
    AssertThrow(
      op.has_steady_state(),
      UserError("'Steady = true' in section 'Time' needs a side in " + entries_that_fix_level() +
                " (section 'Boundary conditions'): nothing fixes the level of the solution."));
    Vector rhs, change;
    op.initialize_vector(rhs);
    op.initialize_vector(change);
    op.distribute(u, t);
    op.take_material_at(u);
    op.distribute(u, t);
    op.residual(rhs, u, t);
    LinearSolver solver(op, tolerance, max_iterations, direct_up_to);
    check_no_floating_part(op, solver.surrogate());
    unsigned int n_iterations = solver.solve(0., 1., change, rhs);
    u += change;
    op.distribute(u, t);
    // Picard iterations if the material depends on the solution.
    constexpr unsigned int most  = 200;
    const double           goal  = std::max(10. * tolerance, 1e-12);
    unsigned int           round = 0;
    for (; op.depends_on_solution() && change.l2_norm() > goal * u.l2_norm(); ++round)
      {
        AssertThrow(
          round < most,
          UserError(
            "The iterations for the material's dependence on the temperature (T in section 'Material') did not "
            "converge in 200 rounds. Start nearer to the solution ('Initial value'), or compute the way there in time."));
        op.take_material_at(u);
        op.distribute(u, t);
        solver.operator_changed();
        op.residual(rhs, u, t);
        change = 0.;
        n_iterations += solver.solve(0., 1., change, rhs);
        u += change;
        op.distribute(u, t);
      }
    AssertThrow(
      std::isfinite(u.l1_norm()),
      UserError("The steady solution is not finite. Check the material and the boundary values."));
    return n_iterations;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(require_steady_state);
} // namespace PeriDeal
