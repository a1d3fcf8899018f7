// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What cracks leave of the cells of a small mesh.

#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <perideal/operators/parts/cut_cells.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Rule   = CutCells<2>::Rule;
    using Pieces = std::vector<CrackPiece<2>>;

    /** The unit square with 4 x 4 cells, the same on every process. */
    struct Square
    {
      Square()
        : fe(1)
        , dofs(mesh)
      {
        GridGenerator::subdivided_hyper_cube(mesh, 4);
        dofs.distribute_dofs(fe);
      }

      CutCells<2>::Cell cell_at(const Point<2> &p) const
      {
        for (const auto &cell : dofs.active_cell_iterators())
          if (cell->point_inside(p))
            return cell;
        return dofs.end();
      }

      Triangulation<2> mesh;
      FE_Q<2>          fe;
      DoFHandler<2>    dofs;
    };


    CrackPiece<2> piece(const unsigned int crack, const Point<2> &a, const Point<2> &b)
    {
      return {{a, b}, crack, {}};
    }


    /** Right through the body, in the third row of cells from the top. */
    const Pieces through{piece(0, {-1., 0.4}, {2., 0.4})};

    double not_asked()
    {
      ADD_FAILURE() << "nothing here depends on it";
      return 1.;
    }

    double no_pair(const unsigned int, const unsigned int)
    {
      return not_asked();
    }

    unsigned int n_cut(const CutCells<2> &cells)
    {
      return std::count(cells.flags().begin(), cells.flags().end(), true);
    }


    /** Vertices in deal.II's order: of a square cell of conductivity 1. */
    FullMatrix<double> square_matrix()
    {
      FullMatrix<double> matrix(4, 4);
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b < 4; ++b)
          matrix(a, b) = a == b ? 2. / 3. : (a ^ b) == 3 ? -1. / 3. : -1. / 6.;
      return matrix;
    }
  } // namespace


  TEST(CutCells, which_cells)
  {
    const Square body;
    CutCells<2>  pairs(body.dofs, {false, false, -1., not_asked}),
      removed(body.dofs, {false, true, -1., not_asked}),
      faces(body.dofs, {true, false, -1., not_asked});
    EXPECT_FALSE(pairs.removes());
    EXPECT_TRUE(removed.removes());
    for (CutCells<2> *cells : {&pairs, &removed, &faces})
      {
        EXPECT_EQ(n_cut(*cells), 0u);
        cells->set(through, 0.);
        EXPECT_EQ(n_cut(*cells), cells == &faces ? 0u : 4u);
        EXPECT_EQ(cells->is_cut(body.cell_at({0.6, 0.3})), cells != &faces);
        EXPECT_FALSE(cells->is_cut(body.cell_at({0.6, 0.6})));
      }
    // A crack of another time, first told to one cell alone.
    const Pieces shorter{piece(0, {-1., 0.4}, {0.3, 0.4})};
    pairs.set({body.cell_at({0.9, 0.3})}, shorter, 0.);
    EXPECT_EQ(n_cut(pairs), 3u);
    pairs.set(shorter, 0.);
    EXPECT_EQ(n_cut(pairs), 2u); // two vertices of the cell with the tip are separated
    removed.set(shorter, 0.);
    EXPECT_EQ(n_cut(removed), 1u); // the tip is before the middle of its cell
  }


  TEST(CutCells, pairs_of_a_cut_cell)
  {
    const Square       body;
    CutCells<2>        pairs(body.dofs, {false, false, -1., not_asked});
    const auto         cell = body.cell_at({0.6, 0.3});
    FullMatrix<double> matrix;
    for (const double transmission : {0., 1.})
      {
        pairs.set(through, transmission);
        matrix = square_matrix();
        pairs.cut_matrix(cell, no_pair, matrix);
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int b = 0; b < 4; ++b)
            if (a != b)
              {
                const bool whole = (a < 2) == (b < 2) || transmission == 1.;
                EXPECT_EQ(matrix(a, b), whole ? square_matrix()(a, b) : 0.);
              }
        double sum = 0.;
        for (unsigned int b = 0; b < 4; ++b)
          sum += matrix(0, b);
        EXPECT_NEAR(sum, 0., 1e-15);
      }
    EXPECT_FALSE(pairs.pairs_are_stiffer());
    matrix       = square_matrix();
    matrix(1, 0) = matrix(0, 1) = 0.1;
    pairs.cut_matrix(cell, no_pair, matrix);
    EXPECT_EQ(matrix(1, 0), 0.1); // nothing is held back: the cell as it was
    EXPECT_FALSE(pairs.pairs_are_stiffer());
    pairs.set(through, 0.);
    pairs.cut_matrix(cell, no_pair, matrix);
    EXPECT_EQ(matrix(1, 0), 0.);
    EXPECT_TRUE(pairs.pairs_are_stiffer());
    CutCells<2> removed(body.dofs, {false, true, -1., not_asked});
    removed.set(through, 0.);
    matrix = square_matrix();
    removed.cut_matrix(cell, no_pair, matrix);
    EXPECT_EQ(matrix.linfty_norm(), 0.);
  }


  TEST(CutCells, what_cracks_let_through)
  {
    const Square body;
    const auto   cell  = body.cell_at({0.6, 0.3});
    const auto   kappa = [](const unsigned int, const unsigned int) { return 2.; };
    CutCells<2>  contact(body.dofs, {false, false, 3., not_asked});
    contact.set(through, 0.);
    // In series over the way of 0.25 across the crack, also along the diagonal.
    const double fraction = 3. * 0.25 / (3. * 0.25 + 2.);
    EXPECT_NEAR(contact.kept_fraction(cell, 0, 2, kappa), fraction, 1e-15);
    EXPECT_NEAR(contact.kept_fraction(cell, 0, 3, kappa), fraction, 1e-15);
    EXPECT_EQ(contact.kept_fraction(cell, 0, 1, no_pair), 1.);

    // Two pieces of one crack are one crossing, two cracks are two.
    const Pieces bent{piece(0, {-1., 0.3}, {2., 0.3}), piece(0, {-1., 0.4}, {2., 0.4})},
      two{bent[0], piece(1, {2., 0.4}, {-1., 0.4})};
    std::vector<std::pair<unsigned int, int>> crossed;
    contact.set(bent, 0.);
    EXPECT_NEAR(contact.kept_fraction(cell, 0, 2, kappa, &crossed), fraction, 1e-15);
    EXPECT_EQ(crossed, (std::vector<std::pair<unsigned int, int>>{{0, -1}}));
    crossed.clear();
    contact.set(two, 0.);
    EXPECT_NEAR(contact.kept_fraction(cell, 0, 2, kappa, &crossed), fraction * fraction, 1e-15);
    EXPECT_EQ(crossed, (std::vector<std::pair<unsigned int, int>>{{0, -1}, {1, 1}}));
    crossed.clear();
    contact.kept_fraction(cell, 2, 0, kappa, &crossed);
    EXPECT_EQ(crossed, (std::vector<std::pair<unsigned int, int>>{{0, 1}, {1, -1}}));

    // A transmission needs the horizon, and the better it is the more goes through.
    CutCells<2> partly(body.dofs, {false, false, -1., [] { return 0.5; }});
    double      last = 0.;
    for (const double transmission : {0.2, 0.5, 0.8})
      {
        partly.set(through, transmission);
        const double kept = partly.kept_fraction(cell, 0, 2, kappa);
        EXPECT_GT(kept, last);
        EXPECT_LT(kept, 1.);
        last = kept;
      }
  }
} // namespace PeriDeal
