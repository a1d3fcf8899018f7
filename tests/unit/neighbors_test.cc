// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Who is within the reach of whom, against a plain search of all nodes.

#include <perideal/bonds/diffusion_bonds.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "operator_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;
  using dealii::Tensor;

  const Settings box{{"Domain/Lower corner", "0, 0"},
                     {"Domain/Upper corner", "1, 0.75"},
                     {"Domain/Cells", "16, 12"},
                     {"Boundary conditions/Dirichlet", "left: 1"}};


  /** Bodies whose nodes are found by a table of sites, and those found by a tree. */
  std::map<std::string, Settings> bodies()
  {
    return {{"vertices", box},
            {"cell centres", box + Settings{{"Domain/Nodes", "cell centers"}}},
            {"oblong cells", box + Settings{{"Domain/Cells", "16, 8"}}},
            {"hole",
             Settings{{"Domain/Shape", "plate with hole"},
                      {"Domain/Lower corner", "-1, -1"},
                      {"Domain/Upper corner", "1, 1"},
                      {"Domain/Cells", "16, 16"},
                      {"Domain/Hole radius", "0.3"},
                      {"Boundary conditions/Dirichlet", "left: 1"}}},
            {"doubled nodes",
             box + Settings{{"Cracks/Mesh", "faces"},
                            {"Peridynamics/Boundary treatment", "none"},
                            {"Cracks/Segments", "0.25,0.375 ; 0.75,0.375"}}}};
  }


  /** Neighbours of a node with their weights, by looking at every node that is known here. */
  template <int dim>
  std::map<unsigned int, double> plain_family(const Neighbors<dim> &neighbors,
                                              const unsigned int    node)
  {
    const Nodes<dim>              &nodes   = neighbors.nodes();
    const KernelWeights<dim>      &weights = neighbors.weights();
    std::map<unsigned int, double> family;
    const double                   tiny = 1e-9 * nodes.smallest_spacing();
    for (unsigned int j = 0; j < nodes.n_local() + neighbors.outside().size(); ++j)
      {
        const Tensor<1, dim> xi = neighbors.position(j) - neighbors.position(node);
        if (xi.norm() < tiny && neighbors.is_real(j))
          continue;
        for (const FamilyMember<dim> &member : weights.members())
          if (weights.is_offset(xi, member))
            family[j] = member.weight;
      }
    return family;
  }


  /** That no two bonds of a family are out of the order of their relative positions. */
  template <int dim>
  bool comes_before(const Tensor<1, dim> &a, const Tensor<1, dim> &b, const double tiny)
  {
    for (unsigned int d = dim; d-- > 0;)
      if (std::abs(a[d] - b[d]) > tiny)
        return a[d] < b[d];
    return true;
  }
} // namespace


TEST(Neighbors, are_those_of_a_plain_search)
{
  for (const auto &[name, settings] : bodies())
    for (const std::string m : {"2", "3", "4.5"})
      {
        const Problem<2>         problem(settings + Settings{{"Peridynamics/Horizon ratio", m}});
        const DiffusionBonds<2> &families  = bonds_of(problem.op()).diffusion_bonds();
        const Neighbors<2>      &neighbors = families.neighbors();
        EXPECT_EQ(neighbors.has_unique_sites(), name != "doubled nodes");
        const double                         tiny = 1e-9 * problem.nodes->smallest_spacing();
        std::vector<DiffusionBonds<2>::Bond> bonds;
        for (unsigned int i = 0; i < problem.nodes->n_owned(); ++i)
          {
            const auto   expected = plain_family(neighbors, i);
            auto         missing  = expected;
            Tensor<1, 2> last     = -1e10 * Point<2>(1., 1.);
            unsigned int n        = 0;
            families.bonds_of(i, bonds);
            neighbors.for_each(i, [&](const unsigned int j, const double w) {
              ASSERT_EQ(missing.erase(j), 1u) << name;
              EXPECT_EQ(w, expected.at(j)) << name;
              const Tensor<1, 2> xi = neighbors.bond_vector(i, j);
              EXPECT_TRUE(comes_before(last, xi, tiny)) << name;
              last = xi;
              ASSERT_LT(n, bonds.size());
              EXPECT_EQ(bonds[n].neighbor, j);
              EXPECT_NEAR(bonds[n++].intact / (neighbors.volume(i) * neighbors.volume(j) * w *
                                               families.conductivities().of_bond(i, j)),
                          1.,
                          1e-14);
            });
            EXPECT_TRUE(missing.empty()) << name << ", m = " << m;
            EXPECT_EQ(n, bonds.size());
          }
      }
}


TEST(Neighbors, near_boxes_are_those_of_a_plain_search)
{
  std::vector<dealii::BoundingBox<2>> boxes;
  boxes.emplace_back(std::make_pair(Point<2>(0.1, 0.2), Point<2>(0.3, 0.22)));
  boxes.emplace_back(std::make_pair(Point<2>(0.28, 0.2), Point<2>(0.28, 0.7)));
  for (const auto &[name, settings] : bodies())
    {
      const Problem<2>    problem(settings);
      const Neighbors<2> &neighbors = bonds_of(problem.op()).diffusion_bonds().neighbors();
      for (const double distance : {0., 0.05, 0.2})
        {
          std::vector<unsigned int> expected;
          for (unsigned int i = 0; i < problem.nodes->n_owned(); ++i)
            if (std::any_of(boxes.begin(), boxes.end(), [&](dealii::BoundingBox<2> box) {
                  box.extend(distance * (1. + 1e-6));
                  return box.point_inside(problem.nodes->position(i));
                }))
              expected.push_back(i);
          // On a lattice some more, up to a site farther.
          const auto found = neighbors.nodes_near(boxes, distance);
          EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()))
            << name;
          for (const unsigned int i : found)
            EXPECT_TRUE(std::any_of(boxes.begin(),
                                    boxes.end(),
                                    [&](dealii::BoundingBox<2> box) {
                                      box.extend(distance +
                                                 2.1 * problem.nodes->smallest_spacing());
                                      return box.point_inside(problem.nodes->position(i));
                                    }))
              << name;
        }
    }
}


TEST(Neighbors, outside_come_after_the_nodes)
{
  const Problem<2>    problem(box +
                           Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"}});
  const Neighbors<2> &neighbors = bonds_of(problem.op()).diffusion_bonds().neighbors();
  const unsigned int  n_local   = problem.nodes->n_local();
  ASSERT_GT(sum_of_all(neighbors.outside().size()), 0u);
  for (unsigned int f = 0; f < neighbors.outside().size(); ++f)
    {
      const FictitiousNode<2> &node = neighbors.outside()[f];
      EXPECT_FALSE(neighbors.is_real(n_local + f));
      EXPECT_EQ(neighbors.real(n_local + f), node.mirror);
      EXPECT_EQ(neighbors.volume(n_local + f), node.volume);
      EXPECT_LT(
        neighbors.position(n_local + f).distance(problem.nodes->lattice()->position(node.site)),
        1e-12);
    }
  // Some of them are in families, of volume and place as told.
  unsigned int n_bonds = 0;
  for (unsigned int i = 0; i < problem.nodes->n_owned(); ++i)
    neighbors.for_each(i, [&](const unsigned int j, const double) { n_bonds += j >= n_local; });
  EXPECT_GT(sum_of_all(n_bonds), 0u);
}
