// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Section `Formulas`: constants and tables of a scene, in all of its formulas.

#include <perideal/scene/expression.h>
#include <perideal/scene/formula_names.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "scene_tables.h"

namespace PeriDeal
{
  using namespace dealii;
  using namespace SceneTests;

  namespace
  {
    /** A folder with some files, which goes with the test. */
    struct Folder
    {
      using Files = std::vector<std::pair<std::string, std::string>>;

      explicit Folder(const Files &files)
        : path(std::filesystem::temp_directory_path() /
               ("perideal_tables_" + std::to_string(getpid())))
      {
        std::filesystem::create_directories(path);
        for (const auto &[name, text] : files)
          std::ofstream(path / name, std::ios::binary) << text;
      }

      ~Folder()
      {
        std::filesystem::remove_all(path);
      }

      const std::filesystem::path path;
    };


    struct Names : Formulas
    {
      Names(const Folder &folder, const std::string &constants, const std::string &tables)
      {
        set("Constants", constants);
        set("Tables", tables);
        parse(folder.path.string(), MPI_COMM_SELF);
      }

      ~Names() override // others know none of these
      {
        set("Constants", "");
        set("Tables", "");
        parse("", MPI_COMM_SELF);
      }
    };


    double value_of(const std::string &formula, const double x)
    {
      return Expression(formula, "'Source' in section 'Here'").value(Point<1>(x));
    }
  } // namespace


  TEST(FormulaNames, constants_and_tables_are_known_to_all_formulas)
  {
    const Folder folder({{"k.csv", "# of a test\nplace;other;number\n0;9;1\n1;9;3\n4;9;3\n"},
                         {"plain", "\xEF\xBB\xBF-1 2\r\n 1\t 4 \r\n"},
                         {"a, b.csv", "0,\"1\"\n1,5\n"}});
    const Names  names(folder,
                      "E0: 210e9 ; q: E0/2 ; at: k(0.5)",
                      "k: k.csv, place, number ; w: k.csv, 1, 2 ; p: plain, hold ; "
                       "b: \"a, b.csv\"");
    EXPECT_EQ(value_of("E0", 0.), 210e9);
    EXPECT_EQ(value_of("q*x", 2.), 210e9);
    EXPECT_EQ(value_of("at", 0.), 2.);
    for (const auto &[x, k] : {std::make_pair(0., 1.), {0.25, 1.5}, {1., 3.}, {3., 3.}, {4., 3.}})
      EXPECT_DOUBLE_EQ(value_of("k(x)", x), k);
    EXPECT_EQ(value_of("w(x) + b(x/2)", 1.), 9. + 3.);
    for (const auto &[x, p] : {std::make_pair(-7., 2.), {-1., 2.}, {0., 3.}, {1., 4.}, {1e9, 4.}})
      EXPECT_DOUBLE_EQ(value_of("p(x)", x), p);
    // Marks are where rows are.
    const Expression of_T("k(T)", "", "x, y, z, t, T", true);
    EXPECT_TRUE(of_T.depends_on_temperature());
    EXPECT_TRUE(has(of_T.marked_temperatures(), 4.));
    // A variable of a formula comes before a constant of that name.
    EXPECT_EQ(Expression("2*q", "", "q, r").value(Point<2>(5., 0.)), 10.);
  }


  TEST(FormulaNames, ends_of_tables)
  {
    const Folder folder(Folder::Files{{"k.csv", "0,1\n1,3\n"}});
    const Names  names(folder, "", "k: k.csv");
    {
      const HeldTableEnds held;
      EXPECT_EQ(value_of("k(x)", 5.), 3.);
    }
    const std::string message = message_of([] {
      const DeferredFormulaErrors errors;
      value_of("x > 3 ? 2*k(x) : 1", 5.);
      errors.throw_if_any(MPI_COMM_SELF);
    });
    expect_parts(message,
                 {"'Source' in section 'Here'",
                  "x > 3 ? 2*k(x) : 1",
                  "at (5)",
                  "table 'k'",
                  "k.csv",
                  "from 0 to 1",
                  "asked for 5",
                  "hold"});
    EXPECT_EQ(value_of("x > 3 ? 2*k(x) : 1", 2.), 1.); // the other branch is not asked for
    expect_parts(message_of([] { value_of("k(2)", 0.); }), {"not finite", "from 0 to 1", "hold"});
    expect_parts(message_of([] { value_of("kk(x)", 0.); }), {"did you mean 'k'"});
  }


  TEST(FormulaNames, of_another_scene_are_forgotten)
  {
    const Folder folder(Folder::Files{{"k.csv", "0,1\n1,3\n"}});
    {
      const Names names(folder, "a: 1", "k: k.csv");
      EXPECT_EQ(value_of("a + k(x)", 0.), 2.);
    }
    expect_parts(message_of([] { value_of("a + k(x)", 0.); }), {"unknown name 'a'"});
    const Names again(folder, "a: 2", "k: k.csv");
    EXPECT_EQ(value_of("a + k(x)", 0.), 3.);
  }


  TEST(FormulaNames, mistakes)
  {
    const Folder folder({{"k.csv", "x,y\n0,1\n1,3\n"},
                         {"down.csv", "0,1\n2,3\n1,4\n"},
                         {"twice.csv", "0,1\n\n1,3\n1,4\n"},
                         {"gap.csv", "0,1\n1,\n2,3\n"},
                         {"short.csv", "0,1\n1\n2,3\n"},
                         {"text.csv", "0,1\n1,much\n"},
                         {"comma.csv", "0;1\n0,5;2\n"},
                         {"one.csv", "0,1\n"},
                         {"empty.csv", "# nothing\n"},
                         {"bytes.csv", std::string("\x00\x01\x02\n\xff,\xfe\n", 8)}});
    const auto   said = [&](const std::string &constants, const std::string &tables) {
      return message_of([&] { const Names names(folder, constants, tables); });
    };
    const std::vector<std::pair<std::string, std::vector<std::string>>> of_tables = {
      {"k: down.csv",
       {"'Tables' in section 'Formulas'", "down.csv', line 3", "1 behind 2", "ascend"}},
      {"k: twice.csv", {"line 4", "1 behind 1", "A jump takes two rows"}},
      {"k: gap.csv", {"line 2", "nothing in column 2"}},
      {"k: short.csv", {"line 2", "nothing in column 2"}},
      {"k: text.csv", {"line 2", "'much' in column 2", "needs a number"}},
      {"k: comma.csv", {"line 2", "'0,5'", "decimals are written with a point"}},
      {"k: one.csv", {"has 1 rows", "two or more"}},
      {"k: empty.csv", {"has 0 rows", "two or more"}},
      {"k: bytes.csv", {"bytes.csv", "needs"}},
      {"k: none.csv", {"'none.csv' cannot be read", "Looked for it at", "beside the scene file"}},
      {"k: .", {"cannot be read", "directory"}},
      {"k: k.csv, 1, 3", {"nothing in column 3"}},
      {"k: k.csv, x, z", {"no column 'z'", "has x, y"}},
      {"k: k.csv, 0, 1", {"the column '0'", "1, 2, ..."}},
      {"k: k.csv, 1", {"found 'k.csv, 1'", "'name: file, 1, 3'"}},
      {"k: one.csv, a, b", {"no column 'a'", "no row of names"}},
      {"k.csv", {"'k.csv'", ":"}},
      {"sin: k.csv", {"the name 'sin' is taken"}},
      {"T: k.csv", {"the name 'T' is taken"}},
      {"k: k.csv ; k: k.csv", {"the name 'k' is taken"}},
      {"my k: k.csv", {"the name 'my k'", "letters, digits"}}};
    for (const auto &[tables, words] : of_tables)
      {
        SCOPED_TRACE(tables);
        expect_parts(said("", tables), words);
      }
    expect_parts(said("a: 1 ; a: 2", ""), {"'Constants' in section 'Formulas'", "'a' is taken"});
    expect_parts(said("a: b ; b: 1", ""), {"unknown name 'b'"});
    expect_parts(said("a: 2*x", ""), {"constant 'a'", "'2*x'", "needs a number"});
    expect_parts(said("a: 1/0", ""), {"'Constants'", "not finite"});
    expect_parts(said("pi: 3", ""), {"'pi' is taken"});
  }
} // namespace PeriDeal
