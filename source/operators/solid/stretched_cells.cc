// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/stretched_cells.h>

#include <algorithm>

#include "cell_strains.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void StretchedCells<dim>::set(std::vector<Corners> cells, const Tensor<1, dim> &size)
  {
    std::sort(cells.begin(), cells.end());
    runs.clear();
    for (const Corners &cell : cells)
      {
        if (runs.empty() || shifted(runs.back(), runs.back().n) != cell)
          runs.push_back({cell, 0, static_cast<std::size_t>(&cell - cells.data())});
        ++runs.back().n;
      }
    squares.assign(cells.size(), 0.);
    for (unsigned int d = 0; d < dim; ++d)
      slopes[d] = 2. / (n_corners * size[d]);
  }


  template <int dim>
  bool StretchedCells<dim>::find(const Vector       &u,
                                 const Run          &run,
                                 const std::uint32_t first,
                                 const std::uint32_t n)
  {
    static_assert(at_once <= n_cells_at_once, "More cells than there is room for.");
    const Corners corners = shifted(run, first);
    find_strain_squares(dim, u.begin(), corners.data(), slopes.data(), n, now.data());
    const double *const limits = squares.data() + run.begin + first;
    double              most   = -1.;
    for (std::uint32_t k = 0; k < n; ++k)
      most = std::max(most, now[k] - limits[k]);
    return most >= 0.;
  }


  PERIDEAL_INSTANTIATE_CLASS(class StretchedCells);
} // namespace PeriDeal
