// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/base/types.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace dealii::TrilinosWrappers
{
  class SparseMatrix;
}

namespace PeriDeal
{
  /**
   * A sparse matrix of n x n blocks on nodes, n = 1, 2, 3, whose rows share their values where they
   * are alike: on a lattice next to all of them are, and a product streams two vectors and no
   * matrix.
   *
   * The blocks of a row stand in the order of places, so that a row is summed up in the same order
   * on any number of processes. Rows are alike if their blocks differ by round-off: by 1e-14 of the
   * largest value. Rows that follow one another with columns that are shifted by one node make a
   * run, with one list of columns. What no other row is like has values of its own. The pattern
   * stays as it is.
   */
  template <int n>
  class AlikeRows
  {
  public:
    using Layout = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;

    /**
     * Take all rows of a matrix. Not collective.
     *
     * @param nodes  owned ones and, as ghosts, all columns of their rows
     * @param places of the nodes known here: numbers that grow along the lattice, the fastest in
     *               the first direction
     */
    AlikeRows(const dealii::TrilinosWrappers::SparseMatrix &matrix,
              const Layout                                 &nodes,
              const std::vector<std::uint64_t>             &places);
    ~AlikeRows();

    /** y = K x in the owned rows; ghosts of x are up to date. Not collective. */
    void multiply(Vector &y, const Vector &x) const;

    /**
     * Add a matrix of unknowns of whole nodes, given by global numbers. What other processes own
     * waits for compress(). Not collective.
     */
    void add(const dealii::FullMatrix<double>                   &matrix,
             const std::vector<dealii::types::global_dof_index> &unknowns);

    /** After add(). Collective. */
    void compress();

    /**
     * Call visit(row, column, value) for each entry in the rows of an owned node: the local number
     * of the row, the global one of the column. Not collective.
     */
    template <typename Visit>
    void for_each_entry_of(const unsigned int node, const Visit &visit) const
    {
      const Run           &run    = run_of(node);
      const double        *block  = numbers.data() + values[values_of[node]].first;
      const std::uint32_t *column = columns.data() + run.first_column;
      for (unsigned int k = 0; k < run.n_blocks; ++k, block += n * n)
        {
          const auto first = n * nodes->local_to_global(column[k] + (node - run.begin));
          for (unsigned int c = 0; c < n; ++c)
            for (unsigned int e = 0; e < n; ++e)
              visit(n * node + c, first + e, block[n * e + c]);
        }
    }

    /** The same for all owned nodes. */
    template <typename Visit>
    void for_each_entry(const Visit &visit) const
    {
      for (unsigned int node = 0; node < values_of.size(); ++node)
        for_each_entry_of(node, visit);
    }

    /** On the diagonal, in a row of an owned node. Not collective. */
    double diagonal(const unsigned int node, const unsigned int component) const
    {
      const auto own   = n * nodes->local_to_global(node) + component;
      double     found = 0.;
      for_each_entry_of(node, [&](const unsigned int row, const auto column, const double value) {
        if (row == n * node + component && column == own)
          found = value;
      });
      return found;
    }

    /** Rows of this process that differ. */
    std::size_t n_different() const
    {
      return values.size() - unused.size();
    }

    std::size_t memory_consumption() const;

  private:
    /** A row of blocks that is being taken. */
    struct Taken
    {
      std::vector<std::pair<std::uint64_t, std::uint32_t>> order; // by place: columns
      std::vector<std::uint32_t>                           columns;
      std::vector<double>                                  blocks; // each column by column
    };

    struct Run
    {
      std::uint32_t begin, end;   // owned nodes
      std::uint32_t first_column; // in columns: those of the first row
      std::uint32_t n_blocks, pattern;
      std::size_t   first_offset = 0; // in offsets, of long runs
      int           lowest = 0, highest = -1;
    };

    /**
     * Which of a row's columns are neighbours in memory: the bands that their blocks have of the
     * unknowns of neighbours lie upon one another. slots[k]: where the diagonal of block k is.
     */
    struct Pattern
    {
      std::vector<std::uint32_t> slots;
      std::uint32_t              n_slots = 0;
    };

    /** The blocks of one row, or of many. */
    struct Values
    {
      std::size_t         first    = 0; // in numbers
      std::uint32_t       n_blocks = 0, pattern = 0, users = 0;
      std::uint64_t       key   = 0;
      bool                fixed = false; // may be shared, and does not change
      std::vector<double> stencil;       // of what many share: RowProducts::along_rows()
    };

    void          take(const dealii::TrilinosWrappers::SparseMatrix &matrix,
                       const std::vector<std::uint64_t>             &places,
                       const unsigned int                            node,
                       Taken                                        &row) const;
    void          put_into_run(const unsigned int node, const Taken &row);
    void          make_stencils();
    std::uint32_t pattern_of(const std::vector<std::uint32_t> &of_row);
    std::uint32_t find_alike(const double *blocks, const Values &like) const;
    std::uint32_t add_values(const double *blocks, const Values &like);
    void          release(const std::uint32_t which);
    void       add_block(const unsigned int node, const unsigned int column, const double *block);
    const Run &run_of(const unsigned int node) const;
    void multiply_row(double *y, const double *x, const Run &run, const unsigned int node) const;
    void multiply_alike(double             *y,
                        const double       *x,
                        const Run          &run,
                        const std::uint32_t begin,
                        const std::uint32_t end) const;

    const Layout                                          nodes;
    std::vector<std::uint32_t>                            values_of; // of owned nodes
    std::vector<Run>                                      runs;
    std::vector<std::uint32_t>                            columns;
    std::vector<int>                                      offsets;
    std::vector<Pattern>                                  patterns;
    std::vector<Values>                                   values;
    std::vector<double>                                   numbers;
    std::unordered_multimap<std::uint64_t, std::uint32_t> by_key;  // of fixed values
    std::vector<std::uint32_t>                            unused;  // of the values
    std::vector<unsigned int>                             touched; // nodes, since compress()
    std::vector<double>                                   waiting; // for other processes
  };
} // namespace PeriDeal
