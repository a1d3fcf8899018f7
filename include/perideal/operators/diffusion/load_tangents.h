// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/scene/boundary_conditions.h>

#include <algorithm>
#include <string>

namespace PeriDeal
{
  /**
   * The tangents of sources and of what enters through sides at the temperatures T of the last
   * take(), with h = -dq/du >= 0 there (SurfaceTransfer::slope()):
   *
   *   q(u) = q(T) + h T - h u,
   *
   * exact at T, so that iterations which take them at their last guess are those of Newton. What
   * is a line in u is its own tangent. The arguments of the constructor must outlive this.
   */
  template <int dim>
  class LoadTangents
  {
  public:
    LoadTangents(const BoundaryConditions<dim> &conditions, const Expression &source)
      : source(source)
      , is_any(source.depends_on_temperature() || depend_on_temperature(conditions.transfers))
    {}

    /** Something is no line. */
    bool any() const
    {
      return is_any;
    }

    /** The source is none. */
    bool of_source() const
    {
      return source.depends_on_temperature();
    }

    /**
     * Take those at these temperatures, which have been through distribute(u, t).
     * @param steady in search of a steady state: the first ones may be guesses
     *
     * Collective.
     */
    void take(const Vector &u, const double t, const bool steady)
    {
      constexpr unsigned int guesses = 5; // the start comes twice
      taken                          = u;
      taken.update_ghost_values();
      time     = t;
      is_guess = steady && ++n_taken <= guesses;
    }

    bool taken_at_all() const
    {
      return taken.size() > 0;
    }

    /** T, with ghosts. */
    const Vector &temperatures() const
    {
      return taken;
    }

    /** h of the source, at a place with the temperature T. */
    double slope(const dealii::Point<dim> &p, const double T) const
    {
      return std::max(0., -source.slope(p, time, T));
    }

    double slope(const SurfaceTransfer &transfer, const dealii::Point<dim> &p, const double T) const
    {
      return transfer.slope(p, time, T, is_guess);
    }

    /** q(T) + h T of the source at time t. */
    double given(const dealii::Point<dim> &p, const double t, const double T) const
    {
      const double q = source.value(p, t, T);
      return of_source() ? q + slope(p, T) * T : q;
    }

    double given(const SurfaceTransfer    &transfer,
                 const dealii::Point<dim> &p,
                 const double              t,
                 const double              T) const
    {
      return transfer.depends_on_temperature() ?
               transfer.entering(p, t, T) + slope(transfer, p, T) * T :
               transfer.entering(p, t, 0.);
    }

    /**
     * q itself, for the balance. Reports what is wrong with what the formulas give.
     * @param undershoot of undershoot_of()
     */
    double entering(const SurfaceTransfer    &transfer,
                    const dealii::Point<dim> &p,
                    const double              t,
                    const double              u,
                    const double              undershoot) const
    {
      if (transfer.depends_on_temperature())
        if (const std::string fault = transfer.fault(p, t, u, undershoot); !fault.empty())
          report_formula_error(fault);
      return transfer.entering(p, t, u);
    }

    /** By what temperatures may come out too low beside jumps of the field. Collective. */
    double undershoot_of(const Vector &u) const
    {
      constexpr double share = 0.05;
      return is_any ? share * u.linfty_norm() : 0.;
    }

  private:
    const Expression &source;
    const bool        is_any;
    Vector            taken;
    double            time     = 0.;
    unsigned int      n_taken  = 0;
    bool              is_guess = false;
  };
} // namespace PeriDeal
