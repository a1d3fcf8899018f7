// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>
#include <deal.II/base/numbers.h>

#include <perideal/laws/family_volume.h>

namespace PeriDeal
{
  double ball_volume(const unsigned int dim, const double delta)
  {
    switch (dim)
      {
        case 1:
          return 2. * delta;
        case 2:
          return dealii::numbers::PI * delta * delta;
        default:
          return 4. / 3. * dealii::numbers::PI * delta * delta * delta;
      }
  }


  double volume_factor(const double complete, const double one, const double other)
  {
    Assert(one > 0. && other > 0., dealii::ExcInternalError());
    return 2. * complete / (one + other);
  }
} // namespace PeriDeal
