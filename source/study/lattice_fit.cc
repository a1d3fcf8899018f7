// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/study/lattice_fit.h>

#include <cmath>

namespace PeriDeal
{
  LatticeFit fit_of_lattices(const std::vector<OnLattice> &found)
  {
    LatticeFit   fit;
    const double n = found.size();
    if (n < 3)
      return fit;
    double h = 0., s = 0., hh = 0., hs = 0., rest = 0.;
    for (const OnLattice &one : found)
      {
        h += one.spacing / n;
        s += one.value / n;
      }
    for (const OnLattice &one : found)
      {
        hh += (one.spacing - h) * (one.spacing - h);
        hs += (one.spacing - h) * (one.value - s);
      }
    fit.is_known = hh > 0.;
    if (!fit.is_known)
      return fit;
    fit.slope = hs / hh;
    fit.limit = s - fit.slope * h;
    for (const OnLattice &one : found)
      rest += std::pow(one.value - fit.limit - fit.slope * one.spacing, 2);
    fit.scatter     = std::sqrt(rest / (n - 2.));
    fit.uncertainty = fit.scatter * std::sqrt(1. / n + h * h / hh);
    return fit;
  }


  double error_of_last(const std::vector<OnLattice> &found)
  {
    const LatticeFit fit = fit_of_lattices(found);
    return fit.is_known ? std::abs(found.back().value - fit.limit) + 2. * fit.uncertainty : -1.;
  }
} // namespace PeriDeal
