// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>

namespace PeriDeal
{
  /** Throw the UserError about a line of a mesh file. */
  [[noreturn]] void msh_error(const std::string &name,
                              const unsigned int line,
                              const std::string &what);
} // namespace PeriDeal
