// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>

namespace PeriDeal
{
  void entry_error(const std::string &where, const std::string &what)
  {
    AssertThrow(false, UserError("Entry " + where + ": " + what));
    std::abort(); // never reached: AssertThrow throws
  }


  std::string trimmed(const std::string &text)
  {
    const char *const blanks = " \t\r\n\v\f";
    const std::size_t first  = text.find_first_not_of(blanks);
    if (first == std::string::npos)
      return "";
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
  }


  std::vector<std::string> split_list(const std::string &text, const char separator)
  {
    std::vector<std::string> pieces;
    if (trimmed(text).empty())
      return pieces;
    int         depth = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < text.size(); ++i)
      {
        if (const std::size_t end = text[i] == '"' ? text.find('"', i + 1) : std::string::npos;
            end != std::string::npos)
          i = end;
        else if (text[i] == '(')
          ++depth;
        else if (text[i] == ')')
          --depth;
        else if (text[i] == separator && depth <= 0)
          {
            pieces.push_back(trimmed(text.substr(begin, i - begin)));
            begin = i + 1;
          }
      }
    pieces.push_back(trimmed(text.substr(begin)));
    if (pieces.size() > 1 && pieces.back().empty())
      pieces.pop_back();
    return pieces;
  }


  std::pair<std::string, std::string> name_and_value(const std::string &text,
                                                     const std::string &where)
  {
    const std::string all   = trimmed(text);
    const std::size_t quote = !all.empty() && all[0] == '"' ? all.find('"', 1) : 0;
    const std::size_t colon = all.find(':', quote == std::string::npos ? 0 : quote);
    const std::string name  = unquoted(trimmed(all.substr(0, colon)));
    const std::string value = colon == std::string::npos ? "" : trimmed(all.substr(colon + 1));
    if (name.empty() || value.empty())
      entry_error(where, "found '" + text + "', needs 'name: value' (several separated by ';').");
    return {name, value};
  }


  std::string hint_at_commas(const std::string &text, const unsigned int n)
  {
    std::string words = text;
    std::replace_if(
      words.begin(),
      words.end(),
      [](const char c) { return c == ',' || c == ';'; },
      ' ');
    std::istringstream in(words);
    std::string        with_commas;
    unsigned int       n_words = 0;
    for (std::string word; in >> word; ++n_words)
      with_commas += (with_commas.empty() ? "" : ", ") + word;
    return n_words == n ? " Commas separate them: " + with_commas : "";
  }


  std::optional<double> plain_number(const std::string &text)
  {
    // strtod also takes hexadecimal numbers, inf and nan, which a scene does not
    if (text.find_first_not_of("0123456789+-.eE") != std::string::npos)
      return {};
    char        *end   = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end == text.c_str() || *end != '\0' ? std::optional<double>() : value;
  }


  double parse_number(const std::string &text, const std::string &where)
  {
    const std::string           word  = trimmed(text);
    const std::optional<double> value = plain_number(word);
    if (!value)
      entry_error(where, word.empty() ? "a number is missing." : "'" + word + "' is not a number.");
    if (!std::isfinite(*value))
      entry_error(where, "'" + word + "' is too large for a number.");
    return *value;
  }


  double number_with_unit(const std::string &text, const UnitSizes &units)
  {
    const std::string plain  = trimmed(text);
    char             *end    = nullptr;
    const double      number = std::strtod(plain.c_str(), &end);
    const std::string digits(plain.c_str(), static_cast<const char *>(end));
    if (digits.empty() || digits.find_first_not_of("0123456789.eE+-") != std::string::npos ||
        !std::isfinite(number) || number < 0.)
      return -1.;
    const std::string unit = trimmed(end);
    for (const auto &[name, size] : units)
      if (unit == name)
        return number * size;
    return -1.;
  }


  unsigned int parse_whole_number(const std::string &text,
                                  const std::string &where,
                                  const unsigned int maximum)
  {
    const double value = parse_number(text, where);
    if (value < 0 || value > maximum || value != std::floor(value))
      entry_error(where,
                  "found '" + trimmed(text) + "', needs a whole number from 0 to " +
                    std::to_string(maximum) + ".");
    return static_cast<unsigned int>(value);
  }


  std::vector<double> parse_numbers(const std::string &text,
                                    const unsigned int n,
                                    const std::string &what,
                                    const std::string &where)
  {
    const std::vector<std::string> pieces = split_list(text, ',');
    if (pieces.size() != n)
      entry_error(where,
                  "'" + trimmed(text) + "' needs " + std::to_string(n) + " " + what + ", found " +
                    std::to_string(pieces.size()) + "." + hint_at_commas(text, n));
    std::vector<double> values;
    for (const std::string &piece : pieces)
      values.push_back(parse_number(piece, where));
    return values;
  }


  template <int dim>
  dealii::Point<dim> parse_point(const std::string &text, const std::string &where)
  {
    return point_of<dim>(
      parse_numbers(text, dim, dim == 1 ? "coordinate" : "coordinates", where).data());
  }


  template <int dim>
  std::vector<dealii::Point<dim>> parse_points(const std::string &text, const std::string &where)
  {
    std::vector<dealii::Point<dim>> points;
    for (const std::string &piece : split_list(text, ';'))
      {
        const std::vector<std::string> numbers = split_list(piece, ',');
        if (dim > 1 && numbers.size() > dim && numbers.size() % dim == 0)
          {
            std::string several;
            for (unsigned int k = 0; k < numbers.size(); ++k)
              several += (k == 0 ? "" : k % dim == 0 ? " ; " : ", ") + trimmed(numbers[k]);
            entry_error(where,
                        "'" + trimmed(piece) + "' has " + std::to_string(numbers.size()) +
                          " coordinates, those of " + std::to_string(numbers.size() / dim) +
                          " points. A ';' separates points: " + several);
          }
        points.push_back(parse_point<dim>(piece, where));
      }
    return points;
  }


  unsigned int choice_of(const std::string              &text,
                         const std::vector<std::string> &names,
                         const std::string              &where)
  {
    for (unsigned int i = 0; i < names.size(); ++i)
      if (text == names[i])
        return i;
    const std::string found = text.empty() ? "is empty" : "unknown name '" + text + "'";
    if (names.size() == 1)
      entry_error(where, found + "; this version knows '" + names.front() + "' only.");
    entry_error(where,
                found + "; known: " + join_names(names) + "." +
                  (text.empty() ? "" : did_you_mean(text, names)));
  }


  std::string did_you_mean(const std::string &name, const std::vector<std::string> &known)
  {
    const std::string nearest = nearest_name(name, known);
    return nearest.empty() ? "" : " Did you mean '" + nearest + "'?";
  }


  std::string number_text(const double value)
  {
    for (int digits = 6; digits <= 12; ++digits)
      {
        std::ostringstream out;
        out << std::setprecision(digits) << value;
        if (digits >= 12 || std::strtod(out.str().c_str(), nullptr) == value)
          return out.str();
      }
    return "";
  }


  std::string rounded_text(const double value, const int n_digits)
  {
    std::ostringstream out;
    out << std::setprecision(n_digits) << value;
    return out.str();
  }


  PERIDEAL_INSTANTIATE_FUNCTION(parse_point);
  PERIDEAL_INSTANTIATE_FUNCTION(parse_points);
} // namespace PeriDeal
