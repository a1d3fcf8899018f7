// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The parts of the peridynamic operator of diffusion, each by itself.

#include <algorithm>
#include <numeric>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    double sum_of_entries(const Vector &v)
    {
      return sum_of_all(std::accumulate(v.begin(), v.end(), 0.));
    }


    double sum_of_sides(const Balance &balance)
    {
      double sum = 0.;
      for (const auto &[name, heat] : balance.sides)
        sum += heat;
      return sum_of_all(sum);
    }


    /** The unit square, as peridynamic nodes with their bonds, and as a mesh of finite elements. */
    struct BondedPlate
    {
      explicit BondedPlate(const Settings &settings)
        : problem(Settings{{"Domain/Cells", "12, 10"}} + settings, ModelKind::finite_elements)
        , nodes(problem.handler,
                problem.scene.domain,
                problem.scene.cracks,
                problem.scene.peridynamics.sampling.nodal_volume)
        , families(nodes.find_parts(problem.scene.boundary_conditions), problem.scene)
        , bonds(families, problem.scene)
        , constraints(bonds, problem.scene)
        , all(nodes.n_owned())
      {
        std::iota(all.begin(), all.end(), 0);
      }

      /** With up-to-date ghosts. */
      template <typename Function>
      Vector field(const Function &f) const
      {
        Vector u(nodes.partitioner());
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          u.local_element(i) = f(nodes.position(i));
        u.update_ghost_values();
        return u;
      }

      /** W_ij of an owned node. */
      std::vector<DiffusionBonds<2>::Bond> bonds_of(const unsigned int node) const
      {
        std::vector<DiffusionBonds<2>::Bond> list;
        bonds.bonds_of(node, list);
        return list;
      }

      Problem<2>                problem;
      Nodes<2>                  nodes;
      Families<2>               families;
      DiffusionBonds<2>         bonds;
      NodeConstraints<2>        constraints;
      std::vector<unsigned int> all;
    };


  } // namespace


  TEST(DiffusionParts, rows_of_held_nodes)
  {
    const BondedPlate body(Settings{{"Peridynamics/Flux treatment", "extrapolation"},
                                    {"Boundary conditions/Dirichlet", "left: 1"},
                                    {"Boundary conditions/Flux", "right: 3"}});
    const auto        kind_at = [](const Point<2> &p) {
      return p[0] < 1e-9      ? NodeConstraints<2>::prescribed :
                    p[0] > 1. - 1e-9 ? NodeConstraints<2>::slave :
                                       NodeConstraints<2>::free;
    };
    const unsigned int n = body.nodes.n_owned(), half = n / 2;
    Vector             y   = body.field([](const Point<2> &p) { return 1. + p[1]; });
    double             sum = 0., expected = 0.;
    for (const unsigned int i : body.all)
      {
        EXPECT_EQ(body.constraints.kind(i), kind_at(body.nodes.position(i)));
        if (kind_at(body.nodes.position(i)) == NodeConstraints<2>::prescribed)
          expected += y.local_element(i);
      }
    for (const auto &[begin, end] : {std::make_pair(0u, half), std::make_pair(half, n)})
      sum += body.constraints.sum(y, begin, end);
    EXPECT_NEAR(sum, expected, 1e-13);
    EXPECT_NEAR(sum_of_all(sum), 11. * 1.5, 1e-12);
    body.constraints.mask(y, -7., 0, half);
    for (const unsigned int i : body.all)
      EXPECT_EQ(y.local_element(i),
                i < half && kind_at(body.nodes.position(i)) != NodeConstraints<2>::free ?
                  -7. :
                  1. + body.nodes.position(i)[1]);
  }


  TEST(DiffusionParts, slaves_follow_bonds_that_change)
  {
    // A crack that grows in front of the slaves of a side.
    BondedPlate body(Settings{{"Peridynamics/Flux treatment", "extrapolation"},
                              {"Boundary conditions/Flux", "right: 3 ; top: 2"},
                              {"Cracks/Segments", "0.79,0.05 ; 0.79,0.1"},
                              {"Cracks/Growth", "2: 0, 0,0.7"},
                              {"Time/End time", "1"}});
    Vector      before = body.field(bumpy<2>), still = before, after = before, fresh = before;
    body.constraints.distribute(before, 0.);
    const auto &history = body.problem.scene.crack_history();
    EXPECT_FALSE(history.change(body.bonds.cracks().now(), 1.)->cuts.empty());
    ChangeSet<2> change;
    change.to = history.representative(1.);
    body.bonds.cracks().apply_change(change);
    body.constraints.distribute(still, 0.);
    body.constraints.update(body.bonds, body.problem.scene);
    body.constraints.distribute(after, 0.);
    NodeConstraints<2>(body.bonds, body.problem.scene).distribute(fresh, 0.);
    EXPECT_EQ(largest_difference(still, before), 0.);
    EXPECT_GT(largest_difference(after, before), 1e-3);
    EXPECT_EQ(largest_difference(after, fresh), 0.);
  }


  TEST(DiffusionParts, loads_of_nodes)
  {
    const BondedPlate  body(Settings{{"Initial and source/Source", "2*x"},
                                    {"Boundary conditions/Dirichlet", "bottom: 1"},
                                    {"Boundary conditions/Flux", "top: 3*x"},
                                    {"Boundary conditions/Convection", "right: 2, 4 + y*t"}});
    const NodeLoads<2> loads(body.nodes, body.constraints, body.problem.scene);
    const unsigned int n = body.nodes.n_owned();
    EXPECT_TRUE(loads.depends_on_time());
    EXPECT_TRUE(loads.any());
    for (const double t : {0., 3.})
      {
        const Vector &f     = loads.at(t);
        const double  total = 1. + 1.5 + 2. * (4. + 0.5 * t);
        EXPECT_NEAR(sum_of_entries(f), total, 1e-12);
        EXPECT_NEAR(sum_of_all(loads.sum()), total, 1e-12);
        // At the bottom half a row has the source, and half a side of a cell convection.
        EXPECT_NEAR(sum_of_all(body.constraints.sum(f, 0, n)), 0.05 + 2. * 0.05 * 4., 1e-12);
      }
    const Vector      u = body.field([](const Point<2> &p) { return 1. + p[0] + p[1]; });
    Vector            y(body.nodes.partitioner()), diagonal = y;
    const SideTerm<2> sides(loads);
    EXPECT_NEAR(sum_of_all(loads.through_transfer(u)), -5., 1e-12);
    for (const auto &[begin, end] : {std::make_pair(0u, n / 3), std::make_pair(n / 3, n)})
      sides.add(y, {u, 3.}, begin, end);
    EXPECT_NEAR(sum_of_entries(y), 5., 1e-12);
    Vector whole(body.nodes.partitioner());
    sides.set_then(whole, {u, 3., true}, [&](const unsigned int begin, const unsigned int end) {
      EXPECT_EQ(begin, 0u);
      EXPECT_EQ(end, n);
    });
    EXPECT_EQ(largest_difference(whole, y), 0.);
    // Its matrix is diagonal.
    std::vector<double> sums(n, 0.);
    sides.add_rows(diagonal, sums, body.all);
    for (const unsigned int i : body.all)
      {
        EXPECT_DOUBLE_EQ(diagonal.local_element(i) * u.local_element(i), y.local_element(i));
        EXPECT_EQ(sums[i], 2. * diagonal.local_element(i));
      }
    Balance balance;
    loads.add_to(balance, u, 3.);
    EXPECT_NEAR(sum_of_all(balance.sources), 1., 1e-12);
    EXPECT_NEAR(sum_of_all(balance.sides["top"]), 1.5, 1e-12);
    EXPECT_NEAR(sum_of_all(balance.sides["right"]), 2. * 5.5 - 5., 1e-12);
  }


  TEST(DiffusionParts, loads_that_are_kept)
  {
    const BondedPlate  none(Settings{{"Boundary conditions/Dirichlet", "left: 1"}});
    const NodeLoads<2> nothing(none.nodes, none.constraints, none.problem.scene);
    EXPECT_FALSE(nothing.depends_on_time());
    EXPECT_FALSE(nothing.any());
    EXPECT_EQ(nothing.at(5.).linfty_norm(), 0.);
    const BondedPlate  body(Settings{{"Initial and source/Source", "2 + x"},
                                    {"Boundary conditions/Dirichlet", "left: 1"}});
    const NodeLoads<2> kept(body.nodes, body.constraints, body.problem.scene);
    const Vector       f = kept.at(5.);
    EXPECT_TRUE(kept.any());
    EXPECT_NEAR(sum_of_entries(f), 2.5, 1e-12);
    EXPECT_EQ(largest_difference(kept.at(7.), f), 0.);
    // Slaves follow their flux, and have no load.
    const BondedPlate  drawn(Settings{{"Peridynamics/Flux treatment", "extrapolation"},
                                     {"Initial and source/Source", "1"},
                                     {"Boundary conditions/Flux", "top: 3*t"}});
    const NodeLoads<2> loads(drawn.nodes, drawn.constraints, drawn.problem.scene);
    Balance            balance;
    loads.add_to(balance, drawn.field(bumpy<2>), 2.);
    EXPECT_NEAR(sum_of_all(loads.through_slaves(2.)), 6., 1e-12);
    EXPECT_NEAR(sum_of_all(balance.sides["top"]), 6., 1e-12);
    EXPECT_NEAR(sum_of_all(balance.sources), 0.95, 1e-12);
    EXPECT_NEAR(sum_of_entries(loads.at(2.)), 0.95, 1e-12);
    for (const unsigned int i : drawn.all)
      if (drawn.constraints.kind(i) == NodeConstraints<2>::slave)
        {
          EXPECT_EQ(loads.at(2.).local_element(i), 0.);
        }
  }


  TEST(DiffusionParts, flow_from_beyond_the_sides)
  {
    BondedPlate         body(Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                              {"Boundary conditions/Dirichlet", "left: 1 + t ; right: 3 + t"},
                              {"Boundary conditions/Symmetry", "bottom, top"},
                              {"Cracks/Segments", "0.04,0.3 ; 0.04,0.35"},
                              {"Cracks/Growth", "2: 0, 0,0.5"},
                              {"Time/End time", "1"}});
    const auto         &fictitious = body.bonds.neighbors().outside();
    ExtendedBondTerm<2> term(body.nodes, body.problem.scene);
    term.take_bonds();
    const Vector               u = body.field([](const Point<2> &p) { return 1.5 + 2. * p[0]; });
    const std::vector<double> &values = term.values({u, 0.5});
    // The sum over the bonds with fictitious nodes, as they are now.
    const auto expected = [&] {
      double sum = 0.;
      for (const unsigned int i : body.all)
        for (const auto &bond : body.bonds_of(i))
          if (bond.neighbor >= body.nodes.n_local())
            sum +=
              bond.weight * (values[bond.neighbor - body.nodes.n_local()] - u.local_element(i));
      return sum;
    };
    ASSERT_GT(sum_of_all(fictitious.size()), 100.);
    ASSERT_EQ(values.size(), fictitious.size());
    for (std::size_t f = 0; f < fictitious.size(); ++f)
      {
        // Mirrored about its own values a linear field is linear beyond its sides too.
        const Point<2> p = body.nodes.lattice()->position(fictitious[f].site);
        EXPECT_NEAR(values[f], 1.5 + 2. * p[0], 1e-12);
      }
    const auto flow = [&](const Vector &v) {
      double sum = 0.;
      term.begin({v, 0.5}, sum);
      return sum;
    };
    const double size   = body.problem.op().diagonal().linfty_norm();
    const double before = expected();
    EXPECT_NEAR(flow(u), before, 1e-12 * size);
    // With what is given beyond left out it is linear.
    double direction = 0.;
    term.begin({u, 0.5, true}, direction);
    EXPECT_GT(std::abs(sum_of_all(direction - before)), 1e-3);
    term.values({u, 0.5});
    Balance balance;
    term.add_flows(balance, {u, 0.5});
    EXPECT_NEAR(sum_of_sides(balance), sum_of_all(before), 1e-12 * size);
    EXPECT_LT(sum_of_all(balance.sides["left"]), -0.1);
    EXPECT_GT(sum_of_all(balance.sides["right"]), 0.1);
    EXPECT_NEAR(sum_of_all(balance.sides["top"]), 0., 1e-12 * size);

    // Its sums are those of the bonds when they were last told to have changed.
    const auto history = body.problem.scene.crack_history();
    const auto change  = history.change(body.bonds.cracks().now(), 1.);
    ASSERT_TRUE(change);
    body.bonds.cracks().apply_change(*change);
    const Vector              w      = body.field(bumpy<2>);
    const std::vector<double> of_w   = term.values({w, 0.5});
    double                    direct = 0.;
    const double              kept   = flow(w);
    const Mended              mended = term.apply_change(*change);
    EXPECT_FALSE(mended.stiffer); // bonds are cut
    EXPECT_GT(sum_of_all(mended.rows.size()), 4u);
    EXPECT_TRUE(std::is_sorted(mended.rows.begin(), mended.rows.end()));
    const double now = flow(w);
    for (const unsigned int i : body.all)
      for (const auto &bond : body.bonds_of(i))
        if (bond.neighbor >= body.nodes.n_local())
          direct += bond.weight * (of_w[bond.neighbor - body.nodes.n_local()] - w.local_element(i));
    EXPECT_NEAR(now, direct, 1e-12 * size);
    EXPECT_GT(sum_of_all(std::abs(now - kept)), 1e-6 * size);

    const std::vector<double> &homogeneous = term.values({w, 0.5, true});
    for (std::size_t f = 0; f < fictitious.size(); ++f)
      EXPECT_NEAR(homogeneous[f], of_w[f] - fictitious[f].constant(0.5), 1e-12);
  }


  TEST(DiffusionParts, factors_of_surface_correction)
  {
    const Settings crack{{"Cracks/Segments", "0.3,0.44 ; 0.7,0.57"}};
    BondedPlate    plain(crack);
    EXPECT_FALSE(HeatSurfaceFactors<2>(plain.bonds, plain.problem.scene.peridynamics).any());
    for (const bool energy : {true, false})
      {
        BondedPlate           body(crack + Settings{{"Peridynamics/Surface correction",
                                           energy ? "energy" : "crack scaling"}});
        HeatSurfaceFactors<2> factors(body.bonds, body.problem.scene.peridynamics);
        ASSERT_TRUE(factors.any());
        // The factors by their definition; along a bond between neighbours in x the mean of both.
        Vector                                            g(body.nodes.partitioner());
        std::vector<std::vector<DiffusionBonds<2>::Bond>> without;
        for (const unsigned int i : body.all)
          {
            Tensor<1, 2> moments;
            bool         cut = false;
            without.push_back(body.bonds_of(i));
            for (const auto &bond : without.back())
              {
                const auto xi = body.bonds.neighbors().bond_vector(i, bond.neighbor);
                for (unsigned int d = 0; d < 2; ++d)
                  moments[d] += bond.weight * xi[d] * xi[d];
                cut = cut || bond.cut;
              }
            const double full = 2. * body.nodes.volume(i), both = 0.5 * (moments[0] + moments[1]);
            g.local_element(i) = energy ? full / moments[0] :
                                 cut    ? std::max(0.5, std::min(4., full / both)) :
                                          1.;
          }
        g.update_ghost_values();
        const auto   nodes    = factors.nodes();
        const double n_scaled = sum_of_all(nodes.size());
        EXPECT_EQ(n_scaled == body.nodes.n_global(), energy);
        EXPECT_GT(n_scaled, 10.);
        factors.find(nodes);
        double effect = 0.;
        for (const unsigned int i : body.all)
          {
            const auto with = body.bonds_of(i);
            ASSERT_EQ(with.size(), without[i].size());
            for (std::size_t k = 0; k < with.size(); ++k)
              {
                const auto xi = body.bonds.neighbors().bond_vector(i, with[k].neighbor);
                if (energy && std::abs(xi[1]) > 1e-9)
                  continue;
                const double factor =
                  0.5 * (g.local_element(i) + g.local_element(with[k].neighbor));
                EXPECT_NEAR(with[k].weight, factor * without[i][k].weight, 1e-12 * with[k].intact);
                effect = std::max(effect, std::abs(factor - 1.));
              }
          }
        EXPECT_GT(max_of_all(effect), 0.05);
        // Others keep theirs.
        const auto before = body.bonds_of(0);
        factors.find({});
        const auto after = body.bonds_of(0);
        for (std::size_t k = 0; k < before.size(); ++k)
          EXPECT_EQ(after[k].weight, before[k].weight);
      }
  }
} // namespace PeriDeal
