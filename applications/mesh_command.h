// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>

namespace CLI
{
  class App;
}

namespace PeriDeal
{
  /** What the command line asks of `perideal mesh`. */
  struct MeshRequest
  {
    std::string  file, out;
    unsigned int dimension = 0; // the highest that the file has
    bool         quiet     = false;
  };

  /** Add the command and its options, which fill the request. */
  void describe_mesh(CLI::App &app, MeshRequest &request);

  /** Read, check and divide the mesh of a file, say what it has, and write it, if asked for. Throws
   * UserError. Collective. */
  void convert_mesh(const MeshRequest &request);
} // namespace PeriDeal
