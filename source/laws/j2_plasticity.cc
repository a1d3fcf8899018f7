// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/elasticity.h>
#include <perideal/laws/j2_plasticity.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The part within the plane. */
    SymmetricTensor<2, 3> in_plane(const SymmetricTensor<2, 3> &full)
    {
      SymmetricTensor<2, 3> part;
      for (unsigned int a = 0; a < 2; ++a)
        for (unsigned int b = a; b < 2; ++b)
          part[a][b] = full[a][b];
      return part;
    }


    SymmetricTensor<2, 3> unit_in_plane()
    {
      SymmetricTensor<2, 3> unit;
      unit[0][0] = unit[1][1] = 1.;
      return unit;
    }


    /** Maps the part of a tensor within the plane to itself. */
    SymmetricTensor<4, 3> identity_in_plane()
    {
      SymmetricTensor<4, 3> identity;
      identity[0][0][0][0] = identity[1][1][1][1] = 1.;
      identity[0][1][0][1]                        = 0.5;
      return identity;
    }


    /** The stress of plane stress as a function of M. */
    struct PlaneFlow
    {
      double dilatation, shear, hardening, yield_stress; // at the start of the step
      double p_square, s_square;                         // of the trial stress: p^2, 3/2 s:s

      double of_p(const double M) const
      {
        return 1. / (1. + dilatation * M);
      }

      double of_s(const double M) const
      {
        return 1. / (1. + 3. * shear * M);
      }

      double equivalent(const double M) const
      {
        return std::sqrt(p_square * of_p(M) * of_p(M) + s_square * of_s(M) * of_s(M));
      }

      /** The derivative of the square of equivalent(), over -2. */
      double fall(const double M) const
      {
        return p_square * dilatation * std::pow(of_p(M), 3) +
               3. * s_square * shear * std::pow(of_s(M), 3);
      }

      /** Newton's method, which stays between what is known to be too little and too much. */
      double solve() const
      {
        constexpr unsigned int most      = 100;
        constexpr double       round_off = 1e-15;

        // Beyond: all stress would be gone before the yield stress is.
        double below = 0., above = (std::sqrt(p_square + s_square) / yield_stress) /
                                   std::min(dilatation, 3. * shear);
        if (hardening > 0.)
          above = std::min(above, 1. / hardening);
        double M = 0.;
        for (unsigned int n = 0; n < most; ++n)
          {
            const double now = equivalent(M), value = now * (1. - hardening * M) - yield_stress;
            (value > 0. ? below : above) = M;
            const double slope           = -fall(M) / now * (1. - hardening * M) - hardening * now;
            double       next            = M - value / slope;
            if (!(next >= below && next <= above))
              next = 0.5 * (below + above);
            if (std::abs(value) <= round_off * now || std::abs(next - M) <= round_off * next)
              return next;
            M = next;
          }
        return M;
      }
    };
  } // namespace


  std::vector<double> J2Plasticity::parameters(const Moduli &moduli,
                                               const double  yield_stress,
                                               const double  hardening) const
  {
    return {kind == StressState::plane_stress ?
              plane_lambda(moduli, PlaneState::stress) + moduli.shear :
              moduli.bulk,
            moduli.shear,
            yield_stress,
            hardening};
  }


  StressLaw::Response J2Plasticity::update_with(Beside      &beside,
                                                const Trial &trial,
                                                double      *next,
                                                Tangent     *tangent) const
  {
    const Numbers of{trial.parameters[0],
                     trial.parameters[1],
                     trial.parameters[2],
                     trial.parameters[3]};
    std::copy_n(trial.state, n_state(), next);
    Tensor elastic = trial.strain;
    for (unsigned int k = 0; k < kappa_at; ++k)
      elastic.access_raw_entry(k) -= trial.state[k];
    return kind == StressState::plane_stress ?
             in_plane_stress(in_plane(elastic), of, beside, next, tangent) :
             in_space(elastic, of, beside, next, tangent);
  }


  StressLaw::Response J2Plasticity::in_space(const Tensor  &elastic,
                                             const Numbers &of,
                                             Beside        &beside,
                                             double        *next,
                                             Tangent       *tangent) const
  {
    const double G = of.shear, H = of.hardening, theta = trace(elastic);
    const Tensor trial  = 2. * G * deviator(elastic);
    const double square = beside.square, own = std::sqrt(1.5) * trial.norm();
    const double size  = square > 0. ? std::sqrt(own * own + square) : own,
                 over  = size - of.yield_stress - H * next[kappa_at];
    const bool   flows = over > 0.;
    const double grown = flows ? over / (3. * G + H) : 0.,
                 left  = flows ? 1. - 3. * G * grown / size : 1.;
    Response result;
    result.stress = left * trial + of.dilatation * theta * unit_symmetric_tensor<3>();
    if (flows)
      {
        for (unsigned int k = 0; k < kappa_at; ++k)
          next[k] += 1.5 * grown / size * trial.access_raw_entry(k);
        next[kappa_at] += grown;
      }
    const double shear = left * own; // the equivalent stress, of the strain alone
    result.stored      = 0.5 * of.dilatation * theta * theta + shear * shear / (6. * G) +
                    0.5 * H * next[kappa_at] * next[kappa_at];
    result.dissipated = of.yield_stress * grown;
    // By how much less the factor falls than it would with a yield stress of 0.
    const double keeps  = flows ? 3. * G / (3. * G + H) - (1. - left) : 0.;
    beside.ratio        = left;
    beside.ratio_slope  = flows ? -0.5 * keeps / (size * size) : 0.;
    beside.stress_slope = beside.ratio_slope * trial;
    if (tangent == nullptr)
      return result;
    *tangent =
      of.dilatation * outer_product(unit_symmetric_tensor<3>(), unit_symmetric_tensor<3>()) +
      2. * G * left * deviator_tensor<3>();
    if (flows)
      *tangent -= 3. * G / (size * size) * keeps * outer_product(trial, trial);
    return result;
  }


  StressLaw::Response J2Plasticity::in_plane_stress(const Tensor  &elastic,
                                                    const Numbers &of,
                                                    Beside        &beside,
                                                    double        *next,
                                                    Tangent       *tangent) const
  {
    const Tensor unit = unit_in_plane();
    const double G = of.shear, K = of.dilatation, H = of.hardening, theta = trace(elastic);
    const Tensor s_trial = 2. * G * (elastic - 0.5 * theta * unit);
    const double p_trial = K * theta;

    PlaneFlow    flow{K,
                   G,
                   H,
                   of.yield_stress + H * next[kappa_at],
                   p_trial * p_trial,
                   1.5 * (s_trial * s_trial) + beside.square};
    const bool   flows = flow.equivalent(0.) > flow.yield_stress;
    const double M     = flows ? flow.solve() : 0.;
    const double p     = flow.of_p(M) * p_trial;
    const Tensor s     = flow.of_s(M) * s_trial;
    const double size = flow.equivalent(M), grown = M * size;
    Response     result;
    result.stress = p * unit + s;
    if (flows)
      {
        Tensor plastic = 0.5 * M * p * unit + 1.5 * M * s;
        plastic[2][2]  = -M * p; // no change of volume
        for (unsigned int k = 0; k < kappa_at; ++k)
          next[k] += plastic.access_raw_entry(k);
        next[kappa_at] += grown;
      }
    const double r = flow.of_s(M);
    result.stored =
      0.5 * p * p / K + 0.25 * (s * s) / G + 0.5 * H * next[kappa_at] * next[kappa_at];
    result.dissipated = of.yield_stress * grown;
    // M grows by this per half of a change of the square of s_eq.
    const double keeps  = 1. - H * M,
                 grows  = flows ? keeps / (H * size * size + keeps * flow.fall(M)) : 0.;
    const Tensor along  = K * flow.of_p(M) * p * unit + 3. * G * r * s;
    beside.ratio        = r;
    beside.ratio_slope  = -1.5 * G * std::pow(r, 4) * grows;
    beside.stress_slope = -0.5 * r * r * grows * along;
    if (tangent == nullptr)
      return result;
    *tangent = 2. * G * flow.of_s(M) * (identity_in_plane() - 0.5 * outer_product(unit, unit)) +
               K * flow.of_p(M) * outer_product(unit, unit);
    if (flows)
      *tangent -= grows * outer_product(along, along);
    return result;
  }
} // namespace PeriDeal
