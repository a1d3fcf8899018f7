// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <vector>

namespace PeriDeal
{
  /**
   * What a scalar field is like around the end of a crack, by least squares of the terms
   *
   *   r^(n/2) cos(n phi/2), r^(n/2) sin(n phi/2),   n = lowest, ..., highest,
   *
   * r, phi the polar coordinates about the end, |phi| = pi on the crack faces, and r^2: the
   * expansion of harmonic fields that may jump across the crack, and of those with a uniform
   * source.
   */
  class HalfPowerFit
  {
  public:
    /** @param scale a length, of which r is a multiple */
    HalfPowerFit(const int lowest, const int highest, const double scale);

    void add(const double r, const double angle, const double value, const double weight);

    /** Of what all processes have added. Collective. */
    void solve(const MPI_Comm communicator);

    /** Of solve(). */
    double value(const double r, const double angle) const;

    /** The derivative ahead of the crack, along phi = 0. */
    double slope_ahead(const double r, const double angle) const;

  private:
    template <typename Visit>
    void for_each_term(const Visit &visit) const;

    std::vector<double> terms_at(const double r, const double angle) const;

    int                 lowest, highest;
    double              scale;
    std::vector<double> matrix, right_side, coefficients;
  };
} // namespace PeriDeal
