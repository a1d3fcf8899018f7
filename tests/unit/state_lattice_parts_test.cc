// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The parts of the lattice of elastic bonds, each by itself.

#include "../../source/operators/lattice/edge_nodes.h"
#include "../../source/operators/lattice/lattice_stretches.h"
#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  constexpr double stiff = 2., soft = 0.5;

  /** A box of nodes in cells, soft where x > @p soft_from, not all of which are computed. */
  template <int dim>
  struct Parts
  {
    explicit Parts(const double soft_from, const Settings &settings = {})
      : body(box<dim>() + Settings{{"Domain/Nodes", "cell centers"}} + settings,
             ModelKind::peridynamics)
      , families(body.states->bonds().families)
      , nodes(families.nodes())
      , computed(nodes.n_owned())
      , coefficients{stiff, 1., std::vector<double>(nodes.n_local(), 0.), {}}
      , complete(families, coefficients)
    {
      for (unsigned int i = 0; i < nodes.n_local(); ++i)
        {
          if (i < nodes.n_owned())
            computed[i] = i % 11 != 3;
          if (nodes.position(i)[0] > soft_from)
            coefficients.excesses[i] = 0.5 * (soft / stiff - 1.);
        }
    }

    typename Lattice<dim>::Index site(const unsigned int i) const
    {
      return nodes.lattice()->index(nodes.position(i));
    }

    const Body<dim>       body;
    const Families<dim>  &families;
    const Nodes<dim>     &nodes;
    std::vector<bool>     computed;
    LatticeCoefficients   coefficients;
    CompleteFamilies<dim> complete;
  };
} // namespace


TEST(StateLatticeParts, edge_nodes_are_those_whose_families_end_or_are_mixed)
{
  constexpr double   everywhere_stiff = 2.;
  const Parts<2>     parts(everywhere_stiff), mixed(0.6);
  const EdgeNodes<2> edges(parts.families, parts.complete, parts.coefficients, parts.computed),
    of_mixed(mixed.families, mixed.complete, mixed.coefficients, mixed.computed);
  const auto  &reach   = parts.complete.moments[0].halo();
  const auto  &lattice = *parts.nodes.lattice();
  unsigned int n_edges = 0;
  for (unsigned int i = 0; i < parts.nodes.n_owned(); ++i)
    {
      bool ends = false;
      for (unsigned int d = 0; d < 2; ++d)
        ends = ends || parts.site(i)[d] < reach[d] ||
               parts.site(i)[d] >= lattice.n_sites[d] - reach[d];
      const double beyond = std::abs(mixed.nodes.position(i)[0] - 0.6);
      if (!parts.computed[i])
        continue;
      EXPECT_EQ(edges.number_of[i] != edges.none, ends) << parts.nodes.position(i);
      EXPECT_EQ(of_mixed.number_of[i] != of_mixed.none,
                ends || mixed.nodes.position(i)[0] > 0.6 || beyond < reach[0] * lattice.spacing[0])
        << parts.nodes.position(i);
      if (of_mixed.number_of[i] != of_mixed.none)
        EXPECT_EQ(of_mixed.list[of_mixed.number_of[i]].excess,
                  mixed.nodes.position(i)[0] > 0.6 ? 0.5 * (soft / stiff - 1.) : 0.);
      n_edges += ends;
    }
  EXPECT_EQ(edges.list.size(), n_edges);
  // Along sides all nodes have the moment of one.
  const double n_moments = (2. * reach[0] + 1.) * (2. * reach[1] + 1.);
  EXPECT_LE(edges.memory_consumption(),
            4. * edges.number_of.size() + (sizeof(edges.list[0]) + 4.) * edges.list.size() +
              sizeof(dealii::Tensor<1, 2>) * n_moments);
}


TEST(StateLatticeParts, moments_of_all_nodes_have_no_sum)
{
  Parts<2> parts(2.);
  parts.computed.assign(parts.computed.size(), true);
  const EdgeNodes<2>   edges(parts.families, parts.complete, parts.coefficients, parts.computed);
  dealii::Tensor<1, 2> sum;
  double               size = 0.;
  for (unsigned int i = 0; i < parts.nodes.n_owned(); ++i)
    if (edges.number_of[i] != edges.none)
      {
        const dealii::Tensor<1, 2> &moment = edges.moment(edges.number_of[i]);
        sum += parts.nodes.volume(i) * moment;
        size += parts.nodes.volume(i) * moment.norm();
      }
  EXPECT_LT(sum_of_all(sum).norm(), 1e-12 * sum_of_all(size));
}


template <int dim>
void expect_stretches(const Settings &settings)
{
  const Parts<dim>     parts(0.6, settings);
  const EdgeNodes<dim> edges(parts.families, parts.complete, parts.coefficients, parts.computed);
  const StencilKernel &kernel = parts.complete.moments[0];
  const LatticeLayout<dim>    layout(parts.families, kernel.halo(), parts.computed);
  const LatticeStretches<dim> stretches(layout, edges.number_of);
  std::vector<double>         padded(layout.n_slots(), 0.), sums(stretches.n_sums), apart(sums);
  for (unsigned int i = 0; i < parts.nodes.n_local(); ++i)
    if (layout.in_grid(parts.site(i)))
      padded[layout.slot(parts.site(i))] = std::sin(7. * parts.nodes.position(i).norm_square());
  const StencilKernel::Term term{&kernel, layout.grid(padded.data())};
  std::vector<unsigned int> times(parts.nodes.n_owned(), 0);
  std::size_t               s = 0, cluster = 0;
  for (std::size_t group = 0; group < stretches.groups.size(); ++group)
    {
      stretches.apply(&term, 1, group, sums.data());
      for (; cluster < stretches.groups[group].clusters; ++cluster)
        stretches.apply_to_cluster(&term, 1, cluster, apart.data());
      for (; s < stretches.groups[group].stretches; ++s)
        for (std::uint32_t k = 0; k < stretches.list[s].n; ++k)
          {
            const auto        &stretch = stretches.list[s];
            const unsigned int i       = stretch.node + k;
            const bool         edge    = stretch.edge != stretches.none;
            ++times[i];
            EXPECT_EQ(edges.number_of[i], edge ? stretch.edge + k : stretches.none);
            double sum = 0., size = 0.;
            for (const auto &member : parts.families.weights().members())
              {
                const unsigned int j =
                  parts.families.neighbors().node_at(parts.site(i) + member.offset);
                if (j == dealii::numbers::invalid_unsigned_int)
                  continue;
                const double of_one = member.weight * member.offset[0] *
                                      parts.nodes.lattice()->spacing[0] *
                                      padded[layout.slot(parts.site(j))];
                sum += of_one;
                size += std::abs(of_one);
              }
            EXPECT_NEAR(sums[stretch.at + k], sum, 1e-13 * size);
            if (!edge)
              continue;
            EXPECT_EQ(apart[stretch.at + k], sums[stretch.at + k]);
          }
    }
  for (unsigned int i = 0; i < times.size(); ++i)
    EXPECT_EQ(times[i], parts.computed[i] ? 1u : 0u);
}


TEST(StateLatticeParts, stretches_and_clusters_have_the_sums_of_all_nodes)
{
  expect_stretches<1>({});
  expect_stretches<2>({});
  expect_stretches<2>({{"Domain/Cells", "40, 30"},
                       {"Domain/Shape", "plate with hole"},
                       {"Domain/Hole center", "0.5, 0.4"},
                       {"Domain/Hole radius", "0.13"}});
  expect_stretches<3>({});
}
