// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** An entry and the texts it takes one after the other. */
  using Variation = std::pair<std::string, std::vector<std::string>>;

  /**
   * "Section/Entry=v1 | v2 | v3" taken apart at single bars outside parentheses; two bars are the
   * `or` of formulas. Throws UserError: another form, or an empty value.
   */
  Variation parse_variation(const std::string &text);

  /** All combinations, the first entry varying slowest. One empty combination if nothing varies. */
  std::vector<std::vector<Setting>> combinations(const std::vector<Variation> &variations);

  /**
   * "prefix, Cells = 24, 24, Horizon ratio = 2": sections are left out where the entries' own names
   * tell them apart.
   */
  std::string combination_name(const std::string &prefix, const std::vector<Setting> &combination);

  /**
   * One folder name for each row: its name with letters, digits, `.`, `-` and `_` only, and at most
   * 100 characters. Names that would share a folder, also where upper and lower case are the same,
   * get a hash of the name at the end.
   */
  std::vector<std::string> folder_names(const std::vector<std::string> &names);

  /** FNV-1a with 64 bits, as 16 hexadecimal digits: tells texts apart, not for secrets. */
  std::string text_hash(const std::string &text);
} // namespace PeriDeal
