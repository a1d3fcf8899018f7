// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "work_numbers.h"

#include <perideal/base/user_error.h>

#include <cmath>

namespace PeriDeal
{
  std::vector<double> numbers_of(const RowResult   &result,
                                 const std::string &model,
                                 const WorkMeasure  measure)
  {
    std::vector<double> numbers;
    if (measure == WorkMeasure::stress_intensity)
      {
        const RowResult::Json &models = result.results["models"];
        if (models.contains(model) && models[model].contains("stress intensity"))
          for (const auto &end : models[model]["stress intensity"].items())
            for (const char *const mode : {"I", "II", "III"})
              if (end.value().contains(mode))
                numbers.push_back(end.value()[mode].get<double>());
        return numbers;
      }
    std::vector<const RowResult::Json *> of_model;
    double                               last = 0.;
    for (const RowResult::Json &probe : result.results["probes"])
      if (probe["model"] == model)
        {
          if (probe["time"].get<double>() != last)
            of_model.clear();
          last = probe["time"].get<double>();
          of_model.push_back(&probe);
        }
    for (std::size_t k = 0; k + 1 < of_model.size(); k += 2)
      for (const char *const component : {"ux", "uy"})
        numbers.push_back((*of_model[k + 1])[component].get<double>() -
                          (*of_model[k])[component].get<double>());
    return numbers;
  }


  double relative_difference(const std::vector<double> &a, const std::vector<double> &b)
  {
    AssertThrow(a.size() == b.size(),
                UserError("work_precision: the rows do not have the same "
                          "numbers. Compute them again with --redo."));
    double difference = 0., size = 0.;
    for (std::size_t k = 0; k < a.size(); ++k)
      {
        difference += (a[k] - b[k]) * (a[k] - b[k]);
        size += b[k] * b[k];
      }
    return std::sqrt(difference / size);
  }
} // namespace PeriDeal
