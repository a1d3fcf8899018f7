// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>

namespace PeriDeal
{
  /**
   * A name as it is: without the double quotation marks around it, between which separators and
   * the word `if` are letters like others. Blanks around it are to be gone.
   */
  inline std::string unquoted(const std::string &name)
  {
    const bool is_quoted = name.size() > 1 && name.front() == '"' &&
                           name.find('"', 1) == name.size() - 1;
    return is_quoted ? name.substr(1, name.size() - 2) : name;
  }


  /** The name as a list of a scene has to have it. */
  inline std::string quoted_if_needed(const std::string &name)
  {
    return name.find_first_of(":;,()|") == std::string::npos ? name : '"' + name + '"';
  }
} // namespace PeriDeal
