// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/text_file.h>
#include <perideal/scene/msh_file.h>

#include "scene_test_tools.h"

using namespace PeriDeal;
using PeriDeal::SceneTests::expect_parts;
using PeriDeal::SceneTests::message_of;

namespace
{
  // Four squares of edge 1 on nodes in rows of three, numbered from the lower left one, with two
  // named sides.
  const std::string latest = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"                // lines 1 to 3
                             "$Entities\n0 1 1 0\n"                                  // 5
                             "3 0 0 0 2 0 0 1 5 0\n"                                 // 6
                             "4 0 0 0 2 2 0 0 0\n$EndEntities\n"                     // 8
                             "$Nodes\n1 9 1 9\n2 4 0 9\n"                            // 11
                             "1\n2\n3\n4\n5\n6\n7\n8\n9\n"                           // 20
                             "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n"            // 26
                             "0 2 0\n1 2 0\n2 2 0\n$EndNodes\n"                      // 30
                             "$Elements\n2 6 1 6\n1 3 1 2\n1 1 2\n2 2 3\n"           // 35
                             "2 4 3 4\n3 1 2 5 4\n4 2 3 6 5\n5 4 5 8 7\n6 5 6 9 8\n" // 40
                             "$EndElements\n";

  const std::string old =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n"
    "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n" // 12
    "$Elements\n4\n"
    "1 1 2 5 3 1 2\n2 1 2 5 3 2 3\n3 3 2 0 4 1 2 5 4\n4 3 2 0 4 2 3 6 5\n" // 18
    "$EndElements\n";

  // Two cubes side by side, the lower ones of them on one named face.
  const std::string cubes = "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Nodes\n1 12\n1 3 0 12\n" // 6
                            "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n"
                            "7 0 0 1\n8 1 0 1\n9 2 0 1\n10 0 1 1\n11 1 1 1\n12 2 1 1\n" // 18
                            "$EndNodes\n$Elements\n2 3\n1 2 3 1\n1 1 4 5 2\n1 3 5 2\n"  // 24
                            "2 1 2 5 4 7 8 11 10\n3 2 3 6 5 8 9 12 11\n$EndElements\n";


  void read(const std::string &text, const unsigned int dim)
  {
    MshMesh mesh = parse_msh(text, "part.msh", dim);
    check_msh(mesh, "part.msh", dim);
  }


  /** The text with one piece replaced, which it has once. */
  std::string with(const std::string &text, const std::string &piece, const std::string &other)
  {
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    EXPECT_EQ(text.find(piece, at + 1), std::string::npos) << piece;
    return text.substr(0, at) + other + text.substr(at + piece.size());
  }


  void expect_fault(const std::string              &text,
                    const unsigned int              dim,
                    const unsigned int              line,
                    const std::vector<std::string> &parts)
  {
    const std::string message = message_of([&] { read(text, dim); });
    expect_parts(
      message,
      {"'Mesh file' in section 'Domain'", "'part.msh', line " + std::to_string(line) + ":"});
    expect_parts(message, parts);
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }


  void expect_sound(const std::string &text, const unsigned int dim = 2)
  {
    EXPECT_EQ(message_of([&] { read(text, dim); }), "");
  }
} // namespace


TEST(MshCheck, sound_files)
{
  const MshMesh mesh = parse_msh(latest, "part.msh", 2);
  ASSERT_EQ(mesh.points.size(), 9u);
  ASSERT_EQ(mesh.cells.size(), 4u);
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.points[5], (std::array<double, 3>{{2., 1., 0.}}));
  EXPECT_EQ(mesh.cells[2].number, 5);
  EXPECT_EQ(mesh.cells[2].line, 39u);
  EXPECT_EQ(mesh.cells[2].nodes, (std::array<unsigned int, 8>{{3, 4, 7, 6, 0, 0, 0, 0}}));
  EXPECT_EQ(mesh.sides[1].id, 5);
  EXPECT_EQ(parse_msh(old, "part.msh", 2).sides[0].id, 5);
  expect_sound(latest);
  expect_sound(old);
  expect_sound(cubes, 3);
  for (const std::string name : {"two_materials.msh", "hexes.msh"})
    {
      std::string       fault;
      const std::string text =
        read_file(std::string(PERIDEAL_SOURCE_DIR) + "/tests/data/" + name, 1000000, fault);
      EXPECT_EQ(fault, "");
      expect_sound(text, name == "hexes.msh" ? 3 : 2);
    }
  // Cells numbered clockwise, all or some, names of groups, and sections behind those that are
  // read.
  expect_sound(with(latest, "3 1 2 5 4", "3 4 5 2 1"));
  expect_sound(with(old, "$Nodes", "$PhysicalNames\n1\n1 5 \"side\"\n$EndPhysicalNames\n$Nodes"));
  expect_sound(latest + "$Periodic\n0\n$EndPeriodic\n");
}


TEST(MshCheck, straight_corners)
{
  expect_sound(with(latest, "0 1 0\n1 1 0\n2 1 0", "0 1 0\n0.5 0.5 0\n2 1 0"));
  // A corner in the middle of an edge is in order: quadrilaterals from recombined triangles have
  // some.
  expect_sound(with(latest, "2 0 0\n0 1 0", "2 0 0\n0.5 0.5 0"));
  expect_fault(with(latest, "2 0 0\n0 1 0", "2 0 0\n0.5 0 0"), 2, 37, {"no angle"});
}


TEST(MshCheck, header)
{
  expect_fault("", 2, 1, {"the file ends", "'$MeshFormat'"});
  expect_fault("This is not a mesh.\n", 2, 1, {"no Gmsh file", "broken"});
  expect_fault("$NOD\n1\n", 2, 1, {"version 1", "4.0 and 4.1"});
  expect_fault(with(old, "2.2 0", "3 0"), 2, 2, {"version '3'"});
  expect_fault(with(old, "2.2 0", "2.2 1"), 2, 2, {"binary", "as text"});
  expect_fault(with(old, "0 8", "0 4"), 2, 2, {"8"});
  expect_fault(with(old, "$EndMeshFormat", "$EndFormat"),
               2,
               3,
               {"'$EndFormat'", "'$EndMeshFormat'"});
}


TEST(MshCheck, sections_and_counts)
{
  expect_fault(with(latest, "1 9 1 9", "1 2 1 9"), 2, 11, {"found 9 nodes", "no more than 2"});
  expect_fault(with(latest, "1 9 1 9", "1 10 1 9"), 2, 29, {"found 9 nodes", "10"});
  expect_fault(with(latest, "2 4 0 9", "2 4 0 8"), 2, 28, {"found 8 nodes", "9"});
  expect_fault(with(latest, "1 9 1 9", "2 9 1 9"), 2, 30, {"'$EndNodes'", "entity"});
  expect_fault(with(latest, "1 9 1 9", "1 1000000000 1 9"), 2, 10, {"1000000000", "hold"});
  expect_fault(with(latest, "1 9 1 9", "1 -9 1 9"), 2, 10, {"found -9"});
  expect_fault(with(latest, "1 9 1 9", "1 9x 1 9"), 2, 10, {"'9x'"});
  expect_fault(with(latest, "2 6 1 6", "2 7 1 7"), 2, 40, {"found 6 elements", "7"});
  expect_fault(with(latest, "2 4 3 4\n", "2 4 3 5\n"), 2, 36, {"found 5 elements", "6"});
  expect_fault(with(latest, "$EndNodes\n", ""), 2, 30, {"'$Elements'", "'$EndNodes'"});
  expect_fault(with(latest, "$EndElements\n", ""), 2, 41, {"the file ends", "'$EndElements'"});
  expect_fault(latest.substr(0, latest.find("2 1 0\n0 2 0")),
               2,
               26,
               {"the file ends", "x of node 6"});
  expect_fault(with(old, "$Nodes", "$PhysicalNames\n0\n$Nodes"),
               2,
               22,
               {"ends", "'$EndPhysicalNames'"});
  expect_fault(with(latest, "0 1 1 0\n", "0 2 1 0\n"),
               2,
               8,
               {"'$EndEntities'", "entity 1 of dimension 2"});
  expect_sound(with(latest, "1 5 0\n", "2 5 6 0\n")); // two groups of one line: the first counts
  expect_fault(with(latest, "1 3 1 2\n", "1 7 1 2\n"), 2, 33, {"entity 7", "'$Entities'"});
  expect_fault(with(latest, "1 3 1 2\n", "2 3 1 2\n"), 2, 33, {"line", "dimension 2"});
}


TEST(MshCheck, numbers)
{
  expect_fault(with(latest, "1 1 0\n2 1 0", "1 1e 0\n2 1 0"), 2, 25, {"'1e'", "y of node 5"});
  expect_fault(with(latest, "1 1 0\n2 1 0", "1 nan 0\n2 1 0"), 2, 25, {"'nan'"});
  expect_fault(with(latest, "1 1 0\n2 1 0", "1 1e300 0\n2 1 0"), 2, 25, {"1e300", "too large"});
  expect_fault(with(old, "5 1 1 0", "4 1 1 0"), 2, 10, {"node 4 twice"});
  expect_fault(with(latest, "7\n8\n9\n", "7\n7\n9\n"), 2, 28, {"node 7 twice"});
  expect_fault(with(old, "4 3 2 0 4 2", "3 3 2 0 4 2"), 2, 18, {"element 3", "line 17"});
  expect_fault(with(latest, "6 5 6 9 8", "6 5 6 10 8"), 2, 40, {"node 10", "element 6"});
  expect_fault(with(old, "1 1 2 5 3", "1 1 2 -5 3"), 2, 15, {"found -5"});
}


TEST(MshCheck, types)
{
  expect_sound(with(old, "4 3 2 0 4 2 3 6 5", "4 2 2 0 4 2 3 6"));
  expect_sound(with(old, "4 3 2 0 4 2 3 6 5", "4 10 2 0 4 2 3 6 5 1 1 1 1 1")); // of second order
  expect_fault(with(old, "4 3 2 0 4 2 3 6 5", "4 93 2 0 4 2 3 6 5"), 2, 18, {"type 93"});
  expect_fault(with(cubes, "2 3 6 5 8 9 12 11", "2 3 6 5 8"), 3, 27, {"'$EndElements'"});
  expect_fault(with(with(cubes, "1 3 5 2", "1 3 7 2"),
                    "2 1 2 5 4 7 8 11 10\n3 2 3 6 5 8 9 12 11",
                    "2 1 2 5 4 7\n3 2 3 6 5 8"),
               3,
               24,
               {"pyramid", "without pyramids"});
  expect_fault(cubes, 2, 24, {"hexahedron", "dimension 2"});
  expect_fault(old, 3, 19, {"no hexahedra", "dimension 3"});
  expect_fault(with(latest, "2 4 0 9", "2 4 1 9"),
               2,
               30,
               {"z of node 6"}); // with two parameters each
}


TEST(MshCheck, folded_cells)
{
  expect_fault(with(latest, "5 4 5 8 7", "5 6 5 8 7"), 2, 39, {"5", "6, 5, 8 and 7", "folded"});
  expect_fault(with(latest, "5 4 5 8 7", "5 4 5 7 8"), 2, 39, {"wrong order"});
  expect_fault(with(latest, "5 4 5 8 7", "5 4 5 8 8"), 2, 39, {"node 8 twice"});
  expect_fault(with(latest, "0 1 0\n1 1 0\n2 1 0", "0 1 0\n0 1 0\n2 1 0"),
               2,
               37,
               {"no angle at its node 5"});
  expect_fault(with(latest, "0 1 0\n1 1 0\n2 1 0", "0 1 0\n3 1 0\n2 1 0"), 2, 38, {"folded"});
  expect_fault(with(latest, "6 5 6 9 8", "6 4 5 8 7"), 2, 40, {"same nodes", "5 (line 39)"});
  expect_fault(with(cubes, "3 2 3 6 5 8 9 12 11", "3 2 3 6 5 8 9 11 12"), 3, 26, {"hexahedron 3"});
  expect_fault(with(cubes, "12 2 1 1", "12 0.5 0.5 1"), 3, 26, {"node 12"});
}


TEST(MshCheck, neighbors)
{
  // A second cell on the same side of the edge 2-5, of nodes of its own, and a third cell at that
  // edge.
  const std::string more = with(with(old, "$Nodes\n6\n", "$Nodes\n8\n"),
                                "6 2 1 0\n",
                                "6 2 1 0\n7 0.2 -0.5 0\n8 0.2 1.5 0\n");
  const std::string without_sides =
    with(with(more, "2 1 2 5 3 2 3\n", ""), "$Elements\n4", "$Elements\n3");
  expect_fault(with(without_sides, "4 3 2 0 4 2 3 6 5", "4 3 2 0 4 5 8 7 2"),
               2,
               19,
               {"same side", "3 (line 18)", "4 (line 19)"});
  expect_fault(with(with(without_sides, "$Elements\n3", "$Elements\n4"),
                    "4 3 2 0 4 2 3 6 5",
                    "4 3 2 0 4 2 3 6 5\n5 3 2 0 4 5 8 7 2"),
               2,
               20,
               {"three cells", "5 (line 20)"});
}


TEST(MshCheck, what_others_write)
{
  // Two groups of sides with one name are one.
  const std::string names =
    "$EndMeshFormat\n$PhysicalNames\n3\n1 5 \"wall\"\n1 6 \"hot\"\n1 8 \"wall\"\n$EndPhysicalNames\n";
  const std::string named =
    with(with(old, "$EndMeshFormat\n", names), "2 1 2 5 3 2 3", "2 1 2 8 3 2 3");
  MshMesh mesh = parse_msh(named, "part.msh", 2);
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].id, 5);
  EXPECT_EQ(mesh.sides[1].id, 5);

  EXPECT_EQ((mesh.ids.at({1, "wall"})), 5);
  EXPECT_EQ((mesh.ids.at({1, "hot"})), 6);

  // Points, also in two groups.
  const std::string with_points = with(with(latest, "0 1 1 0\n", "1 1 1 0\n9 0 0 0 2 3 4\n"),
                                       "2 6 1 6\n",
                                       "3 7 1 7\n0 9 15 1\n7 3\n");
  mesh                          = parse_msh(with_points, "part.msh", 2);
  ASSERT_EQ(mesh.places.size(), 2u);
  EXPECT_EQ(mesh.places[0].id, 3);
  EXPECT_EQ(mesh.places[1].id, 4);
  EXPECT_EQ(mesh.places[1].nodes[0], 2u);

  // Comments, and a node that is given twice at one place.
  const std::string comment = "$Comments\nsaved 5 1 1 0 $Nodes\n$EndComments\n";
  expect_sound(with(with(old, "$EndNodes\n", "$EndNodes\n" + comment),
                    "$EndMeshFormat\n",
                    "$EndMeshFormat\n" + comment));
  const std::string twice =
    with(with(old, "6 2 1 0\n", "6 2 1 0\n3 2 0 0\n"), "$Nodes\n6", "$Nodes\n7");
  EXPECT_EQ(parse_msh(twice, "part.msh", 2).points.size(), 6u);

  // What is read is written for deal.II, without sides between two cells.
  mesh = parse_msh(with(old, "2 1 2 5 3 2 3", "2 1 2 5 3 2 5"), "part.msh", 2);
  check_msh(mesh, "part.msh", 2);
  ASSERT_EQ(mesh.sides.size(), 1u);
  ASSERT_EQ(mesh.interfaces.size(), 1u);
  EXPECT_EQ(mesh.interfaces[0].number, 2);
  const MshMesh again = parse_msh(text_of_msh(mesh, 2), "part.msh", 2);
  EXPECT_EQ(again.points, mesh.points);
  ASSERT_EQ(again.cells.size(), 2u);
  EXPECT_EQ(again.cells[1].nodes, mesh.cells[1].nodes);
  EXPECT_EQ(again.sides[0].id, 5);

  // A mesh in the plane of x and z.
  std::string turned = old;
  for (const auto &[from, to] :
       std::vector<std::pair<std::string, std::string>>{{"4 0 1 0\n", "4 0 0 1\n"},
                                                        {"5 1 1 0\n", "5 1 0 1\n"},
                                                        {"6 2 1 0\n", "6 2 0 1\n"}})
    turned = with(turned, from, to);
  expect_fault(turned, 2, 17, {"plane of x and z", "Turn the mesh"});
}


TEST(MshCheck, sides)
{
  expect_sound(with(latest, "1 1 2\n2 2 3", "1 1 2\n2 2 5"), 2); // between two cells
  expect_fault(with(latest, "1 1 2\n2 2 3", "1 1 2\n2 1 3"), 2, 35, {"no edge of a quadrilateral"});
  expect_fault(with(old, "2 1 2 5 3 2 3", "2 1 2 6 3 2 1"), 2, 16, {"groups 5 and 6"});
  expect_sound(with(old, "2 1 2 5 3 2 3", "2 1 2 5 3 2 1")); // the same one twice
  expect_sound(with(cubes, "1 1 4 5 2", "1 2 5 11 8"), 3);
  expect_fault(with(cubes, "1 1 4 5 2", "1 1 5 4 2"), 3, 23, {"no face of a hexahedron"});
}


TEST(MshCheck, pieces_that_touch)
{
  // A node in the middle of the edge 2-5 of the left square, which is one of two on the right.
  const std::string hanging = with(
    with(with(old, "$Nodes\n6\n", "$Nodes\n8\n"), "6 2 1 0\n", "6 2 1 0\n7 1 0.5 0\n8 2 0.5 0\n"),
    "4 3 2 0 4 2 3 6 5",
    "4 3 2 0 4 2 3 8 7\n5 3 2 0 4 7 8 6 5");
  MshMesh mesh = parse_msh(with(hanging, "$Elements\n4", "$Elements\n5"), "part.msh", 2);
  check_msh(mesh, "part.msh", 2);
  EXPECT_EQ(mesh.touching, (std::vector<unsigned int>{6}));
  EXPECT_NEAR(mesh.surface, 8., 1e-12);
  // Doubled nodes along that edge.
  mesh = parse_msh(
    with(with(with(old, "$Nodes\n6\n", "$Nodes\n8\n"), "6 2 1 0\n", "6 2 1 0\n7 1 0 0\n8 1 1 0\n"),
         "2 1 2 5 3 2 3\n3 3 2 0 4 1 2 5 4\n4 3 2 0 4 2 3 6 5",
         "2 1 2 5 3 7 3\n3 3 2 0 4 1 2 5 4\n4 3 2 0 4 7 3 6 8"),
    "part.msh",
    2);
  check_msh(mesh, "part.msh", 2);
  EXPECT_EQ(mesh.touching, (std::vector<unsigned int>{1, 4, 6, 7}));
}


TEST(MshCheck, faces_that_do_not_fit)
{
  // In place of the right cube tetrahedra: blocks of an entity, its dimension, the type, how many.
  const auto cube_and = [](const unsigned int n, const std::string &tetrahedra) {
    return with(with(with(with(cubes, "1 12\n1 3 0 12\n", "1 13\n1 3 0 13\n"),
                          "12 2 1 1\n",
                          "12 2 1 1\n13 3 0 0\n"),
                     "2 3\n1 2 3 1\n1 1 4 5 2\n1 3 5 2\n",
                     "2 " + std::to_string(1 + n) + "\n1 3 5 1\n"),
                "3 2 3 6 5 8 9 12 11\n",
                "2 3 4 " + std::to_string(n) + "\n" + tetrahedra);
  };
  // With three of the corners of the cube's face.
  expect_fault(cube_and(2, "3 2 5 8 3\n4 5 11 8 3\n"),
               3,
               27,
               {"triangles against a quadrilateral", "hexahedron 2", "tetrahedron 4", "(1, 0.5"});
  // With one of its edges, and without a node of it.
  for (const auto &[nodes, what] :
       std::vector<std::pair<std::string, std::string>>{{"2 8 3 6", "at 1 edges"},
                                                        {"13 3 6 9", "2 pieces"}})
    {
      MshMesh mesh = parse_msh(cube_and(1, "3 " + nodes + "\n"), "part.msh", 3);
      check_msh(mesh, "part.msh", 3);
      ASSERT_EQ(mesh.notes.size(), 1u);
      EXPECT_NE(mesh.notes[0].find(what), std::string::npos) << mesh.notes[0];
    }
}
