// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "study_json.h"

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <set>

namespace PeriDeal
{
  StudyObject::StudyObject(const Json                     &object,
                           const std::string              &where,
                           const std::vector<std::string> &keys)
    : object(object)
    , where(where)
  {
    AssertThrow(object.is_object(),
                UserError(where + ": found " + object.type_name() + ", needs { \"key\": value }."));
    for (const auto &item : object.items())
      AssertThrow(std::find(keys.begin(), keys.end(), item.key()) != keys.end(),
                  UserError(where + ": unknown key '" + item.key() + "'; known: " +
                            join_names(keys) + "." + did_you_mean(item.key(), keys)));
  }


  bool StudyObject::has(const std::string &key) const
  {
    return object.contains(key);
  }


  const Json &StudyObject::value(const std::string &key) const
  {
    return object.at(key);
  }


  void StudyObject::error(const std::string &key, const std::string &what) const
  {
    AssertThrow(false, UserError(where + ", key '" + key + "': " + what));
    std::abort(); // never reached: AssertThrow throws
  }


  std::string StudyObject::text(const std::string &key,
                                const bool         required,
                                const std::string &default_value) const
  {
    AssertThrow(has(key) || !required, UserError(where + ": the key '" + key + "' is missing."));
    if (!has(key))
      return default_value;
    if (!value(key).is_string())
      error(key, "found " + value(key).dump() + ", needs a text in quotes.");
    const std::string text = trimmed(value(key).get<std::string>());
    if (required && text.empty())
      error(key, "is empty.");
    return text;
  }


  bool StudyObject::boolean(const std::string &key) const
  {
    if (!has(key))
      return false;
    if (!value(key).is_boolean())
      error(key, "found " + value(key).dump() + ", needs true or false.");
    return value(key).get<bool>();
  }


  std::vector<std::string> StudyObject::texts(const std::string &key) const
  {
    if (!has(key))
      return {};
    const Json               list = value(key).is_array() ? value(key) : Json::array({value(key)});
    std::vector<std::string> texts;
    for (const Json &item : list)
      {
        if (!item.is_string())
          error(key, "found " + item.dump() + ", needs a text or a list of texts in quotes.");
        texts.push_back(item.get<std::string>());
      }
    return texts;
  }


  std::string StudyObject::plain_text(const Json        &value,
                                      const std::string &key,
                                      const std::string &of) const
  {
    if (value.is_string())
      {
        const std::string text = trimmed(value.get<std::string>());
        if (text.find_first_of("#\n\r") != std::string::npos ||
            (!text.empty() && text.back() == '\\'))
          error(key,
                "the value of '" + of +
                  "' must not contain # or line ends, nor end with a backslash.");
        return text;
      }
    if (!value.is_number() && !value.is_boolean())
      error(key,
            "the value of '" + of + "' is " + value.dump() +
              ", needs a text in quotes, a number, true or false.");
    return value.dump();
  }


  std::vector<Setting> StudyObject::settings(const std::string &key) const
  {
    std::vector<Setting> settings;
    if (!has(key))
      return settings;
    if (!value(key).is_object())
      error(key, R"(needs entries and values, { "Section/Entry": value }.)");
    for (const auto &item : value(key).items())
      settings.emplace_back(item.key(), plain_text(item.value(), key, item.key()));
    return settings;
  }


  std::vector<Variation> StudyObject::variations(const std::string &key) const
  {
    std::vector<Variation> variations;
    if (!has(key))
      return variations;
    const std::string form = R"({ "Section/Entry": [value, value] })";
    if (!value(key).is_object() || value(key).empty())
      error(key, "needs entries with lists of values, " + form + ".");
    for (const auto &item : value(key).items())
      {
        if (!item.value().is_array() || item.value().empty())
          error(key, "'" + item.key() + "' needs a list of values, " + form + ".");
        variations.emplace_back(item.key(), std::vector<std::string>());
        for (const Json &one : item.value())
          variations.back().second.push_back(plain_text(one, key, item.key()));
      }
    return variations;
  }


  std::vector<Json> StudyObject::objects(const std::string &key) const
  {
    if (!has(key))
      return {};
    if (!value(key).is_array())
      error(key, "needs a list, [ { ... }, { ... } ].");
    return std::vector<Json>(value(key).begin(), value(key).end());
  }


  namespace
  {
    /** What nlohmann-json says, without its own code and position. */
    std::string without_position(const std::string &message)
    {
      const std::size_t column = message.find("column ");
      const std::size_t colon  = message.find(": ", column == std::string::npos ? 0 : column);
      return colon == std::string::npos ? message : message.substr(colon + 2);
    }
  } // namespace


  Json parse_study_text(const std::string &text, const std::string &file_name)
  {
    constexpr int deepest = 32; // what is made of the text calls itself for each level
    std::vector<std::set<std::string>> open;
    std::string                        message;
    const auto refuse_twice = [&](const int depth, const Json::parse_event_t event, Json &parsed) {
      AssertThrow(depth <= deepest,
                  UserError(file_name + ": found brackets within " + std::to_string(deepest) +
                            " others, more than any study has."));
      if (event == Json::parse_event_t::object_start)
        open.emplace_back();
      else if (event == Json::parse_event_t::object_end)
        open.pop_back();
      else if (event == Json::parse_event_t::key && message.empty() &&
               !open.back().insert(parsed.get<std::string>()).second)
        message =
          file_name + ": the key '" + parsed.get<std::string>() + "' is given twice in one { }.";
      return true;
    };
    Json result;
    try
      {
        result = Json::parse(text, refuse_twice, true, true);
      }
    catch (const nlohmann::json::parse_error &error)
      {
        const std::size_t end  = std::min(error.byte, text.size());
        const auto        line = 1 + std::count(text.begin(), text.begin() + end, '\n');
        message                = file_name + ":" + std::to_string(line) +
                  ": this is no JSON: " + without_position(error.what()) + ".";
      }
    catch (const nlohmann::json::exception &error)
      {
        message = file_name + ": this is no JSON: " + without_position(error.what()) + ".";
      }
    AssertThrow(message.empty(), UserError(message));
    return result;
  }
} // namespace PeriDeal
