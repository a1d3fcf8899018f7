// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/study_file.h>

#include <nlohmann/json.hpp>

namespace PeriDeal
{
  using Json = nlohmann::ordered_json;

  /**
   * An object of a study file, and where it stands, for messages: "convergence.json: row 'coarse'".
   */
  class StudyObject
  {
  public:
    /**
     * @param keys all that are known. Throws UserError for others, and if @p object is no object.
     */
    StudyObject(const Json &object, const std::string &where, const std::vector<std::string> &keys);

    bool has(const std::string &key) const;

    /** The text of a key; without it, the default, or an error if @p required. */
    std::string text(const std::string &key,
                     const bool         required      = false,
                     const std::string &default_value = "") const;

    bool boolean(const std::string &key) const;

    /** A list of texts, or one text. */
    std::vector<std::string> texts(const std::string &key) const;

    /** The entries of an object with plain values, as texts in their order. */
    std::vector<Setting> settings(const std::string &key) const;

    /** The entries of an object with lists of plain values. */
    std::vector<Variation> variations(const std::string &key) const;

    /** The objects of a list, or nothing. */
    std::vector<Json> objects(const std::string &key) const;

    /** The value as it is. */
    const Json &value(const std::string &key) const;

    /** Throw the UserError "<where>, key '<key>': <what>". */
    [[noreturn]] void error(const std::string &key, const std::string &what) const;

  private:
    /** A text, number or boolean as the text of an entry. */
    std::string plain_text(const Json &value, const std::string &key, const std::string &of) const;

    const Json &object;
    std::string where;
  };

  /**
   * The text of a study file as JSON; comments are allowed, a key given twice in one object is not.
   * Throws UserError with file and line.
   */
  Json parse_study_text(const std::string &text, const std::string &file_name);
} // namespace PeriDeal
