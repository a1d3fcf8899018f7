// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/bonds/broken_bonds.h>

#include <algorithm>

namespace PeriDeal
{
  BrokenBonds::BrokenBonds(const double transmission)
    : transmission(transmission)
  {}


  void BrokenBonds::add(const std::vector<NodePair> &more)
  {
    const std::size_t n = pairs.size();
    pairs.insert(pairs.end(), more.begin(), more.end());
    std::inplace_merge(pairs.begin(), pairs.begin() + n, pairs.end());
    for (const NodePair &pair : more)
      nodes.insert(nodes.end(), pair.begin(), pair.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }


  bool BrokenBonds::touch(const dealii::types::global_dof_index node) const
  {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  }


  double BrokenBonds::kept_fraction(const dealii::types::global_dof_index a,
                                    const dealii::types::global_dof_index b) const
  {
    if (pairs.empty())
      return 1.;
    const NodePair pair{std::min(a, b), std::max(a, b)};
    return std::binary_search(pairs.begin(), pairs.end(), pair) ? transmission : 1.;
  }
} // namespace PeriDeal
