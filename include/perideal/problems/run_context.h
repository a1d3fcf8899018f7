// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>
#include <perideal/problems/problem_cost.h>
#include <perideal/problems/result_record.h>
#include <perideal/solvers/step_span.h>

#include <functional>
#include <string>

namespace PeriDeal
{
  /** Where a problem tells what it has found: messages, and what is collected for files. */
  struct RunContext
  {
    Progress     &progress;
    ResultRecord &record;

    /**
     * What the problem of a model will need, from coarse lattices. @param memory raised to what a
     * run needs beyond what is there now. Collective.
     */
    std::function<ModelEstimate(const std::string &model, double &memory)> estimate;

    /** Asked while a problem advances, whenever its state can be kept; or nothing. Collective. */
    AfterStep after_step = {};
  };
} // namespace PeriDeal
