// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>

namespace PeriDeal
{
  /** One bond as its law sees it, with W = V_i V_j omega f. */
  struct BondValues
  {
    double product;     // W x e, e the extension, thermal extension taken off
    double square;      // W x^2
    double damage = 0.; // mean of both ends, each from 0 (whole) to 1
    double length = 0.; // x; 0 where nobody asks

    /** e/x. */
    double stretch() const
    {
      return square > 0. ? product / square : 0.;
    }
  };


  /** What is wrong with a law, empty: nothing, and whether a shorter step may do. */
  struct LawFault
  {
    std::string text;
    bool        asks_for_less = false;
  };


  /**
   * What the extension of a bond counts as in the force of the linear peridynamic solid, in its
   * place: with W x e* of this law the bond pulls by the force spring W x e* + tau of
   * LinearPeridynamicSolid. A law may know what the bond went through: numbers of its own, which
   * are those of the last accepted step until accept() makes those of the next one. They are kept
   * by BondHistory, each set at both ends of its bond; a law itself owns none, so that a step that
   * is given up leaves nothing behind. At e = 0 without history e* is 0.
   */
  class BondLaw
  {
  public:
    virtual ~BondLaw() = default;

    /** The numbers that a bond has, at first all 0. */
    virtual unsigned int n_history() const
    {
      return 0;
    }

    /** All that follows is asked at so much time after the last accepted step, 0 or more. */
    virtual void set_step(const double /*dt*/) {}

    /** e* is linear in e, with the same slope for all bonds. */
    virtual bool is_linear() const
    {
      return false;
    }

    /**
     * The first that has been wrong with it, from which on it is not asked again until who looks
     * here clears it; null: it has no faults.
     */
    virtual LawFault *fault() const
    {
      return nullptr;
    }

    /** BondValues::damage is used. */
    virtual bool knows_damage() const
    {
      return false;
    }

    /**
     * With a linear law: the dilatation, as far as it shears, follows e* in place of e. Energies
     * are half the sums of squares of part(), which is linear in the product and the history, so
     * that these may be sums over the bonds of a node, or displacements.
     */
    virtual bool relaxes_dilatation() const
    {
      return false;
    }

    virtual unsigned int n_parts(const bool /*dissipated*/) const
    {
      return 0;
    }

    virtual double part(const unsigned int /*k*/,
                        const bool /*dissipated*/,
                        const BondValues & /*bond*/,
                        const double * /*history*/) const
    {
      return 0.;
    }

    /** W x e*. @param history n_history() numbers, of the last accepted step */
    virtual double effective(const BondValues &bond, const double *history) const = 0;

    /** The derivative of e* by e. */
    virtual double slope(const BondValues &bond, const double *history) const = 0;

    /**
     * What the bond stores, or has turned into heat since the last accepted step, over its spring:
     * 1/2 (W x e)^2 and 0 of the linear solid.
     */
    virtual double energy(const BondValues &bond,
                          const double     *history,
                          const bool        dissipated) const
    {
      double sum = 0.;
      for (unsigned int k = 0; k < n_parts(dissipated); ++k)
        {
          const double value = part(k, dissipated, bond, history);
          sum += 0.5 * value * value;
        }
      return sum;
    }

    /** The step is accepted: its numbers from the old ones. */
    virtual void accept(const BondValues & /*bond*/, double * /*history*/) const {}
  };
} // namespace PeriDeal
