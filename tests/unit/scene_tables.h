// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <sstream>

#include "elastic_scene_tools.h"

namespace PeriDeal
{
  /** Tables of entries and of what is said about them. */
  namespace SceneTests
  {
    /** A line `LEFT => WORDS | WORDS` of a table; no words where nothing is wrong. */
    struct FaultRow
    {
      std::string              left;
      std::vector<std::string> words;
    };


    /** The lines of a table but those that are empty or begin with '#'. */
    inline std::vector<FaultRow> fault_rows(const std::string &table)
    {
      std::vector<FaultRow> rows;
      std::istringstream    lines(table);
      for (std::string line; std::getline(lines, line);)
        {
          if (line.empty() || line[0] == '#')
            continue;
          const std::size_t middle = line.find("=>");
          EXPECT_NE(middle, std::string::npos) << line;
          rows.push_back(
            {trimmed(line.substr(0, middle)), split_list(line.substr(middle + 2), '|')});
        }
      EXPECT_FALSE(rows.empty());
      return rows;
    }


    /**
     * Rows of `set` statements of a section, separated by '&', behind further text: the message
     * names the entry, the first of the words, with its section and file, and has the others.
     */
    template <int dim = 2>
    void expect_faults(const std::string &section,
                       const std::string &table,
                       const std::string &head = "")
    {
      for (const FaultRow &row : fault_rows(table))
        {
          SCOPED_TRACE(section + ": " + row.left);
          std::string text = head + "subsection " + section + "\n";
          for (const std::string &statement : split_list(row.left, '&'))
            text += "  set " + statement + "\n";
          const std::string message = fault<dim>(text + "end\n");
          if (row.words.empty())
            EXPECT_EQ(message, "");
          else
            expect_fault(message, section, row.words[0], row.words);
        }
    }


    /** Rows of overrides of an elastic body, separated by '&', behind common ones. */
    template <int dim = 2>
    void expect_elastic_faults(const Overrides &common, const std::string &table)
    {
      for (const FaultRow &row : fault_rows(table))
        {
          SCOPED_TRACE(row.left);
          Overrides overrides = common;
          for (const std::string &one : split_list(row.left, '&'))
            overrides.push_back(one);
          const std::string message = elastic_fault<dim>(overrides);
          if (row.words.empty())
            EXPECT_EQ(message, "");
          else
            expect(message, row.words[0], {row.words.begin() + 1, row.words.end()});
        }
    }
  } // namespace SceneTests
} // namespace PeriDeal
