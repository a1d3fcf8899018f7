// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/diffusion/bonds_beside_elements.h>
#include <perideal/operators/lattice/cut_bonds.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  BondsBesideElements<dim>::BondsBesideElements(std::unique_ptr<Coupling<dim>> coupling,
                                                const CrackSideFactors        &factors)
    : coupled(std::move(coupling))
    , factors(factors)
    , layout(coupled->families().nodes().partitioner())
    , in_form(coupled->bonds_of_form() != nullptr)
  {}


  template <int dim>
  bool BondsBesideElements<dim>::leaves_nothing(const typename Coupling<dim>::Cell &cell) const
  {
    return in_form && coupled->leaves_nothing(cell);
  }


  template <int dim>
  void BondsBesideElements<dim>::add_pattern(const DoFHandler<dim>             &dofs,
                                             TrilinosWrappers::SparsityPattern &pattern) const
  {
    std::vector<unsigned int>            neighbors;
    std::vector<types::global_dof_index> columns;
    if (in_form)
      {
        columns.resize(dofs.get_fe().n_dofs_per_cell());
        for (const auto &cell : dofs.active_cell_iterators())
          if (cell->is_locally_owned() && !coupled->leaves_nothing(cell))
            {
              cell->get_dof_indices(columns);
              for (const auto row : columns)
                pattern.add_entries(row, columns.begin(), columns.end());
            }
        return;
      }
    for (unsigned int i = 0; i < layout->locally_owned_size(); ++i)
      {
        coupled->possible_neighbors_of(i, neighbors);
        columns.clear();
        for (const unsigned int j : neighbors)
          columns.push_back(layout->local_to_global(j));
        std::sort(columns.begin(), columns.end()); // which are inserted quicker
        pattern.add_entries(layout->local_to_global(i), columns.begin(), columns.end());
      }
  }


  template <int dim>
  typename BondsBesideElements<dim>::Conductances BondsBesideElements<dim>::rows(
    const std::vector<unsigned int> &nodes) const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    Conductances                              rows(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
      {
        coupled->bonds_of(nodes[k], bonds);
        rows[k].reserve(bonds.size());
        for (const auto &bond : bonds)
          if (bond.weight != 0.)
            rows[k].emplace_back(bond.neighbor,
                                 bond.weight *
                                   (bond.cut ? 1. : factors.of_bond(nodes[k], bond.neighbor)));
      }
    return rows;
  }


  template <int dim>
  void BondsBesideElements<dim>::add_to(TrilinosWrappers::SparseMatrix &matrix) const
  {
    if (in_form)
      return;
    std::vector<unsigned int> nodes(layout->locally_owned_size());
    std::iota(nodes.begin(), nodes.end(), 0);
    add_bonds(matrix, nodes, rows(nodes));
  }


  template <int dim>
  void BondsBesideElements<dim>::add_bonds(TrilinosWrappers::SparseMatrix  &matrix,
                                           const std::vector<unsigned int> &nodes,
                                           const Conductances              &rows) const
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
          matrix.add(own, columns.size(), columns.data(), values.data());
        }
  }


  template <int dim>
  typename BondsBesideElements<dim>::Conductances BondsBesideElements<dim>::change_bonds(
    const ChangeSet<dim>            &change,
    const std::vector<unsigned int> &nodes)
  {
    Conductances old;
    if (!in_form)
      old = rows(nodes);
    coupled->apply_change(change);
    recount = true;
    return old;
  }


  template <int dim>
  void BondsBesideElements<dim>::add_changes(const std::vector<unsigned int> &nodes,
                                             const Conductances              &old,
                                             TrilinosWrappers::SparseMatrix  &matrix,
                                             RowSet                          &touched) const
  {
    if (in_form)
      return;
    Conductances                   rows = this->rows(nodes);
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
          touched.insert(nodes[k]);
      }
    add_bonds(matrix, nodes, rows);
  }


  template <int dim>
  bool BondsBesideElements<dim>::has_damage() const
  {
    return !coupled->families().cracks().broken().empty();
  }


  template <int dim>
  void BondsBesideElements<dim>::take_conductivities_at(const Vector &u)
  {
    coupled->take_conductivities_at(u);
    recount = true;
  }


  template <int dim>
  void BondsBesideElements<dim>::make_form(const OperatorForm wanted)
  {
    set_form_factors();
    const auto &bonds = *coupled->bonds_of_form();
    this->take(takes_lattice_form(wanted, "", true) ? make_lattice_form(bonds) :
                                                      make_stored_form(bonds),
               layout);
  }


  template <int dim>
  void BondsBesideElements<dim>::change_form(const std::vector<unsigned int> &nodes,
                                             RowSet                          &touched)
  {
    set_form_factors();
    this->update_rows(nodes);
    for (const unsigned int i : nodes)
      touched.insert(i);
  }


  template <int dim>
  void BondsBesideElements<dim>::set_form_factors()
  {
    if (factors.empty())
      return;
    std::vector<double> list(coupled->families().nodes().n_local());
    for (unsigned int i = 0; i < list.size(); ++i)
      list[i] = factors.at(i);
    coupled->bonds_of_form()->factors().set(std::move(list), 1, true);
  }


  template <int dim>
  void BondsBesideElements<dim>::mark_broken(const std::vector<unsigned int> &nodes,
                                             CrackSideFactors::Sums          &sums) const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    const Families<dim>                      &families = coupled->families();
    for (const unsigned int i : nodes)
      if (coupled->in_zone(i) && families.near_crack(i))
        {
          coupled->bonds_of(i, bonds);
          if (std::any_of(bonds.begin(), bonds.end(), [](const auto &bond) { return bond.cut; }))
            sums.marked.local_element(i) = 1.;
        }
  }


  template <int dim>
  void BondsBesideElements<dim>::add_traces(const std::vector<unsigned int> &nodes,
                                            CrackSideFactors::Sums          &sums) const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    for (const unsigned int i : nodes)
      if (sums.marked.local_element(i) > 0.)
        {
          coupled->bonds_of(i, bonds);
          for (const auto &bond : bonds)
            {
              const double half_square =
                0.5 * coupled->families().neighbors().bond_vector(i, bond.neighbor).norm_square();
              sums.trace.local_element(i) += bond.weight * half_square;
              if (!bond.cut)
                continue;
              sums.crossing.local_element(i) += bond.weight * half_square;
              sums.crossing_whole.local_element(i) += bond.intact * half_square;
            }
        }
  }


  template <int dim>
  void BondsBesideElements<dim>::add_heat(const Vector &u, Balance &balance) const
  {
    u.update_ghost_values();
    add_heat_of_cut_bonds(
      coupled->families(),
      u,
      [&](const unsigned int i, auto &bonds) { coupled->bonds_of(i, bonds); },
      [](const unsigned int) { return 0.; }, // there are no fictitious nodes
      balance);
    u.set_ghost_state(false);
  }


  template <int dim>
  void BondsBesideElements<dim>::add_to(OperatorSize &size) const
  {
    size.memory += coupled->memory_consumption() + coupled->families().nodes().memory_consumption();
    if (in_form)
      {
        BondTerm<dim>::add_to(size);
        return;
      }
    if (recount)
      {
        std::vector<typename Coupling<dim>::Bond> bonds;
        unsigned long long                        n_ends = 0;
        for (unsigned int i = 0; i < layout->locally_owned_size(); ++i)
          {
            coupled->bonds_of(i, bonds);
            n_ends += std::count_if(bonds.begin(), bonds.end(), [](const auto &bond) {
              return bond.weight != 0.;
            });
          }
        n_bonds = Utilities::MPI::sum(n_ends, layout->get_mpi_communicator()) / 2;
        recount = false;
      }
    size.bonds = n_bonds;
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondsBesideElements);
} // namespace PeriDeal
