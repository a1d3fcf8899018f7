// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  /** How a crack in two dimensions goes on, and what holds at its new end. */
  struct CrackKink
  {
    double angle  = 0.;              // by which it turns to the left, in radians
    double mode_1 = 0., mode_2 = 0.; // stress intensities where it has gone on by very little

    /** E' times the energy that is released per length. */
    double release() const
    {
      return mode_1 * mode_1 + mode_2 * mode_2;
    }
  };


  /**
   * The stress intensities where a straight crack with K_I and K_II has turned by an angle and gone
   * on by very little, in any body: the universal functions of Amestoy and Leblond (1992), Int. J.
   * Solids Structures 29, 465-501, to the twentieth power of the angle over pi, up to 80 degrees.
   */
  CrackKink kink_at(const double angle, const double mode_1, const double mode_2);

  /**
   * The way that releases most energy, among those that open the crack: Griffith's. What closes a
   * crack (K_I < 0) does not count. Its direction is that without K_II to some tenths of a degree.
   */
  CrackKink kink_of_most_release(const double mode_1, const double mode_2);

  /**
   * The direction of the largest hoop stress (Erdogan and Sih 1963), and as mode_1 the stress
   * intensity by which that goes with 1/sqrt(r), which counts as that of the toughness there.
   */
  CrackKink kink_of_hoop_stress(const double mode_1, const double mode_2);
} // namespace PeriDeal
