// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>

namespace PeriDeal
{
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
} // namespace PeriDeal
