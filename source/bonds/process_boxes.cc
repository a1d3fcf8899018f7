// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/bonds/process_boxes.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr std::size_t n_boxes_per_process = 16;
  }


  template <int dim>
  ProcessBoxes<dim>::ProcessBoxes(const std::vector<Point<dim>> &own_points,
                                  const MPI_Comm                 communicator)
  {
    std::vector<double> numbers;
    const std::size_t   n = own_points.size();
    for (std::size_t b = 0; b < n_boxes_per_process; ++b)
      {
        const std::size_t begin = n * b / n_boxes_per_process,
                          end   = n * (b + 1) / n_boxes_per_process;
        for (unsigned int d = 0; d < dim && begin < end; ++d)
          {
            double low = own_points[begin][d], high = low;
            for (std::size_t i = begin; i < end; ++i)
              {
                low  = std::min(low, own_points[i][d]);
                high = std::max(high, own_points[i][d]);
              }
            numbers.insert(numbers.end(), {low, high});
          }
      }
    corners = Utilities::MPI::all_gather(communicator, numbers);
  }


  template <int dim>
  bool ProcessBoxes<dim>::reach(const unsigned int rank,
                                const Point<dim>  &p,
                                const double       distance) const
  {
    const double limit = std::pow(distance * (1. + 1e-6), 2);
    for (std::size_t k = 0; k < corners[rank].size(); k += 2 * dim)
      {
        double sum = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double low = corners[rank][k + 2 * d], high = corners[rank][k + 2 * d + 1];
            const double outside = std::max({low - p[d], p[d] - high, 0.});
            sum += outside * outside;
          }
        if (sum <= limit)
          return true;
      }
    return false;
  }


  PERIDEAL_INSTANTIATE_CLASS(class ProcessBoxes);
} // namespace PeriDeal
