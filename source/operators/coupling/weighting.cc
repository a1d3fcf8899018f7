// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/coupling/weighting.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    class Blending : public Weighting
    {
    public:
      double of_family(const double beta) const override
      {
        return beta;
      }

      double of_row(const double) const override
      {
        return 1.;
      }

      double of_cell(const double mean) const override
      {
        return std::max(0., 1. - mean);
      }

      double of_cell_row(const double) const override
      {
        return 1.;
      }

      bool symmetric() const override
      {
        return true;
      }
    };


    class Splice : public Weighting
    {
    public:
      double of_family(const double) const override
      {
        return 1.;
      }

      double of_row(const double beta) const override
      {
        return beta;
      }

      double of_cell(const double) const override
      {
        return 1.;
      }

      double of_cell_row(const double beta) const override
      {
        return 1. - beta;
      }

      bool symmetric() const override
      {
        return false;
      }
    };
  } // namespace


  std::unique_ptr<const Weighting> make_weighting(const CouplingScheme scheme)
  {
    if (scheme == CouplingScheme::splice)
      return std::make_unique<Splice>();
    if (scheme == CouplingScheme::blending)
      return std::make_unique<Blending>();
    return nullptr;
  }
} // namespace PeriDeal
