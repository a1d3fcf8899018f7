// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/study/study_file.h>

#include <set>

#include "scene_tables.h"

namespace
{
  using namespace PeriDeal;
  using namespace SceneTests;

  TEST(Study, VariationsAreSplitAtSingleBars)
  {
    const Variation cells = parse_variation(" Domain/Cells = 10, 10|20, 20 | 30, 30 ");
    EXPECT_EQ(cells.first, "Domain/Cells");
    EXPECT_EQ(cells.second, (std::vector<std::string>{"10, 10", "20, 20", "30, 30"}));
    // the `or` of formulas, bars in parentheses, and further equal signs belong to the values
    const Variation formulas =
      parse_variation("Material/Phases/Regions=a: x > 1 || y == 2 | a: (x | y)");
    EXPECT_EQ(formulas.second, (std::vector<std::string>{"a: x > 1 || y == 2", "a: (x | y)"}));
    for (const char *const wrong : {"", "Domain/Cells", "=3", "A/B=1 |", "A/B= | 1", "A/B="})
      EXPECT_THROW(parse_variation(wrong), UserError) << wrong;
  }


  TEST(Study, TheFirstVariationVariesSlowest)
  {
    const auto all = combinations({{"A", {"1", "2"}}, {"B", {"x", "y", "z"}}});
    ASSERT_EQ(all.size(), 6u);
    EXPECT_EQ(all[0], (std::vector<Setting>{{"A", "1"}, {"B", "x"}}));
    EXPECT_EQ(all[2], (std::vector<Setting>{{"A", "1"}, {"B", "z"}}));
    EXPECT_EQ(all[3], (std::vector<Setting>{{"A", "2"}, {"B", "x"}}));
    EXPECT_EQ(combinations({}), std::vector<std::vector<Setting>>(1));
  }


  TEST(Study, NamesOfCombinations)
  {
    EXPECT_EQ(
      combination_name("prefix", {{"Domain/Cells", "24, 24"}, {"Peridynamics/Horizon ratio", "2"}}),
      "prefix, Cells = 24, 24, Horizon ratio = 2");
    EXPECT_EQ(
      combination_name("a", {{"Time/Tolerance", "1"}, {"Solver/Tolerance", "2"}, {"Title", "t"}}),
      "a, Time/Tolerance = 1, Solver/Tolerance = 2, Title = t");
    EXPECT_EQ(combination_name("a", {}), "a");
  }


  TEST(Study, FoldersArePlainAndDiffer)
  {
    const std::string              name(300, 'n');
    const std::vector<std::string> names   = {"prefix, Cells = 24, 24",
                                              "a b",
                                              "a_b",
                                              "A b",
                                              "../up",
                                              "-1",
                                              "1",
                                              "\xC3\xA9",
                                              "",
                                              name,
                                              name + "1",
                                              ".",
                                              "x=1e-8"};
    const std::vector<std::string> folders = folder_names(names);
    EXPECT_EQ(folders[0], "prefix_Cells_24_24");
    EXPECT_EQ(folders[12], "x_1e-8");
    std::set<std::string> distinct;
    for (const std::string &folder : folders)
      {
        EXPECT_LE(folder.size(), 100u);
        EXPECT_FALSE(folder.empty());
        EXPECT_NE(folder[0], '.');
        EXPECT_NE(folder[0], '-');
        EXPECT_EQ(folder.find_first_not_of(
                    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-"),
                  std::string::npos)
          << folder;
        distinct.insert(folder);
      }
    EXPECT_EQ(distinct.size(), names.size());
    // a row keeps its folder whatever stands beside it, unless they would share it
    EXPECT_EQ(folder_names({"b", "a"})[1], folder_names({"a"})[0]);
    EXPECT_EQ(folder_names({"a b", "a_b"})[1], folder_names({"a_b", "a b"})[0]);
  }


  /** The values that the authors of the hash publish. */
  TEST(Study, HashOfTexts)
  {
    EXPECT_EQ(text_hash(""), "cbf29ce484222325");
    EXPECT_EQ(text_hash("a"), "af63dc4c8601ec8c");
    EXPECT_EQ(text_hash("foobar"), "85944171f73967e8");
  }


  TEST(Study, MistakesInFiles)
  {
    const TemporaryFile scene("subsection Domain\nset Cells = 12, 12\nend\n");
    const std::string   name = scene.name + ".json";
    for (const FaultRow &row : fault_rows(R"(
{"row": []} => 'row' | Did you mean 'rows'?
{"rows": []} => 'rows' | at least one row
{"rows": {}} => 'rows' | list
{"rows": [3]} => row 1 | number
{"rows": [{"scene": "PLATE"}]} => row 1 | 'name' | missing
{"rows": [{"name": "a"}]} => row 'a' | 'scene' | missing
{"rows": [{"name": 1, "scene": "PLATE"}]} => row 1 | 'name' | text in quotes
{"rows": [{"name": "a", "scene": "PLATE", "sett": {}}]} => row 'a' | 'sett' | Did you mean 'set'?
{"rows": [{"name": "a", "scene": "PLATE", "name": "b"}]} => 'name' | twice
{"rows": [{"name": "a", "scene": "PLATE"},{"name": "a", "scene": "PLATE"}]} => 'a' | two rows
{"rows": [{"name": "a", "scene": "PLATE", "vary": {"Domain/Cells": ["8, 8", "8, 8"]}}]} => 'a, Cells = 8, 8' | two rows
{"rows": [{"name": "a", "scene": "PLATE", "set": {"Cells": "8, 8"}}]} => row 'a' | 'Cells' | Did you mean 'Domain/Cells'?
{"rows": [{"name": "a", "scene": "PLATE"}], "set": {"Output/Field": "none"}} => key 'set' | Did you mean 'Output/Fields'?
{"rows": [{"name": "a", "scene": "PLATE", "vary": {"Time/Stepr": ["rk4"]}}]} => 'vary' | Did you mean 'Time/Stepper'?
{"rows": [{"name": "a", "scene": "PLATE", "set": {"Domain/Cells": [8, 8]}}]} => row 'a' | 'Domain/Cells' | [8,8]
{"rows": [{"name": "a", "scene": "PLATE", "set": {"Title": "a # b"}}]} => row 'a' | 'Title' | #
{"rows": [{"name": "a", "scene": "PLATE", "vary": {"Domain/Cells": "8, 8"}}]} => row 'a' | 'vary' | list of values
{"rows": [{"name": "a", "scene": "PLATE", "vary": {"Domain/Cells": []}}]} => row 'a' | 'vary' | list of values
{"rows": [{"name": "a", "scene": "PLATE", "set": {"Domain/Cells": "8, 8"}, "vary": {"Domain/Cells": ["9, 9"]}}]} => 'Domain/Cells' | 'set', too
{"rows": [{"name": "a", "scene": "PLATE", "set": {"Output directory": "x"}}]} => 'Output directory' | decided by the study
{"rows": [{"name": "a", "scene": "PLATE"}], "output": ""} => 'output' | empty
{"rows": [{"name": "a", "scene": "PLATE", "quick": "yes"}]} => row 'a' | 'quick' | true or false
{"rows": [{"name": "a", "scene": "PLATE", "x": [1]}]} => row 'a' | 'x'
{"rows": [{"name": "a", "scene": "PLATE", "x": "Domain/Cels"}]} => row 'a' | 'x' | Did you mean 'Domain/Cells'?
{"rows": [{"name": "a", "scene": "PLATE"}], "figures": [{"name": "f", "x": "bonds"}]} => figure 'f' | 'y' | missing
{"rows": [{"name": "a", "scene": "PLATE"}], "figures": [{"name": "f", "x": "bonds", "y": "steps", "line": "model"}]} => figure 'f' | Did you mean 'lines'?
{"rows": [{"name": "a", "scene": "PLATE"}], "figures": [{"name": "f", "x": "bonds", "y": "wal time"}]} => figure 'f' | Did you mean 'wall time'?
{"rows": [{"name": "a", "scene": "PLATE"}], "figures": [{"name": "a/b", "x": "bonds", "y": "steps"}]} => figure 'a/b' | name of a file
{"rows": [{"name": "a", "scene": "PLATE"}], "figures": [{"name": "f", "x": "bonds", "y": "steps"}, {"name": "f", "x": "bonds", "y": "steps"}]} => two figures
)"))
      {
        SCOPED_TRACE(row.left);
        std::string text = row.left;
        for (std::size_t at = text.find("PLATE"); at != std::string::npos; at = text.find("PLATE"))
          text.replace(at, 5, scene.name);
        std::ofstream(name) << text;
        EXPECT_FALSE(row.words.empty());
        expect_parts(message_of([&] { read_study(name, MPI_COMM_SELF); }), row.words);
      }
    std::remove(name.c_str());
  }
} // namespace
