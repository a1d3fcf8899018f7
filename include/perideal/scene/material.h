// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/phases.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/section.h>

namespace PeriDeal
{
  /**
   * Section `Material`: conductivity and storage (Density x Heat capacity) as expressions of x, y,
   * z and the temperature T, and in its subsection `Phases` those of parts of the body.
   */
  class Material : public SceneSection
  {
  public:
    Material();

    MaterialProperty conductivity, density, heat_capacity, saturated_concentration;
    bool             stores         = true; // the storage is not 0
    InterfaceRule    interface_rule = InterfaceRule::arithmetic;
    Phases           phases;

    bool uniform_conductivity() const;

    /** rho c at a point. */
    template <int dim>
    double storage(const dealii::Point<dim> &p, const double temperature = 0.) const;

    /** T is in a formula of the storage, or in one of this or the conductivity. */
    bool storage_depends_on_temperature() const;
    bool depends_on_temperature() const;

    /** The storage may be 0 with electricity only, which is then steady. */
    void parse(const Physics physics = Physics::heat);
  };


  /** Section `Initial and source`. */
  class InitialAndSource : public SceneSection
  {
  public:
    InitialAndSource();

    Expression initial_value, source;

    void parse();
  };
} // namespace PeriDeal
