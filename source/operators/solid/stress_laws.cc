// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/laws/j2_plasticity.h>
#include <perideal/laws/linear_stress.h>
#include <perideal/laws/neo_hooke.h>
#include <perideal/laws/user_stress.h>
#include <perideal/operators/coupling/nodal_family.h>
#include <perideal/operators/solid/stress_laws.h>
#include <perideal/operators/solid/thermal_strains.h>
#include <perideal/scene/orthotropy.h>
#include <perideal/scene/user_properties.h>

#include <cmath>
#include <limits>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    PlacedStressLaw<dim> j2_plasticity(const BodyParameters<dim> &body)
    {
      const Material &material = body.material;
      auto law = std::make_unique<const J2Plasticity>(stress_state_of(dim, body.elasticity.plane));
      const auto parameters = [&material, &law = *law](const Point<dim> &p, const double T) {
        return law.parameters(material.moduli(p, T),
                              yield_stress_of(material, p, T),
                              material.law.hardening.value(p, T));
      };
      return {std::move(law),
              parameters,
              material.law.yield_depends_on_temperature() || material.given.depend_on_temperature(),
              [&body](const Point<dim> &p) { return temperature_at_start(body, p); }};
    }


    template <int dim>
    PlacedStressLaw<dim> neo_hooke(const BodyParameters<dim> &body)
    {
      return {std::make_unique<const NeoHooke>(stress_state_of(dim, body.elasticity.plane)),
              [&material = body.material](const Point<dim> &p, const double) {
                const Moduli moduli = material.moduli(p); // which know no temperature
                if (!std::isfinite(moduli.bulk))
                  report_formula_error(
                    "Entry " + material.where("Poisson ratio") + ", at " + place_text(p) +
                    ": 0.5, but 'Law = hyperelastic' has a finite bulk modulus.");
                return std::vector<double>{moduli.bulk, moduli.shear};
              }};
    }


    /** Collective. */
    template <int dim>
    PlacedStressLaw<dim> user_stress(const BodyParameters<dim> &body)
    {
      const Material::Law::User &user       = body.material.law.user;
      const auto                 properties = user_properties(body.material);
      UserStress::Numbers        numbers{user.n_states, {{"MATERIAL", properties.front()}}};
      for (const std::string &phase : body.material.phases.all().names)
        numbers.materials.push_back({phase, properties[numbers.materials.size()]});
      return {
        std::make_unique<const UserStress>(UserLibrary::of_file(user.library,
                                                                body.domain.files.folder,
                                                                body.domain.files.communicator,
                                                                UserLibrary::Wanted::stresses),
                                           dim,
                                           stress_state_of(dim, body.elasticity.plane),
                                           numbers,
                                           body.elasticity.has_full_kinematics()),
        [&material = body.material](const Point<dim> &p, const double) {
          std::vector<double> parameters(3, 0.);
          for (unsigned int d = 0; d < dim; ++d)
            parameters[d] = p[d];
          parameters.push_back(material.phases.all().at(p) + 1.);
          return parameters;
        }};
    }


    /** The one list of laws of stresses. */
    template <int dim>
    const std::map<SolidLaw, PlacedStressLaw<dim> (*)(const BodyParameters<dim> &)> &makers()
    {
      static const std::map<SolidLaw, PlacedStressLaw<dim> (*)(const BodyParameters<dim> &)> list =
        {{SolidLaw::plastic, j2_plasticity<dim>},
         {SolidLaw::hyperelastic, neo_hooke<dim>},
         {SolidLaw::user, user_stress<dim>}};
      return list;
    }
  } // namespace


  template <int dim>
  PlacedStressLaw<dim> stress_law_of(const BodyParameters<dim> &body)
  {
    const Material::Law &law = body.material.law;
    if (law.kind == SolidLaw::linear &&
        (!law.orthotropy.young.empty() || body.elasticity.has_full_kinematics()))
      return linear_stress_law(body);
    const auto found = makers<dim>().find(law.kind);
    return found == makers<dim>().end() ? PlacedStressLaw<dim>() : found->second(body);
  }


  template <int dim>
  double yield_stress_of(const Material &material, const Point<dim> &p, const double temperature)
  {
    const double yields = material.law.yield_stress->value(p, temperature);
    return yields > 0. ? yields : std::numeric_limits<double>::max();
  }


  template <int dim>
  std::string yield_stress_fault(const Material   &material,
                                 const Point<dim> &p,
                                 const double      temperature)
  {
    if (!material.law.yields())
      return "";
    const bool is_weak = !(material.law.yield_stress->value(p, temperature) > 0.),
               softens = !(material.law.hardening.value(p, temperature) >= 0.);
    if (!is_weak && !softens)
      return "";
    const MaterialProperty &formula = is_weak ? *material.law.yield_stress : material.law.hardening;
    return "Entry " + material.where(is_weak ? "Yield stress" : "Hardening modulus") + ": not " +
           (is_weak ? "greater than 0" : "0 or more") + " at " + place_text(p) +
           (formula.depends_on_temperature() ? ", T = " + number_text(temperature) : "") + ".";
  }


  template <int dim>
  PlacedStressLaw<dim> linear_stress_law(const BodyParameters<dim> &body)
  {
    return {std::make_unique<const LinearStress>(),
            [&body](const Point<dim> &p, const double T) {
              return LinearStress::parameters(linear_stiffness(body, p, T));
            },
            body.material.given.depend_on_temperature(),
            [&body](const Point<dim> &p) { return temperature_at_start(body, p); }};
  }


  PERIDEAL_INSTANTIATE_FUNCTION(stress_law_of);
  PERIDEAL_INSTANTIATE_FUNCTION(linear_stress_law);
  PERIDEAL_INSTANTIATE_FUNCTION(yield_stress_of);
  PERIDEAL_INSTANTIATE_FUNCTION(yield_stress_fault);
} // namespace PeriDeal
