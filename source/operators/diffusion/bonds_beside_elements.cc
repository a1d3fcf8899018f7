// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/operators/diffusion/bonds_beside_elements.h>

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
    , in_form(coupled->has_form())
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
  typename BondsBesideElements<dim>::Rows BondsBesideElements<dim>::rows(
    const std::vector<unsigned int> &nodes) const
  {
    std::vector<typename Coupling<dim>::Bond> bonds;
    Rows                                      rows(nodes.size());
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
    add(matrix, nodes, rows(nodes));
  }


  template <int dim>
  void BondsBesideElements<dim>::add(TrilinosWrappers::SparseMatrix  &matrix,
                                     const std::vector<unsigned int> &nodes,
                                     const Rows                      &rows) const
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
  typename BondsBesideElements<dim>::Rows BondsBesideElements<dim>::apply_change(
    const ChangeSet<dim>            &change,
    const std::vector<unsigned int> &nodes)
  {
    Rows old;
    if (!in_form)
      old = rows(nodes);
    coupled->apply_change(change);
    recount = true;
    return old;
  }


  template <int dim>
  void BondsBesideElements<dim>::add_changes(const std::vector<unsigned int> &nodes,
                                             const Rows                      &old,
                                             TrilinosWrappers::SparseMatrix  &matrix,
                                             RowSet                          &touched) const
  {
    if (in_form)
      return;
    Rows                           rows = this->rows(nodes);
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
    add(matrix, nodes, rows);
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
  void BondsBesideElements<dim>::make_form()
  {
    set_form_factors();
    form = coupled->make_form();
    form_sums.resize(layout->locally_owned_size());
    form->row_sums(form_sums.data());
  }


  template <int dim>
  void BondsBesideElements<dim>::change_form(const std::vector<unsigned int> &nodes,
                                             RowSet                          &touched)
  {
    set_form_factors();
    form->update_rows(nodes, form_sums.data());
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
    coupled->set_form_factors(std::move(list));
  }


  template <int dim>
  void BondsBesideElements<dim>::take_remainder(const TrilinosWrappers::SparseMatrix &matrix)
  {
    remainder   = Remainder();
    double size = 0.;
    for_each_entry(matrix, [&](const unsigned int, const auto, const double value) {
      size = std::max(size, std::abs(value));
    });
    // What is left of two equal terms is round-off, another on each number of processes.
    const double nothing = 1e-14 * Utilities::MPI::max(size, layout->get_mpi_communicator());
    for_each_entry(matrix, [&](const unsigned int i, const auto column, const double value) {
      if (std::abs(value) <= nothing)
        return;
      if (remainder.rows.empty() || remainder.rows.back() != i)
        {
          remainder.rows.push_back(i);
          remainder.starts.push_back(remainder.columns.size());
        }
      remainder.columns.push_back(layout->global_to_local(column));
      remainder.values.push_back(value);
    });
    remainder.starts.push_back(remainder.columns.size());
  }


  template <int dim>
  void BondsBesideElements<dim>::add_remainder(Vector            &y,
                                               const Vector      &x,
                                               const unsigned int begin,
                                               const unsigned int end) const
  {
    const auto first = std::lower_bound(remainder.rows.begin(), remainder.rows.end(), begin);
    for (auto row = first; row != remainder.rows.end() && *row < end; ++row)
      {
        const std::size_t k   = row - remainder.rows.begin();
        double            sum = 0.;
        for (unsigned int e = remainder.starts[k]; e < remainder.starts[k + 1]; ++e)
          sum += remainder.values[e] * x.local_element(remainder.columns[e]);
        y.local_element(*row) += sum;
      }
  }


  template <int dim>
  void BondsBesideElements<dim>::multiply_then(Vector                     &y,
                                               const Vector               &x,
                                               const Operator::RowsAction &finish) const
  {
    x.update_ghost_values();
    form->apply(y.begin(),
                x.begin(),
                nullptr,
                [&](const unsigned int begin, const unsigned int end) {
                  add_remainder(y, x, begin, end);
                  finish(begin, end);
                });
    x.set_ghost_state(false);
  }


  template <int dim>
  double BondsBesideElements<dim>::sum_of(const unsigned int node) const
  {
    return in_form ? form_sums[node] : 0.;
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
    std::vector<typename Coupling<dim>::Bond> bonds;
    std::vector<std::pair<unsigned int, int>> crossed;
    const Families<dim>                      &families = coupled->families();
    u.update_ghost_values();
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      if (coupled->in_zone(i) && families.near_crack(i))
        {
          coupled->bonds_of(i, bonds);
          for (const auto &bond : bonds)
            if (bond.cut && bond.weight > 0.)
              {
                families.cracks().crossed_cracks(i, bond.neighbor, crossed);
                for (const auto &[crack, side] : crossed) // each bond is seen from both of its ends
                  balance.cracks[crack] += 0.5 * side * bond.weight *
                                           (u.local_element(bond.neighbor) - u.local_element(i));
              }
        }
    u.set_ghost_state(false);
  }


  template <int dim>
  void BondsBesideElements<dim>::add_to(OperatorSize &size) const
  {
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
    size.memory += coupled->memory_consumption() + coupled->families().nodes().memory_consumption();
    if (!in_form)
      return;
    size.form     = form->name();
    size.nonzeros = Utilities::MPI::sum(remainder.values.size() + form->n_stored(),
                                        layout->get_mpi_communicator());
  }


  template class BondsBesideElements<1>;
  template class BondsBesideElements<2>;
  template class BondsBesideElements<3>;
} // namespace PeriDeal
