// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/base/user_error.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /*
   * The texts of a scene: `;` separates sides and points, the first `:` separates a name from its
   * value, `,` separates components; separators count only outside parentheses. In all functions
   * below @p where names the entry and its section for messages, for example "'Cells' in section
   * 'Domain'".
   */

  /** Throw the UserError "Entry <where>: <what>". */
  [[noreturn]] void entry_error(const std::string &where, const std::string &what);

  /** Without blanks, tabs and line ends around it. */
  std::string trimmed(const std::string &text);

  /**
   * The trimmed pieces between separators outside parentheses. No piece for an empty text; one
   * separator at the end is allowed.
   */
  std::vector<std::string> split_list(const std::string &text, const char separator);

  /** Name and value around the first `:`, or an error if one of them is missing. */
  std::pair<std::string, std::string> name_and_value(const std::string &text,
                                                     const std::string &where);

  /** Whether a value is one of the list. */
  template <typename List, typename Value>
  bool has(const List &list, const Value &value)
  {
    return std::find(list.begin(), list.end(), value) != list.end();
  }

  /**
   * What to add to a message where @p n words stand without the commas that lists need, or nothing.
   */
  std::string hint_at_commas(const std::string &text, const unsigned int n);

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

  /** A decimal number, infinite if it is too large, or nothing if the text is anything else. */
  std::optional<double> plain_number(const std::string &text);

  /** A finite decimal number and nothing else. */
  double parse_number(const std::string &text, const std::string &where);

  /** A whole number from 0 to @p maximum. */
  unsigned int parse_whole_number(const std::string &text,
                                  const std::string &where,
                                  const unsigned int maximum = 4294967294u);

  /** A unit and what it is in that in which a number is kept. */
  using UnitSizes = std::vector<std::pair<std::string, double>>;

  /**
   * A decimal number that is not negative and its unit, `1.5 min`, in that in which it is kept;
   * negative if the text is none, or its unit is not listed.
   */
  double number_with_unit(const std::string &text, const UnitSizes &units);

  /** Exactly @p n numbers separated by commas; @p what is what they are called ("coordinates"). */
  std::vector<double> parse_numbers(const std::string &text,
                                    const unsigned int n,
                                    const std::string &what,
                                    const std::string &where);

  /** The point of the first dim of these coordinates. */
  template <int dim>
  dealii::Point<dim> point_of(const double *x)
  {
    dealii::Point<dim> p;
    std::copy_n(x, dim, p.begin_raw());
    return p;
  }


  /** dim coordinates separated by commas. */
  template <int dim>
  dealii::Point<dim> parse_point(const std::string &text, const std::string &where);

  /** Points separated by semicolons. */
  template <int dim>
  std::vector<dealii::Point<dim>> parse_points(const std::string &text, const std::string &where);

  /** Position of @p text in @p names, or an error with the names and the nearest of them. */
  unsigned int choice_of(const std::string              &text,
                         const std::vector<std::string> &names,
                         const std::string              &where);

  /** " Did you mean 'X'?" or nothing, to end a message about an unknown name. */
  std::string did_you_mean(const std::string &name, const std::vector<std::string> &known);

  /** Shortest decimal text that reads back as the same number, as far as 12 digits allow. */
  std::string number_text(const double value);

  /** "(1, 0.5)" */
  template <int dim>
  std::string point_text(const dealii::Point<dim> &p)
  {
    std::string text = "(";
    for (unsigned int d = 0; d < dim; ++d)
      text += (d > 0 ? ", " : "") + number_text(p[d]);
    return text + ")";
  }

  /** With so many digits, as people read numbers in a sentence. */
  std::string rounded_text(const double value, const int n_digits = 3);
} // namespace PeriDeal
