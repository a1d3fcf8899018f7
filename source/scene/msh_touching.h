// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/msh_file.h>

#include <array>
#include <utility>
#include <vector>

namespace PeriDeal
{
  using MshEdge = std::pair<unsigned int, unsigned int>;

  /**
   * Nodes of the surface of a mesh that lie on another such node, or on an edge that has not got
   * them: hanging ones, and those of pieces that only touch. Not collective.
   *
   * @param edges of the surface (in 2D its lines), each once or more often
   */
  std::vector<unsigned int> touching_nodes(const MshMesh        &mesh,
                                           std::vector<MshEdge> &edges,
                                           const unsigned int    dim);
} // namespace PeriDeal
