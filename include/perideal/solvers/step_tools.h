// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/operators/solid/elastic_operator.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** rate = C^{-1} (f(t) - K u) with diagonal C; u is distributed at t first. Collective. */
  void compute_rate(const Operator &op, Vector &u, const double t, Vector &rate);

  /** C^{-1} with diagonal C, owned entries: a product is cheaper than a division. */
  std::vector<double> inverse_capacity(const Operator &op);

  /** Owned entries: whether a boundary condition prescribes them. */
  std::vector<bool> held_unknowns(const Operator &op);

  /** Bytes of vectors. */
  std::size_t memory_of(const std::initializer_list<const Vector *> vectors);

  /**
   * sqrt(sum C_i v_i^2 / sum C_i): the root mean square in the measure of the capacity. Collective.
   */
  double capacity_norm(const Operator &op, const Vector &v);

  /**
   * Bound of the error of one step, relative to the solution, of methods whose steps are wrong by
   * O(h^3). Their n steps come to n = O(bound^(-1/3)), and their errors add up to O(bound^(2/3)):
   * so it goes with the power 3/2 of the accuracy wanted at the end.
   */
  double local_tolerance(const double tolerance);

  /** The error of values that are none at t, with the message for the user. */
  Diverged not_finite(const std::string &message, const double t);

  /** Throws Diverged with what to change if u is not finite. Collective. */
  void check_finite(const Vector &u, const std::string &stepper, const double t);

  /**
   * Throws UserError, with the place, if a node of a body that is to move has no mass, or a
   * negative one. Collective.
   */
  void require_mass(const ElasticOperator &op);

  /**
   * What to say of a body that is inside out: a sentence that goes on after a time, and what to
   * change.
   */
  std::string inverted_text(const Inversion &found);

  /**
   * Number of equal steps, each at most dt, that fill a span; a span that is dt up to round-off
   * counts as one.
   */
  unsigned long long n_equal_steps(const double span, const double dt);


  /*
   * How long steps of explicit methods may be: the one place of these numbers, for steppers, what
   * refuses a step, and studies. Names are those of scenes.
   */

  /**
   * What one step leaves of a field, as a factor of its size.
   *
   * @param z        step times rate of decay (`euler`, `rk4`, `rkc2`, of du/dt = -lambda u), step
   *                 times circular frequency (`verlet`, of d^2u/dt^2 = -omega^2 u); not negative
   * @param n_stages of `rkc2`, two or more
   *
   * 1 at most where the step is stable. No other methods. Not collective.
   */
  double amplification(const std::string &method, const double z, const unsigned int n_stages = 0);

  /**
   * The largest z up to which amplification() is nowhere above 1: `euler` and `verlet` 2, `rk4`
   * 2.785, `rkc2` about 0.65 (n_stages^2 - 1), without @p n_stages and for all other methods
   * infinity, since they take as many stages as a step needs, or are implicit. Not collective.
   */
  double stability_limit(const std::string &method, const unsigned int n_stages = 0);

  /** So many stages of `rkc2` make a step with this z stable and damped. Not collective. */
  unsigned int rkc2_stages(const double z);


  /**
   * Coefficients of the s-stage scheme of Sommeijer, Shampine and Verwer (J. Comput. Appl. Math.
   * 88, 1998). A step leaves a[s] + b[s] T_s(w0 - w1 z) of a field that decays at the rate z/step,
   * T_s the Chebyshev polynomial of degree s.
   */
  struct RkcCoefficients
  {
    explicit RkcCoefficients(const unsigned int s)
      : a(s + 1)
      , b(s + 1)
      , c(s + 1)
    {
      constexpr double    damping = 2. / 13.;
      std::vector<double> T(s + 1), dT(s + 1), ddT(s + 1);
      w0    = 1. + damping / (static_cast<double>(s) * s);
      T[0]  = 1.;
      T[1]  = w0;
      dT[1] = 1.;
      for (unsigned int j = 2; j <= s; ++j)
        {
          T[j]   = 2. * w0 * T[j - 1] - T[j - 2];
          dT[j]  = 2. * T[j - 1] + 2. * w0 * dT[j - 1] - dT[j - 2];
          ddT[j] = 4. * dT[j - 1] + 2. * w0 * ddT[j - 1] - ddT[j - 2];
        }
      w1 = dT[s] / ddT[s];
      for (unsigned int j = 2; j <= s; ++j)
        {
          b[j] = ddT[j] / (dT[j] * dT[j]);
          c[j] = w1 * ddT[j] / dT[j];
        }
      b[0] = b[1] = b[2];
      c[0]        = 0.;
      c[1]        = c[2] / dT[2];
      for (unsigned int j = 0; j <= s; ++j)
        a[j] = 1. - b[j] * T[j];
    }

    double              w0, w1;
    std::vector<double> a, b, c;
  };


  /** The error of a body that is inside out at t, with the place of the worst node. */
  Diverged inversion_error(const std::string &message, const Inversion &found, const double t);
} // namespace PeriDeal
