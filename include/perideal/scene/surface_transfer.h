// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/types.h>

#include <perideal/scene/expression.h>

#include <cmath>
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
    bool only_of_heat = false; // temperatures have an absolute zero
  };

  /** In the order of the manual. A program may add its own at the end before there is a scene. */
  std::deque<TransferKind> &transfer_kinds();

  /** The kind with this entry. */
  const TransferKind &transfer_kind(const std::string &entry);


  /**
   * What enters through one side or part where u is the diffusing quantity, per area and time,
   * positive into the body:
   *
   *   q(x, t, u) = f + h (a - u) + e sigma ((r - z)^4 - (u - z)^4),
   *
   * f and a of x, t and h of x, the last term that of radiation with the emissivity e, the
   * temperature r of the surroundings and the absolute zero z. Formulas may know u, too, as T; with
   * one that does, or with radiation, q is no line, and models take its tangent at the temperatures
   * of their last take_material_at().
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
    Expression                 emissivity, surroundings;   // e, r
    double                     absolute_zero = 0.;         // z; to be given before set()
    bool                       radiates      = false;

    /** Throws UserError, also where h is negative or changes with time. */
    void set(const TransferKind            &kind,
             const std::vector<Expression> &formulas,
             const std::string             &where);

    bool fixes_level() const
    {
      return kind->fixes_level || depends_on_temperature();
    }

    /** q is no line in u. */
    bool depends_on_temperature() const
    {
      return is_curved;
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
      const double given = flux.value(p, t, u);
      if (!kind->fixes_level)
        return given;
      const double line = given + coefficient.value(p, t, u) * (ambient.value(p, t, u) - u);
      return radiates ? line + emissivity.value(p, t, u) * black_flux(p, t, u) : line;
    }

    /**
     * The h of a line f + h (a - u) to be taken for q at places with values near u: -dq/du, but not
     * less than 0, where q grows with u. A side that radiates takes up next to nothing more or less
     * per degree where it is cold: of guesses of steady states, colder than the surroundings,
     * it is that of the chord to them, and of one at the absolute zero, that of 1 K.
     */
    template <int dim>
    double slope(const dealii::Point<dim> &p,
                 const double              t,
                 const double              u,
                 const bool                is_guess) const;

    /**
     * What is wrong with what the formulas give at a place with the value u, which radiation takes
     * from the absolute zero on, less @p undershoot (of models that overshoot there); or nothing.
     */
    template <int dim>
    std::string fault(const dealii::Point<dim> &p,
                      const double              t,
                      const double              u,
                      const double              undershoot = 0.) const;

  private:
    /** sigma ((r - z)^4 - (u - z)^4), odd in u - z, which may become negative on the way. */
    template <int dim>
    double black_flux(const dealii::Point<dim> &p, const double t, const double u) const
    {
      return radiation(surroundings.value(p, t) - absolute_zero) - radiation(u - absolute_zero);
    }

    /** Of a black body, by its absolute temperature: that of CODATA 2018 in W/(m2 K4). */
    static double radiation(const double temperature)
    {
      constexpr double sigma = 5.670374419e-8;
      return sigma * temperature * temperature * temperature * std::abs(temperature);
    }

    bool is_curved = false;
  };

  /** Some transfer is no line in the temperature. */
  bool depend_on_temperature(const std::vector<SurfaceTransfer> &transfers);

  /** For messages: entries that fix the level of the solution, "'Dirichlet' or 'Convection'". */
  std::string entries_that_fix_level();
} // namespace PeriDeal
