// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/nodes.h>

#include <cstdint>

namespace PeriDeal
{
  /**
   * Factors of the strength of nodes, drawn from a Weibull distribution of mean 1: with U uniform
   * in (0, 1) and the modulus k,
   *   (-ln U)^(1/k) / Gamma(1 + 1/k).
   * U follows from a seed and the place of the node alone, so that the field is the same on any
   * number of processes, and nodes are independent of each other.
   */
  template <int dim>
  class WeibullField
  {
  public:
    /** @param modulus k > 0. Collective. */
    WeibullField(const Nodes<dim> &nodes, const double modulus, const unsigned int seed);

    /** At the place of a node. Not collective. */
    double factor(const dealii::Point<dim> &p) const;

  private:
    const double  modulus, scale; // 1 / Gamma(1 + 1/k)
    std::uint64_t start;
    double        unit; // of places: what differs by less is the same
  };
} // namespace PeriDeal
