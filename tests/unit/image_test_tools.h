// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What tests of bodies from images share.

#pragma once

#include <perideal/problems/computable.h>

#include <filesystem>
#include <fstream>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal::ImageTests
{
  using OperatorTests::Settings;
  using OperatorTests::operator+;

  /** A PGM file for a test, one on each process, of rows of digits: greys of 10 times as much. */
  class Image
  {
  public:
    explicit Image(const std::vector<std::string> &rows)
      : name((std::filesystem::temp_directory_path() /
              ("image_test_" + std::to_string(getpid()) + ".pgm"))
               .string())
    {
      std::ofstream file(name);
      file << "P2 " << rows.front().size() << ' ' << rows.size() << " 255\n";
      for (const std::string &row : rows)
        for (const char c : row)
          file << 10 * (c - '0') << '\n';
    }

    ~Image()
    {
      std::remove(name.c_str());
    }

    Settings settings(const Settings &more = {}) const
    {
      return Settings{{"Domain/Shape", "image"},
                      {"Domain/Image", name},
                      {"Domain/Image colors", "matrix: 90 ; fibre: 50 ; void: 0"},
                      {"Domain/Color tolerance", "5"},
                      {"Domain/Pixel size", "1"}} +
             more;
    }

  private:
    std::string name;
  };


  inline Settings elastic(const Settings &more = {})
  {
    return Settings{{"Physics", "elasticity"},
                    {"Material/Young modulus", "10"},
                    {"Material/Poisson ratio", "0.25"},
                    {"Peridynamics/Boundary treatment", "none"},
                    {"Boundary conditions/Displacement", "left: 0, 0 ; right: 1, 0"}} +
           more;
  }


  /** As set() of the tools, with entries outside all sections. */
  inline void fill(Scene<2> &scene, const Settings &settings)
  {
    scene.general.set("Dimension", "2");
    for (const auto &[path, text] : settings)
      {
        const std::string section = path.substr(0, path.rfind('/') + 1); // and a slash
        for (SceneSection *s : scene.sections())
          if ((s->name().empty() ? "" : s->name() + "/") == section)
            s->set(path.substr(section.size()), text);
      }
    scene.parse_and_validate();
    require_computable(scene, {});
  }


  inline std::string fault(const Settings &settings)
  {
    return SceneTests::message_of([&] {
      Scene<2> scene;
      fill(scene, settings);
    });
  }
} // namespace PeriDeal::ImageTests
