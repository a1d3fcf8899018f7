// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Whole families beside elastic finite elements, and how many bonds there are.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>
#include <cmath>

#include "elastic_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void ElasticElements<dim>::unknowns_of(const typename ElasticCoupling<dim>::Family &family,
                                         std::vector<types::global_dof_index>        &indices) const
  {
    indices.clear();
    for (const unsigned int j : family.nodes)
      for (unsigned int d = 0; d < dim; ++d)
        indices.push_back(dim * nodes->local_to_global(j) + d);
  }


  template <int dim>
  void ElasticElements<dim>::add_family_pattern(TrilinosWrappers::SparsityPattern &pattern) const
  {
    std::vector<types::global_dof_index> indices;
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      coupling->visit_nodes_of_family(i, [&](const auto &family) {
        unknowns_of(family, indices);
        for (unsigned int a = 0; a < indices.size(); ++a)
          if (family.has_row[a / dim])
            pattern.add_entries(indices[a], indices.begin(), indices.end());
      });
  }


  template <int dim>
  double ElasticElements<dim>::add_families(TrilinosWrappers::SparseMatrix &matrix,
                                            const bool                      intact) const
  {
    std::vector<types::global_dof_index> indices;
    double                               n = 0.;
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      coupling->visit_family(i, intact, {}, [&](const auto &family) {
        unknowns_of(family, indices);
        n += family.n_bonds;
        for (unsigned int a = 0; a < indices.size(); ++a)
          if (family.has_row[a / dim])
            matrix.add(indices[a],
                       static_cast<types::global_dof_index>(indices.size()),
                       indices.data(),
                       &family.stiffness(a, 0));
      });
    return n;
  }


  template <int dim>
  void ElasticElements<dim>::add_thermal_families()
  {
    if (!any_thermal())
      return;
    std::vector<types::global_dof_index> indices;
    double                               energy = 0.;
    const auto strain = [&](const unsigned int node) { return this->thermal_strain_at(node); };
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      coupling->visit_family(i, false, strain, [&](const auto &family) {
        unknowns_of(family, indices);
        for (unsigned int a = 0; a < indices.size(); ++a)
          thermal_loads(indices[a]) += family.thermal(a);
        energy += family.thermal_energy;
      });
    thermal_energy += Utilities::MPI::sum(energy, dofs.get_communicator());
  }


  template <int dim>
  void ElasticElements<dim>::count_bonds(const double n_in_families)
  {
    std::vector<typename ElasticCoupling<dim>::Bond> bonds;
    double                                           n_pairs = 0.;
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      {
        coupling->bonds_of(i, bonds); // at each end
        n_pairs += 0.5 * std::count_if(bonds.begin(), bonds.end(), [](const auto &bond) {
                     return !bond.cut;
                   });
      }
    n_bonds = std::llround(Utilities::MPI::sum(n_pairs + n_in_families, dofs.get_communicator()));
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template void ElasticElements<dim>::add_family_pattern(TrilinosWrappers::SparsityPattern &)      \
    const;                                                                                         \
  template double ElasticElements<dim>::add_families(TrilinosWrappers::SparseMatrix &, const bool) \
    const;                                                                                         \
  template void ElasticElements<dim>::add_thermal_families();                                      \
  template void ElasticElements<dim>::count_bonds(const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
