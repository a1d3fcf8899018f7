// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/stress_law.h>
#include <perideal/scene/moduli.h>

namespace PeriDeal
{
  /**
   * A compressible neo-Hookean body under large deformations (Simo and Hughes 1998, eq 9.2.3): with
   * C = F^T F, J = det F and the moduli G and K,
   *
   *   W = G/2 (J^(-2/3) tr C - 3) + K/2 ((J^2 - 1)/2 - ln J),
   *   S = G J^(-2/3) (1 - tr C/3 C^-1) + K/2 (J^2 - 1) C^-1,
   *
   * so that the volume alone makes a pressure, and at small strains it is the linear law of G and
   * K. Where there is no stress out of the plane the stretch out of it follows from that.
   *
   * Strain and stress are those of StressLaw under large deformations; C is positive definite (a
   * point that is inside out nobody asks about). Sums are those of small numbers where strains are
   * small, so that no digits are lost there. Parameters: K, G.
   */
  class NeoHooke : public StressLaw
  {
  public:
    explicit NeoHooke(const StressState kind)
      : kind(kind)
    {}

    unsigned int n_parameters() const override
    {
      return 2;
    }

    unsigned int n_state() const override
    {
      return 0;
    }

    Response update(const Trial &trial, double *next, Tangent *tangent) const override;

  private:
    const StressState kind;
  };
} // namespace PeriDeal
