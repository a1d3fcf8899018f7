// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/elasticity.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  /**
   * J2 plasticity with isotropic hardening, of a node of the state-based solid: of its family it
   * knows the dilatation theta, and the sum D over what the extensions e of its bonds have of shear
   * and have not kept of it,
   *
   *   e_e = e - theta x/d - e_p,   D = alpha/2 sum omega e_e^2 V,   alpha = d (d + 2) G/q,
   *
   * with the plastic extensions e_p as they were at the last accepted step. In a complete family D
   * is G eps':eps' of the elastic deviator within the dimensions of the family, so that with all of
   * it, D', Mises' stress is sqrt(6 G D'). It may be at most Y + H kappa, with the equivalent
   * plastic strain kappa. Where it were more, the step of kappa and a ratio r follow
   * (backward Euler, the return along the normal), and
   *
   *   e_p += (1 - r) e_e,   t = omega [d p/q x + alpha r e_e]
   *
   * is the force state. p is the mean stress within the dimensions of the family:
   *
   *   3D            p = K theta,  D' = D
   *   plane strain  a number of the node more, the plastic strain z out of the plane; with g =
   *                 -theta/3 - z:  D' = D + 3/2 G g^2,  p = K theta - G r g,  z += (1 - r) g
   *   plane stress  a number more, the plastic dilatation theta_p; with K' = E/(2 (1 - nu)) the
   *                 stress is sqrt(6 G D + p^2), and M = d kappa/stress solves
   *                 6 G D/(1 + 3 G M)^2 + p_t^2/(1 + K' M)^2 = (Y + H (kappa + M stress))^2,
   *                 p_t = K' (theta - theta_p),  r = 1/(1 + 3 G M),  p = p_t/(1 + K' M),
   *                 theta_p += M p
   *
   * Both p and r are derivatives of one function of theta and D, what is stored and dissipated in
   * the step: tangents are symmetric, and with H > 0 definite.
   */
  class OrdinaryPlasticity
  {
  public:
    OrdinaryPlasticity(const Moduli      &moduli,
                       const unsigned int dim,
                       const PlaneState   plane,
                       const double       yield_stress,
                       const double       hardening)
      : is_stress(dim == 2 && plane == PlaneState::stress)
      , is_strain(dim == 2 && plane == PlaneState::strain)
      , shear(moduli.shear)
      , bulk(is_stress ? plane_lambda(moduli, plane) + moduli.shear : moduli.bulk)
      , yield_stress(yield_stress)
      , hardening(hardening)
    {}

    /** What a node remembers. */
    struct State
    {
      double strain = 0.; // kappa
      double plane  = 0.; // z or theta_p
    };

    /** What it makes of theta and D, since a state. */
    struct Answer
    {
      double mean = 0., ratio = 1.; // p, r
      State  change;                // since then
      double out_of_plane = 0.;     // stress, in plane strain
      double stored       = 0.;     // per volume: elastic, and 1/2 H kappa^2
      double dissipated   = 0.;     // per volume: Y times the change of kappa
      // The tangent: d p = by_theta d theta + mixed d D, d r = mixed d theta + by_sum d D.
      double by_theta = 0., mixed = 0., by_sum = 0.;

      bool yields() const
      {
        return change.strain > 0.;
      }
    };

    /**
     * @param theta less what the thermal strain makes within the dimensions of the family
     * @param sum D, of the e_p of the state
     * @param thermal that strain, alpha dT, which plane strain has out of the plane, too
     */
    Answer answer(const double theta,
                  const double sum,
                  const State &state,
                  const double thermal = 0.) const
    {
      Answer       result = is_stress ? in_plane_stress(theta, sum, state) :
                                        confined(theta, sum, state, is_strain ? thermal : 0.);
      const double strain = state.strain + result.change.strain;
      result.stored += 0.5 * hardening * strain * strain;
      result.dissipated = yield_stress * result.change.strain;
      return result;
    }

  private:
    double limit(const State &state) const
    {
      return yield_stress + hardening * state.strain;
    }

    /** In 3D and plane strain. @param thermal of the latter */
    Answer confined(const double in_family,
                    const double sum,
                    const State &state,
                    const double thermal) const
    {
      const double theta   = in_family - thermal;                                  // all of it
      const double outside = is_strain ? -theta / 3. - thermal - state.plane : 0.; // g
      const double all     = sum + 1.5 * shear * outside * outside;                // D'
      const double stress = std::sqrt(6. * shear * all), most = limit(state);
      Answer       result;
      double       lost = 0., slope = 0.; // 1 - r; of -r over D'
      if (stress > most)
        {
          result.change.strain = (stress - most) / (3. * shear + hardening);
          lost                 = 3. * shear * result.change.strain / stress;
          slope = 3. * shear / (3. * shear + hardening) * (most / stress) / (2. * all);
        }
      const double ratio = 1. - lost, of_plane = shear * outside;
      result.ratio        = ratio;
      result.mean         = bulk * theta - ratio * of_plane;
      result.change.plane = lost * outside;
      result.out_of_plane = bulk * theta + 2. * ratio * of_plane;
      result.stored       = 0.5 * bulk * theta * theta + ratio * ratio * all;
      result.by_theta = bulk + (is_strain ? ratio * shear / 3. - slope * of_plane * of_plane : 0.);
      result.mixed    = slope * of_plane;
      result.by_sum   = -slope;
      return result;
    }

    Answer in_plane_stress(const double theta, const double sum, const State &state) const
    {
      const double trial = bulk * (theta - state.plane), of_shear = 6. * shear * sum;
      Answer       result;
      result.by_theta = bulk;
      double lambda   = 0.; // M
      if (std::sqrt(of_shear + trial * trial) > limit(state))
        lambda = multiplier(trial, of_shear, limit(state));
      const double ratio = 1. / (1. + 3. * shear * lambda), of_mean = 1. / (1. + bulk * lambda),
                   mean   = of_mean * trial;
      result.ratio        = ratio;
      result.mean         = mean;
      result.change.plane = lambda * mean;
      result.stored       = 0.5 * mean * mean / bulk + ratio * ratio * sum;
      if (!(lambda > 0.))
        return result;
      const double stress  = std::sqrt(ratio * ratio * of_shear + mean * mean),
                   left    = 1. - hardening * lambda,
                   falling = (3. * shear * ratio * ratio * ratio * of_shear +
                              bulk * of_mean * mean * mean) /
                             stress,
                   per    = left / (stress * (hardening * stress + left * falling)),
                   by_sum = per * 3. * shear * ratio * ratio, by_mean = per * bulk * of_mean * mean;
      result.change.strain = lambda * stress;
      result.by_sum        = -3. * shear * ratio * ratio * by_sum;
      result.mixed         = -3. * shear * ratio * ratio * by_mean;
      result.by_theta      = of_mean * bulk - mean * bulk * of_mean * by_mean;
      return result;
    }

    /** M, from below: what it is a root of is convex and falls. */
    double multiplier(const double trial, const double of_shear, const double most) const
    {
      constexpr unsigned int enough = 100;
      double                 lambda = 0.;
      for (unsigned int k = 0; k < enough; ++k)
        {
          const double a = 1. / (1. + 3. * shear * lambda), b = 1. / (1. + bulk * lambda),
                       stress = std::sqrt(a * a * of_shear + b * b * trial * trial),
                       falling =
                         (3. * shear * a * a * a * of_shear + bulk * b * b * b * trial * trial) /
                         stress,
                       left = 1. - hardening * lambda,
                       next =
                         lambda + (left * stress - most) / (hardening * stress + left * falling);
          if (!(next > lambda))
            break;
          lambda = next;
        }
      return lambda;
    }

    bool   is_stress, is_strain;
    double shear, bulk; // in plane stress K'
    double yield_stress, hardening;
  };
} // namespace PeriDeal
