// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/interleaved.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/elastic_elements.h>
#include <perideal/operators/spectrum.h>
#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  StateOperator<dim>::StateOperator(Nodes<dim> &nodes, const Scene<dim> &scene)
    : scene(scene)
    , bonds(nodes.find_parts(scene.boundary_conditions), scene)
    , unknowns(interleaved(*nodes.partitioner(), dim))
    , full(scene.elasticity.kinematics == Kinematics::full)
  {
    std::vector<NodeOnSide<dim>> on_sides;
    for (const BoundaryShare &share : nodes.condition_shares())
      if (share.inside)
        on_sides.push_back({share.node, share.id, nodes.position(share.node)});
    std::vector<Point<dim>> positions;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      positions.push_back(nodes.position(i));
    const bool at_centers = scene.domain.nodes == NodePlacement::cell_centers;
    conditions            = std::make_unique<DisplacementConditions<dim>>(on_sides,
                                                               positions,
                                                               scene,
                                                               at_centers,
                                                               nodes.communicator());
    conditions->pin(positions, scene, at_centers);
    const auto &force = scene.initial_and_source.body_force;
    loads_vary        = std::any_of(force.begin(), force.end(), [](const Expression &e) {
      return e.depends_on_time();
    });
    for (const VectorCondition &condition : scene.boundary_conditions.traction)
      for (const auto &value : condition.values)
        loads_vary = loads_vary || (value && value->depends_on_time());
    for (Vector *v : {&scratch, &mass, &stiffness_diagonal, &thermal_loads, &constant_loads})
      initialize_vector(*v);
    source.reinit(nodes.partitioner());
    tau.reinit(nodes.partitioner());
    weighted.reinit(nodes.partitioner());
    tractions = traction_shares(nodes, scene.boundary_conditions);
    find_laws();
    find_bonds();
    find_critical_stretches();
    find_diagonal();
    find_thermal_loads();
  }


  template <int dim>
  StateOperator<dim>::~StateOperator() = default;


  template <int dim>
  void StateOperator<dim>::find_thermal_loads()
  {
    if (beyond && any_thermal)
      beyond->set_thermal_strains([&](const unsigned int i) { return laws[i].thermal; });
    if (any_thermal && !full) // with full kinematics it is in the extensions
      {
        const Nodes<dim> &nodes = bonds.nodes();
        scratch                 = 0.;
        if (volumetric)
          find_strained_dilatation_forces(scratch);
        const double *const t = tau.begin();
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          {
            Tensor<1, dim> force;
            for_each_bond(i, [&](const Bond &bond) {
              force += (bond.spring * extension_moment(scratch.begin(), i, bond) + t[i] +
                        t[bond.neighbor]) *
                       bond.moment;
            });
            for (unsigned int d = 0; d < dim; ++d)
              thermal_loads.local_element(dim * i + d) = force[d];
          }
        thermal_loads *= -1.;
        add_strained_image_forces(thermal_loads, scratch);
        if (beyond)
          beyond->keep_forces();
        thermal_loads *= -1.;
      }
    if (!loads_vary)
      find_loads(constant_loads, 0.);
  }


  template <int dim>
  void StateOperator<dim>::find_laws()
  {
    const Nodes<dim> &nodes = bonds.nodes();
    const PlaneState  plane = scene.elasticity.plane;
    laws.resize(nodes.n_local());
    double largest = 0., smallest = 1e300, hottest = 0.;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const Point<dim> &p      = nodes.position(i);
        const Moduli      moduli = scene.material.moduli(p);
        laws[i].law              = scene.elasticity.model == ElasticModel::bond_based ?
                                     bond_law(moduli, dim, plane) :
                                     state_law(moduli, dim, plane);
        laws[i].thermal          = thermal_strain_factor(moduli, dim, plane) *
                          scene.material.thermal_expansion.value(p) *
                          scene.elasticity.temperature_change.value(p);
        largest  = std::max(largest, laws[i].law.extension);
        smallest = std::min(smallest, laws[i].law.extension);
        hottest  = std::max(hottest, std::abs(laws[i].thermal));
        if (i < nodes.n_owned())
          for (unsigned int d = 0; d < dim; ++d)
            mass.local_element(dim * i + d) =
              nodes.volume(i) *
              (scene.elasticity.is_static() ? 1. : scene.material.density.value(p));
      }
    const MPI_Comm all = nodes.communicator();
    any_thermal        = Utilities::MPI::max(hottest, all) > 0.;
    several_phases     = Utilities::MPI::max(largest, all) >
                     (1. + 1e-12) * Utilities::MPI::min(smallest, all);
    volumetric = scene.elasticity.model == ElasticModel::state_based && dim > 1;
  }


  template <int dim>
  void StateOperator<dim>::find_dilatation_forces(const Vector &x) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    const double     *u     = x.begin();
    if (lattice)
      lattice->dilatation_forces(tau.begin(), u);
    for (const unsigned int i : stored_nodes)
      {
        Tensor<1, dim> own;
        for (unsigned int d = 0; d < dim; ++d)
          own[d] = u[dim * i + d];
        double sum = 0.;
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
          {
            const double *const   v = u + dim * neighbors[k];
            const Tensor<1, dim> &p = moments[k];
            for (unsigned int d = 0; d < dim; ++d)
              sum += p[d] * (v[d] - own[d]);
          }
        const StateLaw &law  = laws[i].law;
        const double    q    = weighted.local_element(i);
        tau.local_element(i) = law.volumetric * law.dilatation * sum / (q * q * nodes.volume(i));
      }
    add_images_to_dilatations(x, false);
    tau.update_ghost_values();
  }


  template <int dim>
  void StateOperator<dim>::sum_forces(Vector &y, const Vector &x) const
  {
    const double *u = x.begin();
    if (volumetric)
      find_dilatation_forces(x);
    const double *const t = tau.begin();
    if (lattice)
      lattice->forces(y.begin(), u, volumetric ? t : nullptr);
    for (const unsigned int i : stored_nodes)
      {
        Tensor<1, dim> own, force;
        for (unsigned int d = 0; d < dim; ++d)
          own[d] = u[dim * i + d];
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
          {
            const unsigned int    j       = neighbors[k];
            const double *const   v       = u + dim * j;
            const Tensor<1, dim> &p       = moments[k];
            double                product = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              product += p[d] * (v[d] - own[d]);
            const double size = springs[k] * product + t[i] + t[j];
            for (unsigned int d = 0; d < dim; ++d)
              force[d] += size * p[d];
          }
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) = -force[d];
      }
    if (!beyond)
      return;
    if (!volumetric) // else they have been found
      beyond->find_images(u);
    beyond->add_forces(y, x, volumetric ? t : nullptr);
  }


  template <int dim>
  void StateOperator<dim>::multiply(Vector &y, const Vector &x) const
  {
    x.update_ghost_values();
    sum_forces(y, x);
    if (full)
      add_geometric_forces(y, x);
    x.set_ghost_state(false);
  }


  template <int dim>
  void StateOperator<dim>::initialize_vector(Vector &vector) const
  {
    vector.reinit(unknowns);
  }


  template <int dim>
  void StateOperator<dim>::apply(Vector &y, const Vector &x) const
  {
    ++this->applications;
    multiply(y, x);
    conditions->mask(y);
  }


  template <int dim>
  void StateOperator<dim>::residual(Vector &r, const Vector &u, const double t) const
  {
    unbalanced(r, u, t);
    conditions->mask(r);
  }


  template <int dim>
  void StateOperator<dim>::unbalanced(Vector &r, const Vector &u, const double t) const
  {
    ++this->applications;
    find_forces(r, u);
    if (loads_vary)
      find_loads(scratch, t);
    r.sadd(-1., 1., loads_vary ? scratch : constant_loads);
  }


  template <int dim>
  void StateOperator<dim>::mechanical_loads(Vector &loads, const double t) const
  {
    find_loads(loads, t);
    loads -= thermal_loads;
  }


  template <int dim>
  void StateOperator<dim>::distribute(Vector &u, const double t) const
  {
    conditions->distribute(u, t);
  }

  template <int dim>
  void StateOperator<dim>::distribute_homogeneous(Vector &x) const
  {
    conditions->mask(x);
  }

  template <int dim>
  void StateOperator<dim>::clear_constrained(Vector &y) const
  {
    conditions->mask(y);
  }

  template <int dim>
  const Vector &StateOperator<dim>::lumped_capacity() const
  {
    return mass;
  }

  template <int dim>
  const Vector &StateOperator<dim>::diagonal() const
  {
    return stiffness_diagonal;
  }

  template <int dim>
  bool StateOperator<dim>::depends_on_time() const
  {
    return loads_vary || conditions->depends_on_time();
  }

  template <int dim>
  bool StateOperator<dim>::has_steady_state() const
  {
    return true; // scenes that leave rigid motions free are refused when they are read
  }

  template <int dim>
  bool StateOperator<dim>::surrogate_is_exact() const
  {
    return false;
  }

  template <int dim>
  std::vector<Vector> StateOperator<dim>::near_null_space() const
  {
    std::vector<Point<dim>> positions;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      positions.push_back(bonds.nodes().position(i));
    return rigid_motions(positions, mass);
  }

  template <int dim>
  std::string StateOperator<dim>::place_of(const unsigned int local_index) const
  {
    const Point<dim>  &p = bonds.nodes().position(local_index / dim);
    std::ostringstream text;
    text << '(';
    for (unsigned int d = 0; d < dim; ++d)
      text << (d > 0 ? ", " : "") << p[d];
    text << ')';
    return text.str();
  }

  template <int dim>
  OperatorSize StateOperator<dim>::size() const
  {
    const MPI_Comm all = bonds.nodes().communicator();
    OperatorSize   size;
    size.unknowns = unknowns->size();
    size.bonds    = std::llround(Utilities::MPI::sum(n_bonds, all));
    size.nonzeros =
      std::llround(Utilities::MPI::sum(static_cast<double>(neighbors.size()) * (dim + 1.), all));
    size.memory =
      bonds.memory_consumption() + state.memory_consumption() +
      neighbors.size() * (sizeof(unsigned int) + sizeof(Tensor<1, dim>) + sizeof(double)) +
      laws.size() * sizeof(NodeLaw) + starts.size() * sizeof(std::size_t) +
      stored_nodes.size() * sizeof(unsigned int) + (lattice ? lattice->memory_consumption() : 0) +
      (beyond ? beyond->memory_consumption() : 0);
    size.form = lattice ? "lattice" : "stored";
    return size;
  }

  template <int dim>
  unsigned int StateOperator<dim>::n_components() const
  {
    return dim;
  }

  template <int dim>
  const Families<dim> &StateOperator<dim>::families() const
  {
    return bonds;
  }


  template <int dim>
  template <typename Visit>
  void StateOperator<dim>::for_each_load(const double t, const Visit &visit) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    const auto       &force = scene.initial_and_source.body_force;
    for (unsigned int i = 0; i < nodes.n_owned() && !force.empty(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        visit(numbers::internal_face_boundary_id,
              dim * i + d,
              nodes.volume(i) * force[d].value(nodes.position(i), t));
    for (const TractionShare<dim> &share : tractions)
      {
        const auto &values = find_condition(scene.boundary_conditions.traction, share.side)->values;
        for (unsigned int d = 0; d < dim; ++d)
          visit(share.side, dim * share.node + d, share.area * values[d]->value(share.place, t));
      }
  }


  template <int dim>
  void StateOperator<dim>::find_loads(Vector &loads, const double t) const
  {
    loads = thermal_loads;
    for_each_load(t, [&](const auto, const unsigned int unknown, const double value) {
      loads.local_element(unknown) += value;
    });
  }


  template <int dim>
  ForceBalance StateOperator<dim>::forces(const Vector &u, const double t) const
  {
    Vector loads, reactions;
    initialize_vector(loads);
    initialize_vector(reactions);
    find_loads(loads, t);
    find_forces(reactions, u);
    reactions -= loads;
    std::map<types::boundary_id, Tensor<1, dim>> sums;
    conditions->add_reactions(reactions, sums);
    if (beyond)
      {
        // Bonds to mirror images pull at the body; those of the last application are known.
        for (const auto &[side, force] : beyond->forces_of_planes())
          if (force != Tensor<1, dim>())
            sums[side] += force;
      }
    for_each_load(t, [&](const auto side, const unsigned int unknown, const double value) {
      sums[side][unknown % dim] += value;
    });
    return gather_forces(sums, scene, bonds.nodes().communicator());
  }


  template class StateOperator<1>;
  template class StateOperator<2>;
  template class StateOperator<3>;
} // namespace PeriDeal
