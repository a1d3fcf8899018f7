// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/types.h>

#include <perideal/scene/expression.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A value of a field that a scene asks for in totals.csv (`Quantities` in section `Output`):
   *
   *   name: max uy on right ; name: mean von_mises over region x > 0.9 ; name: sum T over steel
   */
  struct Quantity
  {
    enum Kind
    {
      minimum,
      maximum,
      mean, // by volume, on sides by area
      sum   // the integral: values times volumes, on sides areas
    };

    std::string                               name, field;
    Kind                                      kind = maximum;
    std::optional<dealii::types::boundary_id> place;  // of a side or part; none: the whole body
    std::optional<int>                        phase;  // as Regions number it; -1: elsewhere
    std::optional<Expression>                 region; // where this is > 0

    bool has_place() const // of its value, in the body
    {
      return kind == minimum || kind == maximum;
    }
  };


  /**
   * The quantities of a list. @param where entry and section for messages
   * @param phases names of the material's phases, for `over NAME`
   * @param place_of the number of a side or part; throws UserError where there is none
   * Throws UserError.
   */
  std::vector<Quantity> parse_quantities(
    const std::string                                                    &text,
    const std::string                                                    &where,
    const std::vector<std::string>                                       &phases,
    const std::function<dealii::types::boundary_id(const std::string &)> &place_of);
} // namespace PeriDeal
