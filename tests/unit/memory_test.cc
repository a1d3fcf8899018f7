// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>
#include <perideal/base/text_file.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

using namespace PeriDeal;
namespace fs = std::filesystem;

namespace
{
  /** A folder of this process that stands for / . */
  class Root
  {
  public:
    Root()
      : path(fs::temp_directory_path() /
             ("perideal_memory_" +
              std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) + "_of_" +
              std::to_string(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD))))
    {
      fs::remove_all(path);
      fs::create_directories(path);
    }

    ~Root()
    {
      fs::remove_all(path);
    }

    void write(const std::string &name, const std::string &text) const
    {
      fs::create_directories((path / name).parent_path());
      std::ofstream(path / name) << text;
    }

    const fs::path path;
  };
} // namespace


TEST(Memory, what_is_available)
{
  const Root root;
  EXPECT_EQ(available_memory(root.path), std::numeric_limits<double>::infinity());
  root.write("proc/meminfo", "MemTotal: 4000 kB\nMemFree: 10 kB\nMemAvailable:    2000 kB\n");
  EXPECT_EQ(available_memory(root.path), 2048000.);
  // A group and the one around it, with files in memory that are given back.
  root.write("proc/self/cgroup", "0::/outer/inner\n");
  root.write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  EXPECT_EQ(available_memory(root.path), 2048000.);
  root.write("sys/fs/cgroup/outer/memory.max", "1500000\n");
  root.write("sys/fs/cgroup/outer/memory.current", "1000000\n");
  EXPECT_EQ(available_memory(root.path), 500000.);
  root.write("sys/fs/cgroup/outer/memory.stat", "anon 1\ninactive_file 300000\n");
  EXPECT_EQ(available_memory(root.path), 800000.);
  // a container sees its own group as the root
  root.write("sys/fs/cgroup/memory.max", "100000\n");
  EXPECT_EQ(available_memory(root.path), 100000.);
  root.write("sys/fs/cgroup/memory.current", "200000\n");
  EXPECT_EQ(available_memory(root.path), 0.);
}


TEST(Memory, groups_of_version_1)
{
  const Root root;
  root.write("proc/meminfo", "MemAvailable: 2000 kB\n");
  root.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  root.write("sys/fs/cgroup/memory/memory.usage_in_bytes", "700000\n");
  EXPECT_EQ(available_memory(root.path), 2048000.);
  root.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "1000000\n");
  EXPECT_EQ(available_memory(root.path), 300000.);
}


TEST(Memory, of_this_process)
{
  const double all = available_memory(MPI_COMM_WORLD);
  EXPECT_GT(all, 0.);
  EXPECT_EQ(dealii::Utilities::MPI::max(all, MPI_COMM_WORLD),
            dealii::Utilities::MPI::min(all, MPI_COMM_WORLD));
  EXPECT_GT(resident_memory(), 1e6);
  EXPECT_GE(peak_memory(), resident_memory() * 0.5);
}


TEST(TextFile, only_files_of_a_disk)
{
  const Root  root;
  std::string fault;
  root.write("file", "some text");
  EXPECT_EQ(read_file(root.path / "file", 9, fault), "some text");
  EXPECT_EQ(fault, "");
  EXPECT_EQ(read_file(root.path / "file", 8, fault), "");
  EXPECT_EQ(fault, "cannot be read: it has more than 8 B");
  EXPECT_EQ(read_file(root.path, 100, fault), "");
  EXPECT_EQ(fault, "cannot be read: it is a directory");
  EXPECT_EQ(read_file("/dev/zero", 100, fault), "");
  EXPECT_EQ(fault, "cannot be read: it is a device, a pipe or a socket, not a file");
  EXPECT_EQ(read_file(root.path / "none", 100, fault), "");
  EXPECT_EQ(fault, "cannot be read");
  std::string text =
    dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0 ? "of the first" : "";
  share_text(text, MPI_COMM_WORLD);
  EXPECT_EQ(text, "of the first");
}
