// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What the state-based operator does when bonds have broken.

#include <deal.II/base/mpi.h>

#include <perideal/laws/elasticity.h>
#include <perideal/operators/solid/solid_matrices.h>
#include <perideal/operators/solid/state_operator.h>

#include <algorithm>
#include <set>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  double StateOperator<dim>::energy_of(const std::vector<unsigned int> &of_nodes,
                                       const Vector                    &u) const
  {
    u.update_ghost_values();
    if (solid.beyond)
      solid.beyond->images().find(u.begin());
    double sum = 0.;
    for (const unsigned int i : of_nodes)
      {
        double of_node = 0., own = 0.; // sum of W x e
        solid.rows.for_each(i, [&](const auto &bond) {
          const double product = solid.kinematics.extension_moment(u.begin(), i, bond);
          own += product;
          of_node += 0.25 * bond.spring * product * product;
        });
        if (solid.beyond)
          solid.beyond->for_each_of(i, [&](const auto &bond) {
            const double product = solid.beyond->extension_moment(bond, u.begin());
            own += product;
            of_node += 0.5 * bond.spring * product * product;
          });
        if (solid.laws.volumetric)
          of_node += 0.5 * solid.laws.tension(i, own) * own;
        sum += of_node;
      }
    u.set_ghost_state(false);
    return Utilities::MPI::sum(sum, solid.families.nodes().communicator());
  }


  template <int dim>
  std::vector<unsigned int> StateOperator<dim>::renew_tensions(const Vector &u,
                                                               Vector       &change) const
  {
    const Nodes<dim> &nodes = solid.families.nodes();
    change.reinit(tau.get_partitioner());
    for (const unsigned int i : breakage.nodes_at_work())
      {
        double sum = 0.;
        solid.rows.for_each_stored(i, [&](const auto &bond) {
          sum += solid.kinematics.extension_moment(u.begin(), i, bond);
        });
        const double now        = solid.laws.tension(i, sum);
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
        Tensor<1, dim> force;
        solid.rows.for_each_stored(i, [&](const auto &bond) {
          double size = bond.spring * solid.kinematics.extension_moment(u.begin(), i, bond);
          if (solid.laws.volumetric)
            size += tau.local_element(i) + tau.local_element(bond.neighbor);
          force += size * bond.moment;
        });
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
    solid.kinematics.find_forces_of(list, r.begin(), u.begin(), tau);
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
    if (nonlinear() ? solid.beyond != nullptr : !solid.rows.has_lattice() || solid.thermal.any())
      hinder = 1.;
    if (solid.beyond)
      for (const unsigned int i : losing)
        {
          if (solid.beyond->images().is_followed(i)) // their rows are not all that pulls at them
            hinder = 1.;
          // tau of these changes what their images bear
          solid.beyond->for_each_of(i, [&](const auto &) { hinder = 1.; });
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
    const auto               change =
      breakage.break_bonds(u, t, share, [&]() { return energy_of(breakage.nodes_at_work(), u); });
    if (!change)
      return 0;
    apply_change(*change, true);
    breakage.add_released(contact->change(change->nodes, u));
    return this->n_broken_bonds() - before;
  }


  template <int dim>
  void StateOperator<dim>::apply_change(const ChangeSet<dim> &change, const bool loaded)
  {
    if (!change.damage)
      breakage.apply_change(change, loaded);
    follow_bonds(change.damage ? &change.nodes : nullptr);
  }


  template <int dim>
  void StateOperator<dim>::follow_bonds(const std::vector<unsigned int> *of_nodes)
  {
    if (of_nodes && !solid.beyond)
      mend_stiffness_diagonal(solid, *of_nodes, stiffness_diagonal);
    else if (!of_nodes || !this->forgoes_diagonal)
      find_stiffness_diagonal(solid, stiffness_diagonal);
    conditions->mask(stiffness_diagonal, 1.);
    if (solid.thermal.any())
      find_thermal_loads();
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
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                   \
  template double StateOperator<dim>::energy_of(const std::vector<unsigned int> &, const Vector &)  \
    const;                                                                                          \
  template void StateOperator<dim>::mend_unbalanced(Vector &, const Vector &, const double) const;  \
  template unsigned long long StateOperator<dim>::break_bonds(const Vector &, double, double);      \
  template void               StateOperator<dim>::apply_change(const ChangeSet<dim> &, const bool); \
  template void               StateOperator<dim>::follow_bonds(const std::vector<unsigned int> *);  \
  template void               StateOperator<dim>::exchange_bonds(Archive &,                         \
                                                   const NodeKeys &,                  \
                                                   const std::function<void()> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
