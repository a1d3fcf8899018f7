// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/stress_law.h>
#include <perideal/scene/moduli.h>

namespace PeriDeal
{
  /**
   * sigma = C : eps, with any C that is its own transpose. Parameters: the upper triangle of C as a
   * matrix of the raw entries of tensors, row by row.
   */
  class LinearStress : public StressLaw
  {
  public:
    unsigned int n_parameters() const override
    {
      constexpr unsigned int n = Tensor::n_independent_components;
      return n * (n + 1) / 2;
    }

    unsigned int n_state() const override
    {
      return 0;
    }

    Response update(const Trial &trial, double *next, Tangent *tangent) const override;

    static std::vector<double> parameters(const Tangent &stiffness);
  };


  /** lambda' I x I + 2 G 1, in plane stress with the lambda' of the plane and of it alone. */
  StressLaw::Tangent isotropic_stiffness(const Moduli &moduli, const StressState kind);

  /** What is left of C in the plane where there is no stress out of it. */
  StressLaw::Tangent in_plane_stress(const StressLaw::Tangent &stiffness);
} // namespace PeriDeal
