// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/user_properties.h>

#include <algorithm>

namespace PeriDeal
{
  std::vector<std::vector<double>> user_properties(const Material &material)
  {
    const std::string entry   = "User properties";
    const auto        numbers = [](const std::string &text, const std::string &where) {
      std::vector<double> list;
      if (!text.empty())
        for (const std::string &number : split_list(text, ','))
          list.push_back(parse_number(number, where));
      return list;
    };
    const std::vector<std::string>  &names = material.phases.all().names;
    std::vector<bool>                has_own(names.size(), false);
    std::vector<std::vector<double>> of_phases(
      names.size() + 1,
      numbers(material.text(entry), material.where(entry)));
    for (const std::string &piece : split_list(material.phases.text(entry), ';'))
      {
        const std::string where = material.phases.where(entry);
        const auto [name, text] = name_and_value(piece, where);
        const auto found        = std::find(names.begin(), names.end(), name);
        if (found == names.end())
          entry_error(where,
                      "there is no phase '" + name + "' in 'Regions'." + did_you_mean(name, names));
        if (has_own[found - names.begin()])
          entry_error(where, "the phase '" + name + "' is named twice.");
        has_own[found - names.begin()]       = true;
        of_phases[found - names.begin() + 1] = numbers(text, where + ", phase '" + name + "'");
      }
    return of_phases;
  }
} // namespace PeriDeal
