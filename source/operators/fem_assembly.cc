// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/fem_operator.h>
#include <perideal/operators/spectrum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fem_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  bool FEMOperator<dim>::assemble_whole_cell(const Cell &cell,
                                             CellData   &data,
                                             const bool  with_bonds) const
  {
    cell_material.assemble(cell, data.stiffness, data.mass);
    return zone_bonds && with_bonds && zone_bonds->coupling().change_cell(cell, data.stiffness);
  }


  template <int dim>
  void FEMOperator<dim>::assemble_cell(const Cell &cell,
                                       CellData   &data,
                                       const bool  with_bonds) const
  {
    assemble_whole_cell(cell, data, with_bonds);
    if (cut_by_cracks.is_cut(cell))
      cut_by_cracks.cut_matrix(
        cell,
        [&] { return cell_material.center_conductivity(cell); },
        data.stiffness);
    if (zone_bonds && with_bonds)
      zone_bonds->coupling().finish_cell(cell, data.stiffness);
    loads.find_convection(cell, data.convection);
    cell->get_dof_indices(data.indices);
  }


  template <int dim>
  void FEMOperator<dim>::find_crack_factors()
  {
    std::vector<Cell> cells;
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        cells.push_back(cell);
    const Vector zero(layout);
    crack_factors.start(zero);
    std::vector<unsigned int> nodes(zero.locally_owned_size());
    std::iota(nodes.begin(), nodes.end(), 0);
    CrackSideFactors::Sums sums(zero);
    find_crack_factors(cells, nodes, sums);
  }


  template <int dim>
  void FEMOperator<dim>::find_crack_factors(const std::vector<Cell>         &cells,
                                            const std::vector<unsigned int> &nodes,
                                            CrackSideFactors::Sums          &sums)
  {
    CellData &data = *cell_data;
    for (const Cell &cell : cells)
      if (cell->is_locally_owned() && cut_by_cracks.is_cut(cell))
        {
          cell->get_dof_indices(data.indices);
          sums.mark(data.indices);
        }
    sums.marked.compress(VectorOperation::max);
    if (zone_bonds)
      zone_bonds->mark_broken(nodes, sums);
    sums.marked.update_ghost_values();
    for (const Cell &cell : cells)
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(data.indices);
          if (!sums.any_marked(data.indices))
            continue;
          assemble_cell(cell, data);
          sums.add(cell,
                   data.indices,
                   data.stiffness,
                   dim * cell_material.center_conductivity(cell));
        }
    sums.compress();
    if (zone_bonds)
      zone_bonds->add_traces(nodes, sums);
    crack_factors.find(nodes, sums);
  }


  template <int dim>
  void FEMOperator<dim>::scale_beside_cracks(CellData &data) const
  {
    if (!crack_factors.empty())
      data.stiffness *= crack_factors.of_cell(data.indices);
  }


  template <int dim>
  void FEMOperator<dim>::assemble()
  {
    const IndexSet &owned = dofs.locally_owned_dofs();
    IndexSet        relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    TrilinosWrappers::SparsityPattern pattern(owned, owned, relevant, dofs.get_communicator());
    if (!apart())
      DoFTools::make_sparsity_pattern(dofs, pattern, hanging.constraints(), false);
    if (zone_bonds)
      zone_bonds->add_pattern(dofs, pattern);
    pattern.compress();
    stiffness.reinit(pattern);
    if (!capacity_is_diagonal())
      mass.reinit(pattern);
    capacity.reinit(layout);
    cell_data = std::make_shared<CellData>(dofs.get_fe());
    fill();
  }


  template <int dim>
  void FEMOperator<dim>::fill()
  {
    CellData &data = *cell_data;
    if (scene.peridynamics.surface_correction == SurfaceCorrection::crack_scaling &&
        scene.cracks.mesh == CrackMesh::pairs && !scene.cracks.cracks.empty())
      find_crack_factors();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const bool empty = zone_bonds && zone_bonds->leaves_nothing(cell);
          assemble_cell(cell, data);
          scale_beside_cracks(data);
          data.stiffness.add(1., data.convection);
          if (!empty)
            hanging.add_to(stiffness, data.stiffness, data.indices);
          if (!capacity_is_diagonal())
            hanging.add_to(mass, data.mass, data.indices);
          for (unsigned int a = 0; a < data.indices.size(); ++a)
            for (unsigned int b = 0; b < data.indices.size(); ++b)
              capacity(data.indices[a]) += data.mass(a, b);
        }
    if (zone_bonds)
      zone_bonds->add_to(stiffness);
    stiffness.compress(VectorOperation::add);
    if (apart())
      zone_bonds->take_remainder(stiffness);
    if (!capacity_is_diagonal())
      mass.compress(VectorOperation::add);
    capacity.compress(VectorOperation::add);
    hanging.condense(capacity);
    if (hanging.any()) // any value that is positive
      hanging.set(capacity, capacity.l2_norm() / std::sqrt(capacity.size()));
  }


  template <int dim>
  void FEMOperator<dim>::take_material_at(const Vector &u)
  {
    if (!depends_on_solution())
      return;
    cell_material.take(u);
    stiffness = 0.;
    mass      = 0.;
    capacity  = 0.;
    fill();
    std::string message;
    for (unsigned int i = 0; i < capacity.locally_owned_size() && message.empty(); ++i)
      {
        const auto index                    = capacity.get_partitioner()->local_to_global(i);
        stiffness_diagonal.local_element(i) = stiffness.diag_element(index);
        if (!(stiffness_diagonal.local_element(i) > 0.) || !(capacity.local_element(i) > 0.))
          message =
            "'Conductivity', 'Density' or 'Heat capacity' in section 'Material' is not positive at the temperatures near " +
            place_of(i) + "; they must be positive at every temperature that the run reaches.";
      }
    throw_on_all_if_any(dofs.get_communicator(), message);
    find_gershgorin();
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
    if (!apart())
      return;
    std::vector<unsigned int> node(1);
    for (node[0] = 0; node[0] < layout->locally_owned_size(); ++node[0])
      {
        const auto rows = zone_bonds->rows(node);
        for (const auto &[neighbor, conductance] : rows[0])
          visit(node[0], neighbor, conductance);
      }
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
          zone_bonds->coupling().bonds_of(i, bonds);
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
            zone_bonds->coupling().finish_cell(cell, data.stiffness);
          cell->get_dof_indices(data.indices);
          hanging.add_to(matrix, data.stiffness, data.indices);
        }
    matrix.compress(VectorOperation::add);
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


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template struct FEMOperator<dim>::CellData;                                                      \
  template void FEMOperator<dim>::fill();                                                          \
  template bool FEMOperator<dim>::assemble_whole_cell(                                             \
    const typename DoFHandler<dim>::active_cell_iterator &,                                        \
    CellData &,                                                                                    \
    const bool) const;                                                                             \
  template void FEMOperator<dim>::assemble_cell(                                                   \
    const typename DoFHandler<dim>::active_cell_iterator &,                                        \
    CellData &,                                                                                    \
    const bool) const;                                                                             \
  template void FEMOperator<dim>::find_crack_factors();                                            \
  template void FEMOperator<dim>::find_crack_factors(const std::vector<Cell> &,                    \
                                                     const std::vector<unsigned int> &,            \
                                                     CrackSideFactors::Sums &);                    \
  template void FEMOperator<dim>::scale_beside_cracks(CellData &) const;                           \
  template void FEMOperator<dim>::take_material_at(const Vector &);                                \
  template void FEMOperator<dim>::visit_conductances(                                              \
    const std::function<void(const unsigned int, const unsigned int, const double)> &visit) const; \
  template double FEMOperator<dim>::lowest_remainder() const;                                      \
  template void   FEMOperator<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &, const bool)  \
    const;                                                                                         \
  template void FEMOperator<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &) const;      \
  template void FEMOperator<dim>::assemble();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
