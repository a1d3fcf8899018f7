// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/bond_law.h>
#include <perideal/scene/relaxation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace PeriDeal
{
  /**
   * A solid whose shear modulus relaxes, G(t) = G (g + sum g_k exp(-t/T_k)), g + sum g_k = 1, while
   * its bulk modulus stays: in the force of the linear peridynamic solid the products p = W x e,
   * where the shear modulus multiplies them, are
   *
   *   p* = g p + sum g_k h_k,   T_k dh_k/dt = T_k dp/dt - h_k,
   *
   * exact for a p that is linear within a step dt: with r = dt/T_k, E = exp(-r),
   * h_k <- E h_k + (1 - E)/r dp. Stored are 1/2 (g p^2 + sum g_k h_k^2); the dampers of the
   * branches dissipate the integral of g_k h_k^2/T_k. History: p and h_k of the last accepted step.
   */
  class ViscoelasticSolid : public BondLaw
  {
  public:
    explicit ViscoelasticSolid(const std::vector<Relaxation> &terms)
    {
      for (const Relaxation &term : terms)
        {
          branches.push_back({term.share, term.time, std::sqrt(term.share), 1., 1., 0., {}});
          rest = std::max(0., rest - term.share);
        }
    }

    unsigned int n_history() const override
    {
      return 1 + branches.size();
    }

    bool is_linear() const override
    {
      return true;
    }

    bool relaxes_dilatation() const override
    {
      return true;
    }

    void set_step(const double dt) override
    {
      for (Branch &branch : branches)
        {
          branch.ratio = dt / branch.time;
          branch.decay = std::exp(-branch.ratio);
          branch.gain  = branch.ratio > 0. ? -std::expm1(-branch.ratio) / branch.ratio : 1.;
          // Of the dissipated parts: the integral of h^2/T is a d^2 + 2 b d c + r c^2.
          const double a = -0.5 * std::expm1(-2. * branch.ratio), b = branch.gain * branch.ratio;
          const double factor = std::sqrt(2.) * branch.root;
          branch.of_parts     = {{0., 0., 0.}};
          if (branch.ratio > 0.)
            branch.of_parts = {{factor * std::sqrt(a),
                                factor * b / std::sqrt(a),
                                factor * std::sqrt(std::max(0., branch.ratio - b * b / a))}};
        }
    }

    double effective(const BondValues &bond, const double *history) const override
    {
      double sum = rest * bond.product;
      for (unsigned int k = 0; k < branches.size(); ++k)
        sum += branches[k].share * now(k, bond.product, history);
      return sum;
    }

    double slope(const BondValues &, const double *) const override
    {
      double sum = rest;
      for (const Branch &branch : branches)
        sum += branch.share * branch.gain;
      return sum;
    }

    /**
     * Stored: sqrt(g) p and sqrt(g_k) h_k. Dissipated, h within the step being d exp(-t/T_k) + c:
     * sqrt(g_k) times those of the square root of the integral of h^2/T_k, of two parts each.
     */
    unsigned int n_parts(const bool dissipated) const override
    {
      return dissipated ? 2 * branches.size() : 1 + branches.size();
    }

    double part(const unsigned int k,
                const bool         dissipated,
                const BondValues  &bond,
                const double      *history) const override
    {
      if (!dissipated)
        return k == 0 ? std::sqrt(rest) * bond.product :
                        branches[k - 1].root * now(k - 1, bond.product, history);
      const Branch &branch = branches[k / 2];
      if (!(branch.ratio > 0.))
        return 0.;
      const double c = (bond.product - history[0]) / branch.ratio;
      return k % 2 == 0 ? branch.of_parts[0] * (history[1 + k / 2] - c) + branch.of_parts[1] * c :
                          branch.of_parts[2] * c;
    }

    void accept(const BondValues &bond, double *history) const override
    {
      for (unsigned int k = 0; k < branches.size(); ++k)
        history[1 + k] = now(k, bond.product, history);
      history[0] = bond.product;
    }

  private:
    struct Branch
    {
      double share, time, root;  // of the share
      double decay, gain, ratio; // E, (1 - E)/r, r of the step

      std::array<double, 3> of_parts;
    };

    double now(const unsigned int k, const double product, const double *history) const
    {
      return branches[k].decay * history[1 + k] + branches[k].gain * (product - history[0]);
    }

    double              rest = 1.; // g, not below 0
    std::vector<Branch> branches;
  };
} // namespace PeriDeal
