// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include "elastic_test_tools.h"

namespace PeriDeal
{
  namespace OperatorTests
  {
    /** Waves of a size and a phase. */
    template <int dim>
    Vector waves(const Body<dim> &body, const double size, const double phase)
    {
      return body.values([&](dealii::Point<dim> p) {
        for (unsigned int d = 0; d < dim; ++d)
          p[d] += phase * (1. + 0.3 * d);
        return dealii::Tensor<1, dim>(size * bumpy_vector<dim>(p));
      });
    }
  } // namespace OperatorTests
} // namespace PeriDeal
