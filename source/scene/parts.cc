// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/parts.h>

#include <algorithm>
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


  Part parse_part(const std::string &text,
                  const unsigned int dim,
                  const std::string &where,
                  std::string       &side)
  {
    Part        part;
    std::string rest;
    for (const Part::Kind kind : {Part::region, Part::point})
      if (const std::string word = kind == Part::region ? "region" : "point";
          begins_with_word(text, word))
        {
          part.kind = kind;
          rest      = trimmed(text.substr(word.size()));
          if (rest.empty())
            entry_error(where, "'" + word + "' is all there is; needs " + forms + ".");
        }
    if (part.kind == Part::of_side)
      {
        const std::size_t at = place_of_if(text);
        if (at == std::string::npos)
          entry_error(where,
                      "found '" + text + "', needs " + forms +
                        ". Whole sides have a name already and need no part.");
        side = unquoted(trimmed(text.substr(0, at)));
        rest = trimmed(text.substr(at + 2));
        if (rest.empty())
          entry_error(where, "a formula is missing behind 'if'.");
      }
    if (part.kind == Part::point)
      {
        const auto x = parse_numbers(rest, dim, dim == 1 ? "coordinate" : "coordinates", where);
        std::copy(x.begin(), x.end(), part.place.begin());
        return part;
      }
    part.inside = Expression(rest, where, "x, y, z");
    if (part.inside.depends_on_time())
      entry_error(where,
                  "the formula '" + rest +
                    "' depends on t; a part stays where it is. Let the values on it depend on t.");
    if (part.inside.is_constant() && !(part.inside.value(Point<1>()) > 0.))
      entry_error(where, "the formula '" + rest + "' holds nowhere: the part is empty.");
    return part;
  }
} // namespace PeriDeal
