// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "held_system.h"

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_gmres.h>

#include <perideal/base/matrix_product.h>
#include <perideal/base/matrix_rows.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double       tolerance       = 1e-4; // of solutions that are errors
    constexpr unsigned int most_iterations = 500;
    constexpr unsigned int n_inverse_steps = 4;
  } // namespace


  HeldSystem::HeldSystem(const TrilinosWrappers::SparseMatrix &matrix,
                         const TrilinosWrappers::SparseMatrix &elements,
                         const Vector                         &held,
                         const bool                            symmetric,
                         const unsigned int                    n_components)
    : matrix(matrix)
    , elements(elements)
    , held(held)
    , symmetric(symmetric)
  {
    inner.copy_from(matrix);
    hold_unknowns(inner, held);
    TrilinosWrappers::PreconditionAMG::AdditionalData options;
    options.elliptic              = symmetric;
    options.aggregation_threshold = 0.02;
    if (n_components == 1)
      {
        preconditioner.initialize(inner, options);
        return;
      }
    // Elements alone have much shorter rows, and differ from the whole by bounded factors.
    inner_elements.copy_from(elements);
    hold_unknowns(inner_elements, held);
    options.elliptic = true;
    for (unsigned int c = 0; c < n_components; ++c)
      {
        options.constant_modes.emplace_back(held.locally_owned_size());
        for (unsigned int i = c; i < held.locally_owned_size(); i += n_components)
          options.constant_modes[c][i] = true;
      }
    preconditioner.initialize(inner_elements, options);
  }


  void HeldSystem::clear_held(Vector &v) const
  {
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      if (held.local_element(i) > 0.)
        v.local_element(i) = 0.;
  }


  void HeldSystem::solve(Vector &x, const Vector &b) const
  {
    x                 = 0.;
    const double size = b.l2_norm();
    if (size == 0.)
      return;
    SolverControl control(most_iterations, tolerance * size);
    try
      {
        if (symmetric)
          SolverCG<Vector>(control).solve(MatrixProduct(inner), x, b, preconditioner);
        else
          {
            // Preconditioned from the right: from the left it would be the preconditioned residual,
            // of another unit than b, that is compared with the size of b.
            SolverGMRES<Vector>::AdditionalData data;
            data.right_preconditioning = true;
            SolverGMRES<Vector>(control, data).solve(MatrixProduct(inner), x, b, preconditioner);
          }
      }
    catch (const SolverControl::NoConvergence &)
      {} // as good as it gets: what is indefinite shows in the eigenvalue
  }


  double HeldSystem::patch_error(const Vector &u) const
  {
    Vector defect(held.get_partitioner()), error(held.get_partitioner());
    MatrixProduct(matrix).vmult(defect, u);
    MatrixProduct(elements).vmult(error, u);
    defect -= error;
    clear_held(defect);
    solve(error, defect);
    return error.linfty_norm() / u.linfty_norm();
  }


  double HeldSystem::asymmetry(const Vector &noise) const
  {
    Vector x(held.get_partitioner()), ahead(held.get_partitioner()), back(held.get_partitioner());
    double largest = 0.;
    for (unsigned int trial = 1; trial <= 3; ++trial)
      {
        x = noise;
        for (double &value : x)
          value = std::sin(trial * 10. * value);
        MatrixProduct(matrix).vmult(ahead, x);
        MatrixProduct(matrix).Tvmult(back, x);
        const double size = std::max(ahead.linfty_norm(), back.linfty_norm());
        back -= ahead;
        largest = std::max(largest, back.linfty_norm() / size);
      }
    return largest;
  }


  double HeldSystem::lowest_eigenvalue(const Vector &noise, const Vector &capacity) const
  {
    Vector x(held.get_partitioner()), y(held.get_partitioner());
    x = noise;
    clear_held(x);
    for (unsigned int k = 0; k < n_inverse_steps; ++k)
      {
        y = x;
        y.scale(capacity);
        solve(x, y);
        if (const double size = x.l2_norm(); size > 0.)
          x /= size;
      }
    MatrixProduct(inner).vmult(y, x);
    const double energy = x * y;
    y                   = x;
    y.scale(capacity);
    const double size = x * y;
    return size > 0. ? energy / size : std::numeric_limits<double>::infinity();
  }
} // namespace PeriDeal
