// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>

namespace PeriDeal
{
  /** Whether a vector has ghosts is as before where this ends. */
  class KeptGhosts
  {
  public:
    explicit KeptGhosts(const Vector &vector)
      : vector(vector)
      , before(vector.has_ghost_elements())
    {}

    ~KeptGhosts()
    {
      vector.set_ghost_state(before);
    }

    KeptGhosts(const KeptGhosts &) = delete;

  private:
    const Vector &vector;
    const bool    before;
  };


  /** Ghosts of a vector are up to date while this lives. */
  class WithGhosts : public KeptGhosts
  {
  public:
    explicit WithGhosts(const Vector &vector)
      : KeptGhosts(vector)
    {
      vector.update_ghost_values();
    }
  };
} // namespace PeriDeal
