// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/scene/physics.h>

#include <algorithm>
#include <deque>

namespace PeriDeal
{
  namespace
  {
    /** References to them stay valid when one more is added. */
    std::deque<PhysicsNames> &all_names()
    {
      static std::deque<PhysicsNames> names = {
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


  Physics add_physics(const PhysicsNames &names)
  {
    Assert(std::none_of(all_names().begin(),
                        all_names().end(),
                        [&](const PhysicsNames &other) { return other.physics == names.physics; }),
           dealii::ExcMessage("There is a physics of this name."));
    all_names().push_back(names);
    return static_cast<Physics>(all_names().size() - 1);
  }


  std::vector<std::string> physics_choices()
  {
    std::vector<std::string> choices;
    for (const PhysicsNames &names : all_names())
      choices.push_back(names.physics);
    return choices;
  }
} // namespace PeriDeal
