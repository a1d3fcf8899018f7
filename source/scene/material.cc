// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/material.h>

namespace PeriDeal
{
  namespace
  {
    void refuse_time(const Expression &expression, const std::string &where)
    {
      if (expression.depends_on_time())
        entry_error(where,
                    "'" + expression.text() + "' depends on t; known variables here: x, y, z, T.");
    }
  } // namespace


  Material::Material()
    : SceneSection("Material")
  {
    declare(
      "Conductivity",
      EntryType::formula,
      "1",
      "power/(length temperature)",
      "Thermal conductivity, diffusivity (moisture) or electrical conductivity: a number or a formula of x, y, z and T, the temperature (wetness, potential) itself.");
    declare("Density", EntryType::formula, "1", "mass/length^3", "Ignored when steady.");
    declare(
      "Heat capacity",
      EntryType::formula,
      "1",
      "energy/(mass temperature)",
      "Per mass; the body stores Density x Heat capacity, either a number or a formula of x, y, z, T. Ignored when steady. With electricity their product is the "
      "capacitance per volume, and 0 means a steady state.");
    declare(
      "Saturated concentration",
      EntryType::formula,
      "1",
      "mass/length^3",
      "Moisture only: the concentration at wetness 1, a number or a formula of x, y, z. For the concentration field and the "
      "weight; bonds and elements conduct wetness by Conductivity alone.");
    declare("Interface rule",
            EntryType::choice,
            "arithmetic",
            "",
            "Conductivity of a bond between unequal nodes: the smaller value, the mean, or the "
            "harmonic mean by the length of the bond in each phase.",
            {"minimum", "arithmetic", "harmonic"});
    parse();
  }


  bool Material::uniform_conductivity() const
  {
    return conductivity.is_constant();
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


  void Material::parse(const Physics physics)
  {
    phases.parse();
    stores          = true;
    const auto read = [&](const std::string &entry, MaterialProperty &property) {
      Expression value(text(entry), where(entry), entry != "Saturated concentration");
      refuse_time(value, where(entry));
      const bool may_vanish = physics == Physics::electricity && entry == "Heat capacity";
      if (may_vanish && value.is_constant() && value.value(dealii::Point<1>()) == 0.)
        {
          stores = false;
          value  = Expression(1.); // not used
        }
      if (value.is_constant() && !(value.value(dealii::Point<1>()) > 0.))
        error(entry, "found " + text(entry) + ", needs a value greater than 0.");
      property = phases.property(entry, value);
    };
    read("Conductivity", conductivity);
    read("Density", density);
    read("Heat capacity", heat_capacity);
    read("Saturated concentration", saturated_concentration);
    interface_rule = choice<InterfaceRule>("Interface rule");
    if (conductivity.depends_on_temperature() && interface_rule == InterfaceRule::harmonic)
      error(
        "Interface rule",
        "'harmonic' follows each bond through the phases and cannot have a 'Conductivity' with T; use 'arithmetic' or 'minimum'.");
  }


  InitialAndSource::InitialAndSource()
    : SceneSection("Initial and source")
  {
    declare("Initial value",
            EntryType::formula,
            "0",
            "temperature",
            "Temperature at time 0, a number or a formula of x, y, z (t is 0).");
    declare("Source",
            EntryType::formula,
            "0",
            "power/length^3",
            "Heat produced in the body, a number or a formula of x, y, z, t.");
    parse();
  }


  void InitialAndSource::parse()
  {
    initial_value = Expression(text("Initial value"), where("Initial value"));
    source        = Expression(text("Source"), where("Source"));
  }


  template double Material::storage<1>(const dealii::Point<1> &, const double) const;
  template double Material::storage<2>(const dealii::Point<2> &, const double) const;
  template double Material::storage<3>(const dealii::Point<3> &, const double) const;
} // namespace PeriDeal
