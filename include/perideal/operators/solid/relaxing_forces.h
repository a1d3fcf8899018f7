// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/law_steps.h>

#include <vector>

namespace PeriDeal
{
  /**
   * A shear modulus that relaxes in a body whose forces are linear in displacements, K = K_s + K_b,
   * K_s with the shear modulus and K_b with the bulk modulus. The law (BondLaw, linear, with a
   * history) makes u* of displacements as it makes p* of a product; forces are
   *
   *   F = K_s u* + K_b u = K u + (s* - s),   s = K_s u,
   *
   * since K_s is linear, too: the law is asked about s in place of u, and what the body went
   * through is histories of u and of s at nodes. So that an application takes K_s u and K_b u, and
   * energies are sums of products of numbers at nodes: with the parts a_k of the law (BondLaw)
   *
   *   sum_k a_k(u) . K_s a_k(u)/2 = sum_k a_k(u) . a_k(s)/2.
   *
   * What the law makes is linear in the present state and the histories; its factors are those of
   * the step. Histories of s are those of K_s as it is: where bonds break, renew().
   *
   * Vectors are those of unknowns; of s owned ones count. Not collective unless stated.
   */
  class RelaxingForces
  {
  public:
    /** @param law viscoelastic */
    RelaxingForces(const Material::Law &law, const Vector &layout);

    /** States that follow are those at t. */
    void set_time(const double t) const;

    /** The derivative of what is made of u, in the step. */
    double slope() const
    {
      return factors.effective.front();
    }

    /** Add s* - s. */
    void add_change(Vector &y, const Vector &s) const;

    /** u*; ghosts are up to date. Collective. */
    Vector effective(const Vector &u) const;

    /** The stored parts a_k of displacements; ghosts are up to date. Collective. */
    std::vector<Vector> stored_parts(const Vector &u) const;

    /**
     * What shear stores, or has dissipated since the last accepted state, at u, s = K_s u.
     * Collective.
     */
    double energy(const Vector &u, const Vector &s, const bool dissipated) const;

    /** Go on from u, s = K_s u at time t. */
    void accept(const Vector &u, const Vector &s, const double t);

    /** K_s is another one now: multiply(s, u) makes s = K_s u. */
    template <typename Multiply>
    void renew(const Multiply &multiply)
    {
      for (unsigned int k = 0; k < of_displacements.size(); ++k)
        multiply(of_forces[k], of_displacements[k]);
    }

    /** Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

    std::size_t memory_consumption() const;

  private:
    /** Of the present state and of each history. */
    using Factors = std::vector<double>;

    /** What factors make of a state and its histories, of owned unknowns; added. */
    static void add_up(Vector                    &sum,
                       const Factors             &factors,
                       const Vector              &state,
                       const std::vector<Vector> &histories);

    Vector with_ghosts(const Factors &of, const Vector &u) const;

    LawSteps            steps;
    std::vector<Vector> of_displacements, of_forces; // histories

    struct
    {
      Factors              effective;
      std::vector<Factors> stored, dissipated; // parts
      std::vector<Factors> accepted;           // histories
    } mutable factors;
  };
} // namespace PeriDeal
