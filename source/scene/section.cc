// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/parameter_handler.h>

#include <perideal/scene/lists.h>
#include <perideal/scene/section.h>

#include <algorithm>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    const std::vector<std::string> boolean_names = {"true", "false"};
    constexpr unsigned int         most_of_all   = 2147483647u; // of whole numbers
    constexpr double               infinity      = std::numeric_limits<double>::infinity();


    std::string needs(const Entry &entry, const std::string &what)
    {
      return "found " + entry.text + ", needs " + what + ".";
    }
  } // namespace


  const Bounds Bounds::none{-infinity, infinity, false, ""};
  const Bounds Bounds::positive{0., infinity, false, "a number greater than 0"};
  const Bounds Bounds::fraction{0., 1., false, "a number between 0 and 1"};
  const Bounds Bounds::not_negative{0., infinity, true, "0 or more"};
  const Bounds Bounds::one_or_more{1., infinity, true, "1 or more"};
  const Bounds Bounds::one_to_three{1., 3., true, "1, 2 or 3"};
  const Bounds Bounds::length{0., infinity, false, "a length greater than 0 (or nothing)"};


  // An absolute path, so that the section does not depend on what other acceptors are alive
  SceneSection::SceneSection(const std::string &name)
    : ParameterAcceptor("/" + name)
    , section(name)
  {}


  void SceneSection::declare_parameters(ParameterHandler &prm)
  {
    const Patterns::Bool     truth;
    const Patterns::Anything anything;
    for (const Entry &entry : list)
      {
        std::string documentation = entry.documentation;
        if (entry.type == EntryType::choice || entry.type == EntryType::choices)
          documentation += " Choices: " + join_names(entry.choices, " | ") + ".";
        if (!entry.unit.empty())
          documentation += " Unit: " + entry.unit + ".";
        prm.declare_entry(entry.name,
                          entry.default_text,
                          entry.type == EntryType::boolean ?
                            static_cast<const Patterns::PatternBase &>(truth) :
                            anything,
                          documentation);
      }
  }


  void SceneSection::parse_parameters(ParameterHandler &prm)
  {
    for (Entry &entry : list)
      entry.text = trimmed(prm.get(entry.name));
  }


  void SceneSection::parse()
  {
    for (std::size_t k = 0; k < list.size(); ++k)
      if (readers[k])
        readers[k](list[k]);
      else
        check_plain_value(list[k], list[k].text, where(list[k].name));
  }


  void SceneSection::set(const std::string &entry, const std::string &text)
  {
    const_cast<Entry &>(find(entry)).text = trimmed(text);
  }


  std::string SceneSection::where(const std::string &entry) const
  {
    return "'" + entry + "' " + in_section(section);
  }


  void SceneSection::refuse(const bool         fault,
                            const std::string &entry,
                            const std::string &what) const
  {
    if (fault)
      error(entry, what);
  }


  std::string &SceneSection::bind(const Entry &entry, const Reader &read)
  {
    list.push_back(entry);
    list.back().text = entry.default_text;
    readers.push_back(read);
    if (read)
      read(list.back());
    return list.back().documentation;
  }


  std::string &SceneSection::declare(const std::string &name,
                                     const EntryType    type,
                                     const std::string &default_text,
                                     const std::string &unit,
                                     const Choices     &choices)
  {
    return bind({name, type, default_text, unit, "", choices, ""}, {});
  }


  std::string &SceneSection::declare(double            &member,
                                     const std::string &name,
                                     const std::string &default_text,
                                     const std::string &unit,
                                     const Bounds      &bounds)
  {
    return bind({name, EntryType::number, default_text, unit, "", {}, ""},
                [this, &member, bounds](const Entry &entry) {
                  member = parse_number(entry.text, where(entry.name));
                  refuse(!bounds.hold(member), entry.name, needs(entry, bounds.needs));
                });
  }


  std::string &SceneSection::declare_if_given(double            &member,
                                              const std::string &name,
                                              const std::string &default_text,
                                              const std::string &unit,
                                              const Bounds      &bounds)
  {
    return bind({name, EntryType::text, default_text, unit, "", {}, ""},
                [this, &member, bounds](const Entry &entry) {
                  const std::string &word = entry.default_text;
                  member                  = -1.;
                  if (entry.text == word)
                    return;
                  refuse(!word.empty() &&
                           entry.text.find_first_of("0123456789") == std::string::npos,
                         entry.name,
                         "found '" + entry.text + "', needs '" + word + "' or a number.");
                  member = parse_number(entry.text, where(entry.name));
                  refuse(!bounds.hold(member),
                         entry.name,
                         needs(entry, (word.empty() ? "" : "'" + word + "' or ") + bounds.needs));
                });
  }


  std::string &SceneSection::declare(unsigned int      &member,
                                     const std::string &name,
                                     const std::string &default_text,
                                     const Bounds      &bounds)
  {
    return bind({name, EntryType::whole_number, default_text, "1", "", {}, ""},
                [this, &member, bounds](const Entry &entry) {
                  member = parse_whole_number(entry.text, where(entry.name), most_of_all);
                  refuse(!bounds.hold(member), entry.name, needs(entry, bounds.needs));
                });
  }


  std::string &SceneSection::declare(bool              &member,
                                     const std::string &name,
                                     const std::string &default_text)
  {
    return bind({name, EntryType::boolean, default_text, "", "", {}, ""},
                [this, &member](const Entry &entry) {
                  member = choice_of(entry.text, boolean_names, where(entry.name)) == 0;
                });
  }


  std::string &SceneSection::declare(std::string       &member,
                                     const std::string &name,
                                     const std::string &default_text,
                                     const Choices     &choices,
                                     const std::string &unit)
  {
    const EntryType type = choices.empty() ? EntryType::text : EntryType::choice;
    return bind({name, type, default_text, unit, "", choices, ""},
                [this, &member](const Entry &entry) {
                  if (entry.type == EntryType::choice)
                    choice_index(entry); // for its errors
                  member = entry.text;
                });
  }


  const std::string &SceneSection::text(const std::string &entry) const
  {
    return find(entry).text;
  }


  bool SceneSection::is_given(const std::string &entry) const
  {
    return find(entry).text != find(entry).default_text;
  }


  std::vector<unsigned int> SceneSection::choice_indices(const std::string &entry) const
  {
    std::vector<unsigned int> indices;
    for (const std::string &piece : split_list(text(entry), ','))
      {
        const unsigned int index = choice_of(piece, find(entry).choices, where(entry));
        if (has(indices, index))
          error(entry, "'" + piece + "' is named twice.");
        indices.push_back(index);
      }
    if (indices.empty())
      error(entry, "is empty, needs at least one of: " + join_names(find(entry).choices) + ".");
    return indices;
  }


  void SceneSection::refuse_unless_elastic(const std::string &entry,
                                           const Physics      physics,
                                           const std::string &remedy) const
  {
    refuse(physics != Physics::elasticity && is_given(entry),
           entry,
           "is for 'Physics = elasticity'; 'Physics' is '" + names_of(physics).physics + "'." +
             remedy);
  }


  void SceneSection::error(const std::string &entry, const std::string &what) const
  {
    entry_error(where(entry), what);
  }


  unsigned int SceneSection::choice_index(const Entry &entry) const
  {
    return choice_of(entry.text, entry.choices, where(entry.name));
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
    if (entry.type == EntryType::number)
      parse_number(text, where);
    else if (entry.type == EntryType::whole_number)
      parse_whole_number(text, where, most_of_all);
    else if (entry.type == EntryType::boolean || entry.type == EntryType::choice)
      choice_of(text, entry.type == EntryType::boolean ? boolean_names : entry.choices, where);
  }


  std::string in_section(const std::string &section)
  {
    return section.empty() ? "outside all sections" : "in section '" + section + "'";
  }


  std::string type_text(const Entry &entry)
  {
    static const char *const names[] = {"text",
                                        "number",
                                        "whole number",
                                        "true or false",
                                        "one of: ",
                                        "list of: ",
                                        "formula",
                                        "list"};
    return names[static_cast<unsigned int>(entry.type)] + join_names(entry.choices);
  }
} // namespace PeriDeal
