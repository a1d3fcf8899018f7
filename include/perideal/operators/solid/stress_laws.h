// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/laws/stress_law.h>
#include <perideal/scene/body_parameters.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** A law of stresses, and its parameters at places of the body. */
  template <int dim>
  struct PlacedStressLaw
  {
    /** At a place and its temperature. Not finite: none (yield_stress_fault()). */
    using Parameters = std::function<std::vector<double>(const dealii::Point<dim> &, const double)>;

    std::unique_ptr<const StressLaw> law; // null: none
    Parameters                       parameters;
    bool                             depends_on_temperature = false; // the parameters do

    /** The temperature before any has been computed; empty: 0. */
    std::function<double(const dealii::Point<dim> &)> start = {};

    std::vector<double> parameters_at_start(const dealii::Point<dim> &p) const
    {
      return parameters(p, start ? start(p) : 0.);
    }
  };


  /**
   * The law of the scene where it is one of stresses (`Law` in section `Material`), the linear one
   * of an orthotropic body or of full kinematics among them; none where it is linear else or one of
   * bonds. The body has to outlive it. Collective. Throws UserError.
   */
  template <int dim>
  PlacedStressLaw<dim> stress_law_of(const BodyParameters<dim> &body);

  /**
   * The yield stress of a place at a temperature; where it is none (yield_stress_fault()), as may
   * be at temperatures that the body never has, the largest number.
   */
  template <int dim>
  double yield_stress_of(const Material           &material,
                         const dealii::Point<dim> &p,
                         const double              temperature);

  /**
   * What is wrong with the yield stress and hardening modulus of a place at a temperature; empty:
   * nothing, or the body does not yield.
   */
  template <int dim>
  std::string yield_stress_fault(const Material           &material,
                                 const dealii::Point<dim> &p,
                                 const double              temperature);

  /** The linear law as one of stresses, likewise. */
  template <int dim>
  PlacedStressLaw<dim> linear_stress_law(const BodyParameters<dim> &body);
} // namespace PeriDeal
