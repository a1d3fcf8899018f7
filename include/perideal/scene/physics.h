// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * What a scene computes. All obey rho c du/dt = div(kappa grad u) + source with
   *
   * | | u | kappa | rho c | flux |
   * |---|---|---|---|---|
   * | heat | temperature | conductivity | density x heat capacity | heat flux |
   * | moisture | wetness | diffusivity | 1 | wetness flux |
   * | electricity | potential | electrical conductivity | capacitance; 0: steady | current |
   *
   * (wetness: concentration over saturated concentration, Diyaroglu 2017, section II.B; the flux of
   * electricity is the current density) but elasticity, whose unknown is the displacement, a
   * vector: div sigma + body force = rho d^2u/dt^2.
   */
  enum class Physics
  {
    heat,
    moisture,
    electricity,
    elasticity
  };


  /** The words of a physics in result files. */
  struct PhysicsNames
  {
    std::string physics;  // as in scenes
    std::string field;    // of the unknown
    std::string flux;     // field of the flux
    std::string content;  // what the body holds: heat, sum of C_sat w V, charge, strain energy
    std::string flow;     // what passes through sides
    std::string quantity; // what is conserved
    std::string property; // of the material that has an effective value for a body; or none
  };

  const PhysicsNames &names_of(const Physics physics);

  /**
   * One more physics, for a program that brings its own; scenes may name it from then on. Its
   * sections are those of diffusion. How it is computed: set_problem_factory(). To be called
   * once for each name, before there is a scene. Not collective.
   */
  Physics add_physics(const PhysicsNames &names);

  /** As in scenes, in the order of the enumeration. */
  std::vector<std::string> physics_choices();
} // namespace PeriDeal
