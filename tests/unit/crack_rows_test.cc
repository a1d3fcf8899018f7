// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Lattices that keep cracks off their nodes, and cells that cracks remove.

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <perideal/mesh/cut_cells.h>
#include <perideal/scene/scene.h>

#include <gtest/gtest.h>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * The cells that a scene comes to have; its crack runs along a row of nodes if there is a note.
     */
    template <int dim>
    std::array<unsigned int, dim> cells_of(const std::string &text, const bool note)
    {
      Scene<dim> scene;
      parse_scene<dim>({"a.prm", "set Dimension = " + std::to_string(dim) + "\n" + text}, scene);
      EXPECT_EQ(scene.domain.notes.size(), note ? 1u : 0u) << text;
      return scene.domain.cells;
    }


    std::string square(const std::string &cells,
                       const std::string &cracks,
                       const std::string &more = "")
    {
      return "subsection Domain\nset Cells = " + cells + "\n" + more +
             "\nend\nsubsection Cracks\n" + cracks + "\nend\n";
    }

    using Cells = std::array<unsigned int, 2>;


    /** Numbers of the cells of 4 x 4 on the unit square that some crack removes. */
    std::vector<unsigned int> removed(const std::vector<std::vector<Point<2>>> &cracks,
                                      const bool                                mouths = false)
    {
      Triangulation<2> mesh;
      GridGenerator::subdivided_hyper_cube(mesh, 4);
      std::vector<CrackPiece<2>> pieces;
      for (const auto &corners : cracks)
        pieces.push_back({corners, 0, {true, true}});
      const auto                geometries = make_open_geometries(pieces);
      std::vector<unsigned int> list;
      for (const auto &cell : mesh.active_cell_iterators())
        if (is_removed(cell, geometries, mouths))
          list.push_back(cell->active_cell_index());
      std::sort(list.begin(), list.end());
      return list;
    }

    using Numbers = std::vector<unsigned int>;
  } // namespace


  TEST(CrackRows, the_lattice_gives_way)
  {
    const std::string middle = "set Segments = 0.2,0.5 ; 0.8,0.5";
    EXPECT_EQ(cells_of<2>(square("10, 10", middle), true), (Cells{{10, 11}}));
    EXPECT_EQ(cells_of<2>(square("10, 11", middle), false), (Cells{{10, 11}}));
    // Kept as given, which is said.
    EXPECT_EQ(cells_of<2>(square("10, 10", middle + "\nset Nodes on cracks = left"), true),
              (Cells{{10, 10}}));
    EXPECT_EQ(cells_of<2>(square("10, 10", middle + "\nset Mesh = faces"), false),
              (Cells{{10, 10}}));
    // Cell centres count where they are the nodes.
    EXPECT_EQ(cells_of<2>(square("10, 11", middle, "set Nodes = cell centers"), true),
              (Cells{{10, 12}}));
    EXPECT_EQ(cells_of<2>(square("10, 10", middle, "set Nodes = cell centers"), false),
              (Cells{{10, 10}}));
    // Nearly on a row is on it.
    for (const std::string y : {"0.500000001", "0.499999999", "0.50005"})
      EXPECT_EQ(cells_of<2>(square("10, 10", "set Segments = 0.2," + y + " ; 0.8," + y), true),
                (Cells{{10, 11}}));
    EXPECT_EQ(cells_of<2>(square("10, 10", "set Segments = 0.2,0.501 ; 0.8,0.501"), false),
              (Cells{{10, 10}}));
    // Both ways, and one count for two cracks: 11, 9 and 12 hold one of them.
    EXPECT_EQ(cells_of<2>(square("10, 10", middle + " ; 0.3,0.2 ; 0.3,0.8"), true),
              (Cells{{11, 11}}));
    EXPECT_EQ(
      cells_of<2>(square("10, 12", middle + " ; 0.2,0.3846153846153846 ; 0.8,0.3846153846153846"),
                  true),
      (Cells{{10, 11}}));
    // Diagonals, but not every crack that meets a node.
    EXPECT_EQ(cells_of<2>(square("10, 10", "set Segments = 0.1,0.1 ; 0.9,0.9"), true),
              (Cells{{11, 10}}));
    EXPECT_EQ(cells_of<2>(square("10, 10", "set Segments = 0.1,0.2 ; 0.8,0.4"), false),
              (Cells{{10, 10}}));
    // All that a crack ever reaches.
    EXPECT_EQ(cells_of<2>(square("10, 10",
                                 "set Segments = 0.2,0.43 ; 0.25,0.43\n"
                                 "set Paths = 2: 0, 0.25,0.43 | 0.5, 0.3,0.7 | 1, 0.8,0.7") +
                            "subsection Time\nset End time = 1\nend\n",
                          true),
              (Cells{{10, 11}}));
  }


  TEST(CrackRows, lattices_that_cannot_give_way_say_so)
  {
    EXPECT_EQ(cells_of<2>(square("8, 8",
                                 "set Segments = 0.2,0.5 ; 0.8,0.5",
                                 "set Coarsening = 1\nset Fine where = 1") +
                            "set Models = finite elements\n",
                          true),
              (Cells{{8, 8}}));
    // No count up to three away is free of seven cracks.
    std::string cracks = "set Segments = ";
    for (unsigned int n = 7; n <= 13; ++n)
      cracks +=
        (n > 7 ? " ; 0.2," : "0.2,") + std::to_string(1. / n) + " ; 0.8," + std::to_string(1. / n);
    EXPECT_EQ(cells_of<2>(square("10, 10", cracks), true), (Cells{{10, 10}}));
  }


  TEST(CrackRows, polygons)
  {
    const std::string polygon =
      "set Polygons = 0.2,0.5,0.2 ; 0.8,0.5,0.2 ; 0.8,0.5,0.8 ; 0.2,0.5,0.8";
    const auto cells = cells_of<3>(square("6, 6, 6", polygon), true);
    EXPECT_EQ(cells, (std::array<unsigned int, 3>{{6, 7, 6}}));
  }


  TEST(CrackRows, a_tip_counts_from_the_middle_of_a_cell_on)
  {
    const auto up_to = [](const double x) {
      return removed({{Point<2>(0., 0.4), Point<2>(x, 0.4)}});
    };
    for (const double x : {0.5 - 1e-9, 0.5, 0.5 + 1e-9, 0.62})
      EXPECT_EQ(up_to(x), (Numbers{4, 5})) << x;
    for (const double x : {0.63, 0.75, 0.75 + 1e-9})
      EXPECT_EQ(up_to(x), (Numbers{4, 5, 6})) << x;
    // A turn within a cell is no tip.
    EXPECT_EQ(
      removed({{Point<2>(0., 0.4), Point<2>(0.3, 0.4)}, {Point<2>(0.3, 0.4), Point<2>(0.45, 0.9)}}),
      (Numbers{4, 5, 9, 13}));
  }


  TEST(CrackRows, of_cells_touched_at_a_vertex_the_right_one_goes)
  {
    // The vertex in the middle would hold both sides together; cells touched by a tip stay.
    EXPECT_EQ(removed({{Point<2>(0.25, 0.25), Point<2>(0.75, 0.75)}}), (Numbers{5, 6, 10}));
    EXPECT_EQ(removed({{Point<2>(0.75, 0.75), Point<2>(0.25, 0.25)}}), (Numbers{5, 9, 10}));
    EXPECT_EQ(removed({{Point<2>(0.25, 0.25), Point<2>(0.5, 0.5)},
                       {Point<2>(0.5, 0.5), Point<2>(0.75, 0.75)}}),
              (Numbers{5, 6, 10}));
    // A piece that ends in a joint before a vertex on its line leaves the cells beyond it.
    EXPECT_EQ(removed({{Point<2>(0.1, 0.1), Point<2>(0.45, 0.45)},
                       {Point<2>(0.45, 0.45), Point<2>(0.45, 0.2)}}),
              (Numbers{0, 1, 5}));
    // A mouth at a vertex on the side of the body is no tip where bonds hold that vertex.
    EXPECT_EQ(removed({{Point<2>(0., 0.25), Point<2>(0.5, 0.75)}}), (Numbers{4, 5, 9}));
    EXPECT_EQ(removed({{Point<2>(0., 0.25), Point<2>(0.5, 0.75)}}, true), (Numbers{0, 4, 5, 9}));
    EXPECT_EQ(removed({{Point<2>(0.5, 0.75), Point<2>(0., 0.25)}}, true), (Numbers{4, 8, 9}));
    // Along faces the cells on the right go.
    EXPECT_EQ(removed({{Point<2>(0.25, 0.5), Point<2>(0.75, 0.5)}}), (Numbers{5, 6}));
  }
} // namespace PeriDeal
