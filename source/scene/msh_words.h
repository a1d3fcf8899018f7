// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "msh_error.h"

namespace PeriDeal
{
  /** The words of a file, with their lines; comments between its sections are passed over. */
  class Words
  {
  public:
    Words(const std::string &text, const std::string &name)
      : text(text)
      , name(name)
    {}

    /** The next word; at the end of the file an error that says what is missing. */
    std::string_view next(const std::string &expected)
    {
      const std::string_view word = any(expected);
      if (word != "$Comments")
        return word;
      while (any("'$EndComments'") != "$EndComments")
        {}
      return next(expected);
    }

    double real(const std::string &what)
    {
      const std::string word(next(what));
      char             *end   = nullptr;
      const double      value = std::strtod(word.c_str(), &end);
      if (*end != '\0' || word.find_first_not_of("0123456789+-.eE") != std::string::npos)
        broken("found '" + shortened(word) + "'", what);
      if (!(std::abs(value) < 1e100)) // squares and products have to be finite, too
        broken("found " + shortened(word) + ", which is too large", what);
      return value;
    }

    int whole(const std::string &what, const long lowest, const long highest)
    {
      const std::string word(next(what));
      const bool        digits = word.size() < 12 &&
                          word.find_first_not_of("0123456789", word[0] == '-' ? 1 : 0) ==
                            std::string::npos;
      char      *end   = nullptr;
      const long value = std::strtol(word.c_str(), &end, 10);
      if (!digits || *end != '\0')
        broken("found '" + shortened(word) + "'", what);
      if (value < lowest || value > highest)
        broken("found " + word,
               what + (highest == largest ?
                         ", " + std::to_string(lowest) + " or more" :
                         ", from " + std::to_string(lowest) + " to " + std::to_string(highest)));
      return static_cast<int>(value);
    }

    /** A number of things that follow, of which each takes two letters at least. */
    int count(const std::string &what)
    {
      const int n = whole(what, 0, largest);
      if (static_cast<std::size_t>(n) > (text.size() - position) / 2 + 1)
        broken("found " + std::to_string(n) + ", more than the rest of the file can hold", what);
      return n;
    }

    void skip_to(const std::string &end)
    {
      while (next("'" + end + "'") != end)
        {}
    }

    /** What stands before the word, with its line ends; behind the word goes on what follows. */
    std::string text_until(const std::string &end)
    {
      const std::size_t begin = position;
      skip_to(end);
      return text.substr(begin, position - end.size() - begin);
    }

    void require(const std::string &expected)
    {
      const std::string word(next("'" + expected + "'"));
      if (word != expected)
        broken("found '" + shortened(word) + "'", "'" + expected + "'");
    }

    [[noreturn]] void broken(const std::string &found, const std::string &expected) const
    {
      msh_error(name, line, "the file is broken: " + found + ", expected " + expected + ".");
    }

    [[noreturn]] void error(const std::string &what) const
    {
      msh_error(name, line, what);
    }

    unsigned int line_number() const
    {
      return line;
    }

    static constexpr long largest = 2147483646;

  private:
    static bool is_blank(const char c)
    {
      return std::isspace(static_cast<unsigned char>(c)) != 0;
    }

    /** As next(), comments like anything else. */
    std::string_view any(const std::string &expected)
    {
      while (position < text.size() && is_blank(text[position]))
        {
          line += text[position] == '\n' ? 1 : 0;
          ++position;
        }
      const std::size_t begin = position;
      while (position < text.size() && !is_blank(text[position]))
        ++position;
      if (begin == position)
        broken("the file ends", expected);
      return std::string_view(text).substr(begin, position - begin);
    }

    static std::string shortened(const std::string &word)
    {
      std::string result = word.size() > 40 ? word.substr(0, 40) + "..." : word;
      for (char &c : result) // of a file that is no text
        if (std::iscntrl(static_cast<unsigned char>(c)) != 0 || static_cast<signed char>(c) < 0)
          c = '?';
      return result;
    }

    const std::string &text, &name;
    std::size_t        position = 0;
    unsigned int       line     = 1;
  };
} // namespace PeriDeal
