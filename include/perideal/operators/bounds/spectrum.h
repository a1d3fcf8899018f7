// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/full_matrix.h>

#include <perideal/operators/interface/operator.h>

#include <functional>
#include <vector>

namespace PeriDeal
{
  /**
   * Upper estimate of the largest eigenvalue of C^{-1} K: Lanczos iterations in the inner product
   * of C if K is symmetric (largest Ritz value plus the larger of its residual and 0.4 %), else
   * power iterations with a margin of 5 %. Rounded up to three digits, so that it does not depend
   * on the number of processes, and never above the Gershgorin bound. The start vector is made from
   * positions by @p fill. Iterations end early once the bound has come down to @p enough.
   * Collective.
   *
   * @param metric symmetric K only: the diagonal that stands for C, if another is meant
   */
  double sharp_bound(const Operator                            &op,
                     const double                               gershgorin,
                     const std::function<void(Vector &vector)> &fill,
                     const double                               enough = 0.,
                     const Vector                              *metric = nullptr);

  /**
   * The spectrum of an operator: its Gershgorin bound, and the sharp one, which is found when
   * somebody first asks and kept.
   */
  class SpectralBounds
  {
  public:
    /**
     * @param op         must outlive this
     * @param fill_noise sets numbers in [-1, 1] that look random but depend on the unknowns'
     *                   positions alone; collective
     */
    SpectralBounds(const Operator &op, const std::function<void(Vector &)> &fill_noise);

    /** Take the Gershgorin bound of a new K. Not collective. */
    void set(const double gershgorin);

    /** The Gershgorin bound. Not collective. */
    double safe() const;

    /** Both bounds. Collective. */
    Spectrum get() const;

    /** A vector of fill_noise, which is kept. Collective. */
    const Vector &noise() const;

    /**
     * Some rows of K have changed and no others. The fastest field may have, too, and only there:
     * iterations that start there see it soon.
     *
     * @param gershgorin  bound of these rows
     * @param local_bound what iterations from noise in these rows find, which end once they come
     *                    down to its argument; negative if they are not possible. Then the whole
     *                    operator is asked.
     *
     * Collective.
     */
    void raise(const double                               gershgorin,
               const std::vector<unsigned int>           &rows,
               const std::function<double(const double)> &local_bound);

  private:
    const Operator                     &op;
    const std::function<void(Vector &)> fill_noise;
    mutable Spectrum                    bounds; // sharp is 0 while nobody has asked
    mutable Vector                      kept_noise;
  };

  /** Of a symmetric matrix. Not collective. */
  double lowest_eigenvalue(const dealii::FullMatrix<double> &matrix);

  /** The number rounded up to three significant digits. */
  double round_up(const double x);

  /** A number in [-1, 1] that looks random but depends on the position alone. */
  template <typename PointType>
  double position_noise(const PointType &p)
  {
    double phase = 0.;
    for (unsigned int d = 0; d < PointType::dimension; ++d)
      phase += (12.9898 + 65.233 * d) * static_cast<float>(p[d]) * 1e3;
    const double s = std::sin(phase) * 43758.5453;
    return 2. * (s - std::floor(s)) - 1.;
  }
} // namespace PeriDeal
