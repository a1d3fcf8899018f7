// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/solvers/linear_solver.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The norms of the residuals of Newton's method from the undeformed body on, until one is below
   * the share of the first, at most a dozen. Collective.
   */
  inline std::vector<double> residuals_of_newton(ElasticOperator &op,
                                                 const Vector    &layout,
                                                 const double     share)
  {
    Vector              u = layout, r = u, change = u;
    LinearSolver        solver(op, 1e-12, 1000);
    std::vector<double> sizes;
    u = 0.;
    op.distribute(u, 0.);
    for (unsigned int n = 0; n < 12; ++n)
      {
        op.residual(r, u, 0.);
        sizes.push_back(r.l2_norm());
        if (sizes[n] < share * sizes[0])
          break;
        op.linearize(u);
        solver.operator_changed();
        change = 0.;
        solver.solve(0., 1., change, r);
        u += change;
        op.distribute(u, 0.);
      }
    return sizes;
  }
} // namespace PeriDeal
