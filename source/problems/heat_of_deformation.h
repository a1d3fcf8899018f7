// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/types.h>

#include <functional>

namespace PeriDeal
{
  template <int dim>
  struct Scene;

  template <int dim>
  class SolidProblem;

  /** Of the owned nodes, what its heat problem has found less `Reference temperature`. */
  template <int dim>
  Vector computed_temperature_change(const SolidProblem<dim> &solid);


  /**
   * The heat that a body at rest releases when it is compressed and takes up when it expands,
   *
   *     rho c dT/dt = div k grad T + q - T0 d(beta theta)/dt,
   *
   * beta theta that of entropy_of_deformation(), T0 the absolute temperature of the unstressed
   * body: the heat equation of linear thermoelasticity (Biot 1956), with c at constant strain.
   *
   * In each step the body first conducts as it is deformed, then deforms without conduction: node i
   * with the capacity C_i gets C_i dT_i = -T0 dS_i, S_i the integral of beta theta over its volume.
   * That is the adiabatic split, of first order in the step, and no step makes it unstable (Armero
   * and Simo 1992). Equilibria and temperatures are found by turns until they agree. All functions
   * are collective.
   */
  template <int dim>
  class HeatOfDeformation
  {
  public:
    /** Throws UserError where temperatures cannot be changed node by node. Not collective. */
    static void require(const Scene<dim> &scene);

    /** The body is in its first equilibrium: what has deformed it before releases nothing. */
    void begin(const SolidProblem<dim> &solid);

    /**
     * The body is in an equilibrium at time t, found with the temperatures of its heat problem: add
     * what it has released on the way, and find both again.
     * @param renew the equilibrium, with temperatures as they are. Throws UserError.
     */
    void add(const SolidProblem<dim> &solid, const double t, const std::function<void()> &renew);

    /**
     * Since the start, of the whole body. What nodes of a given temperature release leaves the
     * body there at once; it counts here, and not in what has entered.
     */
    double released() const
    {
      return set_free;
    }

    void exchange(Archive &archive, const SolidProblem<dim> &solid, const NodeKeys &keys);

  private:
    Vector counted; // S_i of the owned nodes for which heat has been released
    double set_free = 0.;
  };
} // namespace PeriDeal
