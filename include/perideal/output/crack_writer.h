// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/output/result_folder.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * The corners of each piece of the cracks: two a segment, three or more a polygon. Missing
   * coordinates are 0.
   */
  using CrackCorners = std::vector<std::vector<std::array<double, 3>>>;

  /**
   * The geometry of the cracks for ParaView: lines and polygons in `fields/cracks_NNNN.vtu`, listed
   * with their times in `cracks.pvd`. Cracks that stay as they are have one file for all times.
   * Each cell has the number of its `piece`.
   */
  class CrackWriter
  {
  public:
    explicit CrackWriter(ResultFolder &folder);

    /**
     * Write the pieces, if there are any, on rank 0. What cannot be written is kept in the folder.
     */
    void write(const CrackCorners &pieces, const double time);

    /** What has been written, so that the series goes on. Collective. */
    void exchange(Archive &archive);

  private:
    ResultFolder                               &folder;
    CrackCorners                                last;
    std::vector<std::pair<double, std::string>> records;
    unsigned int                                n_files = 0;
  };
} // namespace PeriDeal
