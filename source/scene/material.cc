// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/material.h>
#include <perideal/scene/orthotropy.h>
#include <perideal/scene/user_properties.h>
#include <perideal/scene/vector_conditions.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

// The two moduli of section `Material`.

namespace PeriDeal
{
  namespace
  {
    /** The property that is the product of both in each phase. */
    MaterialProperty product(const MaterialProperty &a,
                             const MaterialProperty &b,
                             const Phases           &phases)
    {
      const auto in_phase = [&](const int phase) {
        return Expression("(" + a.formula(phase).text() + ") * (" + b.formula(phase).text() + ")",
                          "'Diffusivity' times 'Saturated concentration' in section 'Material'",
                          "x, y, z, T",
                          true);
      };
      if (!phases.gives("Diffusivity") && !phases.gives("Saturated concentration"))
        return in_phase(-1);
      std::vector<std::optional<Expression>> of_phases(phases.all().names.size());
      for (unsigned int k = 0; k < of_phases.size(); ++k)
        of_phases[k] = in_phase(k);
      return {in_phase(-1), std::make_shared<const Regions>(phases.all()), of_phases};
    }

    // Of what entries say.
    const std::string two =
      " T is for `Law = linear` and `plastic`. Elasticity needs exactly two of the four moduli, in 1D or the Young modulus alone; they are those of the three-dimensional solid, also in 1D and 2D.";
    const std::string formula = ": a number or a formula of x, y, z.";
    const std::string of_warmth =
      ": a number or a formula of x, y, z and T, the temperature where it is computed, else the Temperature change that is given (section `Elasticity`).";
    const std::string of_changes =
      ": a number or a formula of x, y, z, the time t and T, the temperature where it is computed, else the Temperature change that is given (section `Elasticity`).";

    /** An entry whose text the section itself reads. */
    struct PlainEntry
    {
      std::string name;
      EntryType   type;
      std::string default_text, unit, words;
    };


    const std::vector<PlainEntry> &entries_of_laws()
    {
      static const std::vector<PlainEntry> list = {
        {"Critical stress",
         EntryType::formula,
         "",
         "force/length^2",
         "With `Criterion = principal stress` or `von mises`: the stress at which bonds break" +
           of_changes},
        {"Unbreakable",
         EntryType::formula,
         "0",
         "1",
         "Bonds with an end where this is greater than 0 never break, by whatever criterion: grips, supports, what is beneath a load" +
           formula +
           " Of a phase: `name: 1` in `Phases`. Cracks of section `Cracks` cut them all the same."},
        {"Rate factor",
         EntryType::formula,
         "1",
         "1",
         "In motion: by how much the limit at which a bond breaks grows with the rate at which it is stretched, a formula of `rate` (1/time) with the value 1 at 0, as in `1 + 0.05*log(1 + rate/10)`. 1 or more."},
        {"Tensile strength",
         EntryType::formula,
         "",
         "force/length^2",
         "With `Law = softening`: the stress at which a row of bonds begins to open" + formula +
           " The area under stress over opening is Fracture energy."},
        {"Relaxation",
         EntryType::list,
         "",
         "1, time",
         "With `Law = viscoelastic`: a Prony series, `share, time` for each term, several separated by `;`. The shear modulus at once is that of the moduli; each share of it fades with exp(-t/time). A time is that of the section `Time`."},
        {"Bond force",
         EntryType::formula,
         "",
         "1",
         "With `Law = formula`: of the stretch s of a bond and the damage of its ends, from 0 to 1, in units of the force of the linear law at s = 1: `s` is the linear law. 0 at s = 0."},
        {"User law",
         EntryType::text,
         "",
         "",
         "With `Law = user`: a shared library, or its source in Fortran or C, which is compiled by gfortran or cc (FC, CC); its path, or that beside the scene. For finite elements and `Model = correspondence` it has a `umat_` (Abaqus' arguments; strains are small, or those of `Kinematics = full`), with the moduli, too. For `state-based` and `bond-based` bonds it has a `perideal_bond_law`, by the header perideal_bond_law.h, and moduli are those of the scene."},
        {"User properties",
         EntryType::list,
         "",
         "of the law",
         "With `Law = user`: the numbers of the law (PROPS), separated by commas."},
        {"User states",
         EntryType::whole_number,
         "0",
         "1",
         "With `Law = user`: how many numbers the law keeps at a point (STATEV), which fields `state_1`, `state_2`, ... show, or of a bond."},
        {"Interfaces",
         EntryType::list,
         "",
         "energy/length^2, force/length^2",
         "Elasticity: what breaks between two phases of `Phases`, `name/name: fracture energy G`, with `Law = softening` also `, tensile strength f`; several separated by `;`. All bonds that lead from one to the other have these in place of those of the phases. `elsewhere` is what no region holds. Two phases may have the same moduli: a weak plane in one material."}};
      return list;
    }
  } // namespace


  Material::Material()
    : SceneSection("Material")
  {
    const auto entry = [&](const std::string &name,
                           const std::string &default_text = "") -> std::string & {
      return declare(name, EntryType::formula, default_text, material_entry(name).unit);
    };
    entry("Conductivity", "1") =
      "Thermal conductivity, diffusivity (moisture) or electrical conductivity: a number or a formula of x, y, z and T, the temperature (wetness, potential) itself.";
    entry("Diffusivity") =
      "Moisture only, in place of Conductivity: D of the flux -D grad C of the concentration C = Saturated concentration x wetness in each material. Conductivity is then Diffusivity x Saturated concentration, and the body stores Saturated concentration per wetness, so that flows and amounts are masses. A number or a formula of x, y, z and T, the wetness.";
    entry("Density", "1") =
      "Ignored when steady, and by elasticity unless its solver is `dynamics`; may be 0 then. A motion with the default is told in a note; `1.0` says that 1 is meant.";
    entry("Heat capacity", "1") =
      "Per mass; the body stores Density x Heat capacity, either a number or a formula of x, y, z, T. Ignored when steady, and may be 0 then. With electricity their product is the capacitance per volume, and 0 means a steady state.";
    entry("Saturated concentration", "1") =
      "Moisture only: the concentration at wetness 1, a number or a formula of x, y, z. With Conductivity it is for the concentration field and the weight alone, and the flux is -Conductivity x grad(wetness); with Diffusivity it is part of the conductivity and the storage. The wetness is continuous where it jumps.";
    declare(interface_rule, "Interface rule", "arithmetic", {"minimum", "arithmetic", "harmonic"}) =
      "Conductivity of a bond between unequal nodes: the smaller value, the mean, or the harmonic mean by the length of the bond in each phase.";
    entry("Bulk modulus")  = "Pressure per relative change of volume" + of_warmth + two;
    entry("Shear modulus") = "Shear stress per change of angle" + of_warmth + two;
    entry("Young modulus") = "Stress per strain of a bar" + of_warmth + two;
    entry("Poisson ratio") =
      "Contraction of a bar per its extension" + of_warmth +
      " Greater than -1 and less than 0.5; in plane stress and in bars it may be 0.5." + two;
    for (const OrthotropicEntry &of : orthotropic_entries())
      declare(of.name, EntryType::list, of.name == "Material angle" ? "0" : "", of.unit) =
        of.words +
        " Numbers or formulas of x, y, z; with `Law = linear`, in finite elements and correspondence.";
    entry("Thermal expansion", "0") =
      "Strain per `Temperature change`, the mean coefficient from the reference temperature to T" +
      of_warmth;
    entry("Fracture energy") =
      "Energy per area of a new crack" + of_changes +
      " The stretch (or Criterion) at which bonds break follows from it. Without this and Critical stretch they do not break.";
    entry("Critical stretch") =
      "Relative extension at which a bond breaks, instead of Fracture energy" + of_changes;
    declare(law.breaking.criterion, // its other entries: entries_of_laws()
            "Criterion",
            "stretch",
            {"stretch", "energy", "principal stress", "von mises"}) =
      "When a bond breaks. `stretch`: by Critical stretch or Fracture energy; `energy`: when what it has stored exceeds its share of Fracture energy (in peridynamics, not with `correspondence`); `principal stress`, `von mises`: when the mean of that stress at both of its ends exceeds Critical stress (in peridynamics). Always only bonds that are stretched.";
    declare(law.kind,
            "Law",
            "linear",
            {"linear", "viscoelastic", "plastic", "softening", "formula", "hyperelastic", "user"}) =
      "Elasticity: how forces follow from what the body goes through. `viscoelastic`: the shear modulus relaxes (`Relaxation`), the bulk modulus does not; `plastic`: the body yields at a von Mises stress (`Yield stress`, `Hardening modulus`; J2 with isotropic hardening); `softening`: bonds lose their force little by little from the tensile strength on (`Tensile strength`, `Fracture energy`, `Softening`), as concrete does; `formula`: by a formula of your own (`Bond force`); `hyperelastic`: rubber, a compressible neo-Hookean body of the two moduli, in finite elements and correspondence with `Kinematics = full` (section `Elasticity`); `user`: by a program of your own (`User law`), a UMAT in finite elements and correspondence, a law of bonds in `state-based` and `bond-based` peridynamics.";
    entry("Yield stress") =
      "With `Law = plastic`: the von Mises stress from which on the body yields" + of_warmth +
      " A phase that shall stay elastic gets a large one.";
    entry("Hardening modulus", "0") =
      "With `Law = plastic`: by how much the yield stress grows per equivalent plastic strain" +
      of_warmth + " 0 or more.";
    declare(law.softening, "Softening", "exponential", {"linear", "bilinear", "exponential"}) =
      "With `Law = softening`: the stress over the opening. `bilinear` has its kink at a third of the strength (Petersson's, for concrete).";
    for (const PlainEntry &of : entries_of_laws())
      declare(of.name, of.type, of.default_text, of.unit) = of.words;
    declare("Weibull modulus", EntryType::text, "", "1") =
      "The critical stretch of each node, given or that of its Fracture energy, is multiplied by a number from Weibull's distribution with this modulus and mean 1; a bond breaks at the smaller value of its ends. Needs Strength seed. Empty: no scatter.";
    declare("Strength seed", EntryType::text) =
      "With Weibull modulus: which of the possible bodies. The same seed gives the same nodes the same numbers, on any number of processes.";
    parse();
  }


  template <int dim>
  double Material::storage(const dealii::Point<dim> &p, const double temperature) const
  {
    return density.value(p, temperature) * heat_capacity.value(p, temperature);
  }


  bool Material::storage_depends_on_temperature() const
  {
    return density.depends_on_temperature() || heat_capacity.depends_on_temperature();
  }


  bool Material::depends_on_temperature() const
  {
    return conductivity.depends_on_temperature() || storage_depends_on_temperature();
  }


  Expression Material::read(const std::string &entry, const Physics physics) const
  {
    const bool capacity   = entry == "Heat capacity",
               may_vanish = (capacity &&
                             (physics == Physics::electricity || physics == Physics::elasticity)) ||
                            (!phases.needs_storage && (capacity || entry == "Density"));
    return material_formula(text(entry),
                            material_entry(entry),
                            physics == Physics::elasticity,
                            may_vanish,
                            where(entry));
  }


  std::optional<MaterialProperty> Material::optional_property(const std::string &entry,
                                                              const Physics      physics) const
  {
    if (!text(entry).empty())
      return phases.property(entry, read(entry, physics));
    if (phases.gives(entry))
      error(
        entry,
        "is empty, but section 'Material/Phases' gives it for some phases: give it for the rest of the body, too.");
    return {};
  }


  namespace
  {
    /** Entries of a criterion, or that another one has not. */
    void refuse_criterion(const Material &material)
    {
      const Material::Law::Breaking &breaking = material.law.breaking;
      const std::string              name     = "'Criterion = " + material.text("Criterion") + "'",
                        stress = "Critical stress", energy = "Fracture energy",
                        stretch = "Critical stretch";
      material.refuse(breaking.critical_stress && !breaking.by_stress(),
                      stress,
                      "is for 'Criterion = principal stress' and 'von mises'; 'Criterion' is '" +
                        material.text("Criterion") + "'. Leave one of them out.");
      material.refuse(breaking.by_stress() && !breaking.critical_stress,
                      stress,
                      "is empty, which " + name + " needs.");
      material.refuse(breaking.by_stress() && material.fracture_energy,
                      energy,
                      "has no effect with " + name + ", which takes 'Critical stress'.");
      material.refuse(breaking.criterion != BreakCriterion::stretch && material.critical_stretch,
                      stretch,
                      "has no effect with " + name + ", which takes '" +
                        (breaking.by_stress() ? stress : energy) + "'.");
      material.refuse(breaking.criterion == BreakCriterion::energy && !material.fracture_energy,
                      energy,
                      "is empty, which " + name + " needs.");
      material.refuse(
        breaking.criterion != BreakCriterion::stretch && material.law.softens(),
        "Criterion",
        "found '" + material.text("Criterion") +
          "', but bonds of 'Law = softening' soften by their stretch. Leave one of them out.");
      material.refuse(breaking.criterion == BreakCriterion::energy &&
                        material.law.kind != SolidLaw::linear,
                      "Criterion",
                      "found 'energy', which is what bonds of 'Law = linear' store; 'Law' is '" +
                        material.text("Law") + "'. Use another criterion.");
      material.refuse(breaking.criterion != BreakCriterion::stretch &&
                        material.is_given("Interfaces"),
                      "Interfaces",
                      "break by the stretch of their bonds; 'Criterion' is '" +
                        material.text("Criterion") + "'. Leave one of them out.");
      if (breaking.rate_factor)
        {
          const double at_rest = breaking.rate_factor->value(dealii::Point<1>());
          material.refuse(std::abs(at_rest - 1.) > 1e-12,
                          "Rate factor",
                          "is " + number_text(at_rest) +
                            " at a rate of 0, needs 1 there: limits are those of slow loads.");
          material.refuse(
            material.law.softens(),
            "Rate factor",
            "is for bonds that break at once; those of 'Law = softening' soften. Leave one of them out.");
        }
      material.refuse(
        (breaking.unbreakable || breaking.rate_factor) && !material.breaks(),
        breaking.unbreakable ? "Unbreakable" : "Rate factor",
        "is for bodies whose bonds break: give 'Fracture energy', 'Critical stretch' or 'Critical stress', too, or leave it out.");
    }
  } // namespace


  void Material::parse_breaking(const Physics physics)
  {
    fracture_energy              = optional_property("Fracture energy", physics);
    critical_stretch             = optional_property("Critical stretch", physics);
    law.breaking.critical_stress = optional_property("Critical stress", physics);
    refuse(fracture_energy && critical_stretch,
           "Critical stretch",
           "'Fracture energy' is given, too: give one of the two.");
    law.breaking.unbreakable.reset();
    if (is_given("Unbreakable") || phases.gives("Unbreakable"))
      law.breaking.unbreakable = phases.property("Unbreakable", read("Unbreakable", physics));
    law.breaking.rate_factor.reset();
    if (is_given("Rate factor"))
      law.breaking.rate_factor = Expression(text("Rate factor"), where("Rate factor"), "rate");
    refuse_criterion(*this);
    scatter.reset();
    const bool modulus = !text("Weibull modulus").empty(), seed = !text("Strength seed").empty();
    refuse(
      modulus && !breaks(),
      "Weibull modulus",
      "is for bonds that break: give 'Fracture energy', 'Critical stretch' or 'Critical stress', too, or leave it out.");
    refuse(
      modulus && !seed,
      "Strength seed",
      "is empty, but 'Weibull modulus' is given: give a whole number, so that the body is the same each time.");
    refuse(seed && !modulus,
           "Strength seed",
           "has no effect without 'Weibull modulus': give that one, too, or leave the entry out.");
    refuse(modulus && !(parse_number(text("Weibull modulus"), where("Weibull modulus")) >= 0.5),
           "Weibull modulus",
           "found " + text("Weibull modulus") +
             ", needs a number greater than 0, of at least 0.5 (real bodies have 2 to 50).");
    if (modulus)
      scatter =
        Scatter{parse_number(text("Weibull modulus"), where("Weibull modulus")),
                parse_whole_number(text("Strength seed"), where("Strength seed"), 2147483647u)};
  }


  namespace
  {
    /** "fracture energy 10", in the text of an interface. */
    std::optional<double> value_behind(const std::string &name,
                                       const std::string &text,
                                       const std::string &where)
    {
      if (text.compare(0, name.size(), name) != 0)
        return {};
      const double value = parse_number(trimmed(text.substr(name.size())), where);
      if (!(value > 0.))
        entry_error(where, "found '" + text + "', needs a number greater than 0.");
      return value;
    }


    /** Interfaces of phases that have been read, as have the entries of bonds. Throws UserError. */
    std::vector<Material::Law::Interface> parse_interfaces(const Material &material)
    {
      std::vector<Material::Law::Interface> interfaces;
      const std::string                     entry = "Interfaces", energy = "fracture energy",
                        strength = "tensile strength", none = "elsewhere";
      if (!material.is_given(entry))
        return interfaces;
      material.refuse(
        !material.fracture_energy && !material.critical_stretch,
        entry,
        "is for bonds that break: give 'Fracture energy' or 'Critical stretch' of the phases, too.");
      std::vector<std::string> names = material.phases.all().names;
      names.push_back(none);
      const auto phase_of = [&](const std::string &name) {
        const unsigned int k = choice_of(unquoted(trimmed(name)), names, material.where(entry));
        return k + 1 == names.size() ? -1 : static_cast<int>(k);
      };
      for (const std::string &piece : split_list(material.text(entry), ';'))
        {
          const auto [pair, values] = name_and_value(piece, material.where(entry));
          const auto of_pair        = split_list(pair, '/');
          material.refuse(of_pair.size() != 2,
                          entry,
                          "found '" + pair + "', needs two phases, 'name/name'.");
          Material::Law::Interface found{{phase_of(of_pair[0]), phase_of(of_pair[1])}, 0., {}};
          material.refuse(found.phases[0] == found.phases[1],
                          entry,
                          "found '" + pair + "', needs two different phases.");
          for (const Material::Law::Interface &other : interfaces)
            material.refuse(
              std::is_permutation(other.phases.begin(), other.phases.end(), found.phases.begin()),
              entry,
              "has '" + pair + "' twice.");
          for (const std::string &value : split_list(values, ','))
            if (const auto G = value_behind(energy, value, material.where(entry)))
              found.fracture_energy = *G;
            else if (const auto f = value_behind(strength, value, material.where(entry)))
              found.tensile_strength = f;
            else
              entry_error(material.where(entry),
                          "found '" + value + "', knows '" + energy + " NUMBER' and '" + strength +
                            " NUMBER'.");
          material.refuse(found.fracture_energy == 0.,
                          entry,
                          "has no '" + energy + "' for '" + pair + "'.");
          material.refuse(material.law.softens() != found.tensile_strength.has_value(),
                          entry,
                          material.law.softens() ?
                            "has no '" + strength + "' for '" + pair +
                              "', which 'Law = softening' needs." :
                            "has a '" + strength + "' for '" + pair +
                              "', which is for 'Law = softening'; 'Law' is '" +
                              material.text("Law") + "'. Leave it out.");
          interfaces.push_back(found);
        }
      return interfaces;
    }
  } // namespace


  namespace
  {
    /** Entries of bonds that soften, or entries that these have not. */
    void refuse_softening(const Material &material)
    {
      const bool softens = material.law.softens();
      for (const std::string entry : {"Tensile strength", "Softening"})
        material.refuse(material.is_given(entry) && !softens,
                        entry,
                        "is for 'Law = softening'; 'Law' is '" + material.text("Law") +
                          "'. Leave one of them out.");
      if (!softens)
        return;
      material.refuse(!material.law.tensile_strength,
                      "Tensile strength",
                      "is empty, which 'Law = softening' needs.");
      material.refuse(
        material.critical_stretch.has_value(),
        "Critical stretch",
        "is where brittle bonds break; 'Law = softening' takes 'Tensile strength' and "
        "'Fracture energy'.");
      material.refuse(
        !material.fracture_energy,
        "Fracture energy",
        "is empty, which 'Law = softening' needs: the area under the stress over the opening.");
      material.refuse(
        material.fracture_energy->changes(),
        "Fracture energy",
        "depends on t or T, which bonds of 'Law = softening' do not know; known variables here: x, y, z.");
    }


    /** Entries of a body that yields, or entries that another one has not. */
    void refuse_plastic(const Material &material)
    {
      const bool yields = material.law.yields();
      for (const std::string entry : {"Yield stress", "Hardening modulus"})
        material.refuse((material.is_given(entry) || material.phases.gives(entry)) && !yields,
                        entry,
                        "is for 'Law = plastic'; 'Law' is '" + material.text("Law") +
                          "'. Leave one of them out.");
      if (!yields)
        return;
      material.refuse(!material.law.yield_stress,
                      "Yield stress",
                      "is empty, which 'Law = plastic' needs.");
      for (unsigned int k = 0; k <= material.phases.all().names.size(); ++k)
        {
          const Expression &value = material.law.hardening.formula(static_cast<int>(k) - 1);
          material.refuse(
            value.is_constant() && value.value(dealii::Point<1>()) < 0.,
            "Hardening modulus",
            "found " + value.text() +
              ", needs 0 or more: a body whose yield stress falls strains in one row of cells alone, whatever their size. 'Law = softening' has an energy for that.");
        }
    }


    /** The entries of a law of the user, or that another one has none. Throws UserError. */
    void parse_user_law(const Material &material, Material::Law &law)
    {
      const bool has_bonds   = law.kind == SolidLaw::user_bonds,
                 is_user     = law.kind == SolidLaw::user || has_bonds;
      const std::string file = "User law", numbers = "User properties", states = "User states";
      for (const std::string &entry : {file, numbers, states})
        material.refuse((material.is_given(entry) ||
                         (entry == numbers && !material.phases.text(entry).empty())) &&
                          !is_user,
                        entry,
                        "is for 'Law = user'; 'Law' is '" + material.text("Law") +
                          "'. Leave one of them out.");
      law.user.library = material.text(file);
      law.user.properties.clear();
      law.user.n_states = 0;
      if (!is_user)
        return;
      material.refuse(law.user.library.empty(), file, "is empty, which 'Law = user' needs.");
      material.refuse(
        has_bonds && !material.phases.text(numbers).empty(),
        numbers,
        "differ from phase to phase, but bonds that lead from one to another have one law. "
        "Give one list; moduli may differ.");
      bool any_modulus = false;
      for (const std::string modulus :
           {"Bulk modulus", "Shear modulus", "Young modulus", "Poisson ratio"})
        any_modulus = any_modulus || !material.text(modulus).empty();
      material.refuse(
        has_bonds && !any_modulus,
        "Law",
        "found 'user', here a law of bonds, which needs moduli, two of 'Bulk modulus', 'Shear modulus', 'Young modulus' and 'Poisson ratio'. A law of stresses (UMAT) is for 'Models = finite elements', and for 'peridynamics' with 'Model = correspondence' (section 'Elasticity').");
      for (const std::string modulus :
           {"Bulk modulus", "Shear modulus", "Young modulus", "Poisson ratio"})
        material.refuse(!has_bonds &&
                          (!material.text(modulus).empty() || material.phases.gives(modulus)),
                        modulus,
                        "is that of the other laws; 'Law = user' has its own, by 'User "
                        "properties'. Leave it out.");
      law.user.properties = user_properties(material).front();
      law.user.n_states = parse_whole_number(material.text(states), material.where(states), 100000);
    }


    /** The entries of the law in the section, whose kind has been read. Throws UserError. */
    void parse_law(const Material &section, Material::Law &law)
    {
      const auto belongs =
        [&](const std::string &entry, const SolidLaw kind, const std::string &name) {
          section.refuse(section.is_given(entry) && law.kind != kind,
                         entry,
                         "is for 'Law = " + name + "'; 'Law' is '" + section.text("Law") +
                           "'. Leave one of them out.");
          section.refuse(law.kind == kind && !section.is_given(entry),
                         entry,
                         "is empty, which 'Law = " + name + "' needs.");
          return law.kind == kind;
        };
      const std::string relaxation = "Relaxation", force = "Bond force";
      law.relaxation.clear();
      if (belongs(relaxation, SolidLaw::viscoelastic, "viscoelastic"))
        {
          double sum = 0.;
          for (const std::string &term : split_list(section.text(relaxation), ';'))
            {
              const auto numbers =
                parse_numbers(term, 2, "numbers, a share and a time", section.where(relaxation));
              section.refuse(!(numbers[0] > 0.) || !(numbers[1] > 0.),
                             relaxation,
                             "found '" + term + "', needs a share and a time greater than 0.");
              law.relaxation.push_back({numbers[0], numbers[1]});
              sum += numbers[0];
            }
          section.refuse(sum > 1. + 1e-12,
                         relaxation,
                         "has shares of the shear modulus whose sum is " + number_text(sum) +
                           ", needs at most 1.");
        }
      if (belongs(force, SolidLaw::formula, "formula"))
        {
          law.bond_force       = Expression(section.text(force), section.where(force), "s, damage");
          const double at_rest = law.bond_force.value(dealii::Point<2>());
          section.refuse(at_rest != 0.,
                         force,
                         "is " + number_text(at_rest) + " at s = 0, where a bond has no force.");
        }
      section.refuse((law.kind == SolidLaw::formula || law.kind == SolidLaw::user_bonds) &&
                       section.fracture_energy.has_value(),
                     "Fracture energy",
                     "is turned into a stretch by the linear law; with 'Law = " +
                       section.text("Law") + "' give 'Critical stretch'.");
      parse_user_law(section, law);
      refuse_softening(section);
      refuse_plastic(section);
    }
  } // namespace


  void Material::parse(const Physics                          physics,
                       const unsigned int                     dim,
                       const PlaneState                       plane,
                       const std::shared_ptr<const PhaseMap> &image,
                       const bool                             needs_storage)
  {
    phases.parse(physics, image, needs_storage);
    const auto property = [&](const std::string &entry) {
      return phases.property(entry, read(entry, physics));
    };
    const Expression capacity = read("Heat capacity", physics);
    stores                    = !(physics == Physics::electricity && is_zero(capacity));
    conductivity              = property("Conductivity");
    density                   = property("Density");
    heat_capacity             = phases.property("Heat capacity", capacity);
    saturated_concentration   = property("Saturated concentration");
    SceneSection::parse();
    if (const auto diffusivity = optional_property("Diffusivity", physics))
      {
        refuse(physics != Physics::moisture,
               "Diffusivity",
               "is for 'Physics = moisture'; 'Physics' is '" + names_of(physics).physics +
                 "'. Use 'Conductivity', 'Density' and 'Heat capacity'.");
        for (const std::string entry : {"Conductivity", "Density", "Heat capacity"})
          refuse(
            is_given(entry) || phases.gives(entry),
            entry,
            "is given beside 'Diffusivity', from which it follows with 'Saturated concentration'. Give one of the two.");
        conductivity  = product(*diffusivity, saturated_concentration, phases);
        density       = saturated_concentration;
        heat_capacity = MaterialProperty(1.);
      }
    refuse(
      conductivity.depends_on_temperature() && interface_rule == InterfaceRule::harmonic,
      "Interface rule",
      "'harmonic' follows each bond through the phases and cannot have a 'Conductivity' with T; use 'arithmetic' or 'minimum'.");

    thermal_expansion    = property("Thermal expansion");
    law.tensile_strength = optional_property("Tensile strength", physics);
    law.yield_stress     = optional_property("Yield stress", physics);
    law.hardening        = property("Hardening modulus");
    parse_breaking(physics);
    for (const std::string entry : {"Law", "Softening", "Criterion"})
      refuse_unless_elastic(entry, physics);
    if (law.kind == SolidLaw::user && law.user.of_bonds)
      law.kind = SolidLaw::user_bonds;
    for (const PlainEntry &entry : entries_of_laws())
      refuse_unless_elastic(entry.name, physics);
    parse_law(*this, law);
    law.interfaces = parse_interfaces(*this);
    law.orthotropy = parse_orthotropy(*this, physics, dim, plane);
    // No number: nobody may take it for uniform and isotropic.
    if (!law.orthotropy.young.empty() || law.kind == SolidLaw::user)
      given.properties.fill(MaterialProperty(Expression("1 + 0*x", where("Young moduli"))));
    else if (physics == Physics::elasticity)
      parse_moduli(dim, plane);
    else
      for (const std::string entry :
           {"Bulk modulus", "Shear modulus", "Young modulus", "Poisson ratio"})
        if (!text(entry).empty())
          read(entry, physics); // for its errors
  }


  void Material::require_storage()
  {
    phases.needs_storage                  = true;
    const std::vector<std::string> &names = phases.all().names;
    for (const auto &[entry, property] :
         {std::make_pair("Density", &density), std::make_pair("Heat capacity", &heat_capacity)})
      {
        read(entry, Physics::heat); // for its errors
        for (unsigned int k = 0; k < names.size(); ++k)
          refuse(is_zero(property->formula(k)),
                 entry,
                 "is 0 in the phase '" + names[k] + "', needs a value greater than 0.");
      }
  }


  InitialAndSource::InitialAndSource()
    : SceneSection("Initial and source")
  {
    declare("Initial value", EntryType::formula, "0", "temperature") =
      "Temperature at time 0, a number or a formula of x, y, z (t is 0).";
    declare("Source", EntryType::formula, "0", "power/length^3") =
      "Heat produced in the body, a number or a formula of x, y, z, t.";
    declare("Body force", EntryType::list, "", "force/length^3") =
      "Elasticity: force per volume, one formula of x, y, z, t per direction, separated by commas. Empty: none.";
    declare("Initial displacement", EntryType::list, "", "length") =
      "Elasticity with `Solver = dynamics`: at time 0, one formula of x, y, z per direction, separated by commas. Empty: none. Sides in "
      "`Displacement` have theirs from the beginning.";
    declare("Initial velocity", EntryType::list, "", "length/time") =
      "Elasticity with `Solver = dynamics`: at time 0, one formula of x, y, z per direction, "
      "separated by commas. Empty: at rest.";
    parse();
  }


  void InitialAndSource::parse(const Physics physics, const unsigned int dim, const bool with_heat)
  {
    initial_value = Expression(text("Initial value"), where("Initial value"));
    source        = Expression(text("Source"), where("Source"));
    for (const auto &[entry, member] :
         {std::make_pair("Body force", &body_force),
          std::make_pair("Initial displacement", &initial_displacement),
          std::make_pair("Initial velocity", &initial_velocity)})
      {
        const bool is_initial = member != &body_force;
        member->clear();
        if (is_initial)
          refuse_unless_elastic(entry, physics);
        if (!text(entry).empty())
          *member =
            parse_vector(text(entry), dim, where(entry), is_initial ? "x, y, z" : "x, y, z, t");
        refuse_unless_elastic(entry, physics);
        for (const Expression &value : *member)
          refuse(is_initial && value.depends_on_time(),
                 entry,
                 "'" + value.text() + "' depends on t; known variables here: x, y, z.");
      }
    const bool        only_solid  = physics == Physics::elasticity && !with_heat;
    const std::string or_computed = ", or 'Temperature change = computed' in section 'Elasticity'.";
    refuse(
      only_solid && is_given("Initial value"),
      "Initial value",
      "is for diffusion; with 'Physics = elasticity' bodies start at rest, or with 'Initial displacement' and 'Initial velocity'" +
        or_computed);
    refuse(only_solid && is_given("Source"),
           "Source",
           "is for diffusion; with 'Physics = elasticity' use 'Body force'" + or_computed);
  }


  namespace
  {
    // in the order of Modulus
    const std::array<const char *, 4> modulus_names{
      {"Bulk modulus", "Shear modulus", "Young modulus", "Poisson ratio"}};

    std::string name_of(const Modulus modulus)
    {
      return modulus_names[static_cast<unsigned int>(modulus)];
    }

    std::string quoted(const std::vector<std::string> &names)
    {
      return "'" + join_names(names, "', '") + "'";
    }
  } // namespace


  bool Material::GivenModuli::are_uniform() const
  {
    return properties[0].is_constant() && properties[1].is_constant();
  }


  std::string Material::GivenModuli::fault(const double value_a, const double value_b) const
  {
    const bool second_is_poisson = which[1] == Modulus::poisson;
    for (const double value : {value_a, second_is_poisson ? 1. : value_b})
      if (!(value > 0.))
        return "found " + number_text(value) + ", needs a value greater than 0.";
    const double poisson = poisson_from(which[0], value_a, which[1], value_b);
    const auto   found   = [&] { // only where it is told: this is asked at each point of a formula
      return second_is_poisson ?
                   "found " + number_text(value_b) + ", which" :
                   name_of(which[0]) + " " + number_text(value_a) + " and " + name_of(which[1]) + " " +
                 number_text(value_b) + " contradict each other: the Poisson ratio would be " +
                 number_text(poisson) + ", and it";
    };
    if (!(poisson > -1. && (may_be_incompressible ? poisson <= 0.5 : poisson < 0.5)))
      return found() + " has to be greater than -1 and " +
             (may_be_incompressible ? "at most 0.5." : "less than 0.5.");
    const Moduli moduli = moduli_from(which[0], value_a, which[1], value_b);
    if (!(moduli.shear > 0.))
      return found() + " leaves no shear modulus; give 'Young modulus' with it, or less than 0.5.";
    return "";
  }


  void Material::parse_moduli(const unsigned int dim, const PlaneState plane)
  {
    given.may_be_incompressible = dim == 1 || (dim == 2 && plane == PlaneState::stress);
    std::vector<std::string> names;
    std::vector<Modulus>     which;
    for (unsigned int k = 0; k < modulus_names.size(); ++k)
      if (!text(modulus_names[k]).empty())
        {
          names.push_back(modulus_names[k]);
          which.push_back(static_cast<Modulus>(k));
        }
    const bool        bar = dim == 1 && which.size() == 1 && which[0] == Modulus::young;
    const std::string two =
      "needs exactly two of 'Bulk modulus', 'Shear modulus', 'Young modulus' and 'Poisson ratio'";
    if (which.size() > 2)
      error(names.back(),
            "is one of " + std::to_string(which.size()) + " (" + quoted(names) +
              "); 'Physics = elasticity' " + two + ".");
    if (which.size() < 2 && !bar)
      error(names.empty() ? "Young modulus" : names.front(),
            (names.empty() ? "is empty, and so are the other moduli" : "is the only one") +
              std::string("; 'Physics = elasticity' ") + two +
              (dim == 1 ? ", or for a bar 'Young modulus' alone." : "."));
    if (bar)
      which.push_back(Modulus::poisson); // 0: what a bar does not ask for

    for (unsigned int k = 0; k < 2; ++k)
      {
        given.which[k]         = which[k];
        const Expression value = bar && k == 1 ? Expression(0.) :
                                                 read(name_of(which[k]), Physics::elasticity);
        given.properties[k]    = phases.property(name_of(which[k]), value);
      }
    for (const char *const name : modulus_names)
      if (text(name).empty() && phases.gives(name))
        entry_error(phases.where(name),
                    "section 'Material' gives " + quoted(names) +
                      "; phases have values of the same moduli.");

    const int n_regions = static_cast<int>(phases.all().names.size());
    for (int region = -1; region < n_regions; ++region)
      {
        const Expression &a = given.properties[0].formula(region),
                         &b = given.properties[1].formula(region);
        if (!a.is_constant() || !b.is_constant())
          continue;
        const std::string fault =
          given.fault(a.value(dealii::Point<1>()), b.value(dealii::Point<1>()));
        if (fault.empty())
          continue;
        const std::string first  = name_of(given.which[0]),
                          second = name_of(given.which[bar ? 0 : 1]);
        if (region < 0)
          error(second, fault);
        entry_error((phases.gives(second) ? phases.where(second) : phases.where(first)) +
                      ", phase '" + phases.all().names[region] + "'",
                    fault);
      }
  }


  void Material::set_moduli(const Modulus     a,
                            const Expression &value_a,
                            const Modulus     b,
                            const Expression &value_b)
  {
    given.which                 = {{a, b}};
    given.properties            = {{value_a, value_b}};
    given.may_be_incompressible = true; // the laws refuse it where they cannot have it
    if (!uniform_moduli())
      return;
    const std::string fault =
      given.fault(value_a.value(dealii::Point<1>()), value_b.value(dealii::Point<1>()));
    AssertThrow(fault.empty(), UserError(name_of(b) + " of the material: " + fault));
  }


  template <int dim>
  Moduli Material::moduli(const dealii::Point<dim> &p, const double T) const
  {
    if (!law.orthotropy.young.empty())
      return mean_moduli(law.orthotropy, p);
    const double a = given.properties[0].value(p, T), b = given.properties[1].value(p, T);
    // Constant ones have been checked.
    const std::string fault = uniform_moduli() ? "" : given.fault(a, b);
    if (!fault.empty())
      report_formula_error(
        "Entry " + where(name_of(given.which[a > 0. ? 1 : 0])) + ", at " + point_text(p) +
        (given.depend_on_temperature() ? ", T = " + number_text(T) : "") + ": " + fault);
    return moduli_from(given.which[0], a, given.which[1], b);
  }



#define PERIDEAL_TEMPLATES(dim)                                                           \
  template double Material::storage<dim>(const dealii::Point<dim> &, const double) const; \
  template Moduli Material::moduli<dim>(const dealii::Point<dim> &, const double) const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
