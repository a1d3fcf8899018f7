// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/interleaved.h>
#include <perideal/operators/parts/node_subset.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  NodeSubset::NodeSubset(const Layout &nodes, const unsigned int n_components)
    : nodes(nodes)
    , n_components(n_components)
  {}


  void NodeSubset::add(const std::vector<unsigned int> &owned)
  {
    const std::size_t n_before = members.size();
    for (const unsigned int i : owned)
      if (place(i) == numbers::invalid_unsigned_int)
        members.push_back(i);
    const double is_new[] = {members.size() > n_before ? 1. : 0.};
    double       any[1];
    Utilities::MPI::max(is_new, nodes->get_mpi_communicator(), any);
    if (any[0] > 0.)
      find_places(n_before);
  }


  void NodeSubset::find_places(const std::size_t n_before)
  {
    const MPI_Comm communicator = nodes->get_mpi_communicator();
    const IndexSet own          = Utilities::MPI::create_ascending_partitioning(
      communicator,
      members.size())[Utilities::MPI::this_mpi_process(communicator)];
    IndexSet ghosts(own.size());
    places.resize(nodes->locally_owned_size() + nodes->n_ghost_indices(),
                  numbers::invalid_unsigned_int);
    for (std::size_t k = n_before; k < members.size(); ++k)
      places[members[k]] = k;
    const bool is_shared = Utilities::MPI::n_mpi_processes(communicator) > 1;
    Vector     order; // of members among all, from 1 on
    if (is_shared)
      {
        order.reinit(nodes);
        for (std::size_t k = 0; k < members.size(); ++k)
          order.local_element(members[k]) = static_cast<double>(own.nth_index_in_set(k) + 1);
        order.update_ghost_values();
        for (unsigned int i = nodes->locally_owned_size(); i < places.size(); ++i)
          if (const double number = order.local_element(i); number > 0.)
            ghosts.add_index(static_cast<types::global_dof_index>(number) - 1);
      }
    scalars = std::make_shared<const Utilities::MPI::Partitioner>(own, ghosts, communicator);
    vectors = interleaved(*scalars, n_components);
    if (is_shared)
      for (unsigned int i = nodes->locally_owned_size(); i < places.size(); ++i)
        if (const double number = order.local_element(i); number > 0.)
          places[i] = scalars->global_to_local(static_cast<types::global_dof_index>(number) - 1);
  }


  void NodeSubset::fit(Vector &v, const Layout &layout)
  {
    Assert(layout, ExcInternalError());
    if (v.get_partitioner() == layout)
      return;
    Vector fitted(layout);
    std::copy(v.begin(), v.end(), fitted.begin());
    v.swap(fitted);
  }


  std::size_t NodeSubset::memory_consumption() const
  {
    return (members.capacity() + places.capacity()) * sizeof(unsigned int);
  }
} // namespace PeriDeal
