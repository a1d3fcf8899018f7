// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>

namespace PeriDeal
{
  /**
   * Rows of bonds of a deformed body, one of each owned node, as vectorised loops see them; Y and e
   * are those of BondKinematics. Loops take several bonds of a node at once, those that are left
   * over together with bonds that bear nothing. The order of summation is a row's own: the same on
   * any number of processes.
   */
  struct DeformedRows
  {
    /**
     * What loops want of a node, in one line of the cache: position, c theta/q, displacement,
     * thermal strain.
     */
    struct alignas(64) Node
    {
      static constexpr int tau = 3, displacement = 4, strain = 7;

      double numbers[8] = {};
    };

    const Node         *nodes     = nullptr; // owned and ghosts
    const std::size_t  *starts    = nullptr; // of all rows, and the end of the last
    const unsigned int *neighbors = nullptr;
    const double       *lengths   = nullptr; // W x; 0: a bond that bears nothing
    const double       *springs   = nullptr; // (b_i/q_i + b_j/q_j)/(W x^2)
    std::size_t         begin = 0, end = 0;  // the rows to look at
    bool                strained = false;    // some thermal strain is not 0
  };


  /**
   * Numbers of these rows are at the places of the rows in a list of all. With sum_j W x e of a row
   * the sum of spring (W x e)^2 is found, if @p squares is not null.
   */
  template <int dim>
  void sum_extensions(const DeformedRows &rows, double *sums, double *squares);

  /**
   * y = -F.
   * @param limits  of e/x; null: none
   * @param exceeds 1 for rows with a bond that may be beyond its limit, by round-off, else 0; not
   *                looked at without limits
   */
  template <int dim>
  void sum_forces(const DeformedRows &rows,
                  const double       *limits,
                  double             *y,
                  unsigned char      *exceeds);

  /** Of |Y|/x - 1, either sign, over bonds that bear something. */
  template <int dim>
  double largest_of_stretches(const DeformedRows &rows);
} // namespace PeriDeal
