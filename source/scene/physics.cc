// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/physics.h>

namespace PeriDeal
{
  namespace
  {
    const std::vector<PhysicsNames> &all_names()
    {
      static const std::vector<PhysicsNames> names = {
        {"heat", "temperature", "heat_flux", "heat content", "heat flow", "heat", "conductivity"},
        {"moisture",
         "wetness",
         "moisture_flux",
         "weight",
         "moisture flow",
         "moisture",
         "diffusivity"},
        {"electricity",
         "potential",
         "current_density",
         "charge",
         "current",
         "charge",
         "conductivity"},
        {"elasticity", "displacement", "stress", "strain energy", "force", "force", ""}};
      return names;
    }
  } // namespace


  const PhysicsNames &names_of(const Physics physics)
  {
    return all_names()[static_cast<unsigned int>(physics)];
  }


  std::vector<std::string> physics_choices()
  {
    std::vector<std::string> choices;
    for (const PhysicsNames &names : all_names())
      choices.push_back(names.physics);
    return choices;
  }
} // namespace PeriDeal
