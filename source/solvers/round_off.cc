// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/round_off.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    double largest_accepted = 0.;
  }


  double round_off_of_forces(const ElasticOperator &op, const Vector &u, const double size)
  {
    constexpr double several = 16., least_digits = 1e-4;
    Vector           sizes(u);
    sizes.scale(op.diagonal());
    op.clear_constrained(sizes);
    return std::min(several * std::numeric_limits<double>::epsilon() * sizes.l2_norm(),
                    least_digits * size);
  }


  void accept_residual(const double relative)
  {
    largest_accepted = std::max(largest_accepted, relative);
  }


  double take_accepted_residual()
  {
    const double taken = largest_accepted;
    largest_accepted   = 0.;
    return taken;
  }


  RoundOffGoal::RoundOffGoal(const ElasticOperator &op,
                             const StaticOptions   &options,
                             const double           size)
    : op(op)
    , options(options)
    , size(size)
  {}


  bool RoundOffGoal::reached(const Vector &r, const Vector &u, const unsigned int n)
  {
    constexpr unsigned int seldom = 10, shortest = 100; // iterations
    const bool             is_last = n >= options.max_iterations;
    if (n % seldom != 0 && !is_last)
      return false;
    const double now = r.l2_norm();
    if (n == 0 && !(size > 0.))
      size = now;
    lowest = std::min(lowest, now);
    if (n < next && !is_last)
      return false;
    const bool no_longer_falls = lowest > 0.5 * before;
    before                     = lowest;
    lowest                     = std::numeric_limits<double>::max();
    next                       = n + std::max(shortest, n / 4);
    if (!(now > options.tolerance * size) || !(no_longer_falls || is_last) ||
        now > round_off_of_forces(op, u, size))
      return false;
    accept_residual(now / size);
    return true;
  }
} // namespace PeriDeal
