// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  /** A bond that has broken, in the numbering of this process, and when. */
  struct BondBreak
  {
    unsigned int node, neighbor; // the first one is owned, the second one may be a ghost
    double       time;
  };
} // namespace PeriDeal
