// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/floating_part.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Sets of connected unknowns of this process and its ghosts; the root of a set is its lowest member. */
    class ConnectedSets
    {
    public:
      explicit ConnectedSets(const unsigned int n)
        : parent(n)
      {
        std::iota(parent.begin(), parent.end(), 0u);
      }

      unsigned int root(unsigned int i)
      {
        while (parent[i] != i)
          i = parent[i] = parent[parent[i]];
        return i;
      }

      void join(const unsigned int i, const unsigned int j)
      {
        const unsigned int a = root(i), b = root(j);
        parent[std::max(a, b)] = std::min(a, b);
      }

    private:
      std::vector<unsigned int> parent;
    };


    /** 1 on unknowns that are free, 0 elsewhere. */
    Vector free_unknowns(const Operator &op)
    {
      Vector is_free;
      op.initialize_vector(is_free);
      is_free = 1.;
      op.clear_constrained(is_free);
      return is_free;
    }


    /**
     * For each owned free unknown the number of its connected part, the lowest global index in it; 0 on others. Each sweep joins the
     * parts within the processes, so that few are needed: about as many as a part visits processes.
     */
    Vector number_parts(const Operator &op, const TrilinosWrappers::SparseMatrix &surrogate)
    {
      Vector      is_free     = free_unknowns(op);
      const auto &partitioner = *is_free.get_partitioner();
      is_free.update_ghost_values();
      const unsigned int n_owned = partitioner.locally_owned_size();
      ConnectedSets      sets(n_owned + partitioner.n_ghost_indices());
      for_each_entry(surrogate, [&](const unsigned int i, const auto column, const double value) {
        if (value == 0. || is_free.local_element(i) == 0. ||
            !(partitioner.in_local_range(column) || partitioner.is_ghost_entry(column)))
          return;
        const unsigned int j = partitioner.global_to_local(column);
        if (is_free.local_element(j) > 0.)
          sets.join(i, j);
      });
      Vector part;
      op.initialize_vector(part);
      for (unsigned int i = 0; i < n_owned; ++i)
        part.local_element(i) = is_free.local_element(i) > 0. ?
                                  static_cast<double>(partitioner.local_to_global(i)) + 1. :
                                  0.;
      std::vector<double> lowest(n_owned + partitioner.n_ghost_indices());
      for (bool changed = true; changed;)
        {
          changed = false;
          part.update_ghost_values();
          std::fill(lowest.begin(), lowest.end(), std::numeric_limits<double>::max());
          for (unsigned int i = 0; i < lowest.size(); ++i)
            if (part.local_element(i) > 0.)
              lowest[sets.root(i)] = std::min(lowest[sets.root(i)], part.local_element(i));
          for (unsigned int i = 0; i < n_owned; ++i)
            if (part.local_element(i) > lowest[sets.root(i)])
              {
                part.local_element(i) = lowest[sets.root(i)];
                changed               = true;
              }
          part.zero_out_ghost_values();
          changed = Utilities::MPI::max(changed ? 1 : 0, is_free.get_mpi_communicator()) > 0;
        }
      return part;
    }


    /** Numbers of the parts on which K applied to one vanishes: nothing from outside acts on them. */
    std::set<double> numbers_of_loose_parts(const Operator &op, const Vector &part)
    {
      Vector ones = free_unknowns(op), image;
      op.initialize_vector(image);
      op.apply(image, ones);
      std::set<double> all, held;
      for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
        if (part.local_element(i) > 0.)
          {
            all.insert(part.local_element(i));
            if (std::abs(image.local_element(i)) > 1e-12 * op.diagonal().local_element(i))
              held.insert(part.local_element(i));
          }
      for (std::set<double> *list : {&all, &held})
        for (const auto &others :
             Utilities::MPI::all_gather(part.get_mpi_communicator(),
                                        std::vector<double>(list->begin(), list->end())))
          list->insert(others.begin(), others.end());
      for (const double number : held)
        all.erase(number);
      return all;
    }
  } // namespace


  void check_no_floating_part(const Operator &op, const TrilinosWrappers::SparseMatrix &surrogate)
  {
    const Vector part         = number_parts(op, surrogate);
    const auto   communicator = part.get_mpi_communicator();
    for (const double number : numbers_of_loose_parts(op, part))
      {
        Vector indicator, image;
        op.initialize_vector(indicator);
        op.initialize_vector(image);
        double n = 0.;
        for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
          if (part.local_element(i) == number)
            {
              indicator.local_element(i) = 1.;
              n += 1.;
            }
        op.apply(image, indicator);
        double largest = 0.;
        for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
          largest =
            std::max(largest, std::abs(image.local_element(i)) / op.diagonal().local_element(i));
        n       = Utilities::MPI::sum(n, communicator);
        largest = Utilities::MPI::max(largest, communicator);
        if (largest > 1e-12)
          continue; // longer bonds hold it
        const auto  index = static_cast<types::global_dof_index>(number) - 1;
        std::string message;
        if (part.in_local_range(index))
          message =
            "The steady state is not determined in a part of the body with " +
            std::to_string(static_cast<unsigned long long>(n)) + " unknowns, one of them at " +
            op.place_of(part.get_partitioner()->global_to_local(index)) +
            ": cracks (section 'Cracks') have cut it off from all sides with a 'Dirichlet' or 'Convection' condition. "
            "Give one of its sides such a condition, shorten the cracks, or give them a 'Transmission'.";
        throw_on_all_if_any(communicator, message);
      }
  }
} // namespace PeriDeal
