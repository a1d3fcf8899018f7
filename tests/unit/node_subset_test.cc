// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/parts/node_subset.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_own = 10, dim = 3;

    /** Ten nodes of each process; ghosts are two of each neighbour's. */
    NodeSubset::Layout nodes_in_a_row()
    {
      const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                         n = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD), first = rank * n_own;
      IndexSet own(n * n_own), ghosts(n * n_own);
      own.add_range(first, first + n_own);
      if (rank > 0)
        ghosts.add_range(first - 2, first);
      if (rank + 1 < n)
        ghosts.add_range(first + n_own, first + n_own + 2);
      return std::make_shared<const Utilities::MPI::Partitioner>(own, ghosts, MPI_COMM_WORLD);
    }


    /** Whatever a member has at its place is found there, of ghosts, too. */
    void check_values(const NodeSubset                           &subset,
                      const Utilities::MPI::Partitioner          &nodes,
                      const std::vector<types::global_dof_index> &members,
                      const double                                offset)
    {
      Vector scalars, vectors;
      subset.fit_scalars(scalars);
      subset.fit_vectors(vectors);
      for (unsigned int place = 0; place < subset.n_owned(); ++place)
        {
          const double number          = nodes.local_to_global(subset.node(place)) + offset;
          scalars.local_element(place) = number;
          for (unsigned int d = 0; d < dim; ++d)
            vectors.local_element(dim * place + d) = 100. * d + number;
        }
      scalars.update_ghost_values();
      vectors.update_ghost_values();
      for (unsigned int i = 0; i < nodes.locally_owned_size() + nodes.n_ghost_indices(); ++i)
        {
          const auto         number = nodes.local_to_global(i);
          const unsigned int place  = subset.place(i);
          if (std::find(members.begin(), members.end(), number % n_own) == members.end())
            {
              EXPECT_EQ(place, numbers::invalid_unsigned_int) << number;
              continue;
            }
          ASSERT_NE(place, numbers::invalid_unsigned_int) << number;
          EXPECT_EQ(scalars.local_element(place), number + offset);
          for (unsigned int d = 0; d < dim; ++d)
            EXPECT_EQ(vectors.local_element(dim * place + d), 100. * d + number + offset);
        }
    }
  } // namespace


  TEST(NodeSubset, members_are_found_on_all_processes)
  {
    const auto nodes = nodes_in_a_row();
    NodeSubset subset(nodes, dim);
    subset.add({});
    EXPECT_TRUE(subset.empty());
    EXPECT_EQ(subset.place(0), numbers::invalid_unsigned_int);
    subset.add({8, 1});
    EXPECT_FALSE(subset.empty());
    EXPECT_EQ(subset.node(0), 8U);
    check_values(subset, *nodes, {1, 8}, 0.5);
    Vector kept;
    subset.fit_scalars(kept);
    kept.local_element(0) = 7.;
    subset.add({1, 9, 0, 8});
    check_values(subset, *nodes, {0, 1, 8, 9}, 0.25);
    // Members stay where they are.
    EXPECT_EQ(subset.n_owned(), 4U);
    EXPECT_EQ(subset.place(8), 0U);
    EXPECT_EQ(subset.place(1), 1U);
    subset.fit_scalars(kept);
    EXPECT_EQ(kept.local_element(0), 7.);
    EXPECT_EQ(kept.local_element(3), 0.);
  }


  TEST(NodeSubset, some_processes_have_none)
  {
    const auto         nodes = nodes_in_a_row();
    NodeSubset         subset(nodes, dim);
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                       last = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) - 1;
    subset.add(rank == last ? std::vector<unsigned int>{0, 1} : std::vector<unsigned int>());
    EXPECT_FALSE(subset.empty());
    Vector v;
    subset.fit_scalars(v);
    for (unsigned int place = 0; place < subset.n_owned(); ++place)
      v.local_element(place) = 1. + place;
    v.update_ghost_values();
    if (rank + 1 == last) // ghosts come below the own ones and above
      {
        const unsigned int ghost =
          nodes->global_to_local(static_cast<types::global_dof_index>(last * n_own + 1));
        ASSERT_NE(subset.place(ghost), numbers::invalid_unsigned_int);
        EXPECT_EQ(v.local_element(subset.place(ghost)), 2.);
      }
  }
} // namespace PeriDeal
