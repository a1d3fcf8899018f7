// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/parts.h>

#include <cctype>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    const std::string forms =
      "'SIDE if FORMULA', 'region FORMULA' or 'point X, Y' (in three dimensions 'point X, Y, Z')";


    bool is_blank(const char c)
    {
      return std::isspace(static_cast<unsigned char>(c)) != 0;
    }


    /** Whether the text is the word, or begins with it and a blank (or a parenthesis). */
    bool begins_with_word(const std::string &text, const std::string &word)
    {
      return text.compare(0, word.size(), word) == 0 &&
             (text.size() == word.size() || is_blank(text[word.size()]) ||
              text[word.size()] == '(');
    }


    /** Where the word `if` stands between a side and a formula; npos without one. */
    std::size_t place_of_if(const std::string &text)
    {
      const std::size_t quote = !text.empty() && text[0] == '"' ? text.find('"', 1) : 0;
      for (std::size_t i = quote == std::string::npos ? 1 : quote + 1; i < text.size(); ++i)
        if (is_blank(text[i - 1]) && begins_with_word(text.substr(i), "if"))
          return i;
      return std::string::npos;
    }
  } // namespace


  PartText split_part(const std::string &text, const std::string &where)
  {
    PartText result{Part::of_side, "", ""};
    for (const Part::Kind kind : {Part::region, Part::point})
      if (const std::string word = kind == Part::region ? "region" : "point";
          begins_with_word(text, word))
        {
          result.kind = kind;
          result.rest = trimmed(text.substr(word.size()));
          if (result.rest.empty())
            entry_error(where, "'" + word + "' is all there is; needs " + forms + ".");
          return result;
        }
    const std::size_t at = place_of_if(text);
    if (at == std::string::npos)
      entry_error(where,
                  "found '" + text + "', needs " + forms +
                    ". Whole sides have a name already and need no part.");
    result.side = unquoted(trimmed(text.substr(0, at)));
    result.rest = trimmed(text.substr(at + 2));
    if (result.rest.empty())
      entry_error(where, "a formula is missing behind 'if'.");
    return result;
  }


  Expression part_formula(const std::string &text, const std::string &where)
  {
    Expression formula(text, where, "x, y, z");
    if (formula.depends_on_time())
      entry_error(where,
                  "the formula '" + text +
                    "' depends on t; a part stays where it is. Let the values on it depend on t.");
    if (formula.is_constant() && !(formula.value(Point<1>()) > 0.))
      entry_error(where, "the formula '" + text + "' holds nowhere: the part is empty.");
    return formula;
  }
} // namespace PeriDeal
