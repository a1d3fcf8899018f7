// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <perideal/operators/solid/elastic_elements.h>

namespace PeriDeal
{
  /**
   * Scratch memory of the cell loops. Rows and columns of a cell are interleaved like the unknowns.
   */
  template <int dim>
  struct ElasticElements<dim>::CellData
  {
    explicit CellData(const dealii::FiniteElement<dim> &fe)
      : values(fe,
               dealii::QGauss<dim>(fe.degree + 1),
               dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points |
                 dealii::update_JxW_values)
      , stiffness(dim * fe.n_dofs_per_cell(), dim * fe.n_dofs_per_cell())
      , thermal(dim * fe.n_dofs_per_cell())
      , mass(fe.n_dofs_per_cell())
      , diagonal(fe.n_dofs_per_cell())
      , volume(fe.n_dofs_per_cell())
      , indices(fe.n_dofs_per_cell())
      , unknowns(dim * fe.n_dofs_per_cell())
    {}

    void set_indices(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell)
    {
      cell->get_dof_indices(indices);
      for (unsigned int i = 0; i < indices.size(); ++i)
        for (unsigned int d = 0; d < dim; ++d)
          unknowns[dim * i + d] = dim * indices[i] + d;
    }

    /** What a cell has without bonds and cracks; values and indices are those of the cell. */
    void assemble(const ElasticElements &of);

    /** At a state u, whose ghosts are up to date. */
    double energy(const Vector &u) const;

    /** What an unknown has of K u, thermal loads apart. */
    double force(const unsigned int unknown, const Vector &u) const
    {
      double sum = 0.;
      for (unsigned int j = 0; j < unknowns.size(); ++j)
        sum += stiffness(unknown, j) * u(unknowns[j]);
      return sum;
    }

    dealii::FEValues<dim>      values;
    dealii::FullMatrix<double> stiffness;
    dealii::Vector<double>     thermal, mass, diagonal, volume; // diagonal: of the mass
    double                     thermal_energy = 0.;
    std::vector<dealii::types::global_dof_index> indices, unknowns;
  };


  /**
   * Call visit(cell, data) with the matrices of each own cell, as they are without bonds and
   * cracks.
   */
  template <int dim>
  template <typename Visit>
  void ElasticElements<dim>::for_each_own_cell(const Visit &visit) const
  {
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell_data->values.reinit(cell);
          cell_data->set_indices(cell);
          cell_data->assemble(*this);
          visit(cell, *cell_data);
        }
  }
} // namespace PeriDeal
