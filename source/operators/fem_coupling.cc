// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds beside finite elements.

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/operators/fem_operator.h>
#include <perideal/operators/spectrum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fem_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void FEMOperator<dim>::add_bond_pattern(TrilinosWrappers::SparsityPattern &pattern) const
  {
    std::vector<unsigned int>            neighbors;
    std::vector<types::global_dof_index> columns;
    if (bonds_apart)
      {
        columns.resize(dofs.get_fe().n_dofs_per_cell());
        for (const auto &cell : dofs.active_cell_iterators())
          if (cell->is_locally_owned() && !coupling->leaves_nothing(cell))
            {
              cell->get_dof_indices(columns);
              for (const auto row : columns)
                pattern.add_entries(row, columns.begin(), columns.end());
            }
        return;
      }
    for (unsigned int i = 0; i < layout->locally_owned_size(); ++i)
      {
        coupling->possible_neighbors_of(i, neighbors);
        columns.clear();
        for (const unsigned int j : neighbors)
          columns.push_back(layout->local_to_global(j));
        pattern.add_entries(layout->local_to_global(i), columns.begin(), columns.end());
      }
  }


  template <int dim>
  typename FEMOperator<dim>::BondRows FEMOperator<dim>::bond_rows(
    const std::vector<unsigned int> &nodes) const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    BondRows                                  rows(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
      {
        coupling->bonds_of(nodes[k], bonds);
        rows[k].reserve(bonds.size());
        for (const auto &bond : bonds)
          if (bond.weight != 0.)
            rows[k].emplace_back(bond.neighbor,
                                 bond.weight * crack_factors.of_bond(nodes[k], bond.neighbor));
      }
    return rows;
  }


  template <int dim>
  void FEMOperator<dim>::add_bonds(const std::vector<unsigned int> &nodes, const BondRows &rows)
  {
    std::vector<types::global_dof_index> columns;
    std::vector<double>                  values;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (!rows[k].empty())
        {
          const auto own = layout->local_to_global(nodes[k]);
          columns.assign(1, own);
          values.assign(1, 0.);
          for (const auto &[neighbor, conductance] : rows[k])
            {
              columns.push_back(layout->local_to_global(neighbor));
              values.push_back(-conductance);
              values[0] += conductance;
            }
          stiffness.add(own, columns.size(), columns.data(), values.data());
        }
  }


  template <int dim>
  void FEMOperator<dim>::change_bonds(const std::vector<unsigned int> &nodes, const BondRows &old)
  {
    BondRows                       rows = bond_rows(nodes);
    std::map<unsigned int, double> change;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      {
        if (rows[k] == old[k])
          {
            rows[k].clear();
            continue;
          }
        change.clear();
        for (const auto &[neighbor, conductance] : rows[k])
          change[neighbor] += conductance;
        for (const auto &[neighbor, conductance] : old[k])
          change[neighbor] -= conductance;
        rows[k].clear();
        for (const auto &[neighbor, conductance] : change)
          if (conductance != 0.)
            rows[k].emplace_back(neighbor, conductance);
        if (!rows[k].empty())
          event->touched.insert(nodes[k]);
      }
    add_bonds(nodes, rows);
  }


  template <int dim>
  void FEMOperator<dim>::mark_broken_bonds(const std::vector<unsigned int> &nodes,
                                           CrackSideFactors::Sums          &sums) const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    const Families<dim>                      &families = coupling->families();
    for (const unsigned int i : nodes)
      if (coupling->in_zone(i) && families.near_crack(i))
        {
          coupling->bonds_of(i, bonds);
          if (std::any_of(bonds.begin(), bonds.end(), [](const auto &bond) { return bond.cut; }))
            sums.marked.local_element(i) = 1.;
        }
  }


  template <int dim>
  void FEMOperator<dim>::add_bond_traces(const std::vector<unsigned int> &nodes,
                                         CrackSideFactors::Sums          &sums) const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    for (const unsigned int i : nodes)
      if (sums.marked.local_element(i) > 0.)
        {
          coupling->bonds_of(i, bonds);
          for (const auto &bond : bonds)
            sums.trace.local_element(i) +=
              0.5 * bond.weight *
              coupling->families().neighbors().bond_vector(i, bond.neighbor).norm_square();
        }
  }


  template <int dim>
  void FEMOperator<dim>::add_bond_heat(const Vector &u, Balance &balance) const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    std::vector<std::pair<unsigned int, int>> crossed;
    const Families<dim>                      &families = coupling->families();
    u.update_ghost_values();
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      if (coupling->in_zone(i) && families.near_crack(i))
        {
          coupling->bonds_of(i, bonds);
          for (const auto &bond : bonds)
            if (bond.cut && bond.weight > 0.)
              {
                const double factor = crack_factors.of_bond(i, bond.neighbor);
                families.cracks().crossed_cracks(i, bond.neighbor, crossed);
                for (const auto &[crack, side] : crossed) // each bond is seen from both of its ends
                  balance.cracks[crack] += 0.5 * side * factor * bond.weight *
                                           (u.local_element(bond.neighbor) - u.local_element(i));
              }
        }
    u.set_ghost_state(false);
  }


  template <int dim>
  void FEMOperator<dim>::visit_conductances(
    const std::function<void(const unsigned int, const unsigned int, const double)> &visit) const
  {
    for_each_entry(stiffness, [&](const unsigned int i, const auto column, const double value) {
      // The neighbours of a hanging node's neighbours may be unknown here.
      if (!layout->in_local_range(column) && !layout->is_ghost_entry(column))
        return;
      const unsigned int j = layout->global_to_local(column);
      if (i != j && value != 0.)
        visit(i, j, -value);
    });
    if (!bonds_apart)
      return;
    std::vector<unsigned int> node(1);
    for (node[0] = 0; node[0] < layout->locally_owned_size(); ++node[0])
      {
        const BondRows rows = bond_rows(node);
        for (const auto &[neighbor, conductance] : rows[0])
          visit(node[0], neighbor, conductance);
      }
  }


  template <int dim>
  void FEMOperator<dim>::count_bonds() const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    unsigned long long                        n_ends = 0;
    for (unsigned int i = 0; i < capacity.locally_owned_size(); ++i)
      {
        coupling->bonds_of(i, bonds);
        n_ends += std::count_if(bonds.begin(), bonds.end(), [](const auto &bond) {
          return bond.weight != 0.;
        });
      }
    n_bonds       = Utilities::MPI::sum(n_ends, dofs.get_communicator()) / 2;
    recount_bonds = false;
  }


  template <int dim>
  double FEMOperator<dim>::lowest_remainder() const
  {
    CellData &data   = *cell_data;
    double    lowest = std::numeric_limits<double>::infinity();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && assemble_whole_cell(cell, data))
        lowest =
          std::min(lowest,
                   lowest_eigenvalue(data.stiffness) / (cell_material.center_conductivity(cell) *
                                                        std::pow(cell->measure(), 1. - 2. / dim)));
    return Utilities::MPI::min(lowest, dofs.get_communicator());
  }


  template <int dim>
  void FEMOperator<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &matrix,
                                         const bool                      with_bonds) const
  {
    const IndexSet &owned = dofs.locally_owned_dofs();
    IndexSet        relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    TrilinosWrappers::SparsityPattern pattern(owned, owned, relevant, dofs.get_communicator());
    DoFTools::make_sparsity_pattern(dofs, pattern, hanging.constraints(), false);
    std::vector<typename Coupling<dim>::Bond> bonds;
    std::vector<types::global_dof_index>      columns;
    std::vector<double>                       values;
    const auto                                for_each_row = [&](const auto &visit) {
      for (unsigned int i = 0; i < layout->locally_owned_size() && with_bonds; ++i)
        {
          coupling->bonds_of(i, bonds);
          const auto own = layout->local_to_global(i);
          columns.assign(1, own);
          values.assign(1, 0.);
          for (const auto &bond : bonds)
            {
              columns.push_back(layout->local_to_global(bond.neighbor));
              values.push_back(-bond.intact);
              values[0] += bond.intact;
            }
          visit(own);
        }
    };
    for_each_row([&](const auto row) { pattern.add_entries(row, columns.begin(), columns.end()); });
    pattern.compress();
    matrix.reinit(pattern);
    for_each_row(
      [&](const auto row) { matrix.add(row, columns.size(), columns.data(), values.data()); });
    CellData &data = *cell_data;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          assemble_whole_cell(cell, data, with_bonds);
          if (with_bonds)
            coupling->finish_cell(cell, data.stiffness);
          cell->get_dof_indices(data.indices);
          hanging.add_to(matrix, data.stiffness, data.indices);
        }
    matrix.compress(VectorOperation::add);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                 \
  template void FEMOperator<dim>::add_bond_pattern(TrilinosWrappers::SparsityPattern &) const;    \
  template typename FEMOperator<dim>::BondRows FEMOperator<dim>::bond_rows(                       \
    const std::vector<unsigned int> &) const;                                                     \
  template void FEMOperator<dim>::add_bonds(const std::vector<unsigned int> &, const BondRows &); \
  template void FEMOperator<dim>::change_bonds(const std::vector<unsigned int> &,                 \
                                               const BondRows &);                                 \
  template void FEMOperator<dim>::mark_broken_bonds(const std::vector<unsigned int> &,            \
                                                    CrackSideFactors::Sums &) const;              \
  template void FEMOperator<dim>::add_bond_traces(const std::vector<unsigned int> &,              \
                                                  CrackSideFactors::Sums &) const;                \
  template void FEMOperator<dim>::add_bond_heat(const Vector &, Balance &) const;                 \
  template void FEMOperator<dim>::visit_conductances(                                             \
    const std::function<void(const unsigned int, const unsigned int, const double)> &) const;     \
  template void   FEMOperator<dim>::count_bonds() const;                                          \
  template double FEMOperator<dim>::lowest_remainder() const;                                     \
  template void   FEMOperator<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &, const bool) \
    const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
