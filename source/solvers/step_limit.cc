// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/step_limit.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace PeriDeal
{
  StepLimit::StepLimit(ElasticOperator &op, const double step, const bool may_change)
    : op(op)
    , first(step)
    , may_change(may_change)
    , step(step)
    , n_broken(op.n_broken_bonds())
    , next_growth(op.next_event(0.))
  {}


  double StepLimit::estimate(const Vector &u)
  {
    const unsigned long long before = op.n_applications();
    op.linearize(u);
    const double limit = stable_motion_step(op);
    spent += op.n_applications() - before + 1;
    return limit;
  }


  double StepLimit::follow(const Vector &u, const double t, const unsigned long long n_steps)
  {
    // Stretches that differ by a tenth change the limit by a few percent; 0.8 of it leaves room
    // for 25. A step that is not ours has less room, and is looked after more closely.
    constexpr double alarming = 0.25, near = 0.9, at_first = 15.;
    const double     much = may_change ? 0.1 : 0.03, cost = may_change              ? 0.03 :
                                                            op.has_growing_cracks() ? 0.25 :
                                                                                      0.1;
    const double     now     = op.largest_stretch(u);
    const bool       grown   = now > stretch + std::max(much, much * stretch);
    const bool       relaxed = step < first && now < 0.5 * stretch;
    const bool       broken  = op.n_broken_bonds() > n_broken || t >= next_growth;
    if (!grown && !relaxed && !broken)
      return step;
    if (spent > at_first + cost * n_steps && now < (1. + alarming) * (stretch + alarming))
      return step;
    const double limit = estimate(u);
    stretch            = now;
    n_broken           = op.n_broken_bonds();
    next_growth        = op.next_event(t);
    std::ostringstream message;
    if (!may_change && !(step <= limit))
      message << "'Time step' in section 'Time' is " << step << ", but at t = " << t
              << " 'verlet' is stable up to " << limit
              << (op.nonlinear() ?
                    " only: the deformed body is stiffer than the body at rest. " :
                    " only: beside cracks that have grown the body is stiffer than at the start. ")
              << "Choose a smaller step, 'Time step = auto', which follows the deformation, or "
                 "'Stepper = newmark'.";
    if (!message.str().empty())
      throw Diverged(message.str(), "time step", step, limit, t);
    if (may_change && (step > near * limit || relaxed))
      step = std::min(first, share * limit);
    return step;
  }


  void StepLimit::exchange(Archive &archive)
  {
    archive.exchange("limited step", step);
    archive.exchange("stretch at limit", stretch);
    archive.exchange("broken bonds at limit", n_broken);
    archive.exchange("next growth after limit", next_growth);
    archive.exchange("applications for limits", spent);
  }
} // namespace PeriDeal
