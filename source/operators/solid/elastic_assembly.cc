// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/interleaved.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/parts/event_work.h>
#include <perideal/operators/parts/lumped_mass.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "elastic_cell_data.h"
#include "loose_nodes.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void ElasticElements<dim>::change_cell(const Cell &cell, CellData &data) const
  {
    if (zone_bonds && zone_bonds->leave_remainder(cell, data.stiffness))
      {
        // The remainder carries a uniform thermal strain like the whole cell less its bonds.
        double change = 0.;
        if (this->temperature_change().size() == 0)
          change = body.elasticity.temperature_change.value(cell->center());
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
    double factor = cut_by_cracks.kept_of_removed(cell);
    factor *= crack_factors.of_cell(data.indices);
    if (factor == 1.)
      return;
    data.stiffness *= factor;
    data.thermal *= factor;
    data.thermal_energy *= factor;
  }


  template <int dim>
  TrilinosWrappers::SparsityPattern ElasticElements<dim>::element_pattern() const
  {
    const IndexSet owned    = unknowns->locally_owned_range();
    IndexSet       relevant = unknowns->ghost_indices();
    relevant.add_indices(owned);
    TrilinosWrappers::SparsityPattern pattern(owned, owned, relevant, dofs.get_communicator());
    CellData                         &data = *cell_data;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          data.set_indices(cell);
          hanging.add_to(pattern, data.unknowns);
        }
    return pattern;
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
  void ElasticElements<dim>::find_crack_factors()
  {
    const Vector           layout(nodes);
    CrackSideFactors::Sums sums(layout);
    crack_factors.start(layout); // sums are those without factors
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && cut_by_cracks.is_cut(cell))
        {
          cell->get_dof_indices(cell_data->indices);
          sums.mark(cell_data->indices);
        }
    sums.marked.compress(VectorOperation::max);
    zone_bonds->add_to(sums);
    for_each_own_cell([&](const Cell &cell, CellData &data) {
      change_cell(cell, data);
      const Moduli moduli = body.material.moduli(cell->center());
      const double mu     = dim == 1 ? 0.5 * moduli.young() : moduli.shear,
                   lambda = dim == 1 ? 0. : lambda_of(moduli, dim, body.elasticity.plane);
      sums.add(cell, data.indices, data.stiffness, dim * lambda + dim * (dim + 1) * mu);
    });
    sums.compress();
    std::vector<unsigned int> owned(nodes->locally_owned_size());
    std::iota(owned.begin(), owned.end(), 0);
    crack_factors.find(owned, sums);
  }


  template <int dim>
  void ElasticElements<dim>::assemble()
  {
    cell_data = std::make_unique<CellData>(dofs.get_fe());
    stiffness.reinit(pattern());
    if (scales_beside_cracks())
      find_crack_factors();
    mass          = 0.;
    thermal_loads = 0.;
    volumes.reinit(nodes);
    double energy = 0.;
    for_each_own_cell([&](const Cell &cell, CellData &of_cell) {
      change_cell(cell, of_cell);
      add_thermal(of_cell, energy);
      stiffness.add(hanging, of_cell.stiffness, of_cell.unknowns);
      make_positive(of_cell.diagonal, of_cell.mass);
      for (unsigned int i = 0; i < of_cell.unknowns.size(); ++i)
        mass(of_cell.unknowns[i]) += of_cell.mass(i / dim);
      for (unsigned int i = 0; i < of_cell.indices.size(); ++i)
        volumes(of_cell.indices[i]) += of_cell.volume(i);
    });
    if (breaking)
      set_all_bonds();
    else if (zone_bonds)
      n_bonds = zone_bonds->add_to(stiffness.sparse(), crack_factors);
    finish_thermal(energy);
    stiffness.compress();
    mass.compress(VectorOperation::add);
    hanging.condense(mass);
    // Their masters have it; as good as nothing, but a mass.
    hanging.set(mass, std::numeric_limits<double>::epsilon() * mass.l1_norm() / mass.size());
    volumes.compress(VectorOperation::add);
    find_diagonal();
  }


  template <int dim>
  bool ElasticElements<dim>::scales_beside_cracks() const
  {
    return body.peridynamics.scales_beside_cracks() && zone_bonds && !body.cracks.cracks.empty();
  }


  template <int dim>
  void ElasticElements<dim>::find_diagonal()
  {
    stiffness.for_each_entry([&](const unsigned int i, const auto column, const double value) {
      if (column == unknowns->local_to_global(i))
        stiffness_diagonal.local_element(i) = value;
    });
    if (breaking)
      breaking->bonds.add_diagonal(stiffness_diagonal);
    conditions->mask(stiffness_diagonal, 1.);
    if (breaking && breaking->n_broken_pairs() > 0)
      hold_loose(stiffness_diagonal);
    else
      throw_if_isolated();
  }


  template <int dim>
  void ElasticElements<dim>::add_parts(const std::vector<Cell>         &of_cells,
                                       const std::vector<unsigned int> &of_nodes,
                                       const double                     multiple)
  {
    for (const Cell &cell : of_cells)
      if (cell->is_locally_owned())
        {
          cell_data->values.reinit(cell);
          cell_data->set_indices(cell);
          cell_data->assemble(*this);
          change_cell(cell, *cell_data);
          cell_data->stiffness *= multiple;
          stiffness.add(hanging, cell_data->stiffness, cell_data->unknowns);
        }
    if (breaking)
      breaking->bonds.set_rows(of_nodes, crack_factors);
    else if (zone_bonds)
      n_bonds += zone_bonds->add_to(stiffness.sparse(), crack_factors, of_nodes, multiple);
  }


  template <int dim>
  template <typename MakeChange>
  void ElasticElements<dim>::mend(const Boxes      &boxes,
                                  const double      of_cells,
                                  const MakeChange &make_change)
  {
    if (scales_beside_cracks()) // factors of cells and bonds change farther away
      {
        make_change(nullptr);
        assemble();
        return;
      }
    if (!search)
      search = std::make_unique<CellSearch<dim>>(dofs);
    std::vector<Cell> cells;
    search->find(boxes, of_cells, cells);
    const std::vector<unsigned int> near = zone_bonds ? zone_bonds->nodes_near(boxes) :
                                                        std::vector<unsigned int>();
    add_parts(cells, near, -1.);
    make_change(&cells);
    add_parts(cells, near, 1.);
    stiffness.compress();
    if (any_thermal())
      find_thermal();
  }


  template <int dim>
  bool ElasticElements<dim>::join_zone(const ChangeSet<dim> &change)
  {
    if (!zone_bonds || change.cuts.empty())
      return false;
    const Boxes joins = boxes_beside(change.cuts,
                                     zone_bonds->coupling().joining_by(change.to),
                                     dofs.get_communicator());
    if (joins.empty())
      return false;
    mend(joins, zone_bonds->reach(), [&](const std::vector<Cell> *) {
      zone_bonds->join(change.to);
    });
    return true;
  }


  template <int dim>
  void ElasticElements<dim>::apply_change(const ChangeSet<dim> &change, const bool)
  {
    const auto pieces = this->history.pieces(change.to);
    mend(change.cuts, 0., [&](const std::vector<Cell> *cells) {
      if (cells)
        cut_by_cracks.set(*cells, pieces, 0.);
      else
        cut_by_cracks.set(pieces, 0.);
      if (zone_bonds)
        zone_bonds->apply_change(change);
    });
    if (!parted.empty())
      note_parted(known_cells());
    find_diagonal();
    this->keep_constant_loads();
  }


  template <int dim>
  bool ElasticElements<dim>::any_thermal() const
  {
    const Expression &change = body.elasticity.temperature_change;
    return this->temperature_change().size() > 0 || !change.is_constant() ||
           change.value(Point<dim>()) != 0.;
  }


  template <int dim>
  void ElasticElements<dim>::add_thermal(const CellData &data, double &energy)
  {
    energy += data.thermal_energy;
    for (unsigned int i = 0; i < data.unknowns.size(); ++i)
      thermal_loads(data.unknowns[i]) += data.thermal(i);
  }


  template <int dim>
  void ElasticElements<dim>::finish_thermal(const double energy)
  {
    thermal_energy = Utilities::MPI::sum(energy, dofs.get_communicator());
    if (breaking && any_thermal())
      {
        std::vector<double> strains(positions.size());
        for (unsigned int i = 0; i < strains.size(); ++i)
          strains[i] = this->thermal_strain_at(i);
        breaking->set_thermal(std::move(strains));
        thermal_energy +=
          Utilities::MPI::sum(breaking->bonds.add_thermal(thermal_loads,
                                                          breaking->bonds.nodes(),
                                                          breaking->thermal_strains(),
                                                          1.),
                              dofs.get_communicator());
      }
    else if (zone_bonds && any_thermal())
      thermal_energy +=
        Utilities::MPI::sum(zone_bonds->add_thermal(thermal_loads,
                                                    crack_factors,
                                                    [this](const unsigned int node) {
                                                      return this->thermal_strain_at(node);
                                                    }),
                            dofs.get_communicator());
    thermal_loads.compress(VectorOperation::add);
    hanging.condense(thermal_loads);
  }


  template <int dim>
  void ElasticElements<dim>::set_temperature_change(const Vector &nodal)
  {
    this->keep_temperature_change(nodal);
    this->set_contact_strains();
    find_thermal();
    this->keep_constant_loads();
  }


  template <int dim>
  void ElasticElements<dim>::find_thermal()
  {
    thermal_loads = 0.;
    thermal_loads.zero_out_ghost_values();
    double energy = 0.;
    for_each_own_cell([&](const Cell &cell, CellData &of_cell) {
      change_cell(cell, of_cell);
      add_thermal(of_cell, energy);
    });
    finish_thermal(energy);
  }


  template <int dim>
  void ElasticElements<dim>::find_loads(Vector &loads, const double t) const
  {
    loads = thermal_loads;
    loads.zero_out_ghost_values();
    mechanical.for_each(t, [&](const auto, const auto unknown, const auto, const double value) {
      loads(unknown) += value;
    });
    loads.compress(VectorOperation::add);
    hanging.condense(loads);
  }


  template <int dim>
  ForceBalance ElasticElements<dim>::forces(const Vector &u, const double t) const
  {
    Vector loads, reactions;
    this->initialize_vector(loads);
    this->initialize_vector(reactions);
    find_loads(loads, t);
    multiply(reactions, u);
    contact->add_forces(reactions, u, 1.);
    std::map<types::boundary_id, Tensor<1, dim>> sums;
    if (zone_bonds)
      for (const types::boundary_id side : zone_bonds->mirrors())
        for (unsigned int i = side / 2; i < reactions.locally_owned_size(); i += dim)
          sums[side][side / 2] -= reactions.local_element(i) - thermal_loads.local_element(i);
    reactions -= loads;
    conditions->add_reactions(reactions, sums);
    mechanical.for_each(t, [&](const auto side, const auto, const auto d, const double value) {
      sums[side][d] += value;
    });
    return gather_forces(sums, body, dofs.get_communicator());
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
  void ElasticElements<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &matrix,
                                             const bool                      with_bonds) const
  {
    if (with_bonds && !breaking && !stiffness.shares_rows())
      matrix.reinit(stiffness.sparse());
    else
      {
        TrilinosWrappers::SparsityPattern pattern = element_pattern();
        if (with_bonds && zone_bonds)
          zone_bonds->add_pattern(pattern, false);
        pattern.compress();
        matrix.reinit(pattern);
      }
    for_each_own_cell([&](const Cell &cell, CellData &data) {
      if (with_bonds && zone_bonds)
        zone_bonds->leave_remainder(cell, data.stiffness);
      hanging.add_to(matrix, data.stiffness, data.unknowns);
    });
    if (with_bonds && zone_bonds)
      zone_bonds->add_intact(matrix);
    matrix.compress(VectorOperation::add);
  }


  template <int dim>
  double ElasticElements<dim>::lowest_remainder() const
  {
    double lowest = std::numeric_limits<double>::infinity();
    if (zone_bonds)
      for_each_own_cell([&](const Cell &cell, CellData &data) {
        if (zone_bonds->leave_remainder(cell, data.stiffness))
          lowest = std::min(lowest,
                            lowest_eigenvalue(data.stiffness) /
                              (body.material.moduli(cell->center()).shear *
                               std::pow(cell->measure(), 1. - 2. / dim)));
      });
    return Utilities::MPI::min(lowest, dofs.get_communicator());
  }


  template <int dim>
  OperatorSize ElasticElements<dim>::size() const
  {
    OperatorSize size;
    size.unknowns = unknowns->size();
    size.nonzeros = stiffness.n_entries();
    size.bonds    = std::llround(
      Utilities::MPI::sum(breaking ? breaking->bonds.n_whole() : n_bonds, dofs.get_communicator()));
    size.memory = stiffness.memory_consumption() + positions.capacity() * sizeof(Point<dim>);
    if (zone_bonds)
      size.memory += zone_bonds->coupling().memory_consumption();
    if (breaking)
      size.memory += breaking->memory_consumption();
    size.form = "matrix";
    return size;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                 \
  template void ElasticElements<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &) const; \
  template void ElasticElements<dim>::assemble();                                                 \
  template bool ElasticElements<dim>::join_zone(const ChangeSet<dim> &);                          \
  template void ElasticElements<dim>::apply_change(const ChangeSet<dim> &, const bool);           \
  template void ElasticElements<dim>::set_temperature_change(const Vector &);                     \
  template void ElasticElements<dim>::find_loads(Vector &, const double) const;                   \
  template ForceBalance ElasticElements<dim>::forces(const Vector &, const double) const;         \
  template void         ElasticElements<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &,   \
                                                      const bool) const;                  \
  template double       ElasticElements<dim>::lowest_remainder() const;                           \
  template OperatorSize ElasticElements<dim>::size() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
