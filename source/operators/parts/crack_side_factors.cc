// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/parts/crack_side_factors.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  double crack_side_factor(const bool           beside_crack,
                           const double         expected,
                           const double         trace,
                           const CrossingShare &crossing)
  {
    const double beside = trace - crossing.kept; // what the factor multiplies
    if (!beside_crack || !(beside > 0.))
      return 1.;
    const double g         = std::clamp((expected - crossing.kept) / beside, 0.5, 4.);
    const double held_back = crossing.whole > 0. ? 1. - crossing.kept / crossing.whole : 1.;
    return 1. + held_back * held_back * (g - 1.);
  }


  CrackSideFactors::Sums::Sums(const Vector &layout)
    : marked(layout.get_partitioner())
    , trace(layout.get_partitioner())
    , expected(layout.get_partitioner())
    , crossing(layout.get_partitioner())
    , crossing_whole(layout.get_partitioner())
  {}


  void CrackSideFactors::Sums::mark(const std::vector<types::global_dof_index> &of_cell)
  {
    for (const auto i : of_cell)
      marked(i) = 1.;
  }


  bool CrackSideFactors::Sums::any_marked(const std::vector<types::global_dof_index> &of_cell) const
  {
    return std::any_of(of_cell.begin(), of_cell.end(), [&](const auto i) {
      return marked(i) > 0.;
    });
  }


  void CrackSideFactors::Sums::add_crossing(const types::global_dof_index a,
                                            const types::global_dof_index b,
                                            const double                  distance_square,
                                            const CrossingShare          &conductance)
  {
    for (const auto i : {a, b})
      {
        crossing(i) += 0.5 * conductance.kept * distance_square;
        crossing_whole(i) += 0.5 * conductance.whole * distance_square;
      }
  }


  void CrackSideFactors::Sums::compress()
  {
    for (Vector *v : {&trace, &expected, &crossing, &crossing_whole})
      v->compress(VectorOperation::add);
  }


  void CrackSideFactors::Sums::leave_out_uncrossed(const std::vector<unsigned int> &nodes)
  {
    for (const unsigned int i : nodes)
      if (!(crossing_whole.local_element(i) > 0.))
        marked.local_element(i) = 0.;
  }


  void CrackSideFactors::Sums::clear(const std::vector<unsigned int> &nodes)
  {
    for (Vector *v : {&marked, &trace, &expected, &crossing, &crossing_whole})
      {
        v->zero_out_ghost_values();
        for (const unsigned int i : nodes)
          v->local_element(i) = 0.;
      }
  }


  void CrackSideFactors::start(const Vector &layout)
  {
    factors.reinit(layout.get_partitioner());
    for (unsigned int i = 0; i < factors.locally_owned_size(); ++i)
      factors.local_element(i) = 1.;
    factors.update_ghost_values();
  }


  void CrackSideFactors::find(const std::vector<unsigned int> &nodes, const Sums &sums)
  {
    for (const unsigned int i : nodes)
      factors.local_element(i) =
        crack_side_factor(sums.marked.local_element(i) > 0.,
                          sums.expected.local_element(i),
                          sums.trace.local_element(i),
                          {sums.crossing.local_element(i), sums.crossing_whole.local_element(i)});
    factors.update_ghost_values();
  }


  double CrackSideFactors::at(const unsigned int node) const
  {
    return factors.local_element(node);
  }


  double CrackSideFactors::of_cell(const std::vector<types::global_dof_index> &nodes) const
  {
    if (empty())
      return 1.;
    double mean = 0.;
    for (const auto i : nodes)
      mean += factors(i) / nodes.size();
    return mean;
  }
} // namespace PeriDeal
