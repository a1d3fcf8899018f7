// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/exact_solution.h>
#include <perideal/laws/elasticity.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** What the exact displacement of a body may need to know of the scene. */
  struct ExactSolidContext
  {
    unsigned int        dim = 2;
    std::vector<double> lower{0., 0.}, upper{1., 1.}; // corners of the body
    Moduli              moduli;
    PlaneState          plane   = PlaneState::stress;
    double              density = 1.;
    std::vector<double> hole;                  // centre and radius of the one hole; or empty
    std::vector<double> crack;                 // ends of the one crack, x, y each; or empty
    bool                begins_inside = false; // the crack's first end is in the body
    bool                ends_inside   = false; // its second one is
    bool                has_cracks = false, has_holes = false;
    std::string         no_named; // why the named solutions do not suit the scene; empty: they do
  };


  /**
   * The displacement that the entry `Solution` in section `Reference` asks for: an expression of x,
   * y, z, t for each component, separated by commas, or one of
   *
   * - `kirsch(S)`: infinite plate with the circular hole of the scene under a tension S along x;
   *   without displacement at the hole's centre and without rotation.
   * - `crack tip(K_I, K_II)`: the first terms of Williams' series at the end of the scene's crack
   *   that is in the body; without displacement at the tip.
   * - `westergaard(S, T)`: infinite plate with the straight crack of the scene under a tension S
   *   across and T along the crack (if not given: S), after Westergaard.
   * - `cantilever(P)`: box whose right side bears the force -P in y, as a parabola, with
   *   displacements of the beam's left side as given by Timoshenko and Goodier, section 21: none in
   *   its middle, and none in x at its corners.
   * - `standing wave(n, A)`: A sin(n pi (x - x_0)/L) cos(omega t) in x, of whole wave numbers n; in
   *   bars, and between sides that slide in two and three dimensions. A is 1 if not given.
   *
   * The arguments are constant expressions. Throws UserError for an unknown name, wrong arguments,
   * or what the scene cannot give.
   */
  std::unique_ptr<ExactSolution> make_exact_solid(const std::string       &text,
                                                  const ExactSolidContext &context);

  /** The names that make_exact_solid() knows, without arguments. */
  const std::vector<std::string> &exact_solid_names();
} // namespace PeriDeal
