// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/point_evaluator.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  using PointReaders = std::vector<std::unique_ptr<PointEvaluator<dim>>>;


  /**
   * One for each model, or none without points. @p entry names the points in messages; those of a
   * `Line` may lie outside the body. @param beside as PointEvaluator has it. Collective.
   */
  template <int dim, typename Models>
  PointReaders<dim> make_point_readers(const Models                                    &models,
                                       const Cracks<dim>                               &cracks,
                                       const std::vector<std::vector<double>>          &points,
                                       const std::string                               &entry,
                                       const typename PointEvaluator<dim>::BesideCracks beside)
  {
    using Outside = typename PointEvaluator<dim>::Outside;
    PointReaders<dim> readers;
    if (!points.empty())
      for (const auto &model : models)
        readers.push_back(std::make_unique<PointEvaluator<dim>>(
          model->dofs(),
          model->nodes(),
          cracks,
          points,
          entry,
          entry == "Line" ? Outside::leave_gaps : Outside::refuse,
          beside));
    return readers;
  }


  /** A note on the points of a line that are not in the body, or nothing. */
  template <int dim>
  std::vector<std::string> gaps_in_line(const PointReaders<dim>                &readers,
                                        const std::vector<std::vector<double>> &points)
  {
    std::vector<unsigned int> outside;
    for (unsigned int k = 0; k < points.size(); ++k)
      if (std::any_of(readers.begin(), readers.end(), [&](const auto &reader) {
            return reader->is_gap(k);
          }))
        outside.push_back(k);
    if (outside.empty())
      return {};
    const auto place = [&](const unsigned int k) {
      std::ostringstream text;
      for (const double x : points[k])
        text << (text.tellp() > 0 ? ", " : "(") << x;
      return text.str() + ")";
    };
    const std::string n =
      std::to_string(outside.size()) + " of its " + std::to_string(points.size()) + " points ";
    return {"'Line' in section 'Output': " +
            (outside.size() == 1 ?
               n + "lies outside the body, " + place(outside[0]) :
               n + "lie outside the body, the first at " + place(outside.front()) +
                 ", the last at " + place(outside.back())) +
            ". They have no values: nan in line.csv, gaps in figures."};
  }
} // namespace PeriDeal
