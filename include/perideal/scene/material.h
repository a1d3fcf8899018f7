// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/moduli.h>
#include <perideal/scene/phases.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/relaxation.h>
#include <perideal/scene/section.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Section `Material`: what diffusion takes, conductivity and storage (Density x Heat capacity) as
   * expressions of x, y, z and the temperature T; what elasticity takes, two moduli and thermal
   * expansion, likewise, density and strength as expressions of x, y, z; and in its subsection
   * `Phases` those of parts of the body. Properties that a physics does not take are read and not
   * used.
   */
  class Material : public SceneSection
  {
  public:
    Material();

    MaterialProperty conductivity, density, heat_capacity, saturated_concentration;
    bool             stores = true; // the storage is not 0
    InterfaceRule    interface_rule;
    Phases           phases;

    MaterialProperty                thermal_expansion; // strain per temperature
    std::optional<MaterialProperty> fracture_energy;   // per area; not both
    std::optional<MaterialProperty> critical_stretch;

    /** Of the critical stretch from node to node. */
    struct Scatter
    {
      double       modulus = 0.; // of Weibull's distribution
      unsigned int seed    = 0;
    };
    std::optional<Scatter> scatter;

    /** How forces follow from what the body has gone through. */
    struct Law
    {
      SolidLaw                        kind;
      std::vector<Relaxation>         relaxation; // viscoelastic
      Expression                      bond_force; // formula: of the stretch s and the damage
      Softening                       softening;
      std::optional<MaterialProperty> tensile_strength;
      std::optional<MaterialProperty> yield_stress; // plastic
      MaterialProperty                hardening;    // of the yield stress over plastic strain

      /** When bonds break, besides Fracture energy or Critical stretch. */
      struct Breaking
      {
        BreakCriterion                  criterion = BreakCriterion::stretch;
        std::optional<MaterialProperty> critical_stress;
        std::optional<MaterialProperty> unbreakable; // greater than 0 where bonds never break
        std::optional<Expression>       rate_factor; // of limits, by the rate of the stretch

        bool by_stress() const
        {
          return criterion == BreakCriterion::principal_stress ||
                 criterion == BreakCriterion::von_mises;
        }
      } breaking;

      /** A shared library with a law of stresses or of bonds. */
      struct User
      {
        std::string         library;
        std::vector<double> properties;
        unsigned int        n_states = 0;
        bool                of_bonds = false; // set before parse()
      } user;

      /**
       * Three axes of symmetry: Young's moduli along them; shear moduli and Poisson ratios of 12,
       * 13, 23, those of the plane alone where that is enough; by which angles the axes are turned,
       * in degrees. Empty: the body is isotropic.
       */
      struct Orthotropy
      {
        std::vector<MaterialProperty> young, shear, poisson, angles;
      } orthotropy;

      /** What breaks between two phases, by their numbers in Phases::all(); -1: the rest. */
      struct Interface
      {
        std::array<int, 2>    phases;
        double                fracture_energy;
        std::optional<double> tensile_strength; // of bonds that soften
      };
      std::vector<Interface> interfaces;

      /** J2 plasticity. */
      bool yields() const
      {
        return kind == SolidLaw::plastic;
      }

      bool yield_depends_on_temperature() const
      {
        return yields() &&
               (yield_stress->depends_on_temperature() || hardening.depends_on_temperature());
      }

      /** Bonds lose their force little by little. */
      bool softens() const
      {
        return kind == SolidLaw::softening;
      }
    } law;

    /** Bonds may break. */
    bool breaks() const
    {
      return fracture_energy || critical_stretch || law.breaking.critical_stress;
    }

    bool uniform_conductivity() const
    {
      return conductivity.is_constant();
    }

    /** rho c at a point. */
    template <int dim>
    double storage(const dealii::Point<dim> &p, const double temperature = 0.) const;

    /** T is in a formula of the storage, or in one of this or the conductivity. */
    bool storage_depends_on_temperature() const;
    bool depends_on_temperature() const;

    /**
     * Elasticity only, at a temperature, which matters where T is in their formulas. Throws
     * the UserError of formulas whose values are out of range at the point, or defers it
     * (report_formula_error()). What knows the body asks it (BodyParameters::moduli()).
     */
    template <int dim>
    Moduli moduli(const dealii::Point<dim> &p, const double temperature = 0.) const;

    /** For programs: two moduli of a body without phases, numbers or functions of x, y, z. */
    void set_moduli(const Modulus     a,
                    const Expression &value_a,
                    const Modulus     b,
                    const Expression &value_b);

    /** The same moduli in the whole body, given by numbers. */
    bool uniform_moduli() const
    {
      return given.are_uniform();
    }

    /**
     * The storage may be 0 with electricity only, which is then steady. With elasticity exactly two
     * moduli are needed, in one dimension the Young modulus alone will do.
     *
     * @param plane of elasticity in two dimensions: in plane stress the Poisson ratio may be 1/2
     * @param image whose phases are phases of the material, or null
     * @param needs_storage something changes in time: density and heat capacity (elasticity:
     *                      density) have to be greater than 0, else they may be 0
     */
    void parse(const Physics                          physics       = Physics::heat,
               const unsigned int                     dim           = 2,
               const PlaneState                       plane         = PlaneState::stress,
               const std::shared_ptr<const PhaseMap> &image         = nullptr,
               const bool                             needs_storage = true);

    /**
     * Of an elastic body whose temperature changes in time: what parse() has allowed to be 0 must
     * not be. Throws UserError.
     */
    void require_storage();

    /** Two moduli, of which the others follow. */
    struct GivenModuli
    {
      std::array<Modulus, 2>          which{{Modulus::bulk, Modulus::shear}};
      std::array<MaterialProperty, 2> properties;
      bool                            may_be_incompressible = false;

      bool are_uniform() const;

      /** T is in some formula. */
      bool depend_on_temperature() const
      {
        return properties[0].depends_on_temperature() || properties[1].depends_on_temperature();
      }

      /** What is wrong with two numbers, or nothing. */
      std::string fault(const double value_a, const double value_b) const;
    };

    GivenModuli given; // set by parse() or set_moduli()

  private:
    Expression read(const std::string &entry, const Physics physics) const;

    std::optional<MaterialProperty> optional_property(const std::string &entry,
                                                      const Physics      physics) const;

    void parse_breaking(const Physics physics);

    void parse_moduli(const unsigned int dim, const PlaneState plane);
  };


  /** The entry that gives the limit of bonds. */
  inline std::string name_of_limit(const Material &material)
  {
    return material.fracture_energy              ? "Fracture energy" :
           material.law.breaking.critical_stress ? "Critical stress" :
                                                   "Critical stretch";
  }


  /** The formula of that entry, of bonds that break. */
  inline const MaterialProperty &limit_of_bonds(const Material &material)
  {
    return material.fracture_energy              ? *material.fracture_energy :
           material.law.breaking.critical_stress ? *material.law.breaking.critical_stress :
                                                   *material.critical_stretch;
  }


  /** Section `Initial and source`. */
  class InitialAndSource : public SceneSection
  {
  public:
    InitialAndSource();

    Expression initial_value, source;
    std::vector<Expression>
      body_force; // elasticity: one formula of x, y, z, t per component, or none
    std::vector<Expression> initial_displacement,
      initial_velocity; // of x, y, z per component, or none

    /**
     * @param with_heat elasticity with a computed temperature, which has an initial value and a
     *                  source, too
     */
    void parse(const Physics      physics   = Physics::heat,
               const unsigned int dim       = 2,
               const bool         with_heat = false);
  };
} // namespace PeriDeal
