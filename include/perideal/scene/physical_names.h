// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/types.h>

#include <mpi.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Names and numbers of the groups of sides, of dimension @p dim - 1, in the lines of a section
   * `$PhysicalNames`. Not collective.
   */
  std::vector<std::pair<std::string, int>> named_sides(const std::string &lines,
                                                       const unsigned int dim);

  /**
   * The physical names of a Gmsh file for sides of bodies of dimension @p dim (those of dimension
   * dim - 1), with their boundary ids.
   *
   * The file is looked for as it is named and in @p folder. What is missing or broken has no names
   * here; it is reported when the mesh is read. Collective.
   */
  std::map<std::string, dealii::types::boundary_id> read_physical_names(
    const std::string &file_name,
    const std::string &folder,
    const unsigned int dim,
    const MPI_Comm     communicator);
} // namespace PeriDeal
