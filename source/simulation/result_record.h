// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** What has been collected for summary.json and totals.csv so far. */
  struct ResultRecord
  {
    using json = nlohmann::ordered_json;

    std::vector<std::string> notes;
    json                     fields     = json::array();
    json                     errors     = json::object(); // model -> norm -> [[t, value], ...]
    json                     comparison = json::object();
    json        balances = json::object(); // model -> flux and balance at the last time
    std::string totals   = "time,model,quantity,value\n";
  };
} // namespace PeriDeal
