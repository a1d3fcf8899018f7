// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/bond_law.h>
#include <perideal/scene/perideal_bond_law.h>
#include <perideal/scene/user_library.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A law of bonds of the user, by the interface of perideal_bond_law.h: W x e* = W x^2 F. Its
   * answers are looked at; the first fault is kept (fault()), from which on it is not asked again
   * and bonds have no force.
   */
  class UserBondLaw : public BondLaw
  {
  public:
    /** @param library that has a law of bonds */
    UserBondLaw(std::shared_ptr<const UserLibrary> library,
                std::vector<double>                properties,
                const unsigned int                 n_states);

    unsigned int n_history() const override
    {
      return n_states;
    }

    void set_step(const double dt) override
    {
      step = dt;
    }

    bool knows_damage() const override
    {
      return true;
    }

    double effective(const BondValues &bond, const double *history) const override;
    double slope(const BondValues &bond, const double *history) const override;
    double energy(const BondValues &bond,
                  const double     *history,
                  const bool        dissipated) const override;
    void   accept(const BondValues &bond, double *history) const override;

    LawFault *fault() const override
    {
      return &first_fault;
    }

  private:
    perideal_bond_answer ask(const BondValues &bond, const double *history) const;
    /** What is wrong with an answer; empty: nothing. */
    std::string fault_of(const perideal_bond_answer &answer, const int status) const;

    const std::shared_ptr<const UserLibrary> library;
    const std::vector<double>                properties;
    const unsigned int                       n_states;
    double                                   step = 0.;
    mutable std::vector<double>              next; // states, and numbers behind them
    mutable LawFault                         first_fault;
  };
} // namespace PeriDeal
