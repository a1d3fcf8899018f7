// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/fem_operator.h>

#include <algorithm>
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
    return coupling && with_bonds && coupling->change_cell(cell, data.stiffness);
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
    if (coupling && with_bonds)
      coupling->finish_cell(cell, data.stiffness);
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
    if (coupling)
      mark_broken_bonds(nodes, sums);
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
    if (coupling)
      add_bond_traces(nodes, sums);
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
    if (!bonds_apart)
      DoFTools::make_sparsity_pattern(dofs, pattern, hanging.constraints(), false);
    if (coupling)
      add_bond_pattern(pattern);
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
          const bool empty = bonds_apart && coupling->leaves_nothing(cell);
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
    if (coupling && !bonds_apart)
      {
        std::vector<unsigned int> nodes(capacity.locally_owned_size());
        std::iota(nodes.begin(), nodes.end(), 0);
        add_bonds(nodes, bond_rows(nodes));
      }
    stiffness.compress(VectorOperation::add);
    if (bonds_apart)
      extract_remainder();
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


#define PERIDEAL_INSTANTIATE(dim)                                                       \
  template struct FEMOperator<dim>::CellData;                                           \
  template void FEMOperator<dim>::fill();                                               \
  template bool FEMOperator<dim>::assemble_whole_cell(                                  \
    const typename DoFHandler<dim>::active_cell_iterator &,                             \
    CellData &,                                                                         \
    const bool) const;                                                                  \
  template void FEMOperator<dim>::assemble_cell(                                        \
    const typename DoFHandler<dim>::active_cell_iterator &,                             \
    CellData &,                                                                         \
    const bool) const;                                                                  \
  template void FEMOperator<dim>::find_crack_factors();                                 \
  template void FEMOperator<dim>::find_crack_factors(const std::vector<Cell> &,         \
                                                     const std::vector<unsigned int> &, \
                                                     CrackSideFactors::Sums &);         \
  template void FEMOperator<dim>::scale_beside_cracks(CellData &) const;                \
  template void FEMOperator<dim>::take_material_at(const Vector &);                     \
  template void FEMOperator<dim>::assemble();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
