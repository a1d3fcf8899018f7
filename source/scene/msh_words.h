// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/lists.h>
#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace PeriDeal
{
  /**
   * The words of a file, with their lines; comments between its sections are passed over. Numbers
   * of a binary file count as words too, on the lines of the same file as text.
   */
  class MshWords
  {
  public:
    MshWords(const std::string &text, const std::string &name)
      : text(text)
      , file(name)
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

    /** The word that comes next, comments like anything else; none at the end of the file. */
    std::string_view coming() const
    {
      const std::size_t begin = std::min(text.find_first_not_of(blanks, position), text.size());
      return std::string_view(text).substr(begin, text.find_first_of(blanks, begin) - begin);
    }

    double real(const std::string &what)
    {
      const std::string           word  = number<double>(what);
      const std::optional<double> value = plain_number(word);
      if (!value)
        broken("found '" + shortened(word) + "'", what);
      if (!(std::abs(*value) < 1e100)) // squares and products have to be finite, too
        broken("found " + shortened(word) + ", which is too large", what);
      return *value;
    }

    int whole(const std::string &what, const long lowest, const long highest)
    {
      return whole(number<std::int32_t>(what), what, lowest, highest);
    }

    /** The number of a node or an element, for which version 4.1 has 8 bytes. */
    int tag(const std::string &what, const long lowest)
    {
      return whole(has_wide_tags ? number<std::uint64_t>(what) : number<std::int32_t>(what),
                   what,
                   lowest,
                   largest);
    }

    /** A number of things that follow, of which each takes two letters or 4 bytes at least. */
    int count(const std::string &what)
    {
      const std::string word = has_wide_numbers || !given.empty() ? number<std::uint64_t>(what) :
                                                                    std::string(next(what));
      const std::size_t rest = text.size() - position;
      if (has_bytes && has_wide_numbers && std::stoull(word) > rest / 4)
        error_of_binary("the file is broken: it counts " + word + " things that it does not have.");
      const int n = whole(word, what, 0, largest);
      if (!has_bytes && static_cast<std::size_t>(n) > rest / 2 + 1)
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

    /** The rest of the header of a binary file, which has this version. */
    void begin_binary(const std::string &version, const bool latest)
    {
      next("the kind of the file");
      if (coming() != "8")
        error_of_binary("it is binary and of numbers of " + shortened(std::string(coming())) +
                        " bytes, expected 8.");
      has_bytes        = true;
      has_wide_numbers = version[0] == '4';
      has_wide_tags    = latest;
      name             = file + " (binary, as text)";
      begin_data();
      if (read<std::int32_t>() != 1)
        error_of_binary("it is binary and has the byte order of another kind of machine. Save it "
                        "as text (in Gmsh: without -bin, Mesh.Binary = 0).");
      --line; // as text, that number is not there
      end_line();
    }

    /** In a binary file there are numbers from the next line on. */
    void begin_data()
    {
      if (has_bytes)
        position = std::min(text.find('\n', position), text.size() - 1) + 1;
      end_line();
    }

    /** As text, the numbers that follow stand on the next line. */
    void end_line()
    {
      n_ended += has_bytes ? 1 : 0;
    }

    /** As skip_to() the end of a section that may have numbers. */
    void skip_section(const std::string &title)
    {
      const std::string end = "$End" + title.substr(1);
      if (!has_bytes)
        return skip_to(end);
      const std::size_t found = text.find(end, position);
      if (found == std::string::npos)
        error_of_binary("the file is broken: it ends within " + title + ".");
      position = found + end.size();
      ++line;
    }

    /** Begin the next element of a binary file of version 2, of which @p n_left are left: the
     * words that its block has for all of its elements come behind its number. */
    void begin_element(const int n_left)
    {
      if (n_of_block == 0)
        {
          type       = read<std::int32_t>();
          n_of_block = read<std::int32_t>();
          n_tags     = read<std::int32_t>();
          if (n_of_block < 1 || n_of_block > n_left || n_tags < 0)
            error_of_binary("the file is broken: a block of " + std::to_string(n_of_block) +
                            " elements, " + std::to_string(n_left) + " are left.");
        }
      --n_of_block;
      given = {number<std::int32_t>(""), std::to_string(type), std::to_string(n_tags)};
    }

    /** @param at line; 0: that which is read */
    [[noreturn]] void broken(const std::string &found,
                             const std::string &expected,
                             const unsigned int at = 0) const
    {
      msh_error(name,
                at > 0 ? at : line,
                "the file is broken: " + found + ", expected " + expected + ".");
    }

    [[noreturn]] void error(const std::string &what) const
    {
      msh_error(name, line, what);
    }

    unsigned int line_number() const
    {
      return line;
    }

    bool is_binary() const
    {
      return has_bytes;
    }

    static constexpr long largest = 2147483646;

  private:
    int whole(const std::string &word,
              const std::string &what,
              const long         lowest,
              const long         highest) const
    {
      const bool digits = word.size() < 12 &&
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

    /** As next(), comments like anything else. */
    std::string_view any(const std::string &expected)
    {
      const std::string_view word = coming();
      line += n_ended > 0 ? n_ended : std::count(text.data() + position, word.data(), '\n');
      n_ended  = 0;
      position = word.data() + word.size() - text.data();
      if (word.empty() && has_bytes)
        error_of_binary("the file is broken: it ends before '$Elements'.");
      if (word.empty())
        broken("the file ends", expected);
      return word;
    }

    /** The next number, of which a binary file has the bytes. */
    template <typename T>
    std::string number(const std::string &what)
    {
      if (!given.empty())
        {
          const std::string word = given.front();
          given.erase(given.begin());
          return word;
        }
      if (!has_bytes)
        return std::string(next(what));
      std::ostringstream word;
      word << std::setprecision(17) << read<T>();
      return word.str();
    }

    template <typename T>
    T read()
    {
      if (position + sizeof(T) > text.size())
        error_of_binary("the file is broken: it ends within its binary numbers.");
      T value;
      std::memcpy(&value, text.data() + position, sizeof(T));
      position += sizeof(T);
      line += n_ended;
      n_ended = 0;
      return value;
    }

    /** In the line that says that the file is binary. */
    [[noreturn]] void error_of_binary(const std::string &what) const
    {
      msh_error(file, 2, what);
    }

    static std::string shortened(const std::string &word)
    {
      std::string result = word.size() > 40 ? word.substr(0, 40) + "..." : word;
      for (char &c : result) // of a file that is no text
        if (std::iscntrl(static_cast<unsigned char>(c)) != 0 || static_cast<signed char>(c) < 0)
          c = '?';
      return result;
    }

    static constexpr const char *blanks = " \t\n\v\f\r";

    const std::string       &text, &file;
    std::string              name; // in messages
    std::size_t              position = 0;
    unsigned int             line = 1, n_ended = 0;
    bool                     has_bytes = false, has_wide_numbers = false, has_wide_tags = false;
    int                      type = 0, n_of_block = 0, n_tags = 0; // of elements, version 2
    std::vector<std::string> given;                                // words that come first
  };
} // namespace PeriDeal
