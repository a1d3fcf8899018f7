// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>

namespace PeriDeal
{
  /** readable_duration() without an allocation. */
  void format_duration(char *text, const std::size_t size, const double seconds);
} // namespace PeriDeal
