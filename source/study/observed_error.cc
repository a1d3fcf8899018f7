// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/study/observed_error.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    constexpr double usual_order   = 2.25; // where none has been seen, and nothing jumps
    constexpr double careful_order = 1.25; // where that is to be believed

    /** f0^-p - f1^-p over f1^-p - f2^-p, which grows with p. */
    double ratio(const double f0, const double f1, const double f2, const double p)
    {
      return (std::pow(f0, -p) - std::pow(f1, -p)) / (std::pow(f1, -p) - std::pow(f2, -p));
    }


    double order_of(const ComparedSolution &first,
                    const ComparedSolution &second,
                    const ComparedSolution &third,
                    const double            lowest,
                    const double            best)
    {
      if (!(third.difference > 0.) || !(second.difference > 0.))
        return best;
      const double seen = second.difference / third.difference;
      double       low = lowest, high = best;
      for (unsigned int k = 0; k < 40; ++k)
        {
          const double middle = 0.5 * (low + high);
          (ratio(first.fineness, second.fineness, third.fineness, middle) < seen ? low : high) =
            middle;
        }
      return 0.5 * (low + high);
    }


    double error_of(const ComparedSolution &before,
                    const ComparedSolution &step,
                    const double            order)
    {
      return step.difference / (std::pow(step.fineness / before.fineness, order) - 1.);
    }
  } // namespace


  ObservedError observed_error(const std::vector<ComparedSolution> &steps,
                               const double                         lowest,
                               const double                         best)
  {
    ObservedError     now{-1., best};
    const std::size_t n = steps.size();
    if (n < 2)
      return now;
    if (n == 2)
      {
        now.error = error_of(steps[0], steps[1], best > 1. ? std::min(usual_order, best) : best);
        return now;
      }
    now.order           = order_of(steps[n - 3], steps[n - 2], steps[n - 1], lowest, best);
    const double before = error_of(steps[n - 3], steps[n - 2], now.order);
    // Of an order that is known beforehand, since errors come unevenly, both count alike.
    const double counts = lowest < best || best > 1. ? 0.5 : 1.;
    now.error           = std::max(error_of(steps[n - 2], steps[n - 1], now.order),
                         counts * before *
                           std::pow(steps[n - 2].fineness / steps[n - 1].fineness, now.order));
    return now;
  }


  double largest_error(const std::vector<ComparedSolution> &steps)
  {
    const std::size_t n = steps.size();
    return error_of(steps[n - 2], steps[n - 1], careful_order);
  }


  double fineness_for(const ObservedError &now,
                      const double         fineness,
                      const double         wanted,
                      const double         farthest)
  {
    const double factor = std::pow(now.error / wanted, 1. / now.order);
    return fineness * std::clamp(factor, 1.2, farthest);
  }
} // namespace PeriDeal
