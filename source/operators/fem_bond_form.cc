// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds as a form of their own beside the matrix of the cells: peridynamics in the whole body.

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/operators/fem_operator.h>

#include <algorithm>
#include <cmath>

#include "fem_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void FEMOperator<dim>::find_diagonal()
  {
    stiffness_diagonal.reinit(layout);
    if (bonds_apart)
      {
        set_form_factors();
        form = coupling->make_form();
        bond_sums.resize(stiffness_diagonal.locally_owned_size());
        form->row_sums(bond_sums.data());
        std::copy(bond_sums.begin(), bond_sums.end(), stiffness_diagonal.begin());
      }
    for_each_entry(stiffness, [&](const unsigned int i, const auto column, const double value) {
      if (column == layout->local_to_global(i))
        stiffness_diagonal.local_element(i) += value;
    });
  }


  template <int dim>
  void FEMOperator<dim>::extract_remainder()
  {
    remainder   = RemainderRows();
    double size = 0.;
    for_each_entry(stiffness, [&](const unsigned int, const auto, const double value) {
      size = std::max(size, std::abs(value));
    });
    // What is left of two equal terms is round-off, another on each number of processes.
    const double nothing = 1e-14 * Utilities::MPI::max(size, dofs.get_communicator());
    for_each_entry(stiffness, [&](const unsigned int i, const auto column, const double value) {
      if (std::abs(value) <= nothing)
        return;
      if (remainder.rows.empty() || remainder.rows.back() != i)
        {
          remainder.rows.push_back(i);
          remainder.starts.push_back(remainder.columns.size());
        }
      remainder.columns.push_back(layout->global_to_local(column));
      remainder.values.push_back(value);
    });
    remainder.starts.push_back(remainder.columns.size());
  }


  template <int dim>
  void FEMOperator<dim>::add_remainder(Vector            &y,
                                       const Vector      &x,
                                       const unsigned int begin,
                                       const unsigned int end) const
  {
    const auto first = std::lower_bound(remainder.rows.begin(), remainder.rows.end(), begin);
    for (auto row = first; row != remainder.rows.end() && *row < end; ++row)
      {
        const std::size_t k   = row - remainder.rows.begin();
        double            sum = 0.;
        for (unsigned int e = remainder.starts[k]; e < remainder.starts[k + 1]; ++e)
          sum += remainder.values[e] * x.local_element(remainder.columns[e]);
        y.local_element(*row) += sum;
      }
  }


  template <int dim>
  void FEMOperator<dim>::multiply_then(Vector &y, const Vector &x, const RowsAction &finish) const
  {
    if (!form)
      {
        stiffness.vmult(y, x);
        finish(0, y.locally_owned_size());
        return;
      }
    x.update_ghost_values();
    form->apply(y.begin(),
                x.begin(),
                nullptr,
                [&](const unsigned int begin, const unsigned int end) {
                  add_remainder(y, x, begin, end);
                  finish(begin, end);
                });
    x.set_ghost_state(false);
  }


  template <int dim>
  void FEMOperator<dim>::multiply(Vector &y, const Vector &x) const
  {
    multiply_then(y, x, [](const unsigned int, const unsigned int) {});
  }


  template <int dim>
  void FEMOperator<dim>::set_form_factors()
  {
    if (crack_factors.empty())
      return;
    std::vector<double> factors(coupling->families().nodes().n_local());
    for (unsigned int i = 0; i < factors.size(); ++i)
      factors[i] = crack_factors.at(i);
    coupling->set_form_factors(std::move(factors));
  }


  template <int dim>
  void FEMOperator<dim>::change_form(const std::vector<unsigned int> &nodes)
  {
    set_form_factors();
    form->update_rows(nodes, bond_sums.data());
    for (const unsigned int i : nodes)
      event->touched.insert(i);
    extract_remainder();
  }


  template <int dim>
  void FEMOperator<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    // Finite elements with the same cracks conduct nearly like the bonds.
    const IndexSet &owned = dofs.locally_owned_dofs();
    IndexSet        relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    TrilinosWrappers::SparsityPattern pattern(owned, owned, relevant, dofs.get_communicator());
    DoFTools::make_sparsity_pattern(dofs, pattern, hanging.constraints(), false);
    pattern.compress();
    matrix.reinit(pattern);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          assemble_cell(cell, *cell_data, false);
          scale_beside_cracks(*cell_data);
          cell_data->stiffness.add(1., cell_data->convection);
          hanging.add_to(matrix, cell_data->stiffness, cell_data->indices);
        }
    matrix.compress(VectorOperation::add);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                             \
  template void FEMOperator<dim>::find_diagonal();                                            \
  template void FEMOperator<dim>::extract_remainder();                                        \
  template void FEMOperator<dim>::add_remainder(Vector &,                                     \
                                                const Vector &,                               \
                                                const unsigned int,                           \
                                                const unsigned int) const;                    \
  template void FEMOperator<dim>::multiply_then(Vector &, const Vector &, const RowsAction &) \
    const;                                                                                    \
  template void FEMOperator<dim>::multiply(Vector &, const Vector &) const;                   \
  template void FEMOperator<dim>::set_form_factors();                                         \
  template void FEMOperator<dim>::change_form(const std::vector<unsigned int> &);             \
  template void FEMOperator<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
