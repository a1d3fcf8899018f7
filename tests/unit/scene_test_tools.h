// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/problems/computable.h>
#include <perideal/scene/lists.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** What the tests of scenes share. */
  namespace SceneTests
  {
    template <typename Action>
    std::string message_of(const Action &action)
    {
      try
        {
          action();
        }
      catch (const UserError &error)
        {
          return error.message();
        }
      return "";
    }


    /** What is wrong with a scene given as text; empty if nothing is. */
    template <int dim = 2>
    std::string fault(const std::string &text)
    {
      const std::string head = "set Dimension = " + std::to_string(dim) + "\n";
      return message_of([&] {
        Scene<dim> scene;
        parse_computable<dim>({"a.prm", head + text}, scene);
      });
    }


    /** What is wrong with a section that has the given `set` statements, separated by '&'. */
    template <int dim = 2>
    std::string fault(const std::string &section, const std::string &statements)
    {
      std::string text = "subsection " + section + "\n";
      for (const std::string &statement : split_list(statements, '&'))
        text += "  set " + statement + "\n";
      return fault<dim>(text + "end\n");
    }


    inline void expect_parts(const std::string &message, const std::vector<std::string> &parts)
    {
      for (const std::string &part : parts)
        EXPECT_NE(message.find(part), std::string::npos)
          << "'" << part << "' is missing in: '" << message << "'";
    }


    /** Why an action diverges; nothing if it does not. */
    template <typename Action>
    Trip trip_of(const Action &action)
    {
      try
        {
          action();
        }
      catch (const Diverged &diverged)
        {
          return diverged.trip;
        }
      return {};
    }


    /** What is wrong with what an action does has these parts. */
    template <typename Action>
    void expect_error(const Action &action, const std::vector<std::string> &parts)
    {
      expect_parts(message_of(action), parts);
    }


    /** The message names the entry and its section, the file, and contains the other parts. */
    inline void expect_fault(const std::string              &message,
                             const std::string              &section,
                             const std::string              &entry,
                             const std::vector<std::string> &parts = {})
    {
      expect_parts(message, {"a.prm", "'" + entry + "' in section '" + section + "'"});
      expect_parts(message, parts);
    }


    /** A scene file on disk for the time of a test. */
    class TemporaryFile
    {
    public:
      explicit TemporaryFile(const std::string &text)
        : name("scene_test_" + std::to_string(getpid()) + ".prm")
      {
        std::ofstream(name) << text;
      }

      ~TemporaryFile()
      {
        std::remove(name.c_str());
      }

      const std::string name;
    };


    inline std::string read_fault(const std::string              &text,
                                  const std::vector<std::string> &overrides = {})
    {
      const TemporaryFile file(text);
      return message_of([&] { read_scene(file.name, overrides, MPI_COMM_SELF); });
    }
  } // namespace SceneTests
} // namespace PeriDeal
