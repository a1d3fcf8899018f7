// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "lines_of_choice.h"

#include <perideal/output/tables.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    /** Sides and what has to lie on lines, sorted, each once. */
    std::vector<double> wanted_along(const CrackedBox          &box,
                                     const CrackedBox          &points,
                                     const std::vector<double> &places,
                                     const unsigned int         d)
    {
      const double        lower = box.lower[d], upper = box.upper[d];
      const double        same = 1e-9 * (upper - lower);
      std::vector<double> all{lower, upper};
      const auto          add = [&](const double x) {
        if (x > lower + same && x < upper - same)
          all.push_back(x);
      };
      for (const CrackedBox *const of : {&box, &points})
        for (const auto &crack : of->cracks)
          for (const std::vector<double> &corner : crack)
            add(corner[d]);
      for (const double x : places)
        add(x);
      std::sort(all.begin(), all.end());
      all.erase(std::unique(all.begin(),
                            all.end(),
                            [&](const double a, const double b) { return b - a < same; }),
                all.end());
      return all;
    }


    /** With lines between, until no cell is more than @p most times as long as one beside it. */
    std::vector<double> evened(std::vector<double> lines, const double most)
    {
      for (std::size_t k = 0; k + 2 < lines.size();)
        {
          const double     left = lines[k + 1] - lines[k], right = lines[k + 2] - lines[k + 1];
          constexpr double slack = 1. + 1e-9;
          if (left > slack * most * right)
            lines.insert(lines.begin() + k + 1, lines[k + 1] - std::min(0.5 * left, 2. * right));
          else if (right > slack * most * left)
            lines.insert(lines.begin() + k + 2, lines[k + 1] + std::min(0.5 * right, 2. * left));
          else
            {
              ++k;
              continue;
            }
          k = k > 0 ? k - 1 : 0;
        }
      return lines;
    }
  } // namespace


  std::optional<CellLines> lines_through(const CrackedBox &box,
                                         const CrackedBox &points,
                                         const CellLines  &places,
                                         const double      size)
  {
    constexpr double narrowest = 0.01; // of the longest edge
    constexpr double most      = 3.;
    double           longest   = 0.;
    for (unsigned int d = 0; d < box.dim(); ++d)
      longest = std::max(longest, box.upper[d] - box.lower[d]);
    CellLines lines;
    for (unsigned int d = 0; d < box.dim(); ++d)
      {
        const auto wanted =
          wanted_along(box, points, places.empty() ? std::vector<double>() : places[d], d);
        lines.push_back({wanted[0]});
        for (std::size_t k = 1; k < wanted.size(); ++k)
          {
            const double length = wanted[k] - wanted[k - 1];
            if (length < narrowest * longest)
              return {};
            const auto n = static_cast<unsigned int>(std::max(1., std::round(length / size)));
            for (unsigned int i = 1; i <= n; ++i)
              lines.back().push_back(i == n ? wanted[k] : wanted[k - 1] + i * length / n);
          }
        lines.back() = evened(lines.back(), most);
      }
    return lines;
  }


  CellLines divided(const CellLines &lines, const unsigned int n)
  {
    CellLines all;
    for (const std::vector<double> &along : lines)
      {
        all.push_back({along[0]});
        for (std::size_t k = 1; k < along.size(); ++k)
          for (unsigned int i = 1; i <= n; ++i)
            all.back().push_back(i == n ? along[k] :
                                          along[k - 1] + i * (along[k] - along[k - 1]) / n);
      }
    return all;
  }


  double n_cells(const CellLines &lines)
  {
    double n = 1.;
    for (const std::vector<double> &along : lines)
      n *= along.size() - 1.;
    return n;
  }


  std::string to_text(const CellLines &lines)
  {
    std::string text;
    for (const std::vector<double> &along : lines)
      {
        text += text.empty() ? "" : " ; ";
        for (std::size_t k = 0; k < along.size(); ++k)
          text += (k > 0 ? ", " : "") + full_precision(along[k]);
      }
    return text;
  }
} // namespace PeriDeal
