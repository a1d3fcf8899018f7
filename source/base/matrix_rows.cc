// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/matrix_rows.h>

#include <memory>

namespace PeriDeal
{
  using namespace dealii;

  Vector with_columns_as_ghosts(const Vector &v, const TrilinosWrappers::SparseMatrix &matrix)
  {
    const Epetra_Map &columns = matrix.trilinos_matrix().ColMap();
    const IndexSet    owned   = v.locally_owned_elements();
    IndexSet          ghosts(v.size());
    for (int k = 0; k < columns.NumMyElements(); ++k)
      if (!owned.is_element(columns.GID(k)))
        ghosts.add_index(columns.GID(k));
    ghosts.compress();
    Vector wide(
      std::make_shared<Utilities::MPI::Partitioner>(owned, ghosts, v.get_mpi_communicator()));
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      wide.local_element(i) = v.local_element(i);
    wide.update_ghost_values();
    return wide;
  }


  void hold_unknowns(TrilinosWrappers::SparseMatrix &matrix, const Vector &marked)
  {
    const Vector known = with_columns_as_ghosts(marked, matrix);
    for_each_entry(matrix, [&](const unsigned int i, const auto column, double &value) {
      const bool row_held = marked.local_element(i) > 0.;
      if (column == marked.get_partitioner()->local_to_global(i))
        value = row_held ? 1. : value;
      else if (row_held || known(column) > 0.)
        value = 0.;
    });
  }
} // namespace PeriDeal
