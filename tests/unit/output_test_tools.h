// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

// What the tests of output directories share.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace OutputTests
{
  namespace fs = std::filesystem;

  /** An output directory that all processes use and that goes with the test. */
  class OutputDirectory : public ::testing::Test
  {
  protected:
    void SetUp() override
    {
      std::string name;
      if (is_first())
        {
          // mkdtemp() chooses the last six letters.
          name = (fs::temp_directory_path() / "perideal_").string() + std::string(6, 'X');
          EXPECT_NE(mkdtemp(name.data()), nullptr) << "no folder " << name;
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

    /** What the first process does or expects while the others wait. */
    template <typename Action>
    void on_first(const Action &action) const
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (is_first())
        action();
      MPI_Barrier(MPI_COMM_WORLD);
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
} // namespace OutputTests
