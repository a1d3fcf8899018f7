// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/quantities.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    const std::string form = "'name: max FIELD', min, mean or sum in place of max, then nothing, "
                             "'on SIDE', 'over region FORMULA' or 'over PHASE'";


    /** The text up to the first blank, which it loses with the blanks behind. */
    std::string take_word(std::string &text)
    {
      const std::size_t end  = std::min(text.find_first_of(" \t"), text.size());
      const std::string word = text.substr(0, end);
      text                   = trimmed(text.substr(end));
      return word;
    }


    void find_place(Quantity                                                             &quantity,
                    std::string                                                           rest,
                    const std::string                                                    &where,
                    const std::vector<std::string>                                       &phases,
                    const std::function<dealii::types::boundary_id(const std::string &)> &place_of)
    {
      const std::string which = take_word(rest);
      if ((which != "on" && which != "over") || rest.empty())
        entry_error(where,
                    "found '" + which + (rest.empty() ? "" : " " + rest) + "', needs " + form +
                      ".");
      std::string       formula = rest;
      const std::string first   = take_word(formula);
      if (which == "on")
        quantity.place = place_of(unquoted(rest));
      else if (first == "region")
        {
          if (formula.empty())
            entry_error(where, "a formula is missing behind 'region'.");
          quantity.region = Expression(formula, where, "x, y, z");
          if (quantity.region->depends_on_time())
            entry_error(where, "the region depends on t, which stays.");
        }
      else if (unquoted(rest) == "elsewhere" && !phases.empty())
        quantity.phase = -1;
      else
        quantity.phase = static_cast<int>(choice_of(unquoted(rest), phases, where + ", phase"));
    }
  } // namespace


  std::vector<Quantity> parse_quantities(
    const std::string                                                    &text,
    const std::string                                                    &where,
    const std::vector<std::string>                                       &phases,
    const std::function<dealii::types::boundary_id(const std::string &)> &place_of)
  {
    static const std::vector<std::string> kinds = {"min", "max", "mean", "sum"};
    std::vector<Quantity>                 quantities;
    for (const std::string &piece : split_list(text, ';'))
      {
        const auto [name, value] = name_and_value(piece, where);
        const std::string at     = where + ", '" + name + "'";
        Quantity          quantity;
        quantity.name    = unquoted(name);
        std::string rest = value;
        quantity.kind    = static_cast<Quantity::Kind>(choice_of(take_word(rest), kinds, at));
        quantity.field   = take_word(rest);
        if (quantity.field.empty())
          entry_error(at, "found '" + value + "', needs " + form + ".");
        if (quantity.name.find_first_of(",\"\n") != std::string::npos)
          entry_error(at, "a name in a table has no comma and no quotation mark.");
        if (std::any_of(quantities.begin(), quantities.end(), [&](const Quantity &other) {
              return other.name == quantity.name;
            }))
          entry_error(where, "'" + name + "' is named twice.");
        if (!rest.empty())
          find_place(quantity, rest, at, phases, place_of);
        quantities.push_back(quantity);
      }
    return quantities;
  }
} // namespace PeriDeal
