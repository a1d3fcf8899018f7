// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/output/tables.h>

#include "output_test_tools.h"
#include "scene_test_tools.h"

namespace
{
  using namespace PeriDeal;
  namespace fs = std::filesystem;

  class ResultFolderTest : public OutputTests::OutputDirectory
  {
  protected:
    /** The message of a run that is refused, empty if it is not. */
    std::string refusal(const std::vector<std::string> &names) const
    {
      return SceneTests::message_of(
        [&] { ResultFolder folder(place, "scene.prm", names, MPI_COMM_WORLD); });
    }

    /** A run that ends well. */
    void run(const std::vector<std::string> &names) const
    {
      ResultFolder folder(place, "scene.prm", names, MPI_COMM_WORLD);
      for (const std::string &name : names)
        folder.write(name, "of " + name);
      folder.commit();
      folder.check();
    }
  };


  TEST_F(ResultFolderTest, a_run_replaces_what_the_one_before_wrote_and_no_more)
  {
    run({"a.csv", "b.csv"});
    on_first([&] { replace("mine.txt", "mine"); });
    run({"b.csv"});
    on_first([&] {
      EXPECT_FALSE(there_is("a.csv"));
      EXPECT_EQ(content("b.csv"), "of b.csv");
      EXPECT_EQ(content("mine.txt"), "mine");
      EXPECT_FALSE(there_is(".perideal/lock"));
      EXPECT_FALSE(there_is(".perideal/previous"));
    });
  }


  TEST_F(ResultFolderTest, without_results_everything_is_as_before)
  {
    run({"a.csv", "fields/a_0000.h5"});
    {
      ResultFolder folder(place, "scene.prm", {"a.csv", "b.csv"}, MPI_COMM_WORLD);
      folder.write("a.csv", "new");
      folder.write("b.csv", "new");
      on_first([&] {
        EXPECT_EQ(content("a.csv"), "new");
        EXPECT_FALSE(there_is("fields/a_0000.h5"));
      });
    }
    on_first([&] {
      EXPECT_EQ(content("a.csv"), "of a.csv");
      EXPECT_EQ(content("fields/a_0000.h5"), "of fields/a_0000.h5");
      EXPECT_FALSE(there_is("b.csv"));
    });
  }


  TEST_F(ResultFolderTest, a_killed_run_leaves_the_results_before_it)
  {
    run({"a.csv"});
    on_first([&] { // what a run that was killed before it had results leaves
      fs::create_directories(place + "/.perideal/previous");
      fs::rename(place + "/a.csv", place + "/.perideal/previous/a.csv");
      fs::rename(place + "/.perideal/files", place + "/.perideal/previous/files");
      replace(".perideal/files", "b.csv\n");
      replace("b.csv", "half");
      replace(".perideal/lock", "process 1 on nowhere\n");
    });
    EXPECT_EQ(refusal({"b.csv"}), ""); // and ends without results
    on_first([&] {
      EXPECT_EQ(content("a.csv"), "of a.csv");
      EXPECT_FALSE(there_is("b.csv"));
    });
  }


  TEST_F(ResultFolderTest, unfinished_files_of_a_killed_run_stop_nobody)
  {
    run({"fields/peridynamics_0000.h5"});
    on_first([&] { replace("fields/peridynamics_0000.h5.part", "half"); });
    EXPECT_EQ(refusal({"fields/peridynamics_*"}), "");
    run({"fields/peridynamics_0000.h5"});
    on_first([&] { EXPECT_FALSE(there_is("fields/peridynamics_0000.h5.part")); });
  }


  TEST_F(ResultFolderTest, results_outlast_runs_that_are_killed_anywhere)
  {
    run({"a.csv", "b.csv"});
    const std::string own = place + "/.perideal/", previous = own + "previous/";
    on_first([&] { // while it set the results aside: one of two is there, and no mark
      fs::create_directories(previous);
      fs::rename(place + "/a.csv", previous + "a.csv");
    });
    EXPECT_EQ(refusal({"b.csv"}), "");
    on_first([&] {
      EXPECT_EQ(content("a.csv") + content("b.csv"), "of a.csvof b.csv");
      // while it put them back: the list names all, the mark is still there, one of two is back
      fs::create_directories(previous);
      fs::rename(place + "/b.csv", previous + "b.csv");
      fs::copy_file(own + "files", previous + "files");
    });
    EXPECT_EQ(refusal({"b.csv"}), "");
    on_first([&] {
      EXPECT_EQ(content("a.csv") + content("b.csv"), "of a.csvof b.csv");
      fs::remove(place + "/fields"); // an empty folder that somebody has taken away
      replace("totals.csv", "mine");
    });
    EXPECT_NE(refusal({"totals.csv"}), "");
    EXPECT_EQ(refusal({"a.csv", "b.csv"}), "") << "the list is kept";
  }


  TEST_F(ResultFolderTest, files_of_another_origin_are_refused_by_name)
  {
    on_first([&] {
      fs::create_directories(place + "/fields");
      replace("totals.csv", "mine");
      replace("fields/peridynamics_0003.h5", "mine");
    });
    SceneTests::expect_parts(refusal({"scene.prm", "totals.csv"}), {"'totals.csv'"});
    SceneTests::expect_parts(refusal({"fields/peridynamics_*"}), {"peridynamics_0003.h5"});
    EXPECT_EQ(refusal({"probes.csv", "fields/coupled_*"}), "");
    on_first([&] {
      EXPECT_EQ(content("totals.csv"), "mine");
      EXPECT_FALSE(there_is(".perideal"));
    });
  }


  TEST_F(ResultFolderTest, a_folder_has_one_run_at_a_time)
  {
    const ResultFolder folder(place, "scene.prm", {"a.csv"}, MPI_COMM_WORLD);
    SceneTests::expect_parts(refusal({"a.csv"}), {"another run", "process "});
    on_first([&] {
      EXPECT_TRUE(there_is(".perideal/lock"));
      FolderLock other;
      EXPECT_EQ(other.take(place + "/.perideal/lock"), FolderLock::Outcome::taken);
    });
  }


  TEST_F(ResultFolderTest, what_cannot_be_written_is_everybodys_error)
  {
    ResultFolder folder(place, "scene.prm", {"a.csv"}, MPI_COMM_WORLD);
    folder.write("a.csv", "well");
    EXPECT_NO_THROW(folder.check());
    folder.write("not/there/a.csv", "badly");
    EXPECT_EQ(folder.failed(), is_first());
    EXPECT_THROW(folder.check(), UserError);
  }


  TEST_F(ResultFolderTest, tables_grow_line_by_line)
  {
    ResultFolder folder(place, "scene.prm", {"probes.csv"}, MPI_COMM_WORLD);
    PointTable   table(folder, "probes.csv", {{0.1, 0.2}, {0.3, 0.4}}, 2);
    table.add(0.5, "coupled", {1. / 3., 2.});
    on_first([&] {
      EXPECT_EQ(content("probes.csv"),
                "time,model,x,y,value\n0.5,coupled,0.1,0.2,0.333333333333333\n"
                "0.5,coupled,0.3,0.4,2\n");
    });
    EXPECT_NO_THROW(folder.check());
  }
} // namespace
