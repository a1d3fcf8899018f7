// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/stress_law.h>
#include <perideal/scene/moduli.h>

namespace PeriDeal
{
  /**
   * J2 plasticity (von Mises) with linear isotropic hardening, by backward Euler steps. With the
   * equivalent plastic strain kappa, its growth dk in a step, and the deviator s of the stress that
   * the step would have without flow,
   *
   *     s_eq = sqrt(3/2 s:s) > sy + H kappa:  dk = (s_eq - sy - H kappa)/(3 G + H),
   *     s <- r s,  r = 1 - 3 G dk/s_eq,       d eps_p = 3/2 dk s/s_eq,
   *
   * whose tangent is K 1x1 + 2 G r I' - 2 G (3 G/(3 G + H) - (1 - r)) n x n, n = s/|s|. Stored are
   * the elastic energy and H kappa^2/2, and sy dk is dissipated.
   *
   * In plane stress sigma = p 1 + s in the plane, tr s = 0, s_eq^2 = p^2 + 3/2 s:s. With
   * M = dk/s_eq, K' = E/(2 (1 - nu)) and the dilatation theta within the plane
   *
   *     p = p_trial/(1 + K' M),  s = s_trial/(1 + 3 G M),  d theta_p = M p,  d e_p = 3/2 M s,
   *
   * and M is the one root of s_eq(M) (1 - H M) = sy + H kappa (Simo and Taylor 1986).
   *
   * Shear that no strain at the point tells of may flow with it (Beside): its square B counts in
   * s_eq^2, and the factor r of the deviator, in plane stress 1/(1 + 3 G M), is that of it, too.
   *
   * State: the plastic strain (raw entries of the tensor), kappa. Parameters: parameters().
   */
  class J2Plasticity : public StressLaw
  {
  public:
    explicit J2Plasticity(const StressState kind)
      : kind(kind)
    {}

    unsigned int n_parameters() const override
    {
      return 4;
    }

    unsigned int n_state() const override
    {
      return kappa_at + 1;
    }

    /** @param hardening 0 or more */
    std::vector<double> parameters(const Moduli &moduli,
                                   const double  yield_stress,
                                   const double  hardening) const;

    /** Shear beside that of the strain, and what becomes of it. */
    struct Beside
    {
      double square      = 0.; // B, as the step would have it without flow
      double ratio       = 1.; // r: what flow leaves of its root
      double ratio_slope = 0.; // dr/dB
      Tensor stress_slope;     // d sigma/dB, which is dr/d eps over 6 G
    };

    Response update(const Trial &trial, double *next, Tangent *tangent) const override
    {
      Beside none;
      return update_with(none, trial, next, tangent);
    }

    /** As update(); what is stored beside, r^2 B/(6 G), is not in what is stored. */
    Response update_with(Beside &beside, const Trial &trial, double *next, Tangent *tangent) const;

    std::vector<std::pair<std::string, unsigned int>> shown() const override
    {
      return {{"plastic_strain", kappa_at}};
    }

  private:
    static constexpr unsigned int kappa_at = Tensor::n_independent_components;

    /** As parameters() has them: stiffness against dilatation, in plane stress K', else K. */
    struct Numbers
    {
      double dilatation, shear, yield_stress, hardening;
    };

    Response in_space(const Tensor  &elastic_trial,
                      const Numbers &of,
                      Beside        &beside,
                      double        *next,
                      Tangent       *tangent) const;
    Response in_plane_stress(const Tensor  &elastic_trial,
                             const Numbers &of,
                             Beside        &beside,
                             double        *next,
                             Tangent       *tangent) const;

    const StressState kind;
  };
} // namespace PeriDeal
