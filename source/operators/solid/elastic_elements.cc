// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/parts/element_layout.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastic_cell_data.h"
#include "inversion.h"

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
                     body.cuts_in_part_at_tips()})
    , condition_faces(dofs, body.boundary_conditions)
    , hanging(dofs, *nodes, dim)
  {
    find_positions();
    find_conditions();
    // Where tips cut in part, ends on sides are none.
    cut_by_cracks.set(this->history.pieces(this->cracks_of, !body.cuts_in_part_at_tips()), 0.);
    assemble();
    this->keep_constant_loads();
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
    const auto corners =
      cell_corners<dim>(dofs, nodes->locally_owned_size(), [&](const types::global_dof_index i) {
        return nodes->in_local_range(i) || nodes->is_ghost_entry(i) ? nodes->global_to_local(i) :
                                                                      numbers::invalid_unsigned_int;
      });
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
    part_unknowns = unknowns_of_parts(dofs, body.boundary_conditions, [&](const auto node) {
      return hanging.is_hanging(dim * node);
    });
    for (const PartUnknown<dim> &unknown : part_unknowns)
      on_sides.push_back({unknown.node, unknown.id, unknown.position});
    const std::vector<Point<dim>> own(positions.begin(),
                                      positions.begin() + nodes->locally_owned_size());
    conditions = std::make_unique<DisplacementConditions<dim>>(on_sides,
                                                               own,
                                                               body,
                                                               false,
                                                               dofs.get_communicator());
    conditions->pin(own, body, false);
    conditions->let_follow(hanging.owned());
  }


  template <int dim>
  void ElasticElements<dim>::throw_if_isolated() const
  {
    const double                   largest = stiffness_diagonal.linfty_norm();
    std::string                    message;
    const NodeFamilies<dim> *const families = zone_bonds ? zone_bonds->coupling().node_families() :
                                                           nullptr;
    for (unsigned int i = 0; i < stiffness_diagonal.locally_owned_size() && message.empty(); ++i)
      {
        const std::string fault =
          families != nullptr && i % dim == 0 ? families->fault_of(i / dim) : "";
        if (!fault.empty())
          message =
            "The node at " + this->place_of(i) + fault +
            " Check 'Horizon' in section 'Peridynamics' and the cracks in section 'Cracks'.";
        else if (const double own = stiffness_diagonal.local_element(i);
                 own > 0. && !(own > 1e-13 * largest) && body.cracks.cracks.empty())
          message =
            "What holds the node at " + this->place_of(i) + " to others is " +
            rounded_text(own / largest) +
            " of the most that holds any, and disappears in its round-off: 'Young modulus' "
            "or what else gives the stiffness in section 'Material' differs too much. Beyond a thousand times "
            "hardly anything changes but that: choose values that differ less, or leave out what is so soft, as a hole.";
        else if (!(own > 1e-13 * largest))
          message =
            "The node at " + this->place_of(i) +
            " is isolated: cracks cut all cells around it, and no bond holds it. Use " +
            (zone_bonds ?
               "fewer cracks, or a wider 'Zone' in section 'Coupling' where only a part of the body has bonds." :
               "'Models = coupled' with a zone around the cracks, or 'Mesh = "
               "faces' in section 'Cracks'.");
      }
    throw_on_all_if_any(dofs.get_communicator(), message);
  }


  template <int dim>
  Spectrum ElasticElements<dim>::spectrum() const
  {
    std::vector<double> row_sums(mass.locally_owned_size(), 0.);
    for_each_entry(stiffness, [&](const unsigned int row, const auto, const double value) {
      row_sums[row] += std::abs(value);
    });
    for (const unsigned int i : hanging.owned())
      row_sums[i] = 0.;
    double bound = 0.;
    for (unsigned int i = 0; i < row_sums.size(); ++i)
      bound = std::max(bound, row_sums[i] / mass.local_element(i));
    bound = Utilities::MPI::max(bound, dofs.get_communicator());
    return {bound, sharp_bound(*this, bound, [&](Vector &vector) { this->fill_noise(vector); })};
  }

  template <int dim>
  void ElasticElements<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    matrix.copy_from(stiffness);
    hold_unknowns(matrix, this->held_unknowns());
  }

  template <int dim>
  OperatorSize ElasticElements<dim>::size() const
  {
    OperatorSize size;
    size.unknowns = unknowns->size();
    size.nonzeros = stiffness.n_nonzero_elements();
    size.bonds    = std::llround(Utilities::MPI::sum(n_bonds, dofs.get_communicator()));
    size.memory   = stiffness.memory_consumption() + positions.capacity() * sizeof(Point<dim>);
    if (zone_bonds)
      size.memory += zone_bonds->coupling().memory_consumption();
    size.form = "matrix";
    return size;
  }

  template <int dim>
  double ElasticElements<dim>::energy(const Vector &u) const
  {
    Vector image;
    this->initialize_vector(image);
    multiply(image, u);
    return 0.5 * (u * image) - u * thermal_loads + thermal_energy;
  }

  template <int dim>
  const std::shared_ptr<const Utilities::MPI::Partitioner> &ElasticElements<dim>::node_layout()
    const
  {
    return nodes;
  }

  template class ElasticElements<1>;
  template class ElasticElements<2>;
  template class ElasticElements<3>;
} // namespace PeriDeal
