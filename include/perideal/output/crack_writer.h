// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/output/result_folder.h>

#include <array>
#include <cstdint>
#include <map>
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

  /** Pieces that have come up in a run, and what is known of each, by its name in files. */
  struct NewCracks
  {
    CrackCorners                               pieces;
    std::map<std::string, std::vector<double>> numbers;
  };


  /**
   * The geometry of cracks for ParaView: lines and polygons in `fields/NAME_NNNN.vtu`, listed with
   * their times in `NAME.pvd`. Cracks that stay as they are have one file for all times. Each cell
   * has the number of its `piece`.
   */
  class CrackWriter
  {
  public:
    CrackWriter(ResultFolder &folder, const std::string &name);

    /**
     * Write the pieces, if there are any, on rank 0. What cannot be written is kept in the folder.
     */
    void write(const NewCracks &cracks, const double time);

    /** What has been written, so that the series goes on. Collective. */
    void exchange(Archive &archive);

  private:
    ResultFolder                               &folder;
    const std::string                           name;
    std::uint64_t                               last = 0; // checksum of the latest file
    std::vector<std::pair<double, std::string>> records;
    unsigned int                                n_files = 0;
  };
} // namespace PeriDeal
