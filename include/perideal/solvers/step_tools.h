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
} // namespace PeriDeal
