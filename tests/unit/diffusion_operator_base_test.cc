// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What operators of diffusion have alike, by one that is nothing else.

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    /** A body of one unknown of capacity 2 for each of five points of a process, and K = 4 I. */
    class PlainOperator : public DiffusionOperatorBase<2>
    {
    public:
      explicit PlainOperator(const Scene<2> &scene)
        : DiffusionOperatorBase<2>(scene, 0., nullptr, [](Vector &noise) { noise = 0.5; })
      {
        const unsigned int n     = 5;
        const auto         first = n * this_process();
        dealii::IndexSet   owned(n * n_processes());
        owned.add_range(first, first + n);
        set_layout(
          std::make_shared<const dealii::Utilities::MPI::Partitioner>(owned, MPI_COMM_WORLD));
        capacity           = 2.;
        stiffness_diagonal = 4.;
      }

      void apply_then(Vector &y, const Vector &x, const RowsAction &finish) const override
      {
        y.equ(4., x);
        finish(0, 5);
      }

      void residual_then(Vector           &r,
                         const Vector     &u,
                         const double      t,
                         const RowsAction &finish) const override
      {
        r = t;
        r.add(-4., u);
        finish(0, 5);
      }

      void distribute(Vector &, const double) const override {}
      void distribute_homogeneous(Vector &) const override {}
      void clear_constrained(Vector &y) const override
      {
        y.local_element(0) = 0.;
      }

      bool symmetric() const override
      {
        return true;
      }

      bool depends_on_time() const override
      {
        return true;
      }

      bool has_steady_state() const override
      {
        return true;
      }

      bool surrogate_is_exact() const override
      {
        return false;
      }

      void surrogate(dealii::TrilinosWrappers::SparseMatrix &) const override {}

      std::vector<std::pair<double, double>> moves;

    protected:
      bool apply_change(const ChangeSet<2> &change) override
      {
        moves.emplace_back(change.from, change.to);
        return change.to > 0.5;
      }

      void find_flows(Balance &balance, Vector &heat, const Vector &u, const double) const override
      {
        heat.equ(4., u);
        balance.sides["left"] += 3.;
        balance.sources += 5.;
        balance.content += 7.;
        balance.cracks[0] += 11.;
      }

      Point<2> position(const unsigned int local_index) const override
      {
        return {0.25, 1. * local_index};
      }
    };
  } // namespace


  TEST(DiffusionOperatorBase, flows_and_cracks)
  {
    const Problem<2> problem({{"Domain/Cells", "4, 4"},
                              {"Boundary conditions/Dirichlet", "left: 1 ; right: 2"},
                              {"Cracks/Segments", "0.2,0.4 ; 0.4,0.4"},
                              {"Cracks/Growth", "2: 0.1, 0.4,0"},
                              {"Cracks/Transmission", "0.5"},
                              {"Time/End time", "1"}},
                             ModelKind::finite_elements);
    PlainOperator    op(problem.scene);
    Vector           u, y;
    op.initialize_vector(u);
    op.initialize_vector(y);
    ASSERT_EQ(u.size(), 5 * n_processes());
    u = 3.;
    op.apply(y, u);
    EXPECT_EQ(y.local_element(4), 12.);
    op.residual(y, u, 20.);
    EXPECT_EQ(y.local_element(4), 8.);
    op.apply_capacity(y, u);
    EXPECT_EQ(y.local_element(4), 6.);
    EXPECT_EQ(op.diagonal().local_element(1), 4.);
    EXPECT_EQ(op.noise().local_element(1), 0.5);
    EXPECT_EQ(op.place_of(3), "(0.25, 3)");
    EXPECT_EQ(op.size().unknowns, u.size());

    // Flows of all processes; what is prescribed stores nothing.
    const unsigned int n       = n_processes();
    const Balance      balance = op.balance(u, 0., false);
    EXPECT_EQ(balance.sides.size(), 2u);
    EXPECT_EQ(balance.sides.at("left"), 3. * n);
    EXPECT_EQ(balance.sides.at("right"), 0.);
    EXPECT_EQ(balance.sources, 5. * n);
    EXPECT_EQ(balance.content, 7. * n);
    EXPECT_EQ(balance.cracks, std::vector<double>{11. * n});
    EXPECT_EQ(balance.stored, -12. * 4. * n);
    EXPECT_EQ(op.balance(u, 0., true).stored, 0.);

    // Cracks move when the span between events is another one.
    const auto history = problem.scene.crack_history();
    EXPECT_EQ(op.next_event(0.), history.next_event(0.));
    EXPECT_FALSE(op.update(0.));
    EXPECT_TRUE(op.moves.empty());
    EXPECT_TRUE(op.update(0.9));
    EXPECT_FALSE(op.update(0.9));
    EXPECT_FALSE(op.update(0.));
    const double first = history.representative(0.), last = history.representative(0.9);
    EXPECT_EQ(op.moves, (std::vector<std::pair<double, double>>{{first, last}, {last, first}}));
  }
} // namespace PeriDeal
