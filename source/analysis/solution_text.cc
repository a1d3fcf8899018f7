// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solution_text.h"

#include <perideal/base/user_error.h>

#include <algorithm>
#include <cctype>

namespace PeriDeal
{
  namespace
  {
    /** Words and numbers without operators: somebody meant a name, and not a formula. */
    bool reads_like_a_name(const std::string &text)
    {
      return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
             std::all_of(text.begin(), text.end(), [](const char c) {
               return std::isalnum(static_cast<unsigned char>(c)) || c == ' ';
             });
    }
  } // namespace


  std::string tidy(const std::string &text)
  {
    std::string result;
    for (const char c : text)
      if (!std::isspace(static_cast<unsigned char>(c)))
        result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      else if (!result.empty() && result.back() != ' ')
        result += ' ';
    if (!result.empty() && result.back() == ' ')
      result.pop_back();
    return result;
  }


  SolutionCall take_apart(const std::string &text)
  {
    const std::size_t open = text.find('(');
    if (open == std::string::npos || text.back() != ')')
      return {text, "", false};
    return {tidy(text.substr(0, open)), text.substr(open + 1, text.size() - open - 2), true};
  }


  std::vector<std::string> split_at_commas(const std::string &text)
  {
    std::vector<std::string> parts(1);
    int                      depth = 0;
    for (const char c : text)
      {
        depth += (c == '(') - (c == ')');
        if (c == ',' && depth == 0)
          parts.emplace_back();
        else
          parts.back() += c;
      }
    return parts;
  }


  void refuse_name_of_others(const SolutionCall             &call,
                             const std::vector<std::string> &names_of_others,
                             const std::string              &whom,
                             const std::vector<std::string> &names)
  {
    AssertThrow(std::find(names_of_others.begin(), names_of_others.end(), call.name) ==
                  names_of_others.end(),
                UserError(solution_entry + ": '" + call.name + "' is for " + whom +
                          ". Known here are " + join_names(names) + ", and formulas."));
  }


  void refuse_unknown_name(const SolutionCall             &call,
                           const std::vector<std::string> &names,
                           const std::string              &others)
  {
    if (!reads_like_a_name(call.name))
      return;
    const std::string nearest = nearest_name(call.name, names);
    // A misspelt function, as in 'sinn(x)', is a mistake in a formula.
    if (nearest.empty() && call.has_arguments)
      return;
    throw UserError(solution_entry + ": there is no exact solution '" + call.name + "'" +
                    (nearest.empty() ? "" : "; did you mean '" + nearest + "'?") + " Known are " +
                    join_names(names) + ", and " + others + ".");
  }
} // namespace PeriDeal
