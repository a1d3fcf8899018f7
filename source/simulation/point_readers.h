// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/point_evaluator.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  using PointReaders = std::vector<std::unique_ptr<PointEvaluator<dim>>>;


  /** One for each model, or none without points. @p entry names the points in messages. Collective. */
  template <int dim, typename Models>
  PointReaders<dim> make_point_readers(const Models                           &models,
                                       const Cracks<dim>                      &cracks,
                                       const std::vector<std::vector<double>> &points,
                                       const std::string                      &entry)
  {
    PointReaders<dim> readers;
    if (!points.empty())
      for (const auto &model : models)
        readers.push_back(std::make_unique<PointEvaluator<dim>>(model->dofs(),
                                                                model->nodes(),
                                                                cracks,
                                                                points,
                                                                entry));
    return readers;
  }
} // namespace PeriDeal
