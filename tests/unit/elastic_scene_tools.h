// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene_lines.h>

#include <string>
#include <vector>

#include "scene_test_tools.h"

namespace PeriDeal
{
  namespace SceneTests
  {
    using Overrides = std::vector<std::string>;


    /** A body held at its left side. */
    template <int dim>
    SceneText elastic_scene(const Overrides &overrides)
    {
      const std::string zeros = dim == 1 ? "0" : dim == 2 ? "0, 0" : "0, 0, 0";
      const std::string text  = "set Dimension = " + std::to_string(dim) + R"(
set Physics = elasticity
subsection Material
  set Young modulus = 200
  set Poisson ratio = 0.3
end
subsection Boundary conditions
  set Displacement = left: )" + zeros +
                               "\nend\n";
      return {"a.prm", apply_overrides(text, "a.prm", overrides)};
    }


    /** What is wrong with such a body when some entries are changed. */
    template <int dim = 2>
    std::string elastic_fault(const Overrides &overrides)
    {
      return message_of([&] {
        Scene<dim> scene;
        parse_computable<dim>(elastic_scene<dim>(overrides), scene);
      });
    }


    /** The message names the entry, given as Section/Entry, and has the other words. */
    inline void expect(const std::string              &message,
                       const std::string              &entry,
                       const std::vector<std::string> &parts = {})
    {
      const auto slash = entry.rfind('/');
      expect_parts(
        message,
        {"'" + entry.substr(slash + 1) + "' in section '" + entry.substr(0, slash) + "'"});
      expect_parts(message, parts);
    }
  } // namespace SceneTests
} // namespace PeriDeal
