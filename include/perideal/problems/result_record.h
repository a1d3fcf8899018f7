// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/output/crack_writer.h>
#include <perideal/output/tables.h>
#include <perideal/scene/crack_tips.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** The corners of each piece of the cracks. */
  template <int dim>
  nlohmann::ordered_json corners_of(const std::vector<CrackPiece<dim>> &pieces)
  {
    auto list = nlohmann::ordered_json::array();
    for (const CrackPiece<dim> &piece : pieces)
      {
        auto corners = nlohmann::ordered_json::array();
        for (const auto &corner : piece.corners)
          {
            auto coordinates = nlohmann::ordered_json::array();
            for (unsigned int d = 0; d < dim; ++d)
              coordinates.push_back(corner[d]);
            corners.push_back(coordinates);
          }
        list.push_back(corners);
      }
    return list;
  }


  /** The same with three coordinates, for files. */
  template <int dim>
  CrackCorners crack_corners(const std::vector<CrackPiece<dim>> &pieces)
  {
    CrackCorners list;
    for (const CrackPiece<dim> &piece : pieces)
      {
        list.emplace_back();
        for (const auto &corner : piece.corners)
          {
            list.back().push_back({{0., 0., 0.}});
            for (unsigned int d = 0; d < dim; ++d)
              list.back().back()[d] = corner[d];
          }
      }
    return list;
  }


  /** What has been collected for summary.json and totals.csv so far. */
  struct ResultRecord
  {
    using json = nlohmann::ordered_json;

    std::vector<std::string> notes;
    json                     fields     = json::array();
    json                     errors     = json::object(); // model -> norm -> [[t, value], ...]
    json                     comparison = json::object();
    json comparisons = json::object(); // "coupled minus (other model)" -> norm -> [[t, value], ...]
    json balances    = json::object(); // model -> flux and balance at the last time
    json extremes    = json::object(); // model -> largest force, first time with broken bonds
    json warned      = json::object(); // model -> monitors of guards that notes have told of
    std::string totals;                // rows for totals.csv that are not yet written

    /** A row of totals.csv. */
    void add_row(const std::string &model,
                 const std::string &quantity,
                 const double       value,
                 const double       t)
    {
      totals +=
        full_precision(t) + "," + model + "," + quantity + "," + full_precision(value) + "\n";
    }

    /** All of it, so that a run that is resumed has the same summary. Collective. */
    void exchange(Archive &archive)
    {
      json state = json::array(
        {notes, fields, errors, comparison, comparisons, balances, extremes, totals, warned});
      std::string text = state.dump(-1, ' ', false, json::error_handler_t::replace);
      archive.exchange("record", text);
      if (!archive.loads())
        return;
      state                 = json::parse(text);
      notes                 = state[0].get<std::vector<std::string>>();
      totals                = state[7].get<std::string>();
      json *const members[] = {&fields, &errors, &comparison, &comparisons, &balances, &extremes};
      for (unsigned int k = 0; k < 6; ++k)
        *members[k] = state[k + 1];
      if (state.size() > 8) // checkpoints of earlier runs end here
        warned = state[8];
    }
  };
} // namespace PeriDeal
