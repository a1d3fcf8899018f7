// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>

namespace PeriDeal
{
  /**
   * While this is alive, messages about formulas that have a name that they do not know list these
   * variables in place of `x, y, z, t`. That a formula has no others (t where nothing may change)
   * is for the one who reads it to ask. Not thread safe.
   */
  class KnownVariables
  {
  public:
    explicit KnownVariables(const std::string &list);
    ~KnownVariables();
    KnownVariables(const KnownVariables &)            = delete;
    KnownVariables &operator=(const KnownVariables &) = delete;

  private:
    const std::string before;
  };
} // namespace PeriDeal
