// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/diffusion/cell_matrices.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  CellMatrices<dim>::CellMatrices(const DoFHandler<dim>              &dofs,
                                  const CellMaterial<dim>            &material,
                                  const BondsBesideElements<dim>     *bonds,
                                  CrackSideFactors                   &factors,
                                  const typename CutCells<dim>::Rule &rule)
    : dofs(dofs)
    , material(material)
    , bonds(bonds)
    , factors(factors)
    , cut_by_cracks(dofs, rule)
    , matrices(dofs.get_fe().n_dofs_per_cell())
  {}


  template <int dim>
  bool CellMatrices<dim>::assemble_whole(const Cell &cell,
                                         const bool  with_bonds,
                                         const bool  in_pairs) const
  {
    material.assemble(cell, matrices.stiffness, matrices.mass);
    if (in_pairs)
      {
        material.assemble_unit(cell, matrices.stiffness);
        cut_by_cracks.conduct_in_pairs(
          cell,
          [&](const Point<dim> &p, const unsigned int vertex) {
            return material.conductivity(cell, p, vertex);
          },
          matrices.stiffness);
      }
    cell->get_dof_indices(matrices.indices);
    return bonds != nullptr && with_bonds &&
           bonds->coupling().change_cell(cell, matrices.stiffness);
  }


  template <int dim>
  typename CutCells<dim>::PairConductivity CellMatrices<dim>::pair_conductivity(
    const Cell &cell) const
  {
    if (!material.varies())
      return [this, &cell](const unsigned int, const unsigned int) {
        return material.center_conductivity(cell);
      };
    return [this, &cell](const unsigned int a, const unsigned int b) {
      return cut_by_cracks
        .conductivity_between(cell, a, b, [&](const Point<dim> &p, const unsigned int vertex) {
          return material.conductivity(cell, p, vertex);
        });
    };
  }


  template <int dim>
  void CellMatrices<dim>::assemble_cut(const Cell &cell, const bool with_bonds) const
  {
    const bool is_cut = cut_by_cracks.is_cut(cell);
    assemble_whole(cell, with_bonds, is_cut && !cut_by_cracks.removes() && material.varies());
    separated.clear();
    if (is_cut)
      cut_by_cracks.cut_matrix(cell,
                               pair_conductivity(cell),
                               matrices.stiffness,
                               factors.empty() ? nullptr : &separated);
    if (bonds != nullptr && with_bonds)
      bonds->coupling().finish_cell(cell, matrices.stiffness);
  }


  template <int dim>
  typename CellMatrices<dim>::Matrices &CellMatrices<dim>::assemble(const Cell &cell,
                                                                    const bool  with_bonds) const
  {
    assemble_cut(cell, with_bonds);
    if (factors.empty())
      return matrices;
    const double factor = factors.of_cell(matrices.indices);
    matrices.stiffness *= factor;
    for (const auto &pair : separated) // they stay as they are
      {
        const double more = (1. - factor) * pair.kept;
        matrices.stiffness(pair.a, pair.b) -= more;
        matrices.stiffness(pair.b, pair.a) -= more;
        matrices.stiffness(pair.a, pair.a) += more;
        matrices.stiffness(pair.b, pair.b) += more;
      }
    return matrices;
  }


  template <int dim>
  typename CellMatrices<dim>::Matrices &CellMatrices<dim>::assemble_intact(
    const Cell &cell,
    const bool  with_bonds) const
  {
    assemble_whole(cell, with_bonds);
    if (bonds != nullptr && with_bonds)
      bonds->coupling().finish_cell(cell, matrices.stiffness);
    return matrices;
  }


  template <int dim>
  void CellMatrices<dim>::find_factors(const Vector &layout)
  {
    std::vector<Cell> cells;
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        cells.push_back(cell);
    factors.start(layout);
    std::vector<unsigned int> nodes(layout.locally_owned_size());
    std::iota(nodes.begin(), nodes.end(), 0);
    CrackSideFactors::Sums sums(layout);
    find_factors(cells, nodes, sums);
  }


  template <int dim>
  void CellMatrices<dim>::find_factors(const std::vector<Cell>         &cells,
                                       const std::vector<unsigned int> &nodes,
                                       CrackSideFactors::Sums          &sums)
  {
    std::vector<types::global_dof_index> &indices = matrices.indices;
    for (const Cell &cell : cells)
      if (cell->is_locally_owned() && cut_by_cracks.is_cut(cell))
        {
          cell->get_dof_indices(indices);
          sums.mark(indices);
        }
    sums.marked.compress(VectorOperation::max);
    if (bonds != nullptr)
      bonds->mark_broken(nodes, sums);
    sums.marked.update_ghost_values();
    for (const Cell &cell : cells)
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(indices);
          if (!sums.any_marked(indices))
            continue;
          assemble_cut(cell, true);
          sums.add(cell, indices, matrices.stiffness, dim * material.center_conductivity(cell));
          for (const auto &pair : separated)
            sums.add_crossing(indices[pair.a],
                              indices[pair.b],
                              (cell->vertex(pair.b) - cell->vertex(pair.a)).norm_square(),
                              {pair.kept, pair.whole});
        }
    sums.compress();
    if (bonds != nullptr)
      bonds->add_traces(nodes, sums);
    if (cut_by_cracks.conducts())
      sums.leave_out_uncrossed(nodes);
    factors.find(nodes, sums);
  }


  template <int dim>
  void CellMatrices<dim>::add_heat(const Vector &u, Balance &balance) const
  {
    std::vector<std::pair<unsigned int, int>> crossed;
    u.update_ghost_values();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && cut_by_cracks.is_cut(cell))
        {
          assemble(cell);
          const auto &indices = matrices.indices;
          for (const unsigned int a : cell->vertex_indices())
            for (unsigned int b = 0; b < a; ++b)
              {
                crossed.clear();
                cut_by_cracks.kept_fraction(cell, a, b, pair_conductivity(cell), &crossed);
                for (const auto &[crack, side] : crossed)
                  balance.cracks[crack] +=
                    side * -matrices.stiffness(a, b) * (u(indices[b]) - u(indices[a]));
              }
        }
    u.set_ghost_state(false);
  }


  template <int dim>
  double CellMatrices<dim>::lowest_remainder() const
  {
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && assemble_whole(cell, true))
        lowest = std::min(
          lowest,
          lowest_eigenvalue(matrices.stiffness) /
            (material.center_conductivity(cell) * std::pow(cell->measure(), 1. - 2. / dim)));
    return Utilities::MPI::min(lowest, dofs.get_communicator());
  }


  PERIDEAL_INSTANTIATE_CLASS(class CellMatrices);
} // namespace PeriDeal
