// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Cut cells that change with time.

#include <deal.II/base/mpi.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/fem_operator.h>
#include <perideal/operators/spectrum.h>

#include <algorithm>
#include <cmath>

#include "fem_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  double FEMOperator<dim>::next_event(const double t) const
  {
    return history.next_event(t);
  }


  template <int dim>
  bool FEMOperator<dim>::update(const double t)
  {
    const double time = history.representative(t);
    if (time == cracks_of || !history.changes_ever())
      return false;
    const auto cuts  = history.changes(cracks_of, time);
    const auto joins = coupling ? coupling->joining_by(time) : std::vector<BoundingBox<dim>>();
    cracks_of        = time;
    if (cuts.empty())
      return false;
    CellData                       &data   = *cell_data;
    const bool                      scaled = crack_factors.size() > 0;
    const double                    reach  = coupling ? coupling->families().reach() : 0.;
    const std::vector<Cell>         near   = cells_near(cuts, joins);
    std::vector<FullMatrix<double>> old(near.size());
    for (std::size_t k = 0; k < near.size(); ++k)
      if (near[k]->is_locally_owned())
        {
          assemble_cell(near[k], data);
          scale_beside_cracks(data);
          old[k] = data.stiffness;
        }
    std::vector<unsigned int> nodes;
    BondRows                  old_rows;
    if (coupling)
      {
        const double wide  = scaled ? reach + 3. * coupling->families().nodes().smallest_spacing() *
                                               std::sqrt(1. * dim) :
                                      0.;
        auto         boxes = cuts;
        boxes.insert(boxes.end(), joins.begin(), joins.end());
        nodes = coupling->families().nodes_near(boxes, reach + wide);
        if (!bonds_apart)
          old_rows = bond_rows(nodes);
        coupling->set_cracks_of(time);
        recount_bonds = true;
      }
    cracks       = make_crack_geometries(history.pieces(time));
    transmission = history.transmission(time);
    for (const Cell &cell : near)
      cut[cell->active_cell_index()] = is_cut(cell);
    if (scaled)
      find_crack_factors(data);
    Vector touched;
    initialize_vector(touched);
    for (std::size_t k = 0; k < near.size(); ++k)
      if (near[k]->is_locally_owned())
        {
          assemble_cell(near[k], data);
          scale_beside_cracks(data);
          data.stiffness.add(-1., old[k]);
          if (data.stiffness.linfty_norm() == 0.)
            continue;
          if (!(bonds_apart && coupling->leaves_nothing(near[k])))
            add_to(stiffness, data.stiffness, data.indices);
          for (const auto i : data.indices)
            {
              touched(i) = 1.;
              if (const auto *masters = constraints.get_constraint_entries(i))
                for (const auto &master : *masters)
                  touched(master.first) = 1.;
            }
        }
    touched.compress(VectorOperation::max);
    if (coupling && !bonds_apart)
      change_bonds(nodes, old_rows, touched);
    stiffness.compress(VectorOperation::add);
    if (bonds_apart)
      change_form(nodes, touched);
    update_rows(touched, Utilities::MPI::max(joins.size(), dofs.get_communicator()) > 0);
    return true;
  }


  template <int dim>
  void FEMOperator<dim>::update_rows(const Vector &touched, const bool zone_moves)
  {
    const auto &partitioner = *stiffness_diagonal.get_partitioner();
    std::string message;
    double      bound = 0.;
    for (unsigned int i = 0; i < touched.locally_owned_size(); ++i)
      if (touched.local_element(i) > 0.)
        {
          double       sum                    = bonds_apart ? 2. * bond_sums[i] : 0.;
          const double from_form              = bonds_apart ? bond_sums[i] : 0.;
          stiffness_diagonal.local_element(i) = from_form;
          for_each_entry_of_row(stiffness, i, [&](const auto column, const double value) {
            sum += std::abs(value);
            if (column == partitioner.local_to_global(i))
              stiffness_diagonal.local_element(i) = from_form + value;
          });
          bound = std::max(bound, sum / capacity.local_element(i));
          // Cells are taken away by subtraction, which leaves round-off behind.
          if (!(sum > 1e-13 * gershgorin * capacity.local_element(i)) && message.empty())
            message =
              coupling ?
                "The node at " + place_of(i) +
                  " becomes isolated: the growing cracks cut all of its bonds and pairs." :
                "'Mesh' in section 'Cracks': the growing cracks leave the finite element node at " +
                  place_of(i) + " without any conducting cell. Use 'pairs' or a finer mesh.";
        }
    throw_on_all_if_any(dofs.get_communicator(), message);
    // Pairs of a cell with positive entries off the diagonal (of unequal sides) conduct more than it did as a whole.
    const bool stiffer = Utilities::MPI::max(pairs_stiffer ? 1 : 0, dofs.get_communicator()) > 0;
    if (stiffer || zone_moves || crack_factors.size() > 0 || history.may_close())
      {
        // Rates can have grown. Where cells are only cut, the old bounds still hold.
        gershgorin = std::max(gershgorin, Utilities::MPI::max(bound, dofs.get_communicator()));
        raise_bounds(touched);
      }
    mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  void FEMOperator<dim>::raise_bounds(const Vector &touched)
  {
    if (bounds.safe == 0.) // nobody has asked yet
      return;
    // The fastest field may have changed where the rows have, and only there: iterations that start there see it soon.
    const double local = sharp_bound(
      *this,
      gershgorin,
      [&](Vector &vector) {
        vector = noise();
        vector.scale(touched);
      },
      bounds.sharp);
    bounds.sharp = std::max(bounds.sharp, local);
    bounds.safe  = gershgorin;
  }


  template <int dim>
  std::vector<typename FEMOperator<dim>::Cell> FEMOperator<dim>::cells_near(
    const std::vector<BoundingBox<dim>> &cuts,
    const std::vector<BoundingBox<dim>> &joins)
  {
    if (!search)
      search = std::make_unique<CellSearch<dim>>(dofs);
    // Bonds change the cells that they pass. The factors of crack-side scaling change as far as the neighbours of cut cells and of nodes with broken bonds.
    const bool        scaled = crack_factors.size() > 0;
    const double      reach  = coupling ? coupling->families().reach() : 0.;
    const double      wide   = scaled ? 2. * search->largest_diameter() : 0.;
    std::vector<Cell> near;
    search->find(cuts, wide + (scaled ? reach : 0.), near);
    search->find(joins, wide + reach, near);
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
  }


  template <int dim>
  void FEMOperator<dim>::add_crack_heat(const Vector &u, Balance &balance) const
  {
    balance.cracks.assign(scene.cracks.cracks.size(), 0.);
    if (!scene.cracks.conduct())
      return;
    if (coupling)
      add_bond_heat(u, balance);
    CellData                                 &data = *cell_data;
    std::vector<std::pair<unsigned int, int>> crossed;
    u.update_ghost_values();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && cut[cell->active_cell_index()])
        {
          assemble_cell(cell, data);
          scale_beside_cracks(data);
          for (const unsigned int a : cell->vertex_indices())
            for (unsigned int b = 0; b < a; ++b)
              {
                crossed.clear();
                kept_fraction(cell, a, b, &crossed);
                for (const auto &[crack, side] : crossed)
                  balance.cracks[crack] +=
                    side * -data.stiffness(a, b) * (u(data.indices[b]) - u(data.indices[a]));
              }
        }
    u.set_ghost_state(false);
    for (double &heat : balance.cracks)
      heat = Utilities::MPI::sum(heat, dofs.get_communicator());
  }


#define PERIDEAL_INSTANTIATE(dim)                                   \
  template double FEMOperator<dim>::next_event(const double) const; \
  template void   FEMOperator<dim>::raise_bounds(const Vector &);   \
  template bool   FEMOperator<dim>::update(const double);           \
  template void   FEMOperator<dim>::add_crack_heat(const Vector &, Balance &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
