// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/solid/solid_matrices.h>
#include <perideal/operators/solid/state_operator.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "inversion.h"
#include "large_deformation.h"
#include "state_contact.h"

// What the state-based operator does when bonds have broken.

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The laws of nodes. Collective. */
    template <int dim>
    bool have_symmetric_tangents(const SolidBonds<dim> &solid)
    {
      const auto *const nodal = solid.correspondence();
      return nodal == nullptr || nodal->stresses.have_symmetric_tangents();
    }
  } // namespace


  template <int dim>
  StateOperator<dim>::StateOperator(Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : SolidOperator<dim>(body)
    , solid(nodes, body)
    , loads(solid, body)
    , breakage(solid, loads, body)
  {
    this->set_layout(nodes.partitioner());
    tau.reinit(nodes.partitioner());
    find_conditions(nodes);
    for (unsigned int k = 0; k < mass.locally_owned_size(); ++k)
      mass.local_element(k) =
        nodes.volume(k / dim) *
        (body.elasticity.is_static() ? 1. : body.material.density.value(position(k / dim)));
    find_stiffness_diagonal(solid, stiffness_diagonal);
    conditions->mask(stiffness_diagonal, 1.);
    find_thermal_strains();
    make_contact();
    breakage.tell_damage();
    this->stepping.symmetric_law = have_symmetric_tangents(solid);
  }


  template <int dim>
  void StateOperator<dim>::make_contact()
  {
    if (!body.elasticity.contact)
      return;
    const bool full = solid.kinematics.is_full();
    if (!full && this->may_part())
      this->set_contact(make_crack_contact(solid, body, this->nodes));
    if (full && !body.elasticity.is_static())
      this->set_contact(make_short_range_contact(solid, body));
  }


  template <int dim>
  void StateOperator<dim>::find_conditions(const Nodes<dim> &nodes)
  {
    std::vector<NodeOnSide<dim>> on_sides;
    for (const BoundaryShare &share : nodes.condition_shares())
      if (share.inside)
        on_sides.push_back({share.node, share.id, nodes.position(share.node)});
    std::vector<Point<dim>> positions;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      positions.push_back(nodes.position(i));
    const bool at_centers = body.domain.has_nodes_at_centers();
    conditions            = std::make_unique<DisplacementConditions<dim>>(on_sides,
                                                               positions,
                                                               body,
                                                               at_centers,
                                                               nodes.communicator());
    conditions->pin(positions, body, at_centers);
  }


  template <int dim>
  void StateOperator<dim>::set_temperature_change(const Vector &nodal)
  {
    this->keep_temperature_change(nodal);
    if (body.moduli_change())
      solid.take_temperatures(this->temperature_change());
    breakage.take_temperature_change(this->temperature_change());
    thermal_loads = 0.;
    find_thermal_strains();
    if (!body.moduli_change())
      return;
    find_stiffness_diagonal(solid, stiffness_diagonal);
    conditions->mask(stiffness_diagonal, 1.);
    contact->renew();
  }


  template <int dim>
  void StateOperator<dim>::find_thermal_strains()
  {
    const Nodes<dim> &nodes = solid.families.nodes();
    solid.thermal.set(
      nodes.n_local(),
      [&](const unsigned int i) { return this->thermal_strain_at(i); },
      nodes.communicator());
    solid.kinematics.take_thermal_strains();
    if (solid.by_family)
      solid.by_family->take_temperatures(this->temperature_change());
    solid.forces.forget_exceeding();
    this->set_contact_strains();
    find_thermal_loads();
  }


  template <int dim>
  void StateOperator<dim>::find_thermal_loads()
  {
    // Else it is in the extensions, or in the stresses.
    if (solid.thermal.any() && !solid.forces.is_bond_by_bond() && !solid.flows())
      {
        scratch = 0.;
        if (const auto *const nodal = solid.correspondence()) // what relaxes has no part in them
          nodal->find_forces(thermal_loads, scratch, 0.);
        else
          {
            find_tensions(scratch, true);
            solid.forces.find_forces(thermal_loads, scratch.begin(), tau);
          }
        thermal_loads *= -1.;
        if (solid.ends.images)
          solid.ends.images->kept_forces = solid.ends.images->sums_of_forces();
      }
    this->keep_constant_loads();
  }


  template <int dim>
  void StateOperator<dim>::find_tensions(const Vector &u, const bool strained) const
  {
    if (!solid.laws.volumetric)
      return;
    if (strained)
      solid.forces.find_tensions(tau.begin(), u.begin());
    else
      solid.sums.find_tensions(tau.begin(), u.begin());
    tau.update_ghost_values();
  }


  template <int dim>
  void StateOperator<dim>::sum_forces(Vector &y, const Vector &x, const bool with_dilatations) const
  {
    const bool volumetric = with_dilatations && solid.laws.volumetric;
    if (volumetric)
      find_tensions(x, false);
    solid.sums.find_forces(y, x.begin(), volumetric ? tau.begin() : nullptr);
  }


  template <int dim>
  void StateOperator<dim>::multiply(Vector &y, const Vector &x) const
  {
    if (solid.by_family && solid.by_family->has_tangent())
      {
        solid.by_family->multiply(y, x);
        return;
      }
    x.update_ghost_values();
    sum_forces(y, x, true);
    if (solid.kinematics.is_full())
      solid.forces.add_geometric_forces(y, x.begin());
    x.set_ghost_state(false);
  }


  template <int dim>
  void StateOperator<dim>::damping_force(Vector &y, const Vector &v) const
  {
    if (const auto *const nodal = solid.correspondence())
      nodal->multiply(y, v);
    else
      {
        const double slope = std::exchange(solid.laws.slope, 1.); // viscosity does not relax
        v.update_ghost_values();
        sum_forces(y, v, false);
        v.set_ghost_state(false);
        solid.laws.slope = slope;
      }
    conditions->mask(y);
  }


  template <int dim>
  void StateOperator<dim>::find_forces(Vector &y, const Vector &u, const double t) const
  {
    if (solid.remembers())
      {
        solid.by_family->find_forces(y, u, t);
        return;
      }
    if (!solid.forces.is_bond_by_bond())
      {
        multiply(y, u);
        return;
      }
    solid.law.set_time(t);
    if (solid.law.any() && solid.law->is_linear())
      solid.laws.slope = solid.law->slope({}, nullptr);
    u.update_ghost_values();
    find_tensions(u, true);
    solid.forces.find_forces(y, u.begin(), tau);
    u.set_ghost_state(false);
  }


  template <int dim>
  void StateOperator<dim>::linearize(const Vector &u)
  {
    if (!nonlinear())
      return;
    if (solid.flows())
      {
        solid.by_family->linearize(u);
        this->stepping.symmetric_law = have_symmetric_tangents(solid);
        contact->linearize(u);
        return;
      }
    u.update_ghost_values();
    find_tensions(u, true);
    solid.forces.linearize(u.begin(), tau);
    u.set_ghost_state(false);
    contact->linearize(u);
  }


  template <int dim>
  double StateOperator<dim>::largest_stretch(const Vector &u) const
  {
    if (solid.flows() && solid.kinematics.is_full())
      {
        double largest = 0.;
        for (const SymmetricTensor<2, dim> &strain : solid.correspondence()->tensors(u).strain)
          largest = std::max(largest, stiffening_of(strain));
        return Utilities::MPI::max(largest, solid.families.nodes().communicator());
      }
    if (!nonlinear() || solid.flows()) // which makes no body stiffer
      return 0.;
    u.update_ghost_values();
    const double largest = solid.forces.largest_stretch(u.begin());
    u.set_ghost_state(false);
    return largest;
  }


  template <int dim>
  void StateOperator<dim>::find_loads(Vector &all_loads, const double t) const
  {
    all_loads = thermal_loads;
    loads.for_each(t, [&](const auto, const unsigned int unknown, const double value) {
      all_loads.local_element(unknown) += this->stepping.load_factor * value;
    });
  }


  template <int dim>
  ForceBalance StateOperator<dim>::forces(const Vector &u, const double t) const
  {
    Vector all_loads, reactions;
    this->initialize_vector(all_loads);
    this->initialize_vector(reactions);
    find_loads(all_loads, t);
    find_forces(reactions, u, t);
    contact->add_forces(reactions, u, 1.);
    reactions -= all_loads;
    std::map<types::boundary_id, Tensor<1, dim>> sums;
    conditions->add_reactions(reactions, sums);
    if (solid.ends.images)
      {
        if (solid.relaxing() != nullptr)
          solid.relaxing()->pull_images(u);
        // Bonds to mirror images pull at the body; those of the last application are known.
        for (const auto &[side, force] : solid.ends.images->forces_of_planes())
          if (force != Tensor<1, dim>())
            sums[side] += force;
      }
    loads.for_each(t, [&](const auto side, const unsigned int unknown, const double value) {
      sums[side][unknown % dim] += this->stepping.load_factor * value;
    });
    return gather_forces(sums, body, solid.families.nodes().communicator());
  }


  template <int dim>
  double StateOperator<dim>::energy(const Vector &u) const
  {
    const Nodes<dim> &nodes = solid.families.nodes();
    if (solid.by_family)
      return solid.by_family->energy(u) + contact->energy(u);
    if (solid.law.any())
      return solid.forces.energy_of(solid.rows.body.nodes, u) + contact->energy(u);
    u.update_ghost_values();
    find_tensions(u, solid.kinematics.is_strained());
    double sum = solid.forces.energy_of_extensions(u.begin());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const StateLaw &law = solid.laws[i];
        if (solid.laws.volumetric && law.volumetric != 0.)
          {
            const double theta =
              tau.local_element(i) * solid.laws.weighted.local_element(i) / law.volumetric;
            sum += 0.5 * law.volumetric / law.dilatation * nodes.volume(i) * theta * theta;
          }
      }
    u.set_ghost_state(false);
    return Utilities::MPI::sum(sum, nodes.communicator()) + contact->energy(u);
  }


  template <int dim>
  NodalTensors<dim> StateOperator<dim>::tensors(const Vector &u) const
  {
    if (const auto *const yielding = solid.yielding())
      {
        yielding->find(u);
        return nodal_tensors(solid, u, tau);
      }
    if (solid.by_family)
      return nodal_tensors(solid, u, tau);
    u.update_ghost_values();
    find_tensions(u, solid.kinematics.is_strained() || solid.law.any());
    return nodal_tensors(solid, u, tau);
  }


  template <int dim>
  double StateOperator<dim>::largest_row(const Vector &of_dilatations,
                                         const bool    of_tangent,
                                         double        factor) const
  {
    const Vector rows    = find_row_sums(solid, of_dilatations, of_tangent);
    double       largest = 0.;
    factor *= Utilities::MPI::max(solid.forces.largest_slope(), rows.get_mpi_communicator());
    for (unsigned int i = 0; i < rows.locally_owned_size(); ++i)
      {
        const double row = rows.local_element(i) + (of_tangent ? contact->row_bound(i) : 0.);
        largest          = std::max(largest, factor * row / mass.local_element(dim * i));
      }
    return Utilities::MPI::max(largest, solid.families.nodes().communicator());
  }


  template <int dim>
  double StateOperator<dim>::damping_bound() const
  {
    return largest_row(Vector(solid.families.nodes().partitioner()), false, 1.);
  }


  template <int dim>
  Spectrum StateOperator<dim>::spectrum() const
  {
    if (solid.by_family) // steps have to be stable where it does not flow or relax, any more
      solid.by_family->forget_tangent();
    const Vector of_dilatations = find_sums_of_dilatations(solid);
    // Rows of correspondence are those of numbers, not of blocks.
    const double of_blocks = solid.correspondence() ? 1. : std::sqrt(static_cast<double>(dim)),
                 bound     = largest_row(of_dilatations, true, of_blocks);
    return {bound, sharp_bound(*this, bound, [&](Vector &vector) { this->fill_noise(vector); })};
  }


  template <int dim>
  void StateOperator<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    make_surrogate(solid, body, stiffness_diagonal, this->held_unknowns(), matrix);
  }

  template <int dim>
  bool StateOperator<dim>::holds(const CellCorner<dim> &corner) const
  {
    if (solid.rows.is_on_lattice(corner.node))
      return true;
    unsigned int n_found = 0;
    bool         broken  = false;
    solid.rows.for_each_stored(corner.node, [&](const auto &bond) {
      broken = broken || !solid.rows.is_whole(bond.number);
      if (std::find(corner.others.begin(), corner.others.end(), bond.neighbor) !=
          corner.others.end())
        ++n_found;
    });
    return !broken && n_found == dim; // no crack of the scene has cut one
  }


  template <int dim>
  Inversion StateOperator<dim>::inverted(const Vector &u) const
  {
    // Displacements may be of any size.
    if ((solid.law.any() || solid.remembers()) && !solid.kinematics.is_full())
      return {};
    const Nodes<dim> &nodes  = solid.families.nodes();
    const auto       &layout = *nodes.partitioner();
    if (corners.empty())
      corners = cell_corners<dim>(nodes.dof_handler(),
                                  nodes.n_owned(),
                                  [&](const types::global_dof_index i) {
                                    return layout.in_local_range(i) || layout.is_ghost_entry(i) ?
                                             layout.global_to_local(i) :
                                             numbers::invalid_unsigned_int;
                                  });
    u.update_ghost_values();
    const Inversion result = find_inverted<dim>(
      corners,
      u,
      [&](const unsigned int node) { return nodes.position(node); },
      [&](const CellCorner<dim> &corner) { return holds(corner); },
      nodes.communicator());
    u.set_ghost_state(false);
    return result;
  }


  template <int dim>
  OperatorSize StateOperator<dim>::size() const
  {
    const MPI_Comm        all  = solid.families.nodes().communicator();
    const BondTable<dim> &rows = solid.rows;
    OperatorSize          size;
    size.unknowns = mass.size();
    size.bonds    = std::llround(Utilities::MPI::sum(rows.n_bonds, all));
    size.nonzeros =
      std::llround(Utilities::MPI::sum(static_cast<double>(rows.body.size()) * (dim + 1.), all));
    size.memory = solid.families.memory_consumption() + breakage.memory_consumption() +
                  solid.laws.memory_consumption() + solid.thermal.memory_consumption() +
                  solid.kinematics.memory_consumption() + solid.forces.memory_consumption() +
                  rows.memory_consumption() + solid.sums.memory_consumption() +
                  (solid.ends.images ? solid.ends.images->memory_consumption() : 0) +
                  (solid.by_family ? solid.by_family->memory_consumption() : 0) +
                  contact->memory_consumption();
    size.form = solid.rows.body.leaves_out() ? "lattice" : "stored";
    return size;
  }


  template <int dim>
  void StateOperator<dim>::accept(const Vector &u, const double t)
  {
    if (solid.remembers())
      this->released_beside.by_law += solid.by_family->accept(u, t);
    if (!solid.law.any())
      return;
    solid.law.set_time(t);
    if (solid.law.n_history() > 0)
      this->released_beside.by_law += solid.forces.energy_of(solid.rows.body.nodes, u, true);
    solid.law.accept(t);
  }


  template <int dim>
  std::vector<unsigned int> StateOperator<dim>::renew_tensions(const Vector &u,
                                                               Vector       &change) const
  {
    const Nodes<dim> &nodes = solid.families.nodes();
    change.reinit(tau.get_partitioner());
    for (const unsigned int i : breakage.nodes_at_work())
      {
        const double now =
          solid.laws.tension(i, sum_over_bonds(solid.rows, i, [&](const auto &bond) {
                               return solid.kinematics.extension_moment(u.begin(), i, bond);
                             }));
        change.local_element(i) = now - tau.local_element(i);
        tau.local_element(i)    = now;
      }
    change.update_ghost_values();
    tau.update_ghost_values();
    // In the order of all processes, for the same digits.
    std::vector<unsigned int> changed;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      if (change.local_element(i) != 0.)
        changed.push_back(i);
    std::sort(changed.begin(), changed.end(), [&](const unsigned int a, const unsigned int b) {
      return nodes.partitioner()->local_to_global(a) < nodes.partitioner()->local_to_global(b);
    });
    return changed;
  }


  /*
   * tau is new at the nodes that have lost bonds: their neighbours' forces change by that along the
   * bonds between them, whole at both ends or at none. Their own forces are sums over their rows.
   */
  template <int dim>
  void StateOperator<dim>::mend_linear(Vector                          &r,
                                       const Vector                    &u,
                                       const std::vector<unsigned int> &changed,
                                       const Vector                    &change) const
  {
    const Nodes<dim>                &nodes  = solid.families.nodes();
    const std::vector<unsigned int> &losing = breakage.nodes_at_work();
    const auto                       loses  = [&](const unsigned int i) {
      return std::binary_search(losing.begin(), losing.end(), i);
    };
    const auto add = [&](const unsigned int k, const double of_tau, const Tensor<1, dim> &moment) {
      for (unsigned int d = 0; d < dim; ++d)
        r.local_element(dim * k + d) += of_tau * moment[d];
    };
    std::vector<typename Families<dim>::Member> family;
    for (const unsigned int i : changed)
      {
        const double of_tau = change.local_element(i);
        solid.families.members_of(i, family);
        for (const auto &member : family)
          if (const unsigned int k = member.neighbor; k < nodes.n_owned() && !loses(k))
            {
              if (solid.rows.is_on_lattice(k))
                add(k, of_tau, member.weight * solid.families.neighbors().bond_vector(k, i));
              else
                solid.rows.for_each_stored(k, [&](const auto &bond) {
                  if (bond.neighbor == i)
                    add(k, of_tau, bond.moment);
                });
            }
      }
    for (const unsigned int i : losing)
      {
        const Tensor<1, dim> force = solid.forces.force_on(i, u.begin(), tau);
        for (unsigned int d = 0; d < dim; ++d)
          r.local_element(dim * i + d) = scratch.local_element(dim * i + d) + force[d];
      }
  }


  template <int dim>
  void StateOperator<dim>::sum_again(Vector                          &r,
                                     const Vector                    &u,
                                     const std::vector<unsigned int> &changed) const
  {
    const unsigned int     n_owned = solid.families.nodes().n_owned();
    std::set<unsigned int> rows(breakage.nodes_at_work().begin(), breakage.nodes_at_work().end());
    std::vector<typename Families<dim>::Member> family;
    for (const unsigned int i : changed)
      {
        solid.families.members_of(i, family);
        for (const auto &member : family)
          if (member.neighbor < n_owned)
            rows.insert(member.neighbor);
      }
    const std::vector<unsigned int> list(rows.begin(), rows.end());
    solid.forces.find_forces_of(list, r.begin(), u.begin(), tau);
    for (const unsigned int i : list)
      for (unsigned int k = dim * i; k < dim * (i + 1); ++k)
        r.local_element(k) = scratch.local_element(k) - r.local_element(k);
  }


  template <int dim>
  void StateOperator<dim>::mend_unbalanced(Vector &r, const Vector &u, const double t) const
  {
    const Nodes<dim>                &nodes  = solid.families.nodes();
    const std::vector<unsigned int> &losing = breakage.nodes_at_work();
    const double n_losing = Utilities::MPI::sum(1. * losing.size(), nodes.communicator());
    double       hinder   = n_losing > 0.1 * nodes.n_global() ? 1. : 0.;
    if (solid.law.any() || solid.by_family ||
        (nonlinear() ? solid.ends.images != nullptr :
                       !solid.sums.has_lattice() || solid.thermal.any()))
      hinder = 1.;
    for (const unsigned int i : losing)
      {
        if (solid.ends.images && solid.ends.images->is_followed(i))
          hinder = 1.; // their rows are not all that pulls at them
        // tau of these changes what their images bear
        solid.rows.for_each_beyond(i, [&](const auto &) { hinder = 1.; });
      }
    if (Utilities::MPI::max(hinder, nodes.communicator()) > 0.)
      {
        this->unbalanced(r, u, t);
        return;
      }
    contact->add_last_forces(r, 1.);
    u.update_ghost_values();
    std::vector<unsigned int> changed;
    Vector                    change;
    if (solid.laws.volumetric)
      changed = renew_tensions(u, change);
    find_loads(scratch, t);
    if (nonlinear())
      sum_again(r, u, changed);
    else
      mend_linear(r, u, changed, change);
    u.set_ghost_state(false);
    contact->add_forces(r, u, -1.);
  }


  template <int dim>
  unsigned long long StateOperator<dim>::break_bonds(const Vector &u,
                                                     const double  t,
                                                     const double  share)
  {
    const unsigned long long before = this->n_broken_bonds();
    const auto               change = breakage.break_bonds(u, t, share, [&]() {
      solid.renew_gradients(breakage.nodes_at_work());
      const auto &at_work = breakage.nodes_at_work();
      if (const auto *const relaxing = solid.relaxing())
        return relaxing->energy_of(at_work, u);
      const auto *const nodal = solid.correspondence();
      return nodal != nullptr ? nodal->energy_of(at_work, u) : solid.forces.energy_of(at_work, u);
    });
    if (!change)
      {
        solid.renew_gradients({}); // nodes may store their bonds now all the same
        return 0;
      }
    // Laws that know damage take energy from bonds that are whole, too.
    const bool   weakens = solid.law.any() && solid.law->knows_damage();
    const auto  &all     = solid.rows.body.nodes;
    const double stored  = weakens ? solid.forces.energy_of(all, u) : 0.;
    apply_change(*change, true);
    if (weakens)
      breakage.add_released(stored - solid.forces.energy_of(all, u));
    breakage.add_released(contact->change(change->nodes, u));
    return breakage.stored_at_onset() > 0. ? breakage.n_last() : this->n_broken_bonds() - before;
  }


  template <int dim>
  void StateOperator<dim>::apply_change(const ChangeSet<dim> &change, const bool loaded)
  {
    if (!change.damage)
      solid.apply_change(change, loaded);
    follow_bonds(change.damage ? &change.nodes : nullptr);
  }


  template <int dim>
  void StateOperator<dim>::follow_bonds(const std::vector<unsigned int> *of_nodes)
  {
    if (!of_nodes)
      {
        solid.renew_gradients(solid.rows.body.nodes);
        solid.renew_gradients(solid.rows.beyond.nodes);
      }
    if (of_nodes && !solid.ends.images && !solid.correspondence())
      mend_stiffness_diagonal(solid, *of_nodes, stiffness_diagonal);
    else if (!of_nodes || !this->stepping.follow)
      find_stiffness_diagonal(solid, stiffness_diagonal);
    conditions->mask(stiffness_diagonal, 1.);
    if (solid.thermal.any())
      find_thermal_loads();
    breakage.tell_damage();
  }


  template <int dim>
  void StateOperator<dim>::exchange_bonds(Archive                     &archive,
                                          const NodeKeys              &keys,
                                          const std::function<void()> &at_surrogate)
  {
    breakage.exchange(archive, keys, marks_of_surrogate, [&]() {
      follow_bonds();
      at_surrogate();
    });
    if (archive.loads() && this->brittle())
      follow_bonds();
    if (!solid.law.any() && !solid.remembers())
      return;
    const Archive::Part part(archive, "law");
    solid.law.exchange(archive);
    archive.exchange("dissipated", this->released_beside.by_law);
    if (solid.remembers())
      solid.by_family->exchange(archive, keys);
    if (solid.law.n_history() > 0)
      exchange_histories(solid.rows, archive, keys, solid.law.n_history());
  }


  PERIDEAL_INSTANTIATE_CLASS(class StateOperator);
} // namespace PeriDeal
