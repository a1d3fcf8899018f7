// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/scene_lines.h>

#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace SceneTests;
  using dealii::Point;


  TEST(SceneFile, structure_errors)
  {
    EXPECT_EQ(read_fault("set Title = x\nsubsection Time\nend\n"), "");
    EXPECT_EQ(read_fault("\xEF\xBB\xBFset Title = x\r\nsubsection Time\r\nend\r\n"), "");
    const std::string name = "scene_test_" + std::to_string(getpid()) + ".prm:";
    expect_parts(read_fault("subsection Tme\nend\n"),
                 {name + "1: ", "unknown section 'Tme'", "'Time'?"});
    expect_parts(read_fault("subsection Tme\nset End time = 1\nend\n"),
                 {name, "unknown section 'Tme'", "'Time'?"});
    expect_parts(
      read_fault("subsection Time\nset Endtime = 1\nend\n"),
      {name + "2: ", "unknown entry 'Endtime' in section 'Time'", "Did you mean 'End time'?"});
    expect_parts(read_fault("subsection Domain\nset cells = 1, 1\nend\n"),
                 {"Did you mean 'Cells'?"});
    expect_parts(
      read_fault("subsection Domain\nset Conductivity = 1\nend\n"),
      {name + "2: ", "'Conductivity' in section 'Domain'", "There is one in section 'Material'"});
    expect_parts(read_fault("subsection Time\nset Dimension = 1\nend\n"),
                 {"There is one outside all sections"});
    expect_parts(read_fault("set Growth = 1\n"),
                 {name + "1: ", "unknown entry 'Growth' outside all sections"});
    expect_parts(read_fault("set Title = a\n\nset Title = b\n"),
                 {"'Title'", "given twice", "line 1", "line 3"});
    expect_parts(
      read_fault(
        "subsection Time\nset End time = 1\nend\nsubsection Time\nset End time = 2\nend\n"),
      {"'End time' in section 'Time'", "given twice", "line 2", "line 5"});
    expect_parts(read_fault("set Title = a\nsubsection Domain\nsubsection Time\nend\n"),
                 {name + "2: ", "'Domain'", "no 'end'"});
    expect_parts(read_fault("subsection Time\nend\nend\n"),
                 {name + "3: ", "'end' without a subsection"});
    expect_parts(read_fault("include other.prm\n"), {name + "1: ", "'include' is not supported"});
    expect_parts(read_fault("sett Title = a\n"), {name + "1: ", "Did you mean 'set'?"});
    expect_parts(read_fault("Title = a\n"), {name + "1: ", "'set entry = value'"});
    expect_parts(read_fault("set Title a\n"), {name + "1: ", "'set entry = value'"});
    expect_parts(read_fault("subsection\nend\n"), {name + "1: ", "needs a name"});
    expect_parts(read_fault("set Dimension = 5\n"), {name + "1: ", "'Dimension'", "1, 2 or 3"});
    expect_parts(read_fault("subsection Time\nset End time = 12e # s\nend\n"),
                 {name + "2: ", "'End time' in section 'Time'", "'12e' is not a number"});
    expect_parts(read_fault(" \n"), {"is empty"});
    for (const std::string nothing :
         {"# only a comment\n", "# old\r# Mac\r", "subsection Time\nend\n"})
      expect_parts(read_fault(nothing), {"has no entry", "'set entry = value'"});
    expect_parts(message_of([] { read_scene("no such file.prm", {}, MPI_COMM_WORLD); }),
                 {"'no such file.prm' cannot be read"});
    expect_parts(message_of([] { read_scene(".", {}, MPI_COMM_WORLD); }), {"'.' cannot be read"});
  }


  TEST(SceneFile, continuation_lines_count)
  {
    expect_parts(
      fault("subsection Domain\n  set Cells = 3, \\\n   4, \\\n 5\n\n set Hole radius = x\nend\n"),
      {"a.prm:7: ", "'Hole radius'"});
    expect_parts(fault("subsection Domain\n  set Cells = 3, \\\n   4, \\\n 5\nend\n"),
                 {"a.prm:3: ", "'Cells'", "found 3"});
    Scene<2> scene;
    parse_scene<2>({"a.prm", "subsection Domain\n  set Cells = 3, \\  \n   4\nend\n"}, scene);
    EXPECT_EQ(scene.domain.cells[1], 4u);
  }


  TEST(SceneFile, line_ends_of_every_system)
  {
    for (const std::string end : {"\n", "\r\n", "\r"})
      {
        const auto lines = [&](const std::vector<std::string> &list) {
          std::string text;
          for (const std::string &line : list)
            text += line + end;
          return text;
        };
        const TemporaryFile file(lines({"# A comment",
                                        "set Title = a",
                                        "subsection Domain",
                                        "  set Cells = 3, \\",
                                        "  7",
                                        "end"}));
        const auto          text = read_scene(file.name, {}, MPI_COMM_WORLD);
        Scene<2>            scene;
        parse_scene<2>(text, scene);
        EXPECT_EQ(scene.general.title, "a");
        EXPECT_EQ(scene.domain.cells[0], 3u);
        EXPECT_EQ(scene.domain.cells[1], 7u);
        expect_parts(read_fault(lines({"set Title = a", "", "set Titel = b"})), {".prm:3: "});
      }
  }


  TEST(SceneFile, overrides)
  {
    const TemporaryFile file("set Title = a\n"
                             "subsection Domain\n"
                             "  set Cells = 3, \\\n"
                             "     4 # cells\n"
                             "  set Hole radius = 0.1\n"
                             "end\n");
    const auto          text = read_scene(file.name,
                                 {"Domain/Cells = 5",
                                           "Time/End time=2",
                                           "Dimension=1",
                                           "Title=b = c",
                                           "Title=d",
                                           "Domain/Hole center=0.25",
                                           "Boundary conditions/Dirichlet=left: x>0 ? 1 : 2"},
                                 MPI_COMM_WORLD);
    ASSERT_EQ(dimension_of(text), 1u);
    Scene<1> scene;
    parse_scene<1>(text, scene);
    EXPECT_EQ(scene.domain.cells[0], 5u);
    EXPECT_EQ(scene.domain.holes.radius, 0.1);
    EXPECT_EQ(scene.time.end_time, 2.);
    EXPECT_EQ(scene.general.title, "d");
    EXPECT_EQ(scene.boundary_conditions.dirichlet[0].value.value(Point<1>(1.)), 1.);
    // the lines of the file keep their numbers
    EXPECT_EQ(scan_lines(text.text, "f").entries[2].line, 5u);

    const auto with = [&](const std::string &override_text) {
      return message_of([&] { read_scene(file.name, {override_text}, MPI_COMM_WORLD); });
    };
    expect_parts(with("Tme/End time=1"), {"command line: ", "unknown section 'Tme'", "'Time'?"});
    expect_parts(with("Time/End tim=1"),
                 {"command line: ", "'End tim' in section 'Time'", "'End time'?"});
    expect_parts(with("Cells=1"),
                 {"command line: ", "'Cells' outside all sections", "in section 'Domain'"});
    expect_parts(with("Time/End time=12e"),
                 {"command line: ", "'End time' in section 'Time'", "'12e'"});
    expect_parts(with("Domain/Hole radius=x"), {"command line: ", "'Hole radius'"});
    expect_parts(with("Title"), {"command line: ", "'Section/Entry=value'"});
    expect_parts(with("=3"), {"command line: ", "'Section/Entry=value'"});
    expect_parts(with("Title=a#b"), {"command line: ", "'Title'", "#"});
    expect_parts(with("Title=a\\"), {"command line: ", "'Title'", "backslash"});
    expect_parts(with("Dimension=7"), {"command line: ", "'Dimension'", "found '7'"});
  }


  TEST(SceneFile, read_before_and_beside_the_callers_scene)
  {
    const TemporaryFile file("set Title = a\nsubsection Time\nset Stepper = rk4\nend\n");
    Scene<2>            scene;
    const SceneText     text = read_scene(file.name, {}, MPI_COMM_WORLD);
    parse_scene<2>(text, scene);
    EXPECT_EQ(scene.time.stepper, "rk4");
  }


  TEST(SceneFile, scene_with_defaults_reads_back)
  {
    const auto check = [](const SceneText &text) {
      const TemporaryFile file(text.text);
      EXPECT_EQ(message_of([&] { read_scene(file.name, {}, MPI_COMM_WORLD); }), "");
    };
    std::string first;
    {
      Scene<2> scene;
      parse_scene<2>(
        {"a.prm",
         "set Title = a\nsubsection Domain\nset Node spacing = 0.1\nend\n"
         "subsection Boundary conditions\nset Dirichlet = top: max(x, 2); left: t\nend\n"},
        scene);
      first = scene_with_defaults();
      expect_parts(
        first,
        {"Node spacing", "top: max(x, 2); left: t", "subsection Units", "Maximum iterations"});
      check({"a.prm", first});
    }
    Scene<2> scene;
    parse_scene<2>({"b.prm", first}, scene);
    EXPECT_EQ(scene.domain.cells[0], 10u);
    EXPECT_EQ(scene.boundary_conditions.dirichlet.size(), 2u);
    EXPECT_EQ(scene_with_defaults(), first);
  }


  TEST(SceneFile, sections_of_the_calling_program)
  {
    struct Own : public dealii::ParameterAcceptor
    {
      Own()
        : ParameterAcceptor("/My program")
      {
        add_parameter("Factor", factor);
      }

      double factor = 1.;
    };
    {
      Own      own;
      Scene<2> scene;
      parse_scene<2>({"a.prm", "subsection My program\nset Factor = 3\nend\n"}, scene);
      EXPECT_EQ(own.factor, 3.);
      expect_parts(fault("subsection My program\nset Factr = 3\nend\n"),
                   {"Did you mean 'Factor'?"});
      expect_parts(fault("subsection My program\nset Factor = abc\nend\n"), {"a.prm: ", "abc"});
    }
    // add_parameter() has left a pointer to the object in it
    dealii::ParameterAcceptor::prm.clear();
    EXPECT_EQ(fault("set Title = a\n"), "");
  }


  TEST(Manual, all_formats)
  {
    const std::string prm = parameter_manual("prm"), markdown = parameter_manual("markdown"),
                      json = parameter_manual("JSON"), xml = parameter_manual("XML");
    EXPECT_EQ(message_of([&] {
                Scene<2> scene;
                parse_scene<2>({"manual.prm", prm}, scene);
              }),
              "");
    Scene<2> scene;
    for (const SceneSection *section : scene.sections())
      {
        if (!section->name().empty())
          expect_parts(markdown, {"\n## " + section->name() + "\n"});
        for (const Entry &entry : section->entries())
          {
            expect_parts(markdown, {"| " + entry.name + " | "});
            expect_parts(prm, {"set " + entry.name + " "});
            EXPECT_FALSE(entry.documentation.empty());
            for (const std::string &choice : entry.choices)
              {
                expect_parts(markdown, {choice});
                // comments of the prm form are wrapped at blanks
                expect_parts(prm, {choice.substr(0, choice.find(' '))});
              }
            EXPECT_TRUE(entry.type == EntryType::text || entry.type == EntryType::boolean ||
                        entry.type == EntryType::choice || entry.type == EntryType::choices ||
                        entry.name == "Symmetry" || entry.name == "Parts" ||
                        entry.name == "Regions" || entry.name == "Interfaces" ||
                        entry.name == "Image colors" || entry.name == "Constants" ||
                        entry.name == "Tables" || entry.name == "Quantities" || !entry.unit.empty())
              << entry.name;
          }
      }
    EXPECT_EQ(json.front(), '{');
    EXPECT_EQ(xml.compare(0, 5, "<?xml"), 0);
    expect_parts(message_of([] { parameter_manual("json"); }), {"'json'", "'JSON'?"});
  }


  TEST(Manual, one_entry)
  {
    const std::string cells = parameter_manual("Cells"), same = parameter_manual("domain/cells"),
                      section = parameter_manual("Units");
    expect_parts(cells, {"Cells  (section 'Domain')", "type:", "default:  20, 20"});
    EXPECT_EQ(cells, same);
    expect_parts(section, {"Length  (section 'Units')", "Force  (section 'Units')"});
    expect_parts(message_of([] { parameter_manual("Cels"); }),
                 {"'Cels'", "'Cells'?", "Peridynamics"});
  }
} // namespace PeriDeal
