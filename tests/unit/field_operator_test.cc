// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What operators of diffusion have alike, with parts that are nothing else.

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    constexpr unsigned int n_own = 5;


    DiffusionOperator::Layout layout_of_five()
    {
      const auto       first = n_own * this_process();
      dealii::IndexSet owned(n_own * n_processes());
      owned.add_range(first, first + n_own);
      return std::make_shared<const dealii::Utilities::MPI::Partitioner>(owned, MPI_COMM_WORLD);
    }


    struct PlainCapacity : Capacity
    {
      explicit PlainCapacity(const DiffusionOperator::Layout &layout)
      {
        diagonal.reinit(layout);
        diagonal = 2.;
      }

      void heat_between(Vector &y, const Vector &u, const Vector &v) const override
      {
        y.equ(2., v);
        y.add(-2., u);
      }

      double content(const Vector &) const override
      {
        return 7.;
      }
    };


    /** The first unknown of each process is held. */
    struct PlainValues : PrescribedValues<2>
    {
      PlainValues()
      {
        set_held({0}, {});
      }
    };


    struct PlainLoads : DiffusionLoads<2>
    {
      using DiffusionLoads<2>::DiffusionLoads;

      void add_to(Balance &balance, const Vector &, const double) const override
      {
        balance.sources += 5.;
      }

      void assemble(const double t) const override
      {
        loads = t;
      }
    };


    /** K = k I. */
    struct PlainTerm : Term<2>
    {
      explicit PlainTerm(const double k)
        : k(k)
      {}

      void add(Vector            &y,
               const At          &at,
               const unsigned int begin,
               const unsigned int end) const override
      {
        for (unsigned int i = begin; i < end; ++i)
          y.local_element(i) += k * at.u.local_element(i);
      }

      void add_rows(Vector &diagonal, std::vector<double> &sums, const Rows &rows) const override
      {
        for (unsigned int r = 0; r < rows.size(); ++r)
          {
            diagonal.local_element(rows[r]) += k;
            sums[r] += k;
          }
      }

      Mended apply_change(const ChangeSet<2> &change) override
      {
        moves.emplace_back(change.from, change.to);
        k += 1.;
        Mended mended;
        mended.rows    = {1, 2};
        mended.stiffer = true;
        return mended;
      }

      void require_held(const RowsOfK &of_all) const override
      {
        n_rows.push_back(of_all.rows.size());
      }

      void add_flows(Balance &balance, const At &) const override
      {
        balance.sides["left"] += 3.;
        balance.cracks[0] += 11.;
      }

      void add_to(OperatorSize &size) const override
      {
        size.bonds += 1;
      }

      double                                 k;
      std::vector<std::pair<double, double>> moves;
      mutable std::vector<std::size_t>       n_rows;
    };
  } // namespace


  TEST(FieldOperator, flows_and_cracks)
  {
    const Problem<2> problem({{"Domain/Cells", "4, 4"},
                              {"Boundary conditions/Dirichlet", "left: 1 ; right: 2"},
                              {"Cracks/Segments", "0.2,0.4 ; 0.4,0.4"},
                              {"Cracks/Growth", "2: 0.1, 0.4,0"},
                              {"Cracks/Transmission", "0.5"},
                              {"Initial and source/Source", "t"},
                              {"Time/End time", "1"}},
                             ModelKind::finite_elements);
    const auto    first = std::make_shared<PlainTerm>(3.), second = std::make_shared<PlainTerm>(1.);
    FieldParts<2> parts(problem.scene);
    parts.layout         = layout_of_five();
    parts.capacity       = std::make_shared<PlainCapacity>(parts.layout);
    parts.values         = std::make_shared<PlainValues>();
    parts.loads          = std::make_shared<PlainLoads>(parts.layout,
                                               problem.scene.boundary_conditions,
                                               problem.scene.initial_and_source.source);
    parts.terms          = {first, second};
    parts.for_each_place = [](const FieldParts<2>::Visit &visit) {
      for (unsigned int i = 0; i < n_own; ++i)
        visit(i, {0.25, 1. * i});
    };
    FieldOperator<2> op(problem.scene, parts);
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
    EXPECT_EQ(op.diagonal().local_element(0), 1.); // held
    EXPECT_EQ(op.spectrum().safe, 2.);
    EXPECT_EQ(op.noise().local_element(1), position_noise(Point<2>(0.25, 1.)));
    EXPECT_EQ(op.place_of(3), "(0.25, 3)");
    EXPECT_EQ(op.size().unknowns, u.size());
    EXPECT_EQ(op.size().bonds, 2u);
    EXPECT_EQ(&op.first_term(), first.get());

    // Flows of all processes; what is prescribed stores nothing.
    const unsigned int n       = n_processes();
    const Balance      balance = op.balance(u, 0., false);
    EXPECT_EQ(balance.sides.size(), 2u);
    EXPECT_EQ(balance.sides.at("left"), 6. * n); // of two terms
    EXPECT_EQ(balance.sides.at("right"), 0.);
    EXPECT_EQ(balance.sources, 5. * n);
    EXPECT_EQ(balance.content, 7. * n);
    EXPECT_EQ(balance.cracks, std::vector<double>{22. * n});
    EXPECT_EQ(balance.stored, -12. * 4. * n);
    EXPECT_EQ(op.balance(u, 0., true).stored, 0.);

    // Cracks move when the span between events is another one: terms mend their rows.
    const auto history = problem.scene.crack_history();
    EXPECT_EQ(op.next_event(0.), history.next_event(0.));
    EXPECT_FALSE(op.update(0.));
    EXPECT_TRUE(first->moves.empty());
    EXPECT_TRUE(op.update(0.9));
    EXPECT_FALSE(op.update(0.9));
    EXPECT_EQ(op.diagonal().local_element(1), 6.);
    EXPECT_EQ(op.diagonal().local_element(3), 4.); // nobody has named it
    EXPECT_EQ(op.spectrum().safe, 3.);
    EXPECT_TRUE(op.update(0.));
    const double start = history.representative(0.), last = history.representative(0.9);
    const std::vector<std::pair<double, double>> moves{{start, last}, {last, start}};
    EXPECT_EQ(first->moves, moves);
    EXPECT_EQ(second->moves, moves);
    EXPECT_EQ(first->n_rows, (std::vector<std::size_t>{n_own, 2, 2}));
  }
} // namespace PeriDeal
