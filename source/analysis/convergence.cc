// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/analysis/convergence.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  double observed_order(const double first_size,
                        const double first_error,
                        const double second_size,
                        const double second_error)
  {
    Assert(first_size > 0. && second_size > 0. && first_size != second_size,
           ExcMessage("Sizes must be positive and different."));
    return std::log(first_error / second_error) / std::log(first_size / second_size);
  }


  std::vector<double> observed_orders(const std::vector<double> &sizes,
                                      const std::vector<double> &errors)
  {
    AssertDimension(sizes.size(), errors.size());
    std::vector<double> orders;
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i)
      orders.push_back(observed_order(sizes[i], errors[i], sizes[i + 1], errors[i + 1]));
    return orders;
  }


  double least_squares_order(const std::vector<double> &sizes, const std::vector<double> &errors)
  {
    AssertDimension(sizes.size(), errors.size());
    Assert(sizes.size() >= 2, ExcMessage("A slope needs two runs."));
    double mean_size = 0., mean_error = 0.;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      {
        mean_size += std::log(sizes[i]) / sizes.size();
        mean_error += std::log(errors[i]) / sizes.size();
      }
    double covariance = 0., variance = 0.;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      {
        const double x = std::log(sizes[i]) - mean_size;
        covariance += x * (std::log(errors[i]) - mean_error);
        variance += x * x;
      }
    return covariance / variance;
  }


  double relative_l2_difference(const std::vector<double> &reference,
                                const std::vector<double> &values)
  {
    AssertDimension(reference.size(), values.size());
    double difference = 0., norm = 0.;
    for (std::size_t i = 0; i < reference.size(); ++i)
      {
        difference += (reference[i] - values[i]) * (reference[i] - values[i]);
        norm += reference[i] * reference[i];
      }
    return std::sqrt(difference / norm);
  }


  double scaled_relative_difference(const std::vector<double> &reference,
                                    const std::vector<double> &values)
  {
    AssertDimension(reference.size(), values.size());
    double      sum = 0.;
    std::size_t n   = 0;
    for (std::size_t i = 0; i < reference.size(); ++i)
      if (reference[i] != 0.)
        {
          const double relative = (reference[i] - values[i]) / reference[i];
          sum += relative * relative;
          ++n;
        }
    return n > 0 ? std::sqrt(sum) / n : 0.;
  }
} // namespace PeriDeal
