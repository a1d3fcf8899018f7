// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The two moduli of section `Material`.

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/material.h>

#include <array>
#include <string>
#include <vector>

namespace PeriDeal
{
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


  std::string Material::fault_of_moduli(const double value_a, const double value_b) const
  {
    const bool second_is_poisson = given_moduli[1] == Modulus::poisson;
    for (const double value : {value_a, second_is_poisson ? 1. : value_b})
      if (!(value > 0.))
        return "found " + number_text(value) + ", needs a value greater than 0.";
    const double      poisson = poisson_from(given_moduli[0], value_a, given_moduli[1], value_b);
    const std::string found   = second_is_poisson ?
                                  "found " + number_text(value_b) + ", which" :
                                  name_of(given_moduli[0]) + " " + number_text(value_a) + " and " +
                                  name_of(given_moduli[1]) + " " + number_text(value_b) +
                                  " contradict each other: the Poisson ratio would be " +
                                  number_text(poisson) + ", and it";
    if (!(poisson > -1. && (may_be_incompressible ? poisson <= 0.5 : poisson < 0.5)))
      return found + " has to be greater than -1 and " +
             (may_be_incompressible ? "at most 0.5." : "less than 0.5.");
    const Moduli moduli = moduli_from(given_moduli[0], value_a, given_moduli[1], value_b);
    if (!(moduli.shear > 0.))
      return found + " leaves no shear modulus; give 'Young modulus' with it, or less than 0.5.";
    return "";
  }


  void Material::parse_moduli(const unsigned int dim, const PlaneState plane)
  {
    may_be_incompressible = dim == 1 || (dim == 2 && plane == PlaneState::stress);
    std::vector<std::string> given;
    std::vector<Modulus>     which;
    for (unsigned int k = 0; k < modulus_names.size(); ++k)
      if (!text(modulus_names[k]).empty())
        {
          given.push_back(modulus_names[k]);
          which.push_back(static_cast<Modulus>(k));
        }
    const bool        bar = dim == 1 && which.size() == 1 && which[0] == Modulus::young;
    const std::string two =
      "needs exactly two of 'Bulk modulus', 'Shear modulus', 'Young modulus' and 'Poisson ratio'";
    if (which.size() > 2)
      error(given.back(),
            "is one of " + std::to_string(which.size()) + " (" + quoted(given) +
              "); 'Physics = elasticity' " + two + ".");
    if (which.size() < 2 && !bar)
      error(given.empty() ? "Young modulus" : given.front(),
            (given.empty() ? "is empty, and so are the other moduli" : "is the only one") +
              std::string("; 'Physics = elasticity' ") + two +
              (dim == 1 ? ", or for a bar 'Young modulus' alone." : "."));
    if (bar)
      which.push_back(Modulus::poisson); // 0: what a bar does not ask for

    for (unsigned int k = 0; k < 2; ++k)
      {
        given_moduli[k]        = which[k];
        const Expression value = bar && k == 1 ? Expression(0.) :
                                                 read(name_of(which[k]), Physics::elasticity);
        modulus_properties[k]  = phases.property(name_of(which[k]), value);
      }
    for (const char *const name : modulus_names)
      if (text(name).empty() && phases.gives(name))
        entry_error(phases.where(name),
                    "section 'Material' gives " + quoted(given) +
                      "; phases have values of the same moduli.");

    const int n_regions = static_cast<int>(phases.all().names.size());
    for (int region = -1; region < n_regions; ++region)
      {
        const Expression &a = modulus_properties[0].formula(region),
                         &b = modulus_properties[1].formula(region);
        if (!a.is_constant() || !b.is_constant())
          continue;
        const std::string fault =
          fault_of_moduli(a.value(dealii::Point<1>()), b.value(dealii::Point<1>()));
        if (fault.empty())
          continue;
        const std::string first  = name_of(given_moduli[0]),
                          second = name_of(given_moduli[bar ? 0 : 1]);
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
    given_moduli          = {{a, b}};
    modulus_properties    = {{value_a, value_b}};
    may_be_incompressible = true; // the laws refuse it where they cannot have it
    if (!uniform_moduli())
      return;
    const std::string fault =
      fault_of_moduli(value_a.value(dealii::Point<1>()), value_b.value(dealii::Point<1>()));
    AssertThrow(fault.empty(), UserError(name_of(b) + " of the material: " + fault));
  }


  bool Material::uniform_moduli() const
  {
    return modulus_properties[0].is_constant() && modulus_properties[1].is_constant();
  }


  template <int dim>
  Moduli Material::moduli(const dealii::Point<dim> &p) const
  {
    const double a = modulus_properties[0].value(p), b = modulus_properties[1].value(p);
    // Constant ones have been checked.
    const std::string fault = uniform_moduli() ? "" : fault_of_moduli(a, b);
    if (!fault.empty())
      {
        std::string point;
        for (unsigned int d = 0; d < dim; ++d)
          point += (d == 0 ? "" : ", ") + number_text(p[d]);
        report_formula_error("Entry " + where(name_of(given_moduli[a > 0. ? 1 : 0])) + ", at (" +
                             point + "): " + fault);
      }
    return moduli_from(given_moduli[0], a, given_moduli[1], b);
  }


  template Moduli Material::moduli<1>(const dealii::Point<1> &) const;
  template Moduli Material::moduli<2>(const dealii::Point<2> &) const;
  template Moduli Material::moduli<3>(const dealii::Point<3> &) const;
} // namespace PeriDeal
