// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What an event finds of a mesh, and which rows it marks.

#include <deal.II/base/mpi.h>

#include <perideal/operators/parts/event_work.h>

#include <algorithm>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::BoundingBox;
  using dealii::Point;

  namespace
  {
    /** The unit square of 8 x 8 cells with its left side held. */
    struct Square
    {
      Square()
        : problem(Settings{{"Domain/Cells", "8, 8"}, {"Boundary conditions/Dirichlet", "left: 0"}},
                  ModelKind::finite_elements)
        , hanging(problem.handler, *problem.vector().get_partitioner())
        , work(problem.handler, problem.vector(), held())
      {}

      std::vector<unsigned int> held() const
      {
        std::vector<unsigned int> list;
        for (unsigned int i = 0; i < problem.positions.size(); ++i)
          if (problem.positions[i][0] < 1e-9)
            list.push_back(i);
        return list;
      }

      Problem<2>      problem;
      HangingNodes<2> hanging;
      EventWork<2>    work;
    };

    const BoundingBox<2> middle({{0.5, 0.5}, {0.55, 0.55}}), corner({{0., 0.}, {0.05, 0.05}});

    bool is_near(const Point<2> &p, const BoundingBox<2> &box, const double distance)
    {
      bool near = true;
      for (unsigned int d = 0; d < 2; ++d)
        near = near && p[d] > box.lower_bound(d) - distance && p[d] < box.upper_bound(d) + distance;
      return near;
    }
  } // namespace


  TEST(EventWork, cells_near_boxes)
  {
    const Square body;
    const auto   cells = body.work.cells_near({middle}, 0.1, {corner, middle}, 0.18);
    EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
    EXPECT_EQ(std::adjacent_find(cells.begin(), cells.end()), cells.end());
    // Cells are 1/8 wide: their centres tell which come within the distance.
    unsigned int n = 0;
    for (const auto &cell : body.problem.handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const bool near = is_near(cell->center(), middle, 0.18 + 1. / 16.) ||
                            is_near(cell->center(), corner, 0.18 + 1. / 16.);
          EXPECT_EQ(std::binary_search(cells.begin(), cells.end(), cell), near) << cell->center();
          n += near ? 1 : 0;
        }
    EXPECT_EQ(cells.size(), n);
    EXPECT_TRUE(body.work.cells_near({}, 0.1, {}, 0.1).empty());
  }


  TEST(EventWork, rows)
  {
    Square                                       body;
    const auto                                   cells = body.work.cells_near({corner}, 0., {}, 0.);
    std::vector<dealii::types::global_dof_index> indices(4);
    for (const auto &cell : cells)
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(indices);
          body.work.touch(indices, body.hanging);
        }
    // The owner of each vertex of the cell in the corner learns of it.
    body.work.touched.compress();
    body.work.touched.sort();
    const auto is_corner = [](const Point<2> &p) { return std::max(p[0], p[1]) < 0.13; };
    std::vector<unsigned int> expected;
    for (unsigned int i = 0; i < body.problem.positions.size(); ++i)
      {
        if (is_corner(body.problem.positions[i]))
          expected.push_back(i);
        EXPECT_EQ(body.work.held.contains(i), body.problem.positions[i][0] < 1e-9);
      }
    EXPECT_EQ(body.work.touched.rows(), expected);
    body.work.touched.clear();
    EXPECT_TRUE(body.work.touched.rows().empty());
    EXPECT_EQ(owned_unknowns<2>(cells, *body.problem.vector().get_partitioner()), expected);
  }


  TEST(EventWork, boxes_beside_cuts)
  {
    const MPI_Comm     all    = MPI_COMM_WORLD;
    const unsigned int rank   = dealii::Utilities::MPI::this_mpi_process(all),
                       n_last = dealii::Utilities::MPI::n_mpi_processes(all) - 1;
    EXPECT_TRUE(boxes_beside<2>({middle, corner}, {}, all).empty());
    // The first process has a box beside the one cut, the last one two beside the other.
    std::vector<BoundingBox<2>> joins;
    if (rank == 0)
      joins.push_back({{{0.6, 0.6}, {0.7, 0.65}}});
    if (rank == n_last)
      {
        joins.push_back({{{0.1, 0.}, {0.2, 0.1}}});
        joins.push_back({{{0., 0.1}, {0.1, 0.3}}});
      }
    const auto boxes = boxes_beside<2>({middle, corner}, joins, all);
    ASSERT_EQ(boxes.size(), 2u);
    EXPECT_EQ(boxes[0], BoundingBox<2>({{0.6, 0.6}, {0.7, 0.65}}));
    EXPECT_EQ(boxes[1], BoundingBox<2>({{0., 0.}, {0.2, 0.3}}));
  }
} // namespace PeriDeal
