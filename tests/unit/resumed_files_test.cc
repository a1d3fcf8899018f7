// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Runs that are resumed: the entries of the scene, the command, the files that go on.

#include <perideal/base/command_line.h>
#include <perideal/base/process_end.h>
#include <perideal/output/crack_writer.h>
#include <perideal/output/summary_file.h>
#include <perideal/output/tables.h>
#include <perideal/scene/control.h>

#include <cmath>
#include <csignal>
#include <cstdlib>

#include "output_test_tools.h"
#include "scene_test_tools.h"

namespace
{
  using namespace PeriDeal;
  using namespace OutputTests;
  using namespace SceneTests;
  using ResumedFiles = OutputDirectory;


  TEST(CommandThatResumes, is_the_same_with_the_option)
  {
    const char *const words[] =
      {"perideal", "run", "a b.prm", "-s", "Time/End time=2", "--overwrite"};
    EXPECT_EQ(command_that_resumes(6, words, 1),
              "perideal run 'a b.prm' -s 'Time/End time=2' --resume");
    EXPECT_EQ(command_that_resumes(2, words, 4), "mpirun -np 4 perideal run --resume");
    EXPECT_EQ(quoted_for_shell("it's"), "'it'\\''s'");
    setenv("PERIDEAL_COMMAND", "./run a.prm -n 2", 1);
    EXPECT_EQ(command_that_resumes(6, words, 2), "./run a.prm -n 2 --resume");
    unsetenv("PERIDEAL_COMMAND");
  }


  TEST(StopRequests, are_noted_where_a_run_asks)
  {
    handle_signals(false, false);
    for (const int signal : {SIGTERM, SIGINT, SIGUSR1})
      {
        set_stoppable(true);
        EXPECT_FALSE(stop_requested());
        EXPECT_EQ(stop_reason(), "");
        std::raise(signal);
        EXPECT_TRUE(stop_requested());
        expect_parts(stop_reason(),
                     {signal == SIGTERM ? "SIGTERM" :
                      signal == SIGINT  ? "SIGINT" :
                                          "SIGUSR1"});
        std::raise(SIGTERM); // the same request on another way
        EXPECT_TRUE(stop_requested());
      }
    set_stoppable(false);
    EXPECT_FALSE(stop_requested());
    for (const int signal :
         {SIGTERM, SIGINT, SIGUSR1, SIGALRM, SIGXFSZ, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
      std::signal(signal, SIG_DFL);
  }


  TEST(CheckpointControls, durations_have_units)
  {
    EXPECT_EQ(seconds_of("90 s"), 90.);
    EXPECT_EQ(seconds_of("1.5min"), 90.);
    EXPECT_EQ(seconds_of(" 1e1 h "), 36000.);
    EXPECT_EQ(seconds_of("0"), 0.);
    for (const char *none :
         {"", "10", "10 minutes", "-1 s", "min", "nan s", "inf h", "0x10 s", "1 s s"})
      EXPECT_LT(seconds_of(none), 0.) << none;
  }


  TEST(CheckpointControls, entries_are_checked)
  {
    CheckpointControl control;
    EXPECT_EQ(control.every, 600.);
    control.set("Every", "0");
    control.set("Times", "0.5, 0.25,");
    control.set("Wall time limit", "8 h");
    control.parse(1., false);
    EXPECT_EQ(control.every, 0.);
    EXPECT_EQ(control.wall_time_limit, 28800.);
    EXPECT_EQ(control.times, (std::vector<double>{0.25, 0.5}));

    const auto error = [](const std::string &entry, const std::string &text, const bool steady) {
      CheckpointControl wrong;
      wrong.set(entry, text);
      return message_of([&] { wrong.parse(1., steady); });
    };
    expect_parts(error("Every", "10", false),
                 {"'Every' in section 'Checkpoint'", "'10'", "min", "0"});
    expect_parts(error("Every", "", false), {"'Every'", "''"});
    expect_parts(error("Wall time limit", "1 day", false), {"'Wall time limit'", "'1 day'", "h"});
    expect_parts(error("Wall time limit", "0", false), {"'Wall time limit'", "more than 0"});
    expect_parts(error("Keep", "0", false), {"'Keep'", "1 or more"});
    expect_parts(error("Times", "0.5, 2", false), {"'Times'", "2", "'End time'"});
    expect_parts(error("Times", "x", false), {"'Times'", "'x'"});
    expect_parts(error("Times", "0.5", true), {"'Times'", "steady"});
  }


  /** What a run writes besides fields, a time at a time. */
  struct Files
  {
    Files(const std::string &place, const RunMode mode)
      : folder(place, "scene.prm", {"totals.csv", "probes.csv"}, MPI_COMM_WORLD, mode)
      , summary(folder, {{"title", "a"}}, mode == RunMode::resume)
      , totals(folder, "totals.csv", "time,value", mode == RunMode::resume)
      , probes(folder, "probes.csv", {{0.5}}, 1, {"value"}, mode == RunMode::resume)
      , cracks(folder, "cracks")
    {}

    void write(const double t)
    {
      totals.add(std::to_string(t) + "," + full_precision(1. / (3. + t)) + "\n");
      probes.add(t, "coupled", {std::sqrt(t)});
      const CrackCorners line{{{{0., 0., 0.}}, {{std::floor(t / 2.), 1. / 3., 0.}}}};
      cracks.write({line, {}}, t);
      summary.update({{"time", t}}, "until " + std::to_string(t));
      folder.check();
      folder.commit();
    }

    void exchange(Archive &archive)
    {
      summary.exchange(archive);
      {
        const Archive::Part part(archive, "totals");
        totals.exchange(archive);
      }
      {
        const Archive::Part part(archive, "probes");
        probes.exchange(archive);
      }
      cracks.exchange(archive);
      folder.check();
    }

    ResultFolder folder;
    SummaryFile  summary;
    Table        totals;
    PointTable   probes;
    CrackWriter  cracks;
  };


  TEST_F(ResumedFiles, tables_and_series_go_on_where_they_were)
  {
    const std::vector<std::string> names = {"totals.csv",
                                            "probes.csv",
                                            "cracks.pvd",
                                            "fields/cracks_0000.vtu",
                                            "fields/cracks_0001.vtu",
                                            "fields/cracks_0002.vtu",
                                            "summary.json"};
    const auto                     all   = [&] {
      std::string text;
      for (const std::string &name : names)
        {
          text += name + "\n";
          std::istringstream lines(content(name));
          for (std::string line; std::getline(lines, line);)
            if (line.find("was generated by") == std::string::npos) // with the time of the day
              text += line + "\n";
        }
      return text;
    };
    {
      Files files(place, RunMode::begin);
      for (const double t : {0., 1., 2., 3., 4.})
        files.write(t);
      files.summary.complete({{"time", 4.}});
    }
    const std::string whole = is_first() ? all() : "";
    MPI_Barrier(MPI_COMM_WORLD);
    MemoryArchive saved(MPI_COMM_WORLD);
    {
      Files files(place, RunMode::begin);
      files.write(0.);
      files.write(1.);
      files.exchange(saved);
      files.write(2.); // and killed
    }
    {
      Files files(place, RunMode::resume);
      on_first([&] { expect_parts(content("totals.csv"), {"\n2.0"}); }); // not touched yet
      MemoryArchive archive(saved, MPI_COMM_WORLD);
      files.exchange(archive);
      on_first([&] {
        EXPECT_EQ(content("totals.csv").find("\n2.0"), std::string::npos);
        expect_parts(content("summary.json"), {"\"running\""});
      });
      for (const double t : {2., 3., 4.})
        files.write(t);
      files.summary.complete({{"time", 4.}});
    }
    on_first([&] { EXPECT_EQ(all(), whole); });

    // tables that are shorter than they were, or gone
    const auto error = [&] {
      return message_of([&] {
        Files         files(place, RunMode::resume);
        MemoryArchive archive(saved, MPI_COMM_WORLD);
        files.exchange(archive);
      });
    };
    on_first([&] { replace("probes.csv", "time\n"); });
    expect_parts(error(), {"probes.csv", "5 bytes", "--overwrite"});
    on_first([&] { fs::remove(place + "/totals.csv"); });
    expect_parts(error(), {"totals.csv", "gone", "--overwrite"});
    on_first([&] {
      EXPECT_EQ(content("probes.csv"), "time\n");
      EXPECT_FALSE(there_is("totals.csv"));
    });
  }
} // namespace
