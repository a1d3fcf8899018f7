// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * The physical groups of a mesh file that scenes name, with their numbers: those of dimension
   * dim - 1 are sides of the body, or interfaces as far as they lie between two cells, those of
   * dimension dim materials, those of dimension 0 (in 2D and 3D) points. Groups without a name have
   * their number for one.
   */
  struct MeshGroups
  {
    using Place   = std::array<double, 3>;
    using Numbers = std::map<std::string, unsigned int>;

    Numbers                                   sides, interfaces, materials;
    std::map<std::string, std::vector<Place>> points;
    std::map<unsigned int, std::vector<std::vector<Place>>>
      faces; // of interfaces: the corners of each
  };

  /**
   * Read and check a mesh file for a body of dimension @p dim.
   * @param faces whether those of interfaces are asked for; else there are none of them
   *
   * Throws UserError (read_msh()). Collective.
   */
  MeshGroups read_mesh_groups(const std::string &file_name,
                              const std::string &folder,
                              const unsigned int dim,
                              const bool         faces,
                              const MPI_Comm     communicator);

  /** "left (1), right (2), 7": names with their numbers; "none". */
  std::string text_of_groups(const MeshGroups::Numbers &groups);

  /** The number of a group given by its name or number, if there is one. */
  std::optional<unsigned int> number_of_group(const MeshGroups::Numbers &groups,
                                              const std::string         &name);
} // namespace PeriDeal
