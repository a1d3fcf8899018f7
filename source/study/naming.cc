// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/study/naming.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <map>

namespace PeriDeal
{
  namespace
  {
    std::vector<std::string> split_at_bars(const std::string &text)
    {
      std::vector<std::string> pieces(1);
      int                      depth = 0;
      for (std::size_t i = 0; i < text.size(); ++i)
        {
          depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
          if (text.compare(i, 2, "||") == 0)
            {
              pieces.back() += "||";
              ++i;
            }
          else if (text[i] == '|' && depth <= 0)
            pieces.emplace_back();
          else
            pieces.back() += text[i];
        }
      for (std::string &piece : pieces)
        piece = trimmed(piece);
      return pieces;
    }


    std::string without_section(const std::string &entry)
    {
      return entry.substr(entry.rfind('/') + 1);
    }


    /** Runs of characters that make trouble in file names become one underscore. */
    std::string plain_name(const std::string &name)
    {
      std::string plain;
      for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-')
          plain += c;
        else if (!plain.empty() && plain.back() != '_')
          plain += '_';
      while (!plain.empty() && plain.back() == '_')
        plain.pop_back();
      plain.erase(0, plain.find_first_not_of(".-"));
      return plain.empty() ? "row" : plain;
    }


    std::string lower_case(std::string text)
    {
      for (char &c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return text;
    }
  } // namespace


  Variation parse_variation(const std::string &text)
  {
    const std::size_t equals = text.find('=');
    const std::string entry  = trimmed(text.substr(0, equals));
    AssertThrow(equals != std::string::npos && !entry.empty(),
                UserError("command line: --vary '" + text +
                          "' needs the form 'Section/Entry=value | value | ...'."));
    const Variation variation = {entry, split_at_bars(text.substr(equals + 1))};
    for (const std::string &value : variation.second)
      AssertThrow(!value.empty(),
                  UserError("command line: --vary '" + text +
                            "' has an empty value; values are separated by '|'."));
    return variation;
  }


  std::vector<std::vector<Setting>> combinations(const std::vector<Variation> &variations)
  {
    std::vector<std::vector<Setting>> all(1);
    for (const auto &[entry, values] : variations)
      {
        std::vector<std::vector<Setting>> longer;
        for (const auto &begin : all)
          for (const std::string &value : values)
            {
              longer.push_back(begin);
              longer.back().emplace_back(entry, value);
            }
        all.swap(longer);
      }
    return all;
  }


  std::string combination_name(const std::string &prefix, const std::vector<Setting> &combination)
  {
    std::map<std::string, unsigned int> n_of_name;
    for (const auto &setting : combination)
      ++n_of_name[without_section(setting.first)];
    std::string name = prefix;
    for (const auto &[entry, value] : combination)
      {
        const std::string brief = without_section(entry);
        name += ", " + (n_of_name.at(brief) > 1 ? entry : brief) + " = " + value;
      }
    return name;
  }


  std::vector<std::string> folder_names(const std::vector<std::string> &names)
  {
    constexpr std::size_t               longest = 100, n_digits = 8;
    std::vector<std::string>            folders;
    std::map<std::string, unsigned int> n_of_folder;
    for (const std::string &name : names)
      {
        folders.push_back(plain_name(name));
        if (folders.back().size() > longest)
          folders.back().erase(longest - n_digits - 1);
        ++n_of_folder[lower_case(folders.back())];
      }
    for (std::size_t i = 0; i < names.size(); ++i)
      if (n_of_folder.at(lower_case(folders[i])) > 1 || plain_name(names[i]) != folders[i])
        folders[i] += "_" + text_hash(names[i]).substr(0, n_digits);
    return folders;
  }


  std::string text_hash(const std::string &text)
  {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text)
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
    return digits;
  }
} // namespace PeriDeal
