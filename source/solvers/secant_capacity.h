// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/operator.h>

#include <cmath>

namespace PeriDeal
{
  /**
   * Between two iterates of a stage, what an unknown takes up per degree: the slope of the chord of
   * its heat over its temperature, where C(T) is that of the tangent. Where the capacity jumps, as
   * at both ends of a latent heat, Newton's iterations go to and fro between two tangents; chords
   * lead into the bend between them.
   */
  class SecantCapacity
  {
  public:
    /** Forget the iterates of the stage before. */
    void start()
    {
      n_seen = 0;
    }

    /**
     * See an iterate and the heat that it has more than the beginning of the step. Returns what
     * the capacity of the chord has more than that of the operator, or nullptr while tangents may
     * do.
     */
    const Vector *see(const Operator &op, const Vector &iterate, const Vector &heat)
    {
      constexpr unsigned int by_tangents = 4;
      ++n_seen;
      if (n_seen <= by_tangents)
        {
          keep(iterate, heat);
          return nullptr;
        }
      more = 0.;
      for (unsigned int i = 0; i < iterate.locally_owned_size(); ++i)
        {
          const double way  = iterate.local_element(i) - last.local_element(i),
                       gain = heat.local_element(i) - last_heat.local_element(i),
                       size =
                         std::abs(heat.local_element(i)) + std::abs(last_heat.local_element(i));
          if (way * gain > 0. && std::abs(gain) > 1e-10 * size) // above round-off
            more.local_element(i) = gain / way - op.lumped_capacity().local_element(i);
        }
      keep(iterate, heat);
      return &more;
    }

  private:
    void keep(const Vector &iterate, const Vector &heat)
    {
      last      = iterate;
      last_heat = heat;
      if (more.size() == 0)
        more.reinit(iterate, true);
    }

    unsigned int n_seen = 0;
    Vector       last, last_heat, more;
  };
} // namespace PeriDeal
