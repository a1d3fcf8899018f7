// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

// What the tests of runs that are resumed share.

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace ResumeTests
{
  namespace fs = std::filesystem;

  /** The message of the UserError of an action, empty if there is none. */
  template <typename Action>
  std::string error_of(const Action &action)
  {
    try
      {
        action();
      }
    catch (const PeriDeal::UserError &error)
      {
        return error.message();
      }
    return "";
  }


  inline void expect_in(const std::string &text, const std::vector<std::string> &words)
  {
    for (const std::string &word : words)
      EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
  }


  /** An output directory that all processes use and that goes with the test. */
  class OutputDirectory : public ::testing::Test
  {
  protected:
    void SetUp() override
    {
      std::string name;
      if (is_first())
        {
          std::string pattern = (fs::temp_directory_path() / "perideal_XXXXXX").string();
          name                = mkdtemp(pattern.data());
        }
      place = dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, name, 0);
    }

    void TearDown() override
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (is_first())
        fs::remove_all(place);
    }

    static bool is_first()
    {
      return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    }

    bool there_is(const std::string &name) const
    {
      return fs::exists(place + "/" + name);
    }

    std::string content(const std::string &name) const
    {
      std::ifstream in(place + "/" + name, std::ios::binary);
      return {std::istreambuf_iterator<char>(in), {}};
    }

    void replace(const std::string &name, const std::string &bytes) const
    {
      std::ofstream(place + "/" + name, std::ios::binary) << bytes;
    }

    std::string place;
  };
} // namespace ResumeTests
