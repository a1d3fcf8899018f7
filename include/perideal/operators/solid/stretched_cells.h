// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/tensor.h>

#include <perideal/base/types.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace PeriDeal
{
  /**
   * Cells of a lattice, and which of them are stretched beyond a limit of theirs: looked for in
   * each step, so that all those are passed over, many at a time, whose strain |eps| at the centre
   * is below it. Not collective.
   */
  template <int dim>
  class StretchedCells
  {
  public:
    static constexpr unsigned int n_corners = dealii::GeometryInfo<dim>::vertices_per_cell;
    using Corners                           = std::array<std::uint32_t, n_corners>; // local nodes

    /** @param size of all cells, in each direction */
    void set(std::vector<Corners> cells, const dealii::Tensor<1, dim> &size);

    /** @param limit_of(corners) of the strain; cells left out stay so. */
    template <typename LimitOf>
    void set_limits(const LimitOf &limit_of)
    {
      constexpr double round_off = 1e-9;
      for (const Run &run : runs)
        for (std::uint32_t k = 0; k < run.n; ++k)
          if (double &square = squares[run.begin + k]; square != left_out)
            {
              const double limit = limit_of(shifted(run, k));
              square             = limit > 0. ? limit * limit * (1. - round_off) : 0.;
            }
    }

    /**
     * Call take(corners) for the cells that u, with ghosts up to date, may stretch beyond their
     * limits, in the order of their first nodes; those for which it returns true are left out from
     * then on.
     */
    template <typename Take>
    void visit_stretched(const Vector &u, const Take &take)
    {
      for (const Run &run : runs)
        for (std::uint32_t first = 0; first < run.n; first += at_once)
          {
            const std::uint32_t n = std::min<std::uint32_t>(at_once, run.n - first);
            if (!find(u, run, first, n))
              continue;
            for (std::uint32_t k = 0; k < n; ++k)
              if (double &square = squares[run.begin + first + k]; now[k] >= square)
                if (take(shifted(run, first + k)))
                  square = left_out;
          }
    }

    std::size_t memory_consumption() const
    {
      return runs.capacity() * sizeof(Run) + squares.capacity() * sizeof(double);
    }

  private:
    static constexpr unsigned int at_once  = 64;
    static constexpr double       left_out = std::numeric_limits<double>::infinity();

    /** Cells whose corners are shifted by one node each. */
    struct Run
    {
      Corners       corners; // of the first one
      std::uint32_t n;
      std::size_t   begin; // in squares
    };

    static Corners shifted(const Run &run, const std::uint32_t by)
    {
      Corners corners = run.corners;
      for (std::uint32_t &corner : corners)
        corner += by;
      return corners;
    }

    /** Squares of strains of some cells, to now. Returns whether any has reached its limit. */
    bool find(const Vector &u, const Run &run, const std::uint32_t first, const std::uint32_t n);

    std::vector<Run>            runs;
    std::vector<double>         squares; // of the limits
    std::array<double, dim>     slopes{};
    std::array<double, at_once> now{};
  };
} // namespace PeriDeal
