// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>

#include "result_record.h"
#include "run_output.h"

namespace PeriDeal
{
  /** Where a problem tells what it has found: messages, what is collected, what is written. */
  template <int dim>
  struct RunContext
  {
    Progress       &progress;
    ResultRecord   &record;
    RunOutput<dim> &output;
  };
} // namespace PeriDeal
