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
#include <limits>

#include "fem_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  double FEMOperator<dim>::next_event(const double t) const
  {
    return history.next_event(t);
  }


  namespace
  {
    /**
     * One box for all that joins the zone beside each cut, the same on all processes: a cell may
     * feel what happens a little farther away than its own process knows of. Collective.
     */
    template <int dim>
    std::vector<BoundingBox<dim>> boxes_beside(const std::vector<BoundingBox<dim>> &cuts,
                                               const std::vector<BoundingBox<dim>> &joins,
                                               const MPI_Comm                       communicator)
    {
      std::vector<double> lowest(2 * dim * cuts.size(), std::numeric_limits<double>::max());
      for (const BoundingBox<dim> &join : joins)
        {
          std::size_t nearest = 0;
          for (std::size_t k = 1; k < cuts.size(); ++k)
            if (join.center().distance(cuts[k].center()) <
                join.center().distance(cuts[nearest].center()))
              nearest = k;
          double *const box = lowest.data() + 2 * dim * nearest;
          for (unsigned int d = 0; d < dim; ++d)
            {
              box[d]       = std::min(box[d], join.lower_bound(d));
              box[dim + d] = std::min(box[dim + d], -join.upper_bound(d));
            }
        }
      std::vector<double> all(lowest.size());
      Utilities::MPI::min(lowest, communicator, all);
      std::vector<BoundingBox<dim>> boxes;
      for (const double *box = all.data(); box != all.data() + all.size(); box += 2 * dim)
        if (box[0] < std::numeric_limits<double>::max())
          {
            Point<dim> low, high;
            for (unsigned int d = 0; d < dim; ++d)
              {
                low[d]  = box[d];
                high[d] = -box[dim + d];
              }
            boxes.push_back({{low, high}});
          }
      return boxes;
    }
  } // namespace


  template <int dim>
  void FEMOperator<dim>::prepare_event()
  {
    if (event)
      return;
    search = std::make_unique<CellSearch<dim>>(dofs);
    event  = std::make_shared<EventData>(capacity);
    for (const unsigned int i : prescribed.held())
      event->held.insert(i);
  }


  template <int dim>
  bool FEMOperator<dim>::update(const double t)
  {
    const double time = history.representative(t);
    if (time == cracks_of || !history.changes_ever())
      return false;
    const auto cuts = history.changes(cracks_of, time);
    if (cuts.empty())
      {
        cracks_of = time;
        return false;
      }
    prepare_event();
    const auto joins =
      boxes_beside(cuts,
                   coupling ? coupling->joining_by(time) : std::vector<BoundingBox<dim>>(),
                   dofs.get_communicator());
    cracks_of           = time;
    CellData    &data   = *cell_data;
    const bool   scaled = !crack_factors.empty();
    const double reach  = coupling ? coupling->families().weights().reach() : 0.;
    // The factors of crack-side scaling change at the vertices of the cells whose own matrix does,
    // and of all cells around these.
    const double                    wide = scaled ? search->largest_diameter() : 0.;
    const std::vector<Cell>         near = cells_near(cuts, joins, wide);
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
        const double beyond = scaled ? reach + wide : 0.; // bonds have the factors of both ends
        auto         boxes  = cuts;
        boxes.insert(boxes.end(), joins.begin(), joins.end());
        nodes = coupling->families().neighbors().nodes_near(boxes, reach + beyond);
        if (!bonds_apart)
          old_rows = bond_rows(nodes);
        coupling->set_cracks_of(time);
        recount_bonds = true;
      }
    cut_by_cracks.set(near, history.pieces(time), history.transmission(time));
    if (scaled)
      find_crack_factors(near, owned_unknowns_of(cells_near(cuts, joins, 0.)), event->factors);
    for (std::size_t k = 0; k < near.size(); ++k)
      if (near[k]->is_locally_owned())
        {
          assemble_cell(near[k], data);
          scale_beside_cracks(data);
          data.stiffness.add(-1., old[k]);
          if (data.stiffness.linfty_norm() == 0.)
            continue;
          if (!(bonds_apart && coupling->leaves_nothing(near[k])))
            hanging.add_to(stiffness, data.stiffness, data.indices);
          for (const auto i : data.indices)
            {
              event->touched.insert(layout->global_to_local(i));
              if (const auto *masters = hanging.constraints().get_constraint_entries(i))
                for (const auto &master : *masters)
                  event->touched.insert(layout->global_to_local(master.first));
            }
        }
    if (coupling && !bonds_apart)
      change_bonds(nodes, old_rows);
    stiffness.compress(VectorOperation::add);
    if (bonds_apart)
      change_form(nodes);
    event->touched.compress();
    event->touched.sort();
    update_rows(!joins.empty());
    event->touched.clear();
    return true;
  }


  template <int dim>
  void FEMOperator<dim>::update_rows(const bool zone_moves)
  {
    const auto &partitioner = *stiffness_diagonal.get_partitioner();
    std::string message;
    double      bound = 0.;
    for (const unsigned int i : event->touched.rows())
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
        if (event->held.contains(i))
          stiffness_diagonal.local_element(i) = 1.;
      }
    throw_on_all_if_any(dofs.get_communicator(), message);
    const bool stiffer =
      Utilities::MPI::max(cut_by_cracks.pairs_are_stiffer() ? 1 : 0, dofs.get_communicator()) > 0;
    if (stiffer || zone_moves || !crack_factors.empty() || history.may_close())
      {
        // Rates can have grown. Where cells are only cut, the old bounds still hold.
        gershgorin = std::max(gershgorin, Utilities::MPI::max(bound, dofs.get_communicator()));
        raise_bounds();
      }
  }


  template <int dim>
  void FEMOperator<dim>::raise_bounds()
  {
    if (bounds.safe == 0.) // nobody has asked yet
      return;
    // The fastest field may have changed where the rows have, and only there: iterations that start
    // there see it soon.
    const std::vector<unsigned int> &rows  = event->touched.rows();
    double                           local = -1.;
    if (!form && symmetric())
      local = event->bound(stiffness, capacity, event->held, rows, noise(), bounds.sharp);
    if (local >= 0.)
      local = std::min(round_up(local), gershgorin);
    else
      local = sharp_bound(
        *this,
        gershgorin,
        [&](Vector &vector) {
          for (const unsigned int i : rows)
            vector.local_element(i) = noise().local_element(i);
        },
        bounds.sharp);
    bounds.sharp = std::max(bounds.sharp, local);
    bounds.safe  = gershgorin;
  }


  template <int dim>
  std::vector<typename FEMOperator<dim>::Cell> FEMOperator<dim>::cells_near(
    const std::vector<BoundingBox<dim>> &cuts,
    const std::vector<BoundingBox<dim>> &joins,
    const double                         wide) const
  {
    // Bonds change the cells that they pass.
    const double      reach = coupling ? coupling->families().weights().reach() : 0.;
    std::vector<Cell> near;
    search->find(cuts, wide + (!crack_factors.empty() ? reach : 0.), near);
    search->find(joins, wide + reach, near);
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
  }


  template <int dim>
  std::vector<unsigned int> FEMOperator<dim>::owned_unknowns_of(
    const std::vector<Cell> &cells) const
  {
    std::vector<unsigned int>            list;
    std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    for (const Cell &cell : cells)
      {
        cell->get_dof_indices(indices);
        for (const auto i : indices)
          if (layout->in_local_range(i))
            list.push_back(layout->global_to_local(i));
      }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
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
      if (cell->is_locally_owned() && cut_by_cracks.is_cut(cell))
        {
          assemble_cell(cell, data);
          scale_beside_cracks(data);
          for (const unsigned int a : cell->vertex_indices())
            for (unsigned int b = 0; b < a; ++b)
              {
                crossed.clear();
                cut_by_cracks.kept_fraction(
                  cell,
                  a,
                  b,
                  [&] { return cell_material.center_conductivity(cell); },
                  &crossed);
                for (const auto &[crack, side] : crossed)
                  balance.cracks[crack] +=
                    side * -data.stiffness(a, b) * (u(data.indices[b]) - u(data.indices[a]));
              }
        }
    u.set_ghost_state(false);
    for (double &heat : balance.cracks)
      heat = Utilities::MPI::sum(heat, dofs.get_communicator());
  }


#define PERIDEAL_INSTANTIATE(dim)                                                      \
  template double                    FEMOperator<dim>::next_event(const double) const; \
  template std::vector<unsigned int> FEMOperator<dim>::owned_unknowns_of(              \
    const std::vector<Cell> &) const;                                                  \
  template bool FEMOperator<dim>::update(const double);                                \
  template void FEMOperator<dim>::add_crack_heat(const Vector &, Balance &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
