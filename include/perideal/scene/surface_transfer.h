// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/types.h>

#include <perideal/scene/expression.h>

#include <deque>
#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  struct SurfaceTransfer;

  /**
   * A kind of condition on the sides for diffusion that prescribes no value: an entry of section
   * `Boundary conditions`, `side: formula, formula`, several separated by `;`. Here stands all that
   * is particular to it; models, balance, checks, summary and report know a SurfaceTransfer.
   */
  struct TransferKind
  {
    std::string              entry, unit, documentation;
    std::vector<std::string> formulas;    // what they are called in messages
    std::string              word;        // which stands before the formulas in summary and report
    bool                     fixes_level; // h is not zero, and with it a steady state is determined
    /** Set f, h and a from the formulas. Throws UserErrors of the entry and side @p where. */
    std::function<void(SurfaceTransfer &, const std::string &where)> set;
  };

  /** In the order of the manual. A program may add its own at the end before there is a scene. */
  std::deque<TransferKind> &transfer_kinds();

  /** The kind with this entry. */
  const TransferKind &transfer_kind(const std::string &entry);


  /**
   * What enters through one side or part where u is the diffusing quantity, per area and time,
   * positive into the body:
   *
   *   q(x, t, u) = f(x, t) + h(x) (a(x, t) - u).
   *
   * Regions and points have no area: f is the total, and kinds with h are not for them.
   */
  struct SurfaceTransfer
  {
    std::string                name; // as the user wrote it
    dealii::types::boundary_id id   = 0;
    const TransferKind        *kind = nullptr;
    std::vector<Expression>    formulas;
    Expression                 flux, coefficient, ambient; // f, h, a

    /** Throws UserError, also where h is negative or changes with time. */
    void set(const TransferKind            &kind,
             const std::vector<Expression> &formulas,
             const std::string             &where);

    bool fixes_level() const
    {
      return kind->fixes_level;
    }

    bool depends_on_time() const;

    /** Nothing ever enters. */
    bool insulates() const;

    /** The word of its kind and the formulas. */
    std::string text() const;

    /** q. */
    template <int dim>
    double entering(const dealii::Point<dim> &p, const double t, const double u) const
    {
      const double given = flux.value(p, t);
      return fixes_level() ? given + coefficient.value(p) * (ambient.value(p, t) - u) : given;
    }
  };

  /** For messages: entries that fix the level of the solution, "'Dirichlet' or 'Convection'". */
  std::string entries_that_fix_level();
} // namespace PeriDeal
