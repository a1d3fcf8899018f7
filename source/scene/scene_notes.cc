// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What is allowed, but rarely meant.

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "scene_checks.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** `5.09e+03 m/s`. */
    template <int dim>
    std::string speed_text(const double speed, const Scene<dim> &scene)
    {
      return rounded_text(speed) + " " + scene.units.length + "/" + scene.units.time;
    }


    /**
     * Of waves in a bar of the material in the middle of the box; NaN where a formula has no value
     * there.
     */
    template <int dim>
    double wave_speed(const Scene<dim> &scene, const Point<dim> &middle)
    {
      // Of a mesh from a file neither the place nor, in its regions, the material is known yet.
      if (!scene.domain.has_lattice() || scene.material.law.kind == SolidLaw::user)
        return std::numeric_limits<double>::quiet_NaN();
      try
        {
          return std::sqrt(scene.moduli(middle).young() / scene.material.density.value(middle));
        }
      catch (const UserError &)
        {
          return std::numeric_limits<double>::quiet_NaN();
        }
    }


    /** A body in motion whose density nobody has given: bodies without units do well with 1. */
    template <int dim>
    void note_density(Scene<dim> &scene, const double speed)
    {
      if (scene.material.phases.gives("Density") || scene.material.is_given("Density"))
        return;
      scene.domain.notes.push_back(
        "'Density' in section 'Material' is 1, its default" +
        (std::isfinite(speed) ? ", with which waves run at about " + speed_text(speed, scene) :
                                std::string()) +
        ". Give that of the material; '1.0' says that 1 is meant.");
    }


    /**
     * The largest speed at which sides are moved or the body begins, as far as it is known at t
     * = 0.
     */
    template <int dim>
    double given_speed(const Scene<dim> &scene, const Point<dim> &middle)
    {
      double     largest = 0.;
      const auto add     = [&](const auto &components) {
        double square = 0.;
        for (const std::optional<Expression> &value : components)
          try
            {
              square += value ? std::pow(value->value(middle, 0.), 2) : 0.;
            }
          catch (const UserError &) // no number there
            {}
        largest = std::max(largest, std::sqrt(square));
      };
      for (const VectorCondition &condition : scene.boundary_conditions.displacement)
        if (condition.rate)
          add(condition.values);
      const auto &start = scene.initial_and_source.initial_velocity;
      add(std::vector<std::optional<Expression>>(start.begin(), start.end()));
      return largest;
    }


    template <int dim>
    void note_motion(Scene<dim> &scene)
    {
      const Point<dim> middle =
        scene.domain.lower + 0.5 * (scene.domain.upper - scene.domain.lower);
      const double waves = wave_speed(scene, middle);
      note_density(scene, waves);
      const double given = given_speed(scene, middle);
      if (given > waves)
        scene.domain.notes.push_back(
          "a velocity of " + speed_text(given, scene) + " is given, but waves run at about " +
          speed_text(waves, scene) +
          ": nothing is elastic at such speeds. Check the units of 'Velocity', 'Initial velocity', 'Density' and the moduli.");
    }


    /** Wetness is a concentration over the saturated one. */
    template <int dim>
    void note_wetness(Scene<dim> &scene)
    {
      const auto note = [&](const Expression &value, const std::string &what) {
        if (!value.is_constant())
          return;
        const double wetness = value.value(Point<dim>());
        if (wetness >= 0. && wetness <= 1.)
          return;
        scene.domain.notes.push_back(
          what + " is a wetness of " + number_text(wetness) +
          ", but wetness, the concentration over 'Saturated concentration' (section 'Material'), is from 0 to 1 in bodies. Divide concentrations by the saturated one, percent by 100; "
          "the results are in proportion in any case.");
      };
      note(scene.initial_and_source.initial_value, scene.initial_and_source.where("Initial value"));
      for (const SideCondition &condition : scene.boundary_conditions.dirichlet)
        note(condition.value,
             scene.boundary_conditions.where("Dirichlet") + ", side '" + condition.name + "',");
    }


    /** Which quantity is continuous where materials of other saturated concentrations meet. */
    template <int dim>
    void note_saturation(Scene<dim> &scene)
    {
      const Material &material = scene.material;
      const auto      is_one   = [](const MaterialProperty &property) {
        return property.is_constant() && property.value(Point<dim>()) == 1.;
      };
      if (material.saturated_concentration.is_constant() || // with 'Diffusivity' it is the density
          !is_one(material.density) || !is_one(material.heat_capacity))
        return;
      scene.domain.notes.push_back(
        material.where("Saturated concentration") +
        " varies, and is for the concentration field and the weight alone here: the wetness w, concentration over saturated one, is continuous, its flux is "
        "-'Conductivity' grad(w), and each volume stores w. Where 'Conductivity' is meant as the diffusivity D of a flux -D grad(concentration), as in programs of mass diffusion, "
        "give it as 'Diffusivity' instead: the body then conducts D x 'Saturated concentration' and stores 'Saturated concentration'.");
    }


    /** Exchange of cells for bonds asks for the cells on a bond's way, not for its two nodes. */
    template <int dim>
    void note_interface_rule(Scene<dim> &scene)
    {
      std::vector<std::string> models;
      if (runs(scene, ModelKind::peridynamics) &&
          scene.peridynamics.treatment == BoundaryTreatment::exchange)
        models.emplace_back(
          "peridynamics ('Boundary treatment = exchange' in section 'Peridynamics')");
      if (runs(scene, ModelKind::coupled) && scene.coupling.exchanges())
        models.emplace_back("coupled ('Scheme = exchange' in section 'Coupling')");
      if (!models.empty() && scene.material.is_given("Interface rule"))
        scene.domain.notes.push_back(
          scene.material.where("Interface rule") + " has no effect on " + join_names(models) +
          ": a bond has the smallest conductivity of the cells on its way there, and where that jumps by more than a factor of 1.5 "
          "cells conduct in its place, so that layers are exact. The rule is for bonds alone.");
    }


    /** Parts that no condition names. */
    template <int dim>
    void note_unused_parts(Scene<dim> &scene)
    {
      const BoundaryConditions<dim> &conditions = scene.boundary_conditions;
      std::vector<std::string>       unused;
      std::set<types::boundary_id>   used;
      conditions.for_each([&](const auto &, const auto &condition) { used.insert(condition.id); });
      for (const Part &part : conditions.parts)
        if (used.count(part.id) == 0)
          unused.push_back("'" + part.name + "'");
      if (!unused.empty())
        scene.domain.notes.push_back(
          conditions.where("Parts") + ": no condition is on " + join_names(unused) + ", which " +
          (unused.size() == 1 ? "has" : "have") + " no effect. Name " +
          (unused.size() == 1 ? "it" : "them") + " in a condition, or leave " +
          (unused.size() == 1 ? "it" : "them") + " out.");
    }
  } // namespace


  template <int dim>
  void note_doubtful_entries(Scene<dim> &scene)
  {
    if (scene.general.physics == Physics::elasticity && !scene.elasticity.is_static())
      note_motion(scene);
    if (scene.general.physics == Physics::moisture)
      {
        note_wetness(scene);
        note_saturation(scene);
      }
    if (!scene.deforms)
      note_interface_rule(scene);
    note_unused_parts(scene);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(note_doubtful_entries);
} // namespace PeriDeal
