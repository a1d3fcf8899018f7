// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include "work_evaluation.h"

namespace PeriDeal
{
  /** work_precision.csv: a line for each finished row, and for what the program has chosen. */
  std::string work_csv(const WorkResults &results);

  /** work_precision_in_time.csv: a line for each stepper and tolerance. */
  std::string in_time_csv(const WorkResults &results);

  /**
   * work_precision.json: the rows, families with observed orders and costs at given errors, fronts,
   * and how the errors were found.
   */
  std::string work_json(const Study &study, const WorkPlan &plan, const WorkResults &results);

  /**
   * The same in lines for the reader: the front, what is dominated by what, and the cost of errors
   * of 1 and 0.1 percent.
   */
  std::string work_report(const WorkPlan &plan, const WorkResults &results);
} // namespace PeriDeal
