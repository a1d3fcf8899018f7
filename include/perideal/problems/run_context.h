// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>
#include <perideal/operators/interface/operator.h>
#include <perideal/problems/result_record.h>
#include <perideal/solvers/step_span.h>

#include <functional>
#include <string>

namespace PeriDeal
{
  /** What a model will need, as far as that can be told. */
  struct ModelEstimate
  {
    std::string name;
    double      unknowns = 0., bonds = 0.;
    double      applications        = 0.; // of the operator until the end time; 0: not known
    double      time_of_application = 0.; // in seconds
    double      time_of_solution    = 0.; // of a linear equilibrium or steady state; 0: not known
    double      components          = 0.; // of all fields that are written together
  };


  /** Of this process, so that other programs on the machine do not count. */
  double processor_seconds();

  /** In such seconds. Collective. */
  double time_of_application(const Operator &op);


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
