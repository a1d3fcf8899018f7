// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>

namespace PeriDeal
{
  /** Ghosts of a vector are up to date while this lives. */
  class WithGhosts
  {
  public:
    explicit WithGhosts(const Vector &vector)
      : vector(vector)
      , before(vector.has_ghost_elements())
    {
      vector.update_ghost_values();
    }

    ~WithGhosts()
    {
      vector.set_ghost_state(before);
    }

    WithGhosts(const WithGhosts &) = delete;

  private:
    const Vector &vector;
    const bool    before;
  };
} // namespace PeriDeal
