// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/crack_tips.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Point<dim> CrackTip<dim>::at(const double t) const
  {
    if (t <= path.front().first)
      return path.front().second;
    for (std::size_t k = 1; k < path.size(); ++k)
      if (t <= path[k].first)
        {
          const double share = (t - path[k - 1].first) / (path[k].first - path[k - 1].first);
          return path[k - 1].second + share * (path[k].second - path[k - 1].second);
        }
    return path.back().second + (t - path.back().first) * last_velocity;
  }


  template <int dim>
  double CrackTip<dim>::speed(const double t) const
  {
    if (t < path.front().first)
      return 0.;
    for (std::size_t k = 1; k < path.size(); ++k)
      if (t < path[k].first)
        return path[k].second.distance(path[k - 1].second) / (path[k].first - path[k - 1].first);
    return last_velocity.norm();
  }


  namespace
  {
    /** The points that a tip has passed by time t, the last one where it is then. */
    template <int dim>
    std::vector<Point<dim>> way(const CrackTip<dim> &tip, const double t)
    {
      std::vector<Point<dim>> points;
      for (const auto &[time, point] : tip.path)
        if (time < t)
          points.push_back(point);
      points.push_back(tip.at(t));
      return points;
    }


    /**
     * Without points that repeat the one before, and without those in the middle of a straight
     * line.
     */
    template <int dim>
    std::vector<Point<dim>> simplified(const std::vector<Point<dim>> &line)
    {
      constexpr double        straight = 1e-12;
      std::vector<Point<dim>> result;
      for (const Point<dim> &p : line)
        {
          if (!result.empty() && result.back() == p)
            continue;
          if (result.size() > 1)
            {
              Tensor<1, dim> before = result.back() - result[result.size() - 2],
                             next   = p - result.back();
              if ((before / before.norm() - next / next.norm()).norm() < straight)
                result.pop_back();
            }
          result.push_back(p);
        }
      return result;
    }


    template <int dim>
    std::vector<Point<dim>> line_of(const std::vector<Point<dim>>    &ends,
                                    const unsigned int                crack,
                                    const std::vector<CrackTip<dim>> &tips,
                                    const double                      t)
    {
      std::vector<Point<dim>> line(ends);
      for (const CrackTip<dim> &tip : tips)
        if (tip.crack == crack)
          {
            const std::vector<Point<dim>> passed = way(tip, t);
            if (tip.corner == 0)
              line.insert(line.begin(), passed.rbegin(), passed.rend());
            else
              line.insert(line.end(), passed.begin(), passed.end());
          }
      return simplified(line);
    }
  } // namespace


  template <int dim>
  std::vector<CrackPiece<dim>> crack_pieces(const std::vector<std::vector<Point<dim>>> &corners,
                                            const std::vector<CrackTip<dim>>           &tips,
                                            const double                                t)
  {
    std::vector<CrackPiece<dim>> pieces;
    for (unsigned int crack = 0; crack < corners.size(); ++crack)
      if (dim == 2)
        {
          const std::vector<Point<dim>> line = line_of(corners[crack], crack, tips, t);
          for (std::size_t i = 0; i + 1 < line.size(); ++i)
            pieces.push_back({{line[i], line[i + 1]}, crack, {}});
        }
      else
        {
          pieces.push_back({corners[crack], crack, {}});
          for (const CrackTip<dim> &tip : tips)
            if (tip.crack == crack)
              pieces.back().corners[tip.corner] = tip.at(t);
        }
    return pieces;
  }


  PERIDEAL_INSTANTIATE_CLASS(struct CrackTip);
  PERIDEAL_INSTANTIATE_FUNCTION(crack_pieces);
} // namespace PeriDeal
