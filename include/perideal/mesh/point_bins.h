// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace PeriDeal
{
  /** Numbered points in cubes of one edge, for searches within no more than that. */
  template <int dim>
  class PointBins
  {
  public:
    explicit PointBins(const double edge)
      : edge(edge)
    {}

    void add(const dealii::Point<dim> &p, const unsigned int number)
    {
      bins[bin_of(p)].push_back(number);
    }

    /**
     * Visit the numbers of all points within the edge of p, and of some more, in an order that
     * depends on places and on the order of add() alone.
     */
    template <typename Visit>
    void visit_near(const dealii::Point<dim> &p, const Visit &visit) const
    {
      const Bin    center  = bin_of(p);
      unsigned int n_cubes = 1;
      for (unsigned int d = 0; d < dim; ++d)
        n_cubes *= 3;
      for (unsigned int cube = 0; cube < n_cubes; ++cube)
        {
          Bin bin = center;
          for (unsigned int d = 0, rest = cube; d < dim; ++d, rest /= 3)
            bin[d] += static_cast<int>(rest % 3) - 1;
          if (const auto found = bins.find(bin); found != bins.end())
            for (const unsigned int number : found->second)
              visit(number);
        }
    }

  private:
    using Bin = std::array<long, dim>;

    Bin bin_of(const dealii::Point<dim> &p) const
    {
      Bin bin;
      for (unsigned int d = 0; d < dim; ++d)
        bin[d] = std::lround(std::floor(p[d] / edge));
      return bin;
    }

    double                                   edge;
    std::map<Bin, std::vector<unsigned int>> bins;
  };
} // namespace PeriDeal
