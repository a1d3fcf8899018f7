// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/base/interleaved.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/elastic_elements.h>
#include <perideal/operators/spectrum.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "elastic_cell_data.h"
#include "inversion.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ElasticElements<dim>::ElasticElements(const DoFHandler<dim>                &dof_handler,
                                        const Scene<dim>                     &scene,
                                        std::unique_ptr<ElasticCoupling<dim>> given_coupling)
    : dofs(dof_handler)
    , scene(scene)
    , coupling(std::move(given_coupling))
    , cut_by_cracks(dofs,
                    {scene.cracks.mesh == CrackMesh::faces,
                     true,
                     scene.cracks.contact_conductance,
                     [&scene] { return scene.horizon(); }})
    , condition_faces(dofs, scene.boundary_conditions)
  {
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    nodes    = coupling ?
                 coupling->families().nodes().partitioner() :
                 std::make_shared<const Utilities::MPI::Partitioner>(dofs.locally_owned_dofs(),
                                                                  relevant,
                                                                  dofs.get_communicator());
    unknowns = interleaved(*nodes, dim);
    find_positions();
    find_conditions();
    loads_vary = std::any_of(scene.initial_and_source.body_force.begin(),
                             scene.initial_and_source.body_force.end(),
                             [](const Expression &e) { return e.depends_on_time(); });
    for (const VectorCondition &condition : scene.boundary_conditions.traction)
      for (const auto &value : condition.values)
        loads_vary = loads_vary || (value && value->depends_on_time());
    initialize_vector(scratch);
    initialize_vector(constant_loads);
    initialize_vector(thermal_loads);
    cut_by_cracks.set(scene.cracks.pieces(0.), 0.);
    assemble();
    if (!loads_vary)
      assemble_loads(constant_loads, 0.);
  }


  template <int dim>
  ElasticElements<dim>::~ElasticElements() = default;


  template <int dim>
  void ElasticElements<dim>::find_positions()
  {
    positions.resize(nodes->locally_owned_size() + nodes->n_ghost_indices());
    if (coupling)
      {
        for (unsigned int i = 0; i < positions.size(); ++i)
          positions[i] = coupling->families().nodes().position(i);
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
              if (fe.has_support_on_face(i, f) && nodes->in_local_range(indices[i]))
                {
                  const types::boundary_id side = cell->face(f)->boundary_id();
                  const unsigned int       node = nodes->global_to_local(indices[i]);
                  if (seen.try_emplace({side, node}).second)
                    on_sides.push_back({node, side, positions[node]});
                  for (const Part &part : scene.boundary_conditions.parts)
                    if (part.side == side && part.holds(positions[node]) &&
                        seen.try_emplace({part.id, node}).second)
                      on_sides.push_back({node, part.id, positions[node]});
                }
      }
    part_unknowns = unknowns_of_parts(dofs, scene.boundary_conditions);
    for (const PartUnknown<dim> &unknown : part_unknowns)
      on_sides.push_back({unknown.node, unknown.id, unknown.position});
    const std::vector<Point<dim>> own(positions.begin(),
                                      positions.begin() + nodes->locally_owned_size());
    conditions = std::make_unique<DisplacementConditions<dim>>(on_sides,
                                                               own,
                                                               scene,
                                                               false,
                                                               dofs.get_communicator());
    conditions->pin(own, scene, false);
  }


  template <int dim>
  void ElasticElements<dim>::initialize_vector(Vector &vector) const
  {
    vector.reinit(unknowns);
  }


  template <int dim>
  void ElasticElements<dim>::initialize_nodal_vector(Vector &vector) const
  {
    vector.reinit(nodes);
  }


  template <int dim>
  void ElasticElements<dim>::multiply(Vector &y, const Vector &x) const
  {
    stiffness.vmult(y, x);
  }


  template <int dim>
  void ElasticElements<dim>::apply(Vector &y, const Vector &x) const
  {
    ++this->applications;
    stiffness.vmult(y, x);
    conditions->mask(y);
  }


  template <int dim>
  void ElasticElements<dim>::residual(Vector &r, const Vector &u, const double t) const
  {
    unbalanced(r, u, t);
    conditions->mask(r);
  }


  template <int dim>
  void ElasticElements<dim>::unbalanced(Vector &r, const Vector &u, const double t) const
  {
    ++this->applications;
    stiffness.vmult(r, u);
    if (loads_vary)
      assemble_loads(scratch, t);
    r.sadd(-1., 1., loads_vary ? scratch : constant_loads);
  }


  template <int dim>
  void ElasticElements<dim>::distribute(Vector &u, const double t) const
  {
    conditions->distribute(u, t);
  }

  template <int dim>
  void ElasticElements<dim>::distribute_homogeneous(Vector &x) const
  {
    conditions->mask(x);
  }

  template <int dim>
  void ElasticElements<dim>::clear_constrained(Vector &y) const
  {
    conditions->mask(y);
  }

  template <int dim>
  const Vector &ElasticElements<dim>::lumped_capacity() const
  {
    return mass;
  }

  template <int dim>
  const Vector &ElasticElements<dim>::diagonal() const
  {
    return stiffness_diagonal;
  }

  template <int dim>
  Spectrum ElasticElements<dim>::spectrum() const
  {
    std::vector<double> row_sums(mass.locally_owned_size(), 0.);
    for_each_entry(stiffness, [&](const unsigned int row, const auto, const double value) {
      row_sums[row] += std::abs(value);
    });
    double bound = 0.;
    for (unsigned int i = 0; i < row_sums.size(); ++i)
      bound = std::max(bound, row_sums[i] / mass.local_element(i));
    bound = Utilities::MPI::max(bound, dofs.get_communicator());
    return {bound, sharp_bound(*this, bound, [&](Vector &vector) { fill_noise(vector); })};
  }

  template <int dim>
  void ElasticElements<dim>::fill_noise(Vector &vector) const
  {
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      vector.local_element(i) = position_noise(positions[i / dim]) * (1. + i % dim);
  }

  template <int dim>
  bool ElasticElements<dim>::depends_on_time() const
  {
    return loads_vary || conditions->depends_on_time();
  }

  template <int dim>
  bool ElasticElements<dim>::has_steady_state() const
  {
    return true; // scenes that leave rigid motions free are refused when they are read
  }


  template <int dim>
  void ElasticElements<dim>::surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    matrix.copy_from(stiffness);
    Vector marked;
    initialize_vector(marked);
    conditions->mask(marked, 1.);
    hold_unknowns(matrix, marked);
  }

  template <int dim>
  bool ElasticElements<dim>::surrogate_is_exact() const
  {
    return true;
  }

  template <int dim>
  std::vector<Vector> ElasticElements<dim>::near_null_space() const
  {
    return rigid_motions(positions, mass);
  }


  template <int dim>
  std::string ElasticElements<dim>::place_of(const unsigned int local_index) const
  {
    std::ostringstream text;
    text << '(';
    for (unsigned int d = 0; d < dim; ++d)
      text << (d > 0 ? ", " : "") << positions[local_index / dim][d];
    text << ')';
    return text.str();
  }


  template <int dim>
  OperatorSize ElasticElements<dim>::size() const
  {
    OperatorSize size;
    size.unknowns = unknowns->size();
    size.nonzeros = stiffness.n_nonzero_elements();
    size.bonds    = n_bonds;
    size.memory   = stiffness.memory_consumption() + positions.capacity() * sizeof(Point<dim>);
    if (coupling)
      size.memory += coupling->memory_consumption();
    size.form = "matrix";
    return size;
  }

  template <int dim>
  bool ElasticElements<dim>::symmetric() const
  {
    return !coupling || coupling->symmetric();
  }

  template <int dim>
  unsigned int ElasticElements<dim>::n_components() const
  {
    return dim;
  }


  template <int dim>
  double ElasticElements<dim>::energy(const Vector &u) const
  {
    Vector image;
    initialize_vector(image);
    stiffness.vmult(image, u);
    return 0.5 * (u * image) - u * thermal_loads + thermal_energy;
  }

  template <int dim>
  const Point<dim> &ElasticElements<dim>::position(const unsigned int node) const
  {
    return positions[node];
  }

  template <int dim>
  const std::shared_ptr<const Utilities::MPI::Partitioner> &ElasticElements<dim>::node_layout()
    const
  {
    return nodes;
  }

  template <int dim>
  double ElasticElements<dim>::volume(const unsigned int node) const
  {
    return volumes.local_element(node);
  }


  template <int dim>
  std::vector<Vector> rigid_motions(const std::vector<Point<dim>> &positions, const Vector &layout)
  {
    // Rotations about the middle of the body's nodes, of a size near one.
    const unsigned int n_nodes = layout.locally_owned_size() / dim;
    Point<dim>         sum;
    double             n = n_nodes;
    for (unsigned int i = 0; i < n_nodes; ++i)
      sum += positions[i];
    const MPI_Comm communicator = layout.get_mpi_communicator();
    const auto total = Utilities::MPI::sum(static_cast<const Tensor<1, dim> &>(sum), communicator);
    const Point<dim> middle(total / Utilities::MPI::sum(n, communicator));
    double           farthest = 0.;
    for (unsigned int i = 0; i < n_nodes; ++i)
      farthest = std::max(farthest, positions[i].distance(middle));
    farthest = Utilities::MPI::max(farthest, communicator);
    std::vector<Vector> motions;
    for (unsigned int d = 0; d < dim; ++d)
      {
        motions.emplace_back(layout.get_partitioner());
        for (unsigned int i = 0; i < n_nodes; ++i)
          motions.back().local_element(dim * i + d) = 1.;
      }
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a + 1; b < dim; ++b)
        {
          motions.emplace_back(layout.get_partitioner());
          for (unsigned int i = 0; i < n_nodes; ++i)
            {
              const Tensor<1, dim> x                    = (positions[i] - middle) / farthest;
              motions.back().local_element(dim * i + a) = -x[b];
              motions.back().local_element(dim * i + b) = x[a];
            }
        }
    return motions;
  }


#define PERIDEAL_INSTANTIATE(dim)      \
  template class ElasticElements<dim>; \
  template std::vector<Vector> rigid_motions(const std::vector<Point<dim>> &, const Vector &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
