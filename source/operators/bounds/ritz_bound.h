// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace PeriDeal
{
  /**
   * What Lanczos iterations tell of the largest eigenvalue: the largest Ritz value plus the larger
   * of its residual and 0.4 %.
   */
  class RitzBound
  {
  public:
    static constexpr unsigned int n_max = 60; // iterations

    /** @param enough iterations end once the bound has come down to that */
    explicit RitzBound(const double enough)
      : enough(enough)
    {}

    /**
     * Take the numbers of one iteration: A q = ... + alpha q + norm q_next. Returns whether the
     * bound is good.
     */
    bool take(const double new_alpha, const double norm)
    {
      constexpr double      margin  = 4e-3;
      constexpr std::size_t n_least = 12; // before that a start may not have seen what is stiffest
      // A residual of the margin is reached while iterations still follow the waves of the whole
      // mesh, and what a few places are stiffer, as beside a side with convection, is not seen yet.
      constexpr double small = 1e-3;
      alpha.push_back(new_alpha);
      const Eigen::VectorXd diagonal = Eigen::Map<Eigen::VectorXd>(alpha.data(), alpha.size());
      const Eigen::VectorXd side     = Eigen::Map<Eigen::VectorXd>(beta.data(), beta.size());
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
      ritz.computeFromTridiagonal(diagonal, side);
      const Eigen::Index end      = diagonal.size() - 1;
      const double       residual = norm * std::abs(ritz.eigenvectors()(end, end));
      // Some eigenvalue is as near as the residual; where several lie close together the largest
      // may be a little above it.
      bound = ritz.eigenvalues()[end] + std::max(residual, margin * ritz.eigenvalues()[end]);
      beta.push_back(norm);
      return residual < small * bound || norm <= 1e-12 * bound ||
             (bound <= enough && alpha.size() >= n_least);
    }

    double value() const
    {
      return bound;
    }

  private:
    const double        enough;
    double              bound = 0.;
    std::vector<double> alpha, beta;
  };
} // namespace PeriDeal
