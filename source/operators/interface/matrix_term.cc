// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_product.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/operators/interface/matrix_term.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void MatrixTerm<dim>::keep_rows(const Utilities::MPI::Partitioner &layout)
  {
    kept        = Kept();
    double size = 0.;
    for_each_entry(matrix, [&](const unsigned int, const auto, const double value) {
      size = std::max(size, std::abs(value));
    });
    // What is left of two equal terms is round-off, another on each number of processes.
    const double nothing = 1e-14 * Utilities::MPI::max(size, layout.get_mpi_communicator());
    for_each_entry(matrix, [&](const unsigned int i, const auto column, const double value) {
      if (std::abs(value) <= nothing)
        return;
      if (kept.rows.empty() || kept.rows.back() != i)
        {
          kept.rows.push_back(i);
          kept.starts.push_back(kept.columns.size());
        }
      kept.columns.push_back(layout.global_to_local(column));
      kept.values.push_back(value);
    });
    kept.starts.push_back(kept.columns.size());
  }


  template <int dim>
  void MatrixTerm<dim>::add(Vector            &y,
                            const At          &at,
                            const unsigned int begin,
                            const unsigned int end) const
  {
    const auto from = std::lower_bound(kept.rows.begin(), kept.rows.end(), begin);
    for (auto row = from; row != kept.rows.end() && *row < end; ++row)
      {
        const std::size_t k   = row - kept.rows.begin();
        double            sum = 0.;
        for (unsigned int e = kept.starts[k]; e < kept.starts[k + 1]; ++e)
          sum += kept.values[e] * at.u.local_element(kept.columns[e]);
        y.local_element(*row) += sum;
      }
  }


  template <int dim>
  void MatrixTerm<dim>::set_then(Vector &y, const At &at, const Operator::RowsAction &finish) const
  {
    MatrixProduct(matrix).vmult(y, at.u);
    finish(0, y.locally_owned_size());
  }


  template <int dim>
  void MatrixTerm<dim>::add_rows(Vector              &diagonal,
                                 std::vector<double> &sums,
                                 const Rows          &rows) const
  {
    for (std::size_t k = 0; k < rows.size(); ++k)
      for_each_entry_of_row(matrix, rows[k], [&](const auto column, const double value) {
        if (column == diagonal.get_partitioner()->local_to_global(rows[k]))
          diagonal.local_element(rows[k]) += value;
        sums[k] += std::abs(value);
      });
  }


  template <int dim>
  void MatrixTerm<dim>::add_to(OperatorSize &size) const
  {
    size.memory += matrix.memory_consumption();
    const MPI_Comm communicator = matrix.get_mpi_communicator();
    if (!first)
      {
        size.nonzeros += Utilities::MPI::sum(kept.values.size(), communicator);
        return;
      }
    const auto work =
      Utilities::MPI::min_max_avg(matrix.trilinos_matrix().NumMyNonzeros(), communicator);
    size.form     = "matrix";
    size.nonzeros = matrix.n_nonzero_elements();
    size.busiest  = work.max / work.avg;
  }


  PERIDEAL_INSTANTIATE_CLASS(class MatrixTerm);
} // namespace PeriDeal
