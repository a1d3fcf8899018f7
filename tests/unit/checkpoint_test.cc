// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// States of runs in files: what is loaded is what was saved, on any number of processes, or a
// message says why not.

#include <deal.II/base/index_set.h>

#include <perideal/output/checkpoints.h>

#include <cmath>
#include <limits>
#include <map>

#include "output_test_tools.h"
#include "scene_test_tools.h"

namespace
{
  using namespace PeriDeal;
  using namespace OutputTests;
  using namespace SceneTests;
  using dealii::Utilities::MPI::n_mpi_processes;
  using dealii::Utilities::MPI::this_mpi_process;

  const std::string scene_text = "set Title = a\nsubsection Domain\n  set Cells = 4, 4\nend\n"
                                 "subsection Time\n  set End time = 1\n  set Stepper = rk4\nend\n";

  const CheckpointHeader header{PERIDEAL_VERSION, scene_text, 2, 1, 0.25, 12.5, {}};


  /** Of so many nodes with two components each, in their order or dealt out. */
  struct State
  {
    State(const MPI_Comm communicator, const unsigned int n_nodes, const bool dealt_out = false)
    {
      const unsigned int n_proc = n_mpi_processes(communicator),
                         rank   = this_mpi_process(communicator);
      const unsigned int begin = n_nodes * rank / n_proc, end = n_nodes * (rank + 1) / n_proc;
      dealii::IndexSet   owned(2 * n_nodes);
      owned.add_range(2 * begin, 2 * end);
      u.reinit(owned, communicator);
      for (unsigned int k = begin; k < end; ++k)
        {
          const std::uint64_t node = dealt_out ? (k * 7 + 3) % n_nodes : k;
          keys.push_back(node * 0x9e3779b97f4a7c15u);
          nodes.push_back(node);
        }
    }

    void fill()
    {
      for (unsigned int k = 0; k < nodes.size(); ++k)
        for (unsigned int c = 0; c < 2; ++c)
          u.local_element(2 * k + c) = value(nodes[k], c);
      pairs = KeyedPairs();
      for (unsigned int k = 0; k < nodes.size(); ++k)
        if (nodes[k] % 3 == 0)
          {
            pairs.keys.push_back({{keys[k], keys[k] + 1}});
            pairs.values.push_back(value(nodes[k], 0));
          }
      share  = 1. + this_mpi_process(u.get_mpi_communicator());
      number = -0.1;
      count  = std::numeric_limits<unsigned long long>::max() - 1;
      text   = std::string("\xE4 \n\0x", 5);
      list   = {1. / 3., -std::numeric_limits<double>::infinity(), 5e-324};
      flag   = true;
    }

    static double value(const std::uint64_t node, const unsigned int component)
    {
      return std::sin(1. + static_cast<double>(node)) + component / 3.;
    }

    void exchange(Archive &archive)
    {
      const Archive::Part part(archive, "peridynamics");
      archive.exchange("u", u, keys);
      archive.exchange("broken", pairs, keys);
      archive.exchange("v", u, keys);
      archive.exchange_share("share", share);
      archive.exchange("number", number);
      archive.exchange("count", count);
      archive.exchange("text", text);
      archive.exchange("list", list);
      archive.exchange("flag", flag);
    }

    void expect_all_there() const
    {
      State like = *this;
      like.fill();
      for (unsigned int k = 0; k < u.locally_owned_size(); ++k)
        ASSERT_EQ(u.local_element(k), like.u.local_element(k));
      EXPECT_EQ(zipped(), like.zipped());
      EXPECT_EQ(number, like.number);
      EXPECT_EQ(count, like.count);
      EXPECT_EQ(text, like.text);
      EXPECT_EQ(list, like.list);
      EXPECT_EQ(flag, like.flag);
    }

    std::map<KeyedPairs::Key, double> zipped() const
    {
      std::map<KeyedPairs::Key, double> all;
      for (unsigned int k = 0; k < pairs.keys.size(); ++k)
        all[pairs.keys[k]] = pairs.values[k];
      return all;
    }

    Vector                     u;
    NodeKeys                   keys;
    std::vector<std::uint64_t> nodes;
    KeyedPairs                 pairs;
    double                     share = 0., number = 0.;
    unsigned long long         count = 0;
    std::string                text;
    std::vector<double>        list;
    bool                       flag = false;
  };


  class CheckpointTest : public OutputDirectory
  {
  protected:
    /** A run that keeps some states, the newest with the largest number. */
    void run(const unsigned int n_checkpoints, const unsigned int n_kept = 2) const
    {
      ResultFolder folder(place, "scene.prm", {"a.csv"}, MPI_COMM_WORLD, RunMode::overwrite);
      Checkpoints  checkpoints(folder, n_kept, MPI_COMM_WORLD);
      State        state(MPI_COMM_WORLD, 11);
      state.fill();
      for (unsigned int k = 0; k < n_checkpoints; ++k)
        EXPECT_EQ(checkpoints.write(header, [&](Archive &archive) { state.exchange(archive); }),
                  "");
    }

    /** A state of so many nodes in a file. */
    State save(const std::string &name, const unsigned int n_nodes) const
    {
      State saved(MPI_COMM_WORLD, n_nodes);
      saved.fill();
      CheckpointWriter writer(name, header, MPI_COMM_WORLD);
      saved.exchange(writer);
      EXPECT_EQ(writer.finish(), 0);
      return saved;
    }

    /** What is taken on resume. */
    std::string newest(std::vector<std::string> &notes) const
    {
      const std::string name = newest_checkpoint(place, MPI_COMM_WORLD, notes);
      return name.substr(place.size() + 1);
    }
  };


  TEST_F(CheckpointTest, a_state_is_loaded_as_it_was_saved)
  {
    for (const unsigned int n_nodes : {1, 2, 50})
      {
        const std::string name  = place + "/of_all.h5";
        const State       saved = save(name, n_nodes);
        on_first([&] {
          EXPECT_EQ(fault_of_checkpoint(name), "");
          EXPECT_FALSE(there_is("of_all.h5.part"));
        });
        CheckpointReader reader(name, MPI_COMM_WORLD);
        EXPECT_EQ(reader.header().scene, scene_text);
        EXPECT_EQ(reader.header().time, 0.25);
        EXPECT_EQ(reader.header().wall_time, 12.5);
        State loaded(MPI_COMM_WORLD, n_nodes);
        loaded.exchange(reader);
        loaded.expect_all_there();
        EXPECT_EQ(loaded.share, saved.share);

        CheckpointReader again(name, MPI_COMM_WORLD);
        State            other_order(MPI_COMM_WORLD, n_nodes, n_nodes % 7 != 0);
        other_order.exchange(again);
        other_order.expect_all_there();
        MPI_Barrier(MPI_COMM_WORLD);
      }
  }


  TEST_F(CheckpointTest, a_state_is_loaded_on_another_number_of_processes)
  {
    const std::string  name = place + "/a.h5", alone = place + "/alone.h5";
    const unsigned int n_proc = n_mpi_processes(MPI_COMM_WORLD);
    save(name, 50);
    {
      State            loaded(MPI_COMM_SELF, 50);
      CheckpointReader reader(name, MPI_COMM_SELF);
      loaded.exchange(reader);
      loaded.expect_all_there();
      EXPECT_EQ(loaded.share, n_proc * (n_proc + 1) / 2.);
    }
    on_first([&] {
      State of_one(MPI_COMM_SELF, 50);
      of_one.fill();
      CheckpointWriter writer_alone(alone, header, MPI_COMM_SELF);
      of_one.exchange(writer_alone);
      EXPECT_EQ(writer_alone.finish(), 0);
    });
    CheckpointReader reader(alone, MPI_COMM_WORLD);
    State            loaded(MPI_COMM_WORLD, 50);
    loaded.exchange(reader);
    loaded.expect_all_there();
    EXPECT_EQ(dealii::Utilities::MPI::sum(loaded.share, MPI_COMM_WORLD), 1.);
  }


  TEST_F(CheckpointTest, the_state_of_another_mesh_is_refused)
  {
    const std::string name = place + "/a.h5";
    save(name, 50);
    CheckpointReader reader(name, MPI_COMM_WORLD);
    State            finer(MPI_COMM_WORLD, 60);
    expect_parts(message_of([&] { finer.exchange(reader); }), {"'peridynamics/u'", "mesh"});
    expect_parts(message_of([&] { reader.exchange("w", finer.number); }), {"'w'", "another scene"});
  }


  TEST_F(CheckpointTest, the_newest_are_kept)
  {
    run(3);
    on_first([&] {
      EXPECT_FALSE(there_is("checkpoints/1.h5"));
      EXPECT_TRUE(there_is("checkpoints/2.h5"));
      EXPECT_TRUE(there_is("checkpoints/3.h5"));
      replace("checkpoints/4.h5", "mine");      // no run's own
      replace("checkpoints/3.h5.part", "half"); // what a kill leaves
    });
    ResultFolder folder(place, "scene.prm", {}, MPI_COMM_WORLD, RunMode::resume);
    Checkpoints  checkpoints(folder, 1, MPI_COMM_WORLD);
    on_first([&] { EXPECT_FALSE(there_is("checkpoints/3.h5.part")); });
    EXPECT_EQ(checkpoints.write(header, [](Archive &) {}), "");
    EXPECT_EQ(checkpoints.last(), "checkpoints/5.h5");
    on_first([&] {
      EXPECT_FALSE(there_is("checkpoints/2.h5"));
      EXPECT_FALSE(there_is("checkpoints/3.h5"));
      EXPECT_TRUE(there_is("checkpoints/5.h5"));
    });
    checkpoints.remove_all();
    on_first([&] {
      EXPECT_FALSE(there_is("checkpoints/5.h5"));
      EXPECT_EQ(content("checkpoints/4.h5"), "mine");
    });
  }


  TEST_F(CheckpointTest, one_that_is_not_whole_is_named_and_the_one_before_is_taken)
  {
    std::vector<std::string> notes;
    expect_parts(message_of([&] { newest(notes); }), {"nothing to resume", place, "--resume"});
    run(2);
    EXPECT_EQ(newest(notes), "checkpoints/2.h5");
    EXPECT_TRUE(notes.empty());

    std::string whole;
    if (is_first())
      whole = content("checkpoints/2.h5");
    const auto expect_fault = [&](const std::string &bytes, const std::string &fault) {
      on_first([&] { replace("checkpoints/2.h5", bytes); });
      notes.clear();
      EXPECT_EQ(newest(notes), "checkpoints/1.h5");
      ASSERT_EQ(notes.size(), 1u);
      expect_parts(notes[0], {"checkpoints/2.h5", fault, "checkpoints/1.h5"});
    };
    std::string other_bit = whole;
    if (is_first())
      other_bit[whole.size() / 2] ^= 1;
    expect_fault(other_bit, "checksum");
    if (is_first())
      {
        other_bit = whole;
        other_bit.back() ^= 64;
      }
    expect_fault(other_bit, "checksum");
    expect_fault(whole.substr(0, whole.size() - 1), "cut short");
    expect_fault(whole.substr(0, 300), "cut short");
    expect_fault(whole.substr(0, 25), "damaged head");
    expect_fault(whole + "x", "checksum");
    expect_fault("", "no checkpoint");
    expect_fault("time,model\n", "no checkpoint");
    std::string other_format = whole;
    if (is_first())
      other_format.replace(0, 21, "PeriDeal checkpoint 9");
    expect_fault(other_format, "format 9");
    on_first([&] { replace("checkpoints/1.h5", ""); });
    expect_error([&] { newest(notes); }, {"nothing to resume", "1.h5", "2.h5", "--overwrite"});
  }


  TEST_F(CheckpointTest, what_cannot_be_written_leaves_those_before_it)
  {
    run(1);
    ResultFolder folder(place, "scene.prm", {}, MPI_COMM_WORLD, RunMode::resume);
    Checkpoints  checkpoints(folder, 1, MPI_COMM_WORLD);
    on_first([&] { // no file can get these names
      fs::create_directories(place + "/checkpoints/2.h5.part/full");
      fs::create_directories(place + "/checkpoints/3.h5/full");
    });
    State state(MPI_COMM_WORLD, 11);
    state.fill();
    const auto save = [&](Archive &archive) {
      state.exchange(archive);
      MPI_Barrier(MPI_COMM_WORLD);
      if (is_first()) // the folder goes while it is being written
        fs::rename(place + "/checkpoints", place + "/gone");
    };
    expect_parts(checkpoints.write(header, save), {"checkpoints/4.h5", "could not be written"});
    on_first([&] { fs::rename(place + "/gone", place + "/checkpoints"); });
    EXPECT_NO_THROW(folder.check());
    std::vector<std::string> notes;
    EXPECT_EQ(newest(notes), "checkpoints/1.h5");
    EXPECT_EQ(notes.size(), 1u); // of 3.h5, a folder
    on_first([&] { EXPECT_EQ(fault_of_checkpoint(place + "/checkpoints/1.h5"), ""); });
  }


  TEST_F(CheckpointTest, a_stopped_run_is_not_replaced_unless_asked)
  {
    run(1);
    const auto begin = [&](const RunMode mode) {
      return message_of([&] { ResultFolder folder(place, "scene.prm", {}, MPI_COMM_WORLD, mode); });
    };
    expect_parts(begin(RunMode::begin), {place, "--resume", "--overwrite"});
    EXPECT_EQ(begin(RunMode::overwrite), ""); // and ends without results
    EXPECT_EQ(begin(RunMode::resume), "");
    on_first([&] {
      EXPECT_TRUE(there_is("checkpoints/1.h5"));
      // killed without results
      fs::create_directories(place + "/.perideal/previous/checkpoints");
      fs::rename(place + "/checkpoints/1.h5", place + "/.perideal/previous/checkpoints/1.h5");
      fs::rename(place + "/.perideal/files", place + "/.perideal/previous/files");
      replace(".perideal/files", "b.csv\n");
      replace("b.csv", "half");
    });
    expect_parts(begin(RunMode::begin), {"--resume"});
    EXPECT_EQ(begin(RunMode::resume), "");
    on_first([&] {
      EXPECT_TRUE(there_is("checkpoints/1.h5"));
      EXPECT_FALSE(there_is("b.csv"));
      EXPECT_FALSE(there_is(".perideal/previous"));
    });
  }


  TEST(CheckpointHeaders, entries_that_differ_are_named)
  {
    const auto error = [](const std::string &from, const std::string &to) {
      CheckpointHeader now = header;
      if (!from.empty())
        now.scene.replace(now.scene.find(from), from.size(), to);
      return message_of([&] { require_same_run(header, now, "out/checkpoints/1.h5"); });
    };
    EXPECT_EQ(error("", ""), "");
    EXPECT_EQ(error("Title = a", "Title = b"), "");
    EXPECT_EQ(error("End time = 1", "End time = 2"), "");
    EXPECT_EQ(error("4, 4", "4,4"), "");
    EXPECT_EQ(error("subsection Time",
                    "subsection Output\n  set Fields = none\nend\nsubsection Solver\n  set "
                    "Tolerance = 1\nend\nsubsection Time"),
              "");
    expect_parts(
      error("4, 4", "4, 5"),
      {"'Cells' in section 'Domain'", "'4, 4'", "'4, 5'", "out/checkpoints/1.h5", "may"});
    expect_parts(error("rk4", "euler"), {"'Stepper'", "'rk4'", "'euler'"});
    expect_parts(error("set Stepper = rk4", ""), {"'Stepper'", "'rk4'", "missing"});
    CheckpointHeader other = header;
    other.program          = "0.0.1";
    expect_parts(message_of([&] { require_same_run(other, header, "1.h5"); }),
                 {"PeriDeal 0.0.1", "PeriDeal " PERIDEAL_VERSION});
    other                       = header;
    other.files["Domain/Image"] = "2";
    expect_parts(message_of([&] { require_same_run(header, other, "1.h5"); }),
                 {"'Image' in section 'Domain'", "1.h5", "changed"});
    EXPECT_EQ(message_of([&] { require_same_run(other, other, "1.h5"); }), "");
  }
} // namespace
