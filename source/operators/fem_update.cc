// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Cut cells that change with time.

#include <deal.II/base/mpi.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/fem_operator.h>

#include <algorithm>

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
    const auto cuts = history.changes(cracks_of, time);
    if (cuts.empty())
      {
        cracks_of = time;
        return false;
      }
    if (!event)
      event = std::make_unique<EventWork<dim>>(dofs, capacity, prescribed.held());
    const auto joins    = boxes_beside(cuts,
                                    zone_bonds ? zone_bonds->coupling().joining_by(time) :
                                                    std::vector<BoundingBox<dim>>(),
                                    dofs.get_communicator());
    cracks_of           = time;
    CellData    &data   = *cell_data;
    const bool   scaled = !crack_factors.empty();
    const double reach  = zone_bonds ? zone_bonds->coupling().families().weights().reach() : 0.;
    // The factors of crack-side scaling change at the vertices of the cells whose own matrix does,
    // and of all cells around these.
    const double                    wide = scaled ? event->search.largest_diameter() : 0.;
    const std::vector<Cell>         near = cells_near(cuts, joins, wide);
    std::vector<FullMatrix<double>> old(near.size());
    for (std::size_t k = 0; k < near.size(); ++k)
      if (near[k]->is_locally_owned())
        {
          assemble_cell(near[k], data);
          scale_beside_cracks(data);
          old[k] = data.stiffness;
        }
    std::vector<unsigned int>               nodes;
    typename BondsBesideElements<dim>::Rows old_rows;
    if (zone_bonds)
      {
        const double beyond = scaled ? reach + wide : 0.; // bonds have the factors of both ends
        auto         boxes  = cuts;
        boxes.insert(boxes.end(), joins.begin(), joins.end());
        nodes    = zone_bonds->coupling().families().neighbors().nodes_near(boxes, reach + beyond);
        old_rows = zone_bonds->set_cracks_of(time, nodes);
      }
    cut_by_cracks.set(near, history.pieces(time), history.transmission(time));
    if (scaled)
      {
        const auto beside = owned_unknowns<dim>(cells_near(cuts, joins, 0.), *layout);
        find_crack_factors(near, beside, event->factors);
        event->factors.clear(owned_unknowns<dim>(near, *layout));
        event->factors.clear(beside);
      }
    add_changes(near, old);
    if (zone_bonds)
      zone_bonds->add_changes(nodes, old_rows, stiffness, event->touched);
    stiffness.compress(VectorOperation::add);
    if (apart())
      {
        zone_bonds->change_form(nodes, event->touched);
        zone_bonds->take_remainder(stiffness);
      }
    event->touched.compress();
    event->touched.sort();
    update_rows(!joins.empty());
    event->touched.clear();
    return true;
  }


  template <int dim>
  void FEMOperator<dim>::add_changes(const std::vector<Cell>               &cells,
                                     const std::vector<FullMatrix<double>> &old)
  {
    CellData &data = *cell_data;
    for (std::size_t k = 0; k < cells.size(); ++k)
      if (cells[k]->is_locally_owned())
        {
          assemble_cell(cells[k], data);
          scale_beside_cracks(data);
          data.stiffness.add(-1., old[k]);
          if (data.stiffness.linfty_norm() == 0.)
            continue;
          if (!(zone_bonds && zone_bonds->leaves_nothing(cells[k])))
            hanging.add_to(stiffness, data.stiffness, data.indices);
          event->touch(data.indices, hanging);
        }
  }


  template <int dim>
  void FEMOperator<dim>::update_rows(const bool zone_moves)
  {
    const auto &partitioner = *stiffness_diagonal.get_partitioner();
    std::string message;
    double      bound = 0.;
    for (const unsigned int i : event->touched.rows())
      {
        const double from_form              = zone_bonds ? zone_bonds->sum_of(i) : 0.;
        double       sum                    = 2. * from_form;
        stiffness_diagonal.local_element(i) = from_form;
        for_each_entry_of_row(stiffness, i, [&](const auto column, const double value) {
          sum += std::abs(value);
          if (column == partitioner.local_to_global(i))
            stiffness_diagonal.local_element(i) = from_form + value;
        });
        bound = std::max(bound, sum / capacity.local_element(i));
        // Cells are taken away by subtraction, which leaves round-off behind.
        if (!(sum > 1e-13 * bounds.safe() * capacity.local_element(i)) && message.empty())
          message =
            zone_bonds ?
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
        bounds.raise(Utilities::MPI::max(bound, dofs.get_communicator()),
                     event->touched.rows(),
                     [&](const double enough) {
                       return apart() || !symmetric() ? -1. :
                                                        event->bound(stiffness,
                                                                     capacity,
                                                                     event->held,
                                                                     event->touched.rows(),
                                                                     noise(),
                                                                     enough);
                     });
      }
  }


  template <int dim>
  std::vector<typename FEMOperator<dim>::Cell> FEMOperator<dim>::cells_near(
    const std::vector<BoundingBox<dim>> &cuts,
    const std::vector<BoundingBox<dim>> &joins,
    const double                         wide) const
  {
    // Bonds change the cells that they pass.
    const double reach = zone_bonds ? zone_bonds->coupling().families().weights().reach() : 0.;
    return event->cells_near(cuts,
                             wide + (crack_factors.empty() ? 0. : reach),
                             joins,
                             wide + reach);
  }


  template <int dim>
  void FEMOperator<dim>::add_crack_heat(const Vector &u, Balance &balance) const
  {
    balance.cracks.assign(scene.cracks.cracks.size(), 0.);
    if (!scene.cracks.conduct())
      return;
    if (zone_bonds)
      zone_bonds->add_heat(u, balance);
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


#define PERIDEAL_INSTANTIATE(dim)                                   \
  template double FEMOperator<dim>::next_event(const double) const; \
  template bool   FEMOperator<dim>::update(const double);           \
  template void   FEMOperator<dim>::add_crack_heat(const Vector &, Balance &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
