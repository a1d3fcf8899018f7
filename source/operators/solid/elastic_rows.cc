// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/operators/bounds/spectrum.h>

#include <algorithm>
#include <cmath>

#include "elastic_cell_data.h"
#include "loose_nodes.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Spectrum ElasticElements<dim>::spectrum() const
  {
    std::vector<double> row_sums(mass.locally_owned_size(), 0.);
    stiffness.for_each_entry([&](const unsigned int row, const auto, const double value) {
      row_sums[row] += std::abs(value);
    });
    if (breaking)
      breaking->bonds.add_row_sums(row_sums);
    for (const unsigned int i : hanging.owned())
      row_sums[i] = 0.;
    double bound = 0.;
    for (unsigned int i = 0; i < row_sums.size(); ++i)
      bound = std::max(bound, row_sums[i] / mass.local_element(i));
    bound = Utilities::MPI::max(bound, dofs.get_communicator());
    return {bound, sharp_bound(*this, bound, [&](Vector &vector) { this->fill_noise(vector); })};
  }


  template <int dim>
  TrilinosWrappers::SparsityPattern ElasticElements<dim>::pattern() const
  {
    TrilinosWrappers::SparsityPattern pattern = element_pattern();
    if (zone_bonds && !breaking)
      zone_bonds->add_pattern(pattern, true);
    pattern.compress();
    return pattern;
  }


  template <int dim>
  void ElasticElements<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    if (!breaking)
      {
        stiffness.copy_to(matrix, pattern());
        hold_unknowns(matrix, this->held_unknowns());
        return;
      }
    matrix.reinit(pattern());
    for_each_own_cell([&](const Cell &cell, CellData &data) {
      if (cut_by_cracks.is_cut(cell) || zone_bonds->is_parted(cell))
        return;
      hanging.add_to(matrix, data.stiffness, data.unknowns);
    });
    breaking->bonds.add_between_vertices(matrix);
    matrix.compress(VectorOperation::add);
    Vector loose = this->held_unknowns();
    mark_loose(matrix, stiffness_diagonal, loose);
    hold_unknowns(matrix, loose);
  }


  template <int dim>
  void ElasticElements<dim>::share_rows_for_steps() const
  {
    if (!this->forgoes_diagonal || stiffness.was_asked_to_share() || hanging.any() ||
        !body.domain.has_lattice() || (zone_bonds && !breaking && this->has_growing_cracks()))
      return;
    std::vector<std::uint64_t> places(positions.size(), 0);
    for (unsigned int i = 0; i < positions.size(); ++i)
      for (unsigned int d = dim; d-- > 0;)
        {
          constexpr double   finer = 8.; // nodes within cells of higher degree
          constexpr int      bits  = 21;
          const Domain<dim> &box   = body.domain;
          const double share = (positions[i][d] - box.lower[d]) / (box.upper[d] - box.lower[d]);
          places[i]          = (places[i] << bits) + std::lround(finer * box.cells[d] * share);
        }
    stiffness.share_rows(nodes, places);
  }


  template <int dim>
  void ElasticElements<dim>::multiply(Vector &y, const Vector &x) const
  {
    share_rows_for_steps();
    const bool is_known = x.has_ghost_elements();
    if (breaking || stiffness.shares_rows())
      x.update_ghost_values();
    stiffness.multiply(y, x);
    if (breaking)
      breaking->bonds.add_forces(y, x);
    x.set_ghost_state(is_known);
    hanging.set(y, 0.); // the nodes they follow from have all of it
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                 \
  template Spectrum                          ElasticElements<dim>::spectrum() const;              \
  template TrilinosWrappers::SparsityPattern ElasticElements<dim>::pattern() const;               \
  template void ElasticElements<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &) const; \
  template void ElasticElements<dim>::multiply(Vector &, const Vector &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
