// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/parameter_handler.h>

#include <perideal/scene/lists.h>
#include <perideal/scene/section.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    const std::vector<std::string> boolean_names = {"true", "false"};
  }


  // An absolute path, so that the section does not depend on what other acceptors are alive
  SceneSection::SceneSection(const std::string &name)
    : ParameterAcceptor("/" + name)
    , section(name)
  {}


  void SceneSection::declare_parameters(ParameterHandler &prm)
  {
    for (const Entry &entry : list)
      {
        std::string documentation = entry.documentation;
        if (entry.type == EntryType::choice || entry.type == EntryType::choices)
          documentation += " Choices: " + join_names(entry.choices, " | ") + ".";
        if (!entry.unit.empty())
          documentation += " Unit: " + entry.unit + ".";
        switch (entry.type)
          {
            case EntryType::boolean:
              prm.declare_entry(entry.name, entry.default_text, Patterns::Bool(), documentation);
              break;
            default:
              prm.declare_entry(entry.name,
                                entry.default_text,
                                Patterns::Anything(),
                                documentation);
          }
      }
  }


  void SceneSection::parse_parameters(ParameterHandler &prm)
  {
    for (Entry &entry : list)
      entry.text = trimmed(prm.get(entry.name));
  }


  void SceneSection::set(const std::string &entry, const std::string &text)
  {
    const_cast<Entry &>(find(entry)).text = trimmed(text);
  }


  std::string SceneSection::where(const std::string &entry) const
  {
    return "'" + entry + "' " +
           (section.empty() ? "outside all sections" : "in section '" + section + "'");
  }


  void SceneSection::refuse(const bool         fault,
                            const std::string &entry,
                            const std::string &what) const
  {
    if (fault)
      error(entry, what);
  }


  void SceneSection::declare(const std::string              &name,
                             const EntryType                 type,
                             const std::string              &default_text,
                             const std::string              &unit,
                             const std::string              &documentation,
                             const std::vector<std::string> &choices)
  {
    list.push_back({name, type, default_text, unit, documentation, choices, default_text});
  }


  const std::string &SceneSection::text(const std::string &entry) const
  {
    return find(entry).text;
  }


  bool SceneSection::is_given(const std::string &entry) const
  {
    return find(entry).text != find(entry).default_text;
  }


  double SceneSection::number(const std::string &entry) const
  {
    return parse_number(text(entry), where(entry));
  }


  double SceneSection::positive_number(const std::string &entry) const
  {
    const double value = number(entry);
    if (!(value > 0.))
      error(entry, "found " + text(entry) + ", needs a number greater than 0.");
    return value;
  }


  unsigned int SceneSection::whole_number(const std::string &entry) const
  {
    return parse_whole_number(text(entry), where(entry), 2147483647u);
  }


  bool SceneSection::boolean(const std::string &entry) const
  {
    return choice_of(text(entry), boolean_names, where(entry)) == 0;
  }


  double SceneSection::fraction(const std::string &entry) const
  {
    const double value = number(entry);
    if (!(value > 0. && value < 1.))
      error(entry, "found " + text(entry) + ", needs a number between 0 and 1.");
    return value;
  }


  const std::string &SceneSection::choice_name(const std::string &entry) const
  {
    return find(entry).choices[choice_index(entry)];
  }


  std::vector<unsigned int> SceneSection::choice_indices(const std::string &entry) const
  {
    std::vector<unsigned int> indices;
    for (const std::string &piece : split_list(text(entry), ','))
      {
        const unsigned int index = choice_of(piece, find(entry).choices, where(entry));
        if (std::find(indices.begin(), indices.end(), index) != indices.end())
          error(entry, "'" + piece + "' is named twice.");
        indices.push_back(index);
      }
    if (indices.empty())
      error(entry, "is empty, needs at least one of: " + join_names(find(entry).choices) + ".");
    return indices;
  }


  void SceneSection::error(const std::string &entry, const std::string &what) const
  {
    entry_error(where(entry), what);
  }


  unsigned int SceneSection::choice_index(const std::string &entry) const
  {
    return choice_of(text(entry), find(entry).choices, where(entry));
  }


  const Entry &SceneSection::find(const std::string &entry) const
  {
    const auto found =
      std::find_if(list.begin(), list.end(), [&](const Entry &e) { return e.name == entry; });
    AssertThrow(found != list.end(),
                ExcMessage("The section '" + section + "' has no entry '" + entry + "'."));
    return *found;
  }


  void check_plain_value(const Entry &entry, const std::string &text, const std::string &where)
  {
    switch (entry.type)
      {
        case EntryType::number:
          parse_number(text, where);
          break;
        case EntryType::whole_number:
          parse_whole_number(text, where, 2147483647u);
          break;
        case EntryType::boolean:
          choice_of(text, boolean_names, where);
          break;
        case EntryType::choice:
          choice_of(text, entry.choices, where);
          break;
        default:
          break;
      }
  }


  std::string type_text(const Entry &entry)
  {
    switch (entry.type)
      {
        case EntryType::number:
          return "number";
        case EntryType::whole_number:
          return "whole number";
        case EntryType::boolean:
          return "true or false";
        case EntryType::choice:
          return "one of: " + join_names(entry.choices);
        case EntryType::choices:
          return "list of: " + join_names(entry.choices);
        case EntryType::formula:
          return "formula";
        case EntryType::list:
          return "list";
        default:
          return "text";
      }
  }
} // namespace PeriDeal
