// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Whole families beside elastic finite elements, and how many bonds there are.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>

#include "elastic_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  /** Call visit(family, its unknowns) for what the families of the own nodes add. */
  template <int dim>
  template <typename Visit>
  void ElasticElements<dim>::for_each_family(const bool intact, const Visit &visit) const
  {
    std::vector<types::global_dof_index> unknowns_of_family;
    const bool                           warm = any_thermal();
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      coupling->visit_family(
        i,
        intact,
        [&](const unsigned int node) { return warm ? thermal_strain_at(node) : 0.; },
        [&](const auto &family) {
          unknowns_of_family.clear();
          for (const unsigned int j : family.nodes)
            for (unsigned int d = 0; d < dim; ++d)
              unknowns_of_family.push_back(dim * nodes->local_to_global(j) + d);
          visit(family, unknowns_of_family);
        });
  }


  template <int dim>
  void ElasticElements<dim>::add_family_pattern(TrilinosWrappers::SparsityPattern &pattern) const
  {
    for_each_family(true, [&](const auto &, const auto &indices) {
      for (const auto row : indices)
        pattern.add_entries(row, indices.begin(), indices.end());
    });
  }


  template <int dim>
  void ElasticElements<dim>::add_families(TrilinosWrappers::SparseMatrix &matrix,
                                          const bool                      intact) const
  {
    for_each_family(intact, [&](const auto &family, const auto &indices) {
      for (unsigned int a = 0; a < indices.size(); ++a)
        matrix.add(indices[a],
                   static_cast<types::global_dof_index>(indices.size()),
                   indices.data(),
                   &family.stiffness(a, 0));
    });
  }


  template <int dim>
  void ElasticElements<dim>::add_thermal_families()
  {
    if (!any_thermal())
      return;
    double energy = 0.;
    for_each_family(false, [&](const auto &family, const auto &indices) {
      for (unsigned int a = 0; a < indices.size(); ++a)
        thermal_loads(indices[a]) += family.thermal(a);
      energy += family.thermal_energy;
    });
    thermal_energy += Utilities::MPI::sum(energy, dofs.get_communicator());
  }


  template <int dim>
  void ElasticElements<dim>::count_bonds()
  {
    std::vector<typename ElasticCoupling<dim>::Bond> bonds;
    unsigned long long                               n_ends = 0;
    for (unsigned int i = 0; i < nodes->locally_owned_size(); ++i)
      {
        coupling->bonds_of(i, bonds);
        n_ends +=
          std::count_if(bonds.begin(), bonds.end(), [](const auto &bond) { return !bond.cut; });
      }
    for_each_family(false, [&](const auto &family, const auto &) { n_ends += family.n_bonds; });
    n_bonds = Utilities::MPI::sum(n_ends, dofs.get_communicator()) / 2;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                \
  template void ElasticElements<dim>::add_family_pattern(TrilinosWrappers::SparsityPattern &)    \
    const;                                                                                       \
  template void ElasticElements<dim>::add_families(TrilinosWrappers::SparseMatrix &, const bool) \
    const;                                                                                       \
  template void ElasticElements<dim>::add_thermal_families();                                    \
  template void ElasticElements<dim>::count_bonds();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
