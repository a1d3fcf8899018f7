// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds and cracks beside elastic finite elements.

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/spectrum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "elastic_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  bool ElasticElements<dim>::any_thermal() const
  {
    const Expression &change = scene.elasticity.temperature_change;
    return this->temperature_change().size() > 0 || !change.is_constant() ||
           change.value(Point<dim>()) != 0.;
  }


  template <int dim>
  void ElasticElements<dim>::change_cell(const Cell &cell, CellData &data) const
  {
    if (coupling && coupling->change_cell(cell, data.stiffness))
      {
        // The remainder carries a uniform thermal strain like the whole cell less its bonds.
        double change = 0.;
        if (this->temperature_change().size() == 0)
          change = scene.elasticity.temperature_change.value(cell->center());
        else
          for (const auto i : data.indices)
            change += this->temperature_change()(i) / data.indices.size();
        const double           strain = this->thermal_strain(cell->center(), change);
        dealii::Vector<double> free(data.thermal.size());
        for (unsigned int a = 0; a < data.indices.size(); ++a)
          for (unsigned int d = 0; d < dim; ++d)
            free(dim * a + d) = strain * (cell->vertex(a)[d] - cell->center()[d]);
        data.stiffness.vmult(data.thermal, free);
        data.thermal_energy = 0.5 * (free * data.thermal);
      }
    double factor = cut_by_cracks.is_cut(cell) ? 0. : 1.;
    factor *= crack_factors.of_cell(data.indices);
    if (factor == 1.)
      return;
    data.stiffness *= factor;
    data.thermal *= factor;
    data.thermal_energy *= factor;
  }


  template <int dim>
  void ElasticElements<dim>::add_bond_pattern(TrilinosWrappers::SparsityPattern &pattern) const
  {
    std::vector<typename ElasticCoupling<dim>::Bond> bonds;
    std::vector<types::global_dof_index>             columns;
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      {
        coupling->bonds_of(i, bonds);
        if (bonds.empty())
          continue;
        columns.clear();
        for (const auto &bond : bonds)
          for (unsigned int d = 0; d < dim; ++d)
            columns.push_back(dim * nodes->local_to_global(bond.neighbor) + d);
        for (unsigned int d = 0; d < dim; ++d)
          columns.push_back(dim * nodes->local_to_global(i) + d);
        for (unsigned int d = 0; d < dim; ++d)
          pattern.add_entries(dim * nodes->local_to_global(i) + d, columns.begin(), columns.end());
      }
  }


  template <int dim>
  void ElasticElements<dim>::add_bonds(TrilinosWrappers::SparseMatrix &matrix,
                                       const bool                      intact) const
  {
    std::vector<typename ElasticCoupling<dim>::Bond> bonds;
    std::vector<types::global_dof_index>             columns;
    std::vector<double>                              values[dim];
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      {
        coupling->bonds_of(i, bonds);
        if (bonds.empty())
          continue;
        const auto own = nodes->local_to_global(i);
        columns.clear();
        for (unsigned int c = 0; c < dim; ++c)
          {
            columns.push_back(dim * own + c);
            values[c].assign(dim, 0.);
          }
        for (const auto &bond : bonds)
          {
            if (bond.cut && !intact)
              continue;
            const double factor = intact ? 1. : crack_factors.of_bond(i, bond.neighbor);
            for (unsigned int e = 0; e < dim; ++e)
              columns.push_back(dim * nodes->local_to_global(bond.neighbor) + e);
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int e = 0; e < dim; ++e)
                {
                  values[c].push_back(-factor * bond.block[c][e]);
                  values[c][e] += factor * bond.block[c][e];
                }
          }
        for (unsigned int c = 0; c < dim; ++c)
          matrix.add(dim * own + c, columns.size(), columns.data(), values[c].data());
      }
  }


  template <int dim>
  void ElasticElements<dim>::add_thermal_bonds()
  {
    if (!any_thermal())
      return;
    std::vector<typename ElasticCoupling<dim>::Bond> bonds;
    double                                           energy = 0.;
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      {
        coupling->bonds_of(i, bonds);
        for (const auto &bond : bonds)
          {
            if (bond.cut)
              continue;
            const double         factor = crack_factors.of_bond(i, bond.neighbor);
            const Tensor<1, dim> xi     = positions[bond.neighbor] - positions[i];
            const double         strain =
              0.5 * (this->thermal_strain_at(i) + this->thermal_strain_at(bond.neighbor));
            const Tensor<1, dim> force = factor * strain * (bond.block * xi);
            for (unsigned int d = 0; d < dim; ++d)
              thermal_loads.local_element(dim * i + d) -= force[d];
            energy += 0.25 * strain * (force * xi); // each bond is seen from both of its ends
          }
      }
    thermal_energy += Utilities::MPI::sum(energy, dofs.get_communicator());
  }


  template <int dim>
  void ElasticElements<dim>::find_crack_factors()
  {
    const Vector                                     layout(nodes);
    CrackSideFactors::Sums                           sums(layout);
    std::vector<unsigned int>                        owned(nodes->locally_owned_size());
    std::vector<typename ElasticCoupling<dim>::Bond> bonds;
    std::iota(owned.begin(), owned.end(), 0);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && cut_by_cracks.is_cut(cell))
        {
          cell->get_dof_indices(cell_data->indices);
          sums.mark(cell_data->indices);
        }
    sums.marked.compress(VectorOperation::max);
    for (const unsigned int i : owned)
      {
        coupling->bonds_of(i, bonds);
        if (std::any_of(bonds.begin(), bonds.end(), [](const auto &bond) { return bond.cut; }))
          sums.marked.local_element(i) = 1.;
        for (const auto &bond : bonds)
          if (!bond.cut)
            sums.trace.local_element(i) +=
              0.5 * trace(bond.block) * (positions[bond.neighbor] - positions[i]).norm_square();
      }
    for_each_own_cell([&](const Cell &cell, CellData &data) {
      change_cell(cell, data);
      const Moduli moduli = scene.material.moduli(cell->center());
      const double mu     = dim == 1 ? 0.5 * moduli.young() : moduli.shear,
                   lambda = dim == 1 ? 0. : lambda_of(moduli, dim, scene.elasticity.plane);
      sums.add(cell, data.indices, data.stiffness, dim * lambda + dim * (dim + 1) * mu);
    });
    sums.compress();
    crack_factors.start(layout);
    crack_factors.find(owned, sums);
  }


  template <int dim>
  void ElasticElements<dim>::throw_if_isolated() const
  {
    const double largest = stiffness_diagonal.linfty_norm();
    std::string  message;
    for (unsigned int i = 0; i < stiffness_diagonal.locally_owned_size() && message.empty(); ++i)
      {
        const std::string fault = coupling && i % dim == 0 ? coupling->fault_of(i / dim) : "";
        if (!fault.empty())
          message =
            "The node at " + this->place_of(i) + fault +
            " Check 'Horizon' in section 'Peridynamics' and the cracks in section 'Cracks'.";
        else if (!(stiffness_diagonal.local_element(i) > 1e-13 * largest))
          message =
            "The node at " + this->place_of(i) +
            " is isolated: cracks cut all cells around it, and no bond holds it. Use " +
            (coupling ?
               "fewer cracks, or a wider 'Zone' in section 'Coupling' where only a part of the body has bonds." :
               "'Models = coupled' with a zone around the cracks, or 'Mesh = "
               "faces' in section 'Cracks'.");
      }
    throw_on_all_if_any(dofs.get_communicator(), message);
  }


  template <int dim>
  void ElasticElements<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &matrix,
                                             const bool                      with_bonds) const
  {
    if (with_bonds)
      matrix.reinit(stiffness);
    else
      {
        TrilinosWrappers::SparsityPattern pattern = element_pattern();
        pattern.compress();
        matrix.reinit(pattern);
      }
    for_each_own_cell([&](const Cell &cell, CellData &data) {
      if (with_bonds && coupling)
        coupling->change_cell(cell, data.stiffness);
      data.add_stiffness_to(matrix);
    });
    if (with_bonds && coupling)
      {
        add_bonds(matrix, true);
        add_families(matrix, true);
      }
    matrix.compress(VectorOperation::add);
  }


  template <int dim>
  double ElasticElements<dim>::lowest_remainder() const
  {
    double lowest = std::numeric_limits<double>::infinity();
    if (coupling)
      for_each_own_cell([&](const Cell &cell, CellData &data) {
        if (coupling->change_cell(cell, data.stiffness))
          lowest = std::min(lowest,
                            lowest_eigenvalue(data.stiffness) /
                              (scene.material.moduli(cell->center()).shear *
                               std::pow(cell->measure(), 1. - 2. / dim)));
      });
    return Utilities::MPI::min(lowest, dofs.get_communicator());
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template void ElasticElements<dim>::change_cell(const Cell &, CellData &) const;                 \
  template void ElasticElements<dim>::add_bond_pattern(TrilinosWrappers::SparsityPattern &) const; \
  template void ElasticElements<dim>::add_bonds(TrilinosWrappers::SparseMatrix &, const bool)      \
    const;                                                                                         \
  template bool   ElasticElements<dim>::any_thermal() const;                                       \
  template void   ElasticElements<dim>::add_thermal_bonds();                                       \
  template void   ElasticElements<dim>::find_crack_factors();                                      \
  template void   ElasticElements<dim>::throw_if_isolated() const;                                 \
  template double ElasticElements<dim>::lowest_remainder() const;                                  \
  template void   ElasticElements<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &,          \
                                                      const bool) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
