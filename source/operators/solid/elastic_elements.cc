// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/parts/element_layout.h>
#include <perideal/operators/parts/event_work.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "elastic_cell_data.h"
#include "inversion.h"
#include "loose_nodes.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void ElasticElements<dim>::require(const BodyParameters<dim> &body, const bool coupled)
  {
    SolidOperator<dim>::require(body);
    if (coupled)
      return SolidBondsBesideElements<dim>::require(body);
    body.elasticity.refuse(
      body.elasticity.has_full_kinematics(),
      "Kinematics",
      "'full' is for 'Models = peridynamics' alone; finite elements have small displacements. "
      "Leave them out, or use 'linear'.");
  }


  template <int dim>
  ElasticElements<dim>::ElasticElements(const DoFHandler<dim>         &dof_handler,
                                        const BodyParameters<dim>     &body,
                                        std::unique_ptr<Coupling<dim>> coupling)
    : SolidOperator<dim>(body, element_layout(dof_handler, coupling.get()))
    , dofs(dof_handler)
    , zone_bonds(coupling ? std::make_unique<SolidBondsBesideElements<dim>>(std::move(coupling)) :
                            nullptr)
    , cut_by_cracks(dofs,
                    {body.cracks.on_faces(),
                     true,
                     body.cracks.contact_conductance,
                     [&body] { return body.horizon(); },
                     body.cuts_in_part_at_tips(),
                     zone_bonds && body.coupling.zone != ZoneKind::formula &&
                       body.coupling.zone != ZoneKind::adaptive})
    , hanging(dofs, *nodes, dim)
    , mechanical(dofs, body, nodes, [this](const auto unknown) {
      return hanging.is_hanging(unknown);
    })
  {
    if (zone_bonds && (body.material.fracture_energy || body.material.critical_stretch))
      {
        breaking = std::make_unique<ZoneBreaking<dim>>(zone_bonds->coupling(), dofs, body);
        this->initialize_vector(force_change);
      }
    find_positions();
    // Where tips cut in part, ends on sides are none.
    cut_by_cracks.set(this->history.pieces(this->cracks_of, !body.cuts_in_part_at_tips()), 0.);
    find_conditions();
    assemble();
    this->keep_constant_loads();
    if (zone_bonds && body.coupling.exchanges() && !body.cracks.on_faces() &&
        body.elasticity.contact && this->may_part())
      this->set_contact(zone_bonds->make_contact(nodes));
  }


  template <int dim>
  ElasticElements<dim>::~ElasticElements() = default;


  template <int dim>
  void ElasticElements<dim>::find_positions()
  {
    positions.resize(nodes->locally_owned_size() + nodes->n_ghost_indices());
    if (zone_bonds)
      {
        for (unsigned int i = 0; i < positions.size(); ++i)
          positions[i] = zone_bonds->nodes().position(i);
        return;
      }
    const MappingQ1<dim>                 mapping;
    std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(indices);
          for (unsigned int i = 0; i < indices.size(); ++i)
            positions[nodes->global_to_local(indices[i])] =
              mapping.transform_unit_to_real_cell(cell, dofs.get_fe().unit_support_point(i));
        }
  }


  template <int dim>
  Inversion ElasticElements<dim>::inverted(const Vector &u) const
  {
    const auto corners = cell_corners_of<dim>(dofs, *nodes);
    u.update_ghost_values();
    const Inversion result = find_inverted<dim>(
      corners,
      u,
      [&](const unsigned int node) { return positions[node]; },
      [](const CellCorner<dim> &) { return true; },
      dofs.get_communicator());
    u.set_ghost_state(false);
    return result;
  }


  template <int dim>
  void ElasticElements<dim>::find_conditions()
  {
    const auto                                                 &fe = dofs.get_fe();
    std::vector<types::global_dof_index>                        indices(fe.n_dofs_per_cell());
    std::map<std::pair<types::boundary_id, unsigned int>, bool> seen;
    std::vector<NodeOnSide<dim>>                                on_sides;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        if (cell->is_artificial() || !cell->at_boundary())
          continue;
        cell->get_dof_indices(indices);
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            for (unsigned int i = 0; i < indices.size(); ++i)
              if (fe.has_support_on_face(i, f) && nodes->in_local_range(indices[i]) &&
                  !hanging.is_hanging(dim * indices[i]))
                {
                  const types::boundary_id side = cell->face(f)->boundary_id();
                  const unsigned int       node = nodes->global_to_local(indices[i]);
                  if (seen.try_emplace({side, node}).second)
                    on_sides.push_back({node, side, positions[node]});
                  for (const Part &part : body.boundary_conditions.parts)
                    if (part.side == side && part.holds(positions[node]) &&
                        seen.try_emplace({part.id, node}).second)
                      on_sides.push_back({node, part.id, positions[node]});
                }
      }
    for (const PartUnknown<dim> &unknown : mechanical.part_unknowns())
      on_sides.push_back({unknown.node, unknown.id, unknown.position});
    const std::vector<Point<dim>> own(positions.begin(),
                                      positions.begin() + nodes->locally_owned_size());
    conditions = std::make_unique<DisplacementConditions<dim>>(on_sides,
                                                               own,
                                                               body,
                                                               false,
                                                               dofs.get_communicator());
    conditions->pin(own, body, false);
    if (!zone_bonds && !body.cracks.cracks.empty() && dofs.get_fe().degree == 1)
      {
        Vector free(unknowns);
        free = 1.;
        conditions->mask(free);
        hanging.let_follow(find_followers(dofs, cut_by_cracks, hanging, free, Vector(nodes)),
                           dofs.get_communicator());
      }
    conditions->let_follow(hanging.owned());
  }


  template <int dim>
  void ElasticElements<dim>::throw_if_isolated() const
  {
    const double                   largest = stiffness_diagonal.linfty_norm();
    const Vector                   held = this->held_unknowns(); // 1 on the diagonal, in any units
    std::string                    message;
    const NodeFamilies<dim> *const families = zone_bonds ? zone_bonds->coupling().node_families() :
                                                           nullptr;
    for (unsigned int i = 0; i < stiffness_diagonal.locally_owned_size() && message.empty(); ++i)
      {
        const std::string fault =
          families != nullptr && i % dim == 0 ? families->fault_of(i / dim) : "";
        const double own = stiffness_diagonal.local_element(i);
        if (!fault.empty() || (held.local_element(i) == 0. && !(own > 1e-13 * largest)))
          message =
            fault.empty() ?
              looseness_text(this->place_of(i),
                             own / largest,
                             body.cracks.cracks.empty(),
                             zone_bonds != nullptr) :
              "The node at " + this->place_of(i) + fault +
                " Check 'Horizon' in section 'Peridynamics' and the cracks in section 'Cracks'.";
      }
    throw_on_all_if_any(dofs.get_communicator(), message);
  }


  template <int dim>
  void ElasticElements<dim>::set_all_bonds()
  {
    std::vector<unsigned int> owned(nodes->locally_owned_size());
    std::iota(owned.begin(), owned.end(), 0);
    breaking->bonds.set_rows(owned, crack_factors);
  }


  template <int dim>
  double ElasticElements<dim>::add_zone_parts(const std::vector<Cell>         &of_cells,
                                              const std::vector<unsigned int> &rows,
                                              const double                     multiple,
                                              const Vector                    &u)
  {
    CellData  &data   = *cell_data;
    const bool warms  = any_thermal();
    double     energy = 0., held = 0.;
    for (const Cell &cell : of_cells)
      if (cell->is_locally_owned())
        {
          data.values.reinit(cell);
          data.set_indices(cell);
          data.assemble(*this);
          change_cell(cell, data);
          energy += data.energy(u);
          for (unsigned int i = 0; i < data.unknowns.size(); ++i)
            force_change(data.unknowns[i]) += multiple * data.force(i, u);
          held += data.thermal_energy;
          data.stiffness *= multiple;
          stiffness.add(hanging, data.stiffness, data.unknowns);
          for (unsigned int i = 0; i < data.unknowns.size() && warms; ++i)
            thermal_loads(data.unknowns[i]) += multiple * data.thermal(i);
        }
    const std::vector<double> &strains = breaking->thermal_strains();
    energy += breaking->bonds.energy(u, rows, strains);
    breaking->bonds.add_forces_of(rows, multiple, force_change, u);
    if (warms)
      held += breaking->bonds.add_thermal(thermal_loads, rows, strains, multiple) / multiple;
    thermal_energy += Utilities::MPI::sum(multiple * held, dofs.get_communicator());
    return multiple * energy;
  }


  template <int dim>
  double ElasticElements<dim>::mend_zone(const Boxes                     &boxes,
                                         const double                     of_cells,
                                         const std::vector<unsigned int> &rows,
                                         const Vector                    &u,
                                         const std::function<void()>     &make_change)
  {
    if (!search)
      search = std::make_unique<CellSearch<dim>>(dofs);
    std::vector<Cell> cells;
    search->find(boxes, of_cells, cells);
    changes_forces = true;
    double gained  = add_zone_parts(cells, rows, -1., u);
    make_change();
    gained += add_zone_parts(cells, rows, 1., u);
    stiffness.compress();
    if (any_thermal())
      {
        thermal_loads.compress(VectorOperation::add);
        hanging.condense(thermal_loads);
        this->keep_constant_loads();
      }
    note_parted(cells);
    if (!this->forgoes_diagonal)
      mend_diagonal(cells, rows);
    return contact->change(rows, u) - Utilities::MPI::sum(gained, dofs.get_communicator());
  }


  template <int dim>
  std::vector<typename ElasticElements<dim>::Cell> ElasticElements<dim>::known_cells() const
  {
    std::vector<Cell> list;
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        list.push_back(cell);
    return list;
  }


  template <int dim>
  void ElasticElements<dim>::mend_unbalanced(Vector &r, const Vector &u, const double t) const
  {
    if (!breaking || any_thermal())
      return this->unbalanced(r, u, t);
    if (!changes_forces)
      return;
    force_change.compress(VectorOperation::add);
    hanging.condense(force_change);
    hanging.set(force_change, 0.);
    r -= force_change;
    contact->add_last_forces(r, 1.);
    contact->add_forces(r, u, -1.);
    force_change   = 0.;
    changes_forces = false;
  }


  template <int dim>
  void ElasticElements<dim>::note_parted(const std::vector<Cell> &of_cells)
  {
    if (breaking->n_broken_pairs() == 0)
      return;
    if (parted.empty())
      parted = cut_by_cracks.flags();
    for (const Cell &cell : of_cells)
      parted[cell->active_cell_index()] = cut_by_cracks.is_cut(cell) || zone_bonds->is_parted(cell);
  }


  template <int dim>
  void ElasticElements<dim>::mend_diagonal(const std::vector<Cell>         &of_cells,
                                           const std::vector<unsigned int> &rows)
  {
    std::vector<unsigned int> touched = rows;
    for (const unsigned int i : owned_unknowns<dim>(of_cells, *nodes))
      touched.push_back(i);
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    const Vector held    = this->held_unknowns();
    const double largest = stiffness_diagonal.linfty_norm();
    for (const unsigned int i : touched)
      {
        const Tensor<1, dim> of_bonds = breaking->bonds.diagonal_of(i);
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double value                            = stiffness.diagonal(i, d) + of_bonds[d];
            const bool   stands                           = value > 1e-13 * largest;
            stiffness_diagonal.local_element(dim * i + d) = held.local_element(dim * i + d) > 0. ?
                                                              1. :
                                                            stands ? value :
                                                                     largest;
          }
      }
  }


  template <int dim>
  bool ElasticElements<dim>::join_zone_around(const std::vector<Point<dim>> &places,
                                              const Vector                  &u)
  {
    const auto joining = breaking->joining(places);
    Boxes      boxes;
    for (const auto &[node, weight] : joining)
      boxes.emplace_back(std::vector<Point<dim>>{positions[node], positions[node]});
    if (Utilities::MPI::sum(static_cast<double>(joining.size()), dofs.get_communicator()) == 0.)
      return false;
    const std::vector<unsigned int> rows = zone_bonds->nodes_near(boxes);
    this->released_by_joining += mend_zone(boxes, zone_bonds->reach(), rows, u, [&] {
      breaking->join(joining);
      breaking->bonds.set_rows(rows, crack_factors);
    });
    return true;
  }


  template <int dim>
  bool ElasticElements<dim>::widen_zone(const Vector &u)
  {
    if (changes_forces)
      {
        force_change = 0.;
        force_change.zero_out_ghost_values();
        changes_forces = false;
      }
    if (!zone_follows_stretches())
      return false;
    u.update_ghost_values();
    const std::vector<Point<dim>> places  = breaking->find_places_to_join(u);
    const bool                    widened = !places.empty() && join_zone_around(places, u);
    u.set_ghost_state(false);
    return widened;
  }


  template <int dim>
  void ElasticElements<dim>::break_pairs(const std::vector<NodePair> &pairs,
                                         const Vector                &u,
                                         const double                 t)
  {
    u.update_ghost_values();
    breaking->history.released +=
      mend_zone(breaking->parted_by(pairs), 0., breaking->rows_of(pairs), u, [&] {
        breaking->take(pairs, t);
      });
    if (const auto places = breaking->find_places_to_join(u); !places.empty())
      join_zone_around(places, u);
    u.set_ghost_state(false);
  }


  template <int dim>
  unsigned long long ElasticElements<dim>::break_bonds(const Vector &u,
                                                       const double  t,
                                                       const double  share)
  {
    if (!breaking)
      return 0;
    u.update_ghost_values();
    const std::vector<NodePair> pairs = breaking->find_overstretched(u, share);
    u.set_ghost_state(false);
    if (!pairs.empty())
      break_pairs(pairs, u, t);
    return pairs.size();
  }


  template <int dim>
  void ElasticElements<dim>::surrogate_made() const
  {
    if (!breaking)
      return;
    n_broken_of_surrogate = breaking->n_broken_pairs();
    breaking->keep_zone();
  }


  template <int dim>
  void ElasticElements<dim>::exchange_bonds(Archive                     &archive,
                                            const NodeKeys              &keys,
                                            const std::function<void()> &at_surrogate)
  {
    if (!breaking)
      return;
    breaking->exchange(archive, keys, n_broken_of_surrogate, [&] {
      set_all_bonds();
      at_surrogate();
    });
    if (!archive.loads())
      return;
    assemble();
    this->keep_constant_loads();
    note_parted(known_cells());
  }


  template <int dim>
  void ElasticElements<dim>::share_rows_for_steps() const
  {
    if (!this->forgoes_diagonal || stiffness.was_asked_to_share() || hanging.any() ||
        !body.domain.has_lattice() || (zone_bonds && !breaking && this->has_growing_cracks()))
      return;
    stiffness.share_rows(nodes, places_on_lattice(positions, body.domain));
  }


  template <int dim>
  void ElasticElements<dim>::multiply(Vector &y, const Vector &x) const
  {
    share_rows_for_steps();
    const bool is_known = x.has_ghost_elements();
    if (breaking || stiffness.shares_rows())
      x.update_ghost_values();
    stiffness.multiply(y, x);
    if (breaking)
      breaking->bonds.add_forces(y, x);
    x.set_ghost_state(is_known);
    hanging.set(y, 0.); // the nodes they follow from have all of it
  }


  template <int dim>
  Spectrum ElasticElements<dim>::spectrum() const
  {
    std::vector<double> row_sums(mass.locally_owned_size(), 0.);
    stiffness.for_each_entry([&](const unsigned int row, const auto, const double value) {
      row_sums[row] += std::abs(value);
    });
    if (breaking)
      breaking->bonds.add_row_sums(row_sums);
    for (const unsigned int i : hanging.owned())
      row_sums[i] = 0.;
    double bound = 0.;
    for (unsigned int i = 0; i < row_sums.size(); ++i)
      bound = std::max(bound, row_sums[i] / mass.local_element(i));
    bound = Utilities::MPI::max(bound, dofs.get_communicator());
    return {bound, sharp_bound(*this, bound, [&](Vector &vector) { this->fill_noise(vector); })};
  }


  template <int dim>
  double ElasticElements<dim>::energy(const Vector &u) const
  {
    Vector image;
    this->initialize_vector(image);
    multiply(image, u);
    return 0.5 * (u * image) - u * thermal_loads + thermal_energy + contact->energy(u);
  }


  template class ElasticElements<1>;
  template class ElasticElements<2>;
  template class ElasticElements<3>;
} // namespace PeriDeal
