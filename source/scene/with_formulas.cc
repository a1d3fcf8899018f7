// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/with_formulas.h>

namespace PeriDeal
{
  void with_formulas(const MPI_Comm communicator, const std::function<void()> &action)
  {
    const DeferredFormulaErrors errors;
    try
      {
        action();
      }
    catch (Diverged &diverged) // on all processes
      {
        if (diverged.trip.monitor == "formulas") // where what is not positive is no number
          errors.throw_if_any(communicator);
        if (diverged.trip.cause.empty())
          diverged.trip.cause = errors.first(communicator);
        throw;
      }
    catch (const UserError &)
      {
        // The cause, if it is a formula's value; not of this process alone: others wait elsewhere.
        if (all_processes_arrive(communicator))
          errors.throw_if_any(communicator);
        throw;
      }
    errors.throw_if_any(communicator);
  }
} // namespace PeriDeal
