// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/interleaved.h>

namespace PeriDeal
{
  using namespace dealii;

  IndexSet interleaved(const IndexSet &nodes, const unsigned int n_components)
  {
    IndexSet unknowns(n_components * nodes.size());
    for (auto interval = nodes.begin_intervals(); interval != nodes.end_intervals(); ++interval)
      unknowns.add_range(n_components * *interval->begin(), n_components * (interval->last() + 1));
    unknowns.compress();
    return unknowns;
  }


  std::shared_ptr<const Utilities::MPI::Partitioner> interleaved(
    const Utilities::MPI::Partitioner &nodes,
    const unsigned int                 n_components)
  {
    return std::make_shared<const Utilities::MPI::Partitioner>(
      interleaved(nodes.locally_owned_range(), n_components),
      interleaved(nodes.ghost_indices(), n_components),
      nodes.get_mpi_communicator());
  }
} // namespace PeriDeal
