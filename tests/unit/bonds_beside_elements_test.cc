// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds in a matrix and apart from it, against sums over the bonds of the coupling.

#include <perideal/operators/diffusion/bonds_beside_elements.h>

#include <algorithm>
#include <numeric>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;
  using Matrix = dealii::TrilinosWrappers::SparseMatrix;

  namespace
  {
    /** A square with the bonds of its zone. */
    struct BondedSquare
    {
      explicit BondedSquare(const Settings &settings)
        : problem(Settings{{"Domain/Cells", "16, 12"}, {"Domain/Upper corner", "1.6, 1.2"}} +
                    settings,
                  ModelKind::coupled)
        , nodes(problem.handler, problem.scene.domain, problem.scene.cracks, NodalVolume::partial)
        , bonds(make_coupling(nodes,
                              problem.scene,
                              Zone<2>(problem.scene.coupling, problem.scene.horizon()),
                              problem.scene.coupling.scheme),
                factors)
        , all(nodes.n_owned())
      {
        std::iota(all.begin(), all.end(), 0);
      }

      Vector vector() const
      {
        return Vector(nodes.partitioner());
      }

      Vector field() const
      {
        Vector u = vector();
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          u.local_element(i) = bumpy<2>(nodes.position(i));
        return u;
      }

      /** A matrix with what the bonds need and the whole diagonal, empty. */
      Matrix matrix() const
      {
        const auto                               &owned = problem.handler.locally_owned_dofs();
        dealii::TrilinosWrappers::SparsityPattern pattern(owned, owned, MPI_COMM_WORLD, 100);
        bonds.add_pattern(problem.handler, pattern);
        for (const auto i : owned)
          pattern.add(i, i);
        pattern.compress();
        Matrix matrix;
        matrix.reinit(pattern);
        return matrix;
      }

      /** The sum over the bonds as the coupling tells them. */
      Vector sums(const Vector &u) const
      {
        Vector                         y = vector();
        std::vector<Coupling<2>::Bond> list;
        u.update_ghost_values();
        for (const unsigned int i : all)
          {
            bonds.coupling().bonds_of(i, list);
            for (const auto &bond : list)
              y.local_element(i) +=
                bond.weight * (u.local_element(i) - u.local_element(bond.neighbor));
          }
        u.set_ghost_state(false);
        return y;
      }

      Problem<2>                problem;
      Nodes<2>                  nodes;
      CrackSideFactors          factors;
      BondsBesideElements<2>    bonds;
      std::vector<unsigned int> all;
    };

    const Settings block{{"Coupling/Zone", "0.4 - max(abs(x - 0.8), abs(y - 0.6))"}};
  } // namespace


  TEST(BondsBesideElements, in_the_matrix)
  {
    const BondedSquare body(block);
    EXPECT_FALSE(body.bonds.apart());
    Matrix matrix = body.matrix();
    body.bonds.add_to(matrix);
    matrix.compress(dealii::VectorOperation::add);
    const Vector u = body.field(), expected = body.sums(u);
    Vector       y = body.vector();
    matrix.vmult(y, u);
    EXPECT_GT(expected.linfty_norm(), 0.1);
    EXPECT_LT(largest_difference(y, expected), 1e-13 * expected.linfty_norm());
    OperatorSize size;
    body.bonds.add_to(size);
    EXPECT_GT(size.bonds, 100u);
    EXPECT_EQ(size.bonds, body.problem.op().size().bonds);
    EXPECT_TRUE(size.form.empty());
  }


  TEST(BondsBesideElements, apart)
  {
    BondedSquare body(Settings{{"Coupling/Zone", "everywhere"}});
    ASSERT_TRUE(body.bonds.apart());
    MatrixTerm<2> cells(false, true);
    cells.matrix.copy_from(body.matrix());
    body.bonds.add_to(cells.matrix); // nothing
    // What cells leave: something on the diagonal of some rows, and round-off elsewhere.
    const auto left = [&](const unsigned int i) {
      return body.nodes.position(i)[0] < 0.45 ? 3. : 1e-16;
    };
    for (const unsigned int i : body.all)
      {
        const auto row = body.nodes.partitioner()->local_to_global(i);
        cells.matrix.add(row, row, left(i));
      }
    cells.matrix.compress(dealii::VectorOperation::add);
    body.bonds.make_form(body.problem.scene.peridynamics.form);
    cells.keep_rows(*body.nodes.partitioner());
    const Vector                   u        = body.field();
    Vector                         expected = body.sums(u), y = body.vector();
    std::vector<unsigned int>      finished(body.all.size(), 0);
    std::vector<Coupling<2>::Bond> list;
    for (const unsigned int i : body.all)
      {
        expected.local_element(i) += left(i) * u.local_element(i);
        body.bonds.coupling().bonds_of(i, list);
        double sum = 0.;
        for (const auto &bond : list)
          sum += bond.weight;
        EXPECT_NEAR(body.bonds.sum_of(i), sum, 1e-12 * sum);
      }
    const double      accuracy = 1e-12 * expected.linfty_norm();
    const Term<2>::At at{u, 0.};
    double            entering = 0.;
    body.bonds.begin(at, entering);
    EXPECT_EQ(entering, 0.);
    body.bonds.set_then(y, at, [&](const unsigned int begin, const unsigned int end) {
      cells.add(y, at, begin, end);
      for (unsigned int i = begin; i < end; ++i)
        {
          ++finished[i];
          EXPECT_NEAR(y.local_element(i), expected.local_element(i), accuracy);
        }
    });
    EXPECT_TRUE(
      std::all_of(finished.begin(), finished.end(), [](const unsigned int n) { return n == 1; }));
    OperatorSize size, of_cells;
    cells.add_to(of_cells);
    EXPECT_TRUE(of_cells.form.empty());
    const auto n_left = std::count_if(body.all.begin(), body.all.end(), [&](const unsigned int i) {
      return left(i) > 1.;
    });
    EXPECT_EQ(of_cells.nonzeros, sum_of_all(n_left));
    body.bonds.add_to(size);
    EXPECT_FALSE(size.form.empty());
    EXPECT_GT(size.bonds, 0u); // which a lattice does not store
    // Both say what their matrices have.
    Vector              diagonal = body.vector();
    std::vector<double> row_sums(body.all.size(), 0.);
    body.bonds.add_rows(diagonal, row_sums, body.all);
    for (const unsigned int i : body.all)
      EXPECT_EQ(row_sums[i], 2. * diagonal.local_element(i));
    cells.add_rows(diagonal, row_sums, body.all);
    for (const unsigned int i : body.all)
      {
        EXPECT_DOUBLE_EQ(diagonal.local_element(i), body.bonds.sum_of(i) + left(i));
        EXPECT_DOUBLE_EQ(row_sums[i], 2. * body.bonds.sum_of(i) + left(i));
      }
  }


  TEST(BondsBesideElements, changes_with_cracks)
  {
    const Settings growing{{"Cracks/Segments", "0.7,0.52 ; 0.7,0.52"},
                           {"Cracks/Growth", "1: 0.1, 0.2,0.1, 0.7"},
                           {"Time/End time", "1"}};
    BondedSquare   body(block + growing);
    Matrix         matrix = body.matrix();
    body.bonds.add_to(matrix);
    matrix.compress(dealii::VectorOperation::add);
    const auto   history = body.problem.scene.crack_history();
    RowSet       touched(body.vector());
    const auto   before = body.bonds.rows(body.all);
    ChangeSet<2> change;
    change.to        = history.representative(1.);
    const auto old   = body.bonds.change_bonds(change, body.all);
    const auto after = body.bonds.rows(body.all);
    EXPECT_EQ(old, before);
    body.bonds.add_changes(body.all, old, matrix, touched);
    matrix.compress(dealii::VectorOperation::add);
    unsigned int n = 0;
    for (const unsigned int i : body.all)
      {
        EXPECT_EQ(touched.contains(i), before[i] != after[i]);
        n += touched.contains(i) ? 1 : 0;
      }
    EXPECT_GT(sum_of_all(n), 4u);
    const Vector u = body.field(), expected = body.sums(u);
    Vector       y = body.vector();
    matrix.vmult(y, u);
    EXPECT_LT(largest_difference(y, expected), 1e-13 * expected.linfty_norm());
    // Bonds are marked where they are broken, and these have lost some of their trace.
    CrackSideFactors::Sums sums(body.vector());
    body.bonds.mark_broken(body.all, sums);
    body.bonds.add_traces(body.all, sums);
    for (const unsigned int i : body.all)
      {
        EXPECT_EQ(sums.marked.local_element(i) > 0., touched.contains(i));
        EXPECT_EQ(sums.trace.local_element(i) > 0., touched.contains(i));
      }
  }
} // namespace PeriDeal
