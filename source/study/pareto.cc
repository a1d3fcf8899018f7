// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/study/pareto.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace PeriDeal
{
  namespace
  {
    /** The order in the cost of the last three points of a family (of two, if it has no more). */
    double final_order(const std::vector<WorkPoint> &family)
    {
      std::vector<double> costs, errors;
      for (std::size_t k = family.size() - std::min<std::size_t>(3, family.size());
           k < family.size();
           ++k)
        {
          costs.push_back(family[k].cost);
          errors.push_back(family[k].error);
        }
      return -observed_order(costs, errors);
    }
  } // namespace


  bool dominates(const WorkPoint &a, const WorkPoint &b)
  {
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
  }


  std::vector<std::size_t> pareto_front(const std::vector<WorkPoint> &points)
  {
    std::vector<std::size_t> order(points.size()), front;
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) {
      return points[a].cost < points[b].cost ||
             (points[a].cost == points[b].cost && points[a].error < points[b].error);
    });
    for (const std::size_t k : order)
      if (front.empty() || !dominates(points[front.back()], points[k]))
        front.push_back(k);
    return front;
  }


  std::vector<std::size_t> dominating_points(const std::vector<WorkPoint> &points)
  {
    const std::vector<std::size_t> front = pareto_front(points);
    std::vector<std::size_t>       by(points.size(), no_point);
    for (std::size_t k = 0; k < points.size(); ++k)
      for (const std::size_t best : front)
        if (dominates(points[best], points[k]))
          {
            by[k] = best;
            break;
          }
    return by;
  }


  double observed_order(const std::vector<double> &spacings, const std::vector<double> &errors)
  {
    AssertDimension(spacings.size(), errors.size());
    constexpr double nan   = std::numeric_limits<double>::quiet_NaN();
    const double     n     = static_cast<double>(spacings.size());
    double           sum_x = 0., sum_y = 0., sum_xx = 0., sum_xy = 0.;
    for (std::size_t k = 0; k < spacings.size(); ++k)
      {
        if (!(spacings[k] > 0.) || !(errors[k] > 0.))
          return nan;
        const double x = std::log(spacings[k]), y = std::log(errors[k]);
        sum_x += x;
        sum_y += y;
        sum_xx += x * x;
        sum_xy += x * y;
      }
    const double spread = n * sum_xx - sum_x * sum_x;
    return n < 2. || spread <= 1e-12 * n * sum_xx ? nan : (n * sum_xy - sum_x * sum_y) / spread;
  }


  CostAtError cost_at_error(const std::vector<WorkPoint> &family, const double error)
  {
    CostAtError result;
    if (family.empty())
      return result;
    // The last point that is not good enough: what is coarser may be better by chance.
    std::size_t last = no_point;
    for (std::size_t k = 0; k < family.size(); ++k)
      if (family[k].error > error)
        last = k;
    if (last == no_point)
      {
        result.kind = CostAtError::Kind::at_most;
        result.cost = family.front().cost;
        return result;
      }
    const bool       beyond = last + 1 == family.size();
    const WorkPoint &b      = family[beyond ? last : last + 1];
    result.beyond           = beyond ? b.error / error : 1.;
    double order            = 0.; // error = C cost^-order
    if (beyond)
      order = result.beyond > farthest_extrapolation ? 0. : final_order(family);
    else
      order = std::log(family[last].error / b.error) / std::log(b.cost / family[last].cost);
    const bool steady = b.error > 0. && order > 1e-2 && std::isfinite(order);
    if (!steady && !beyond)
      {
        // The good point is hardly dearer than the one before.
        result.kind = CostAtError::Kind::at_most;
        result.cost = b.cost;
      }
    if (!steady)
      return result;
    result.kind = beyond ? CostAtError::Kind::extrapolated : CostAtError::Kind::interpolated;
    result.cost = b.cost * std::pow(b.error / error, 1. / order);
    return result;
  }


  double order_of_differences(const double coarse, const double fine)
  {
    return std::log2(coarse / fine);
  }


  std::vector<double> richardson(const std::vector<double> &coarse,
                                 const std::vector<double> &fine,
                                 const double               order)
  {
    AssertDimension(coarse.size(), fine.size());
    std::vector<double> limit(fine.size());
    for (std::size_t k = 0; k < fine.size(); ++k)
      limit[k] = fine[k] + (fine[k] - coarse[k]) / (std::exp2(order) - 1.);
    return limit;
  }
} // namespace PeriDeal
