// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>
#include <vector>

namespace PeriDeal
{
  /** For messages. */
  inline const std::string solution_entry = "'Solution' in section 'Reference'";

  /** `lattice harmonic(1, 2)` taken apart: the name and what stands in the parentheses. */
  struct SolutionCall
  {
    std::string name, arguments;
    bool        has_arguments;
  };

  /** Lower case, without blanks at the ends, single blanks inside. */
  std::string tidy(const std::string &text);

  SolutionCall take_apart(const std::string &text);

  /** Separated by commas outside of parentheses. */
  std::vector<std::string> split_at_commas(const std::string &text);

  /** Throws UserError for a name that is known for another physics: that of @p whom. */
  void refuse_name_of_others(const SolutionCall             &call,
                             const std::vector<std::string> &names_of_others,
                             const std::string              &whom,
                             const std::vector<std::string> &names);

  /**
   * Throws UserError with the nearest name if what is no formula was meant as a name. @param others
   * what else may be given
   */
  void refuse_unknown_name(const SolutionCall             &call,
                           const std::vector<std::string> &names,
                           const std::string              &others);
} // namespace PeriDeal
