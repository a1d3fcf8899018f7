// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

/**
 * @file
 * Elastic moduli: numbers that a material gives and pure laws take.
 */

namespace PeriDeal
{
  /**
   * Moduli of an isotropic three-dimensional solid, also where a scene has one or two dimensions.
   * The bulk modulus may be infinite (Poisson ratio 1/2): young() and poisson() are finite then,
   * lambda() is not.
   */
  struct Moduli
  {
    double bulk = 1., shear = 1.;

    /** E = 9 K G/(3 K + G) */
    double young() const;

    /** nu = (3 K - 2 G)/(2 (3 K + G)) */
    double poisson() const;

    /** lambda = K - 2 G/3 */
    double lambda() const;
  };


  /**
   * One of the numbers of which two make the moduli; in the order of the entries of section
   * `Material`.
   */
  enum class Modulus
  {
    bulk,
    shear,
    young,
    poisson
  };

  /**
   * The moduli that two different numbers make, in either order:
   *
   * | given | K | G |
   * |---|---|---|
   * | K, G | K | G |
   * | K, E | K | 3 K E/(9 K - E) |
   * | K, nu | K | 3 K (1 - 2 nu)/(2 (1 + nu)) |
   * | G, E | G E/(3 (3 G - E)) | G |
   * | G, nu | 2 G (1 + nu)/(3 (1 - 2 nu)) | G |
   * | E, nu | E/(3 (1 - 2 nu)) | E/(2 (1 + nu)) |
   *
   * Two that contradict each other give moduli that are not positive, or infinite ones. A Poisson
   * ratio of 1/2 makes the bulk modulus infinite, or with a given K the shear modulus 0.
   */
  Moduli moduli_from(const Modulus a, const double value_a, const Modulus b, const double value_b);

  /**
   * The Poisson ratio that they make, in or out of its range (-1, 1/2]: what a message can say
   * about numbers that do not fit.
   */
  double poisson_from(const Modulus a, const double value_a, const Modulus b, const double value_b);
} // namespace PeriDeal
