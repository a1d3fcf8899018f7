// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>

namespace PeriDeal
{
  /** What writing and reading of checkpoints agree on; checkpoint_file.h says all. */
  namespace CheckpointFormat
  {
    constexpr std::size_t head_size = 512;
    constexpr const char *title     = "PeriDeal checkpoint ";
    constexpr unsigned    number    = 2;
  } // namespace CheckpointFormat
} // namespace PeriDeal
