// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>
#include <vector>

#include "row_result.h"

namespace PeriDeal
{
  /**
   * study.csv: a line for each row and model, and where errors are known at several times a line
   * for each of them, the last time last. Sizes and costs are those of the whole run. Rows without
   * a result are left out.
   */
  std::string study_csv(const Study                   &study,
                        const std::vector<CheckedRow> &rows,
                        const std::vector<RowResult>  &results);

  /**
   * study.json: the lines of study.csv ("table"), and of each row its settings, the summary of its
   * run, errors over time, totals and probes.
   */
  std::string study_json(const Study                   &study,
                         const std::vector<CheckedRow> &rows,
                         const std::vector<RowResult>  &results);
} // namespace PeriDeal
