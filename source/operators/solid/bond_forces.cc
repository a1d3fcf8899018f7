// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/bond_forces.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  BondForces<dim>::BondForces(const Families<dim>       &families,
                              const BondEnds<dim>       &ends,
                              BondTable<dim>            &bonds,
                              const NodeLaws<dim>       &laws,
                              const LawSteps            &law,
                              const BondKinematics<dim> &kinematics)
    : families(families)
    , ends(ends)
    , bonds(bonds)
    , laws(laws)
    , law(law)
    , kinematics(kinematics)
  {}


  template <int dim>
  DeformedRows BondForces<dim>::rows_at(const double *u, const Vector *tau) const
  {
    using Node        = DeformedRows::Node;
    seen              = false;
    const bool is_new = nodes.empty();
    nodes.resize(families.nodes().n_local());
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        double *const to = nodes[i].numbers;
        for (unsigned int d = 0; is_new && d < dim; ++d)
          to[d] = families.nodes().position(i)[d];
        for (unsigned int d = 0; d < dim; ++d)
          to[Node::displacement + d] = u[dim * i + d];
        to[Node::strain] = kinematics.strains()[i];
        if (tau != nullptr)
          to[Node::tau] = tau->local_element(i);
      }

    DeformedRows all;
    all.starts    = bonds.body.starts.data();
    all.end       = bonds.body.nodes.size();
    all.neighbors = bonds.body.neighbors.data();
    all.springs   = bonds.body.springs.data();
    all.nodes     = nodes.data();
    all.lengths   = bonds.body.nonlinear.lengths.data();
    all.strained  = kinematics.strains().any();
    return all;
  }


  template <int dim>
  void BondForces<dim>::watch(std::vector<double> of_nodes)
  {
    Assert(kinematics.is_full(), ExcInternalError());
    limits = std::move(of_nodes);
    exceeds.resize(limits.size());
    seen = false;
  }


  template <int dim>
  const unsigned char *BondForces<dim>::exceeding(const double *u) const
  {
    if (!seen)
      return nullptr;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        if (nodes[i].numbers[DeformedRows::Node::displacement + d] != u[dim * i + d])
          return nullptr;
    return exceeds.data();
  }


  template <int dim>
  void BondForces<dim>::find_tensions(double *tau, const double *u) const
  {
    ends.find(u);
    const auto product_at = [&](const unsigned int i) {
      return [this, u, i](const Bond &bond) { return kinematics.extension_moment(u, i, bond); };
    };
    if (law.any())
      {
        for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
          {
            double sum = 0., effective = 0.;
            bonds.for_each(i, [&](const Bond &bond) {
              if (bond.spring == 0.) // what it went through is still there
                return;
              sum += kinematics.extension_moment(u, i, bond);
              if (law->relaxes_dilatation())
                effective += effective_moment(u, i, bond);
            });
            tau[i] = laws.tension(i, sum);
            if (law->relaxes_dilatation())
              tau[i] += laws.shear_tension(i, effective - sum);
          }
        return;
      }
    if (!kinematics.is_full())
      {
        for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
          tau[i] = laws.tension(i, sum_over_bonds(bonds, i, product_at(i)));
        return;
      }
    sum_extensions<dim>(rows_at(u, nullptr), tau, nullptr);
    visit_beyond([&](const unsigned int i, const Bond &bond) {
      tau[i] += kinematics.extension_moment(u, i, bond);
    });
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      tau[i] = laws.tension(i, tau[i]);
  }


  template <int dim>
  void BondForces<dim>::subtract(Vector               &y,
                                 const unsigned int    i,
                                 const unsigned int    j,
                                 const Tensor<1, dim> &force) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      y.local_element(dim * i + d) -= force[d];
    if (ends.is_fictitious(j))
      ends.images->pull(ends.image(j), force);
  }


  template <int dim>
  double BondForces<dim>::force(const double      *u,
                                const unsigned int i,
                                const Bond        &bond,
                                const Vector      &tau) const
  {
    const unsigned int j = bond.neighbor;
    return LinearPeridynamicSolid::force(bond.spring,
                                         effective_moment(u, i, bond),
                                         tau.local_element(i) +
                                           (ends.is_fictitious(j) ? 0. : tau.local_element(j)));
  }


  template <int dim>
  Tensor<1, dim> BondForces<dim>::force_on(const unsigned int i,
                                           const double      *u,
                                           const Vector      &tau) const
  {
    Tensor<1, dim> sum;
    bonds.for_each_in_body(i, [&](const Bond &bond) {
      sum += force(u, i, bond, tau) * kinematics.direction(u, i, bond);
    });
    return sum;
  }


  template <int dim>
  void BondForces<dim>::find_forces(Vector &y, const double *u, const Vector &tau) const
  {
    if (law.any())
      ends.find(u);
    if (kinematics.is_full() && !law.any())
      {
        sum_forces<dim>(rows_at(u, &tau),
                        limits.empty() ? nullptr : limits.data(),
                        y.begin(),
                        exceeds.data());
        seen = !limits.empty();
      }
    else
      for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
        {
          const Tensor<1, dim> sum = force_on(i, u, tau);
          for (unsigned int d = 0; d < dim; ++d)
            y.local_element(dim * i + d) = -sum[d];
        }
    if (ends.images)
      {
        ends.find(u);
        ends.images->begin_forces();
        visit_beyond([&](const unsigned int i, const Bond &bond) {
          subtract(y, i, bond.neighbor, force(u, i, bond, tau) * kinematics.direction(u, i, bond));
        });
        ends.images->pass_on(y);
      }
    law.throw_faults(families.nodes().communicator());
  }


  template <int dim>
  void BondForces<dim>::find_forces_of(const std::vector<unsigned int> &of_nodes,
                                       double                          *y,
                                       const double                    *u,
                                       const Vector                    &tau) const
  {
    DeformedRows rows_of_nodes = rows_at(u, &tau);
    for (const unsigned int i : of_nodes)
      {
        rows_of_nodes.begin = i;
        rows_of_nodes.end   = i + 1;
        sum_forces<dim>(rows_of_nodes, nullptr, y, nullptr);
      }
  }


  template <int dim>
  double BondForces<dim>::energy_of_extensions(const double *u) const
  {
    double     sum      = 0.;
    const auto add_bond = [&](const unsigned int i, const Bond &bond) {
      sum +=
        (ends.is_fictitious(bond.neighbor) ? 1. : 0.5) *
        LinearPeridynamicSolid::bond_energy(bond.spring, kinematics.extension_moment(u, i, bond));
    };
    ends.find(u);
    visit_beyond(add_bond);
    const unsigned int n_owned = families.nodes().n_owned();
    if (kinematics.is_full())
      {
        std::vector<double> sums(n_owned), squares(n_owned);
        sum_extensions<dim>(rows_at(u, nullptr), sums.data(), squares.data());
        for (const double square : squares)
          sum += 0.25 * square;
        return sum;
      }
    for (unsigned int i = 0; i < n_owned; ++i)
      bonds.for_each_in_body(i, [&](const Bond &bond) { add_bond(i, bond); });
    return sum;
  }


  template <int dim>
  double BondForces<dim>::energy_of(const std::vector<unsigned int> &of_nodes,
                                    const Vector                    &u,
                                    const bool                       accepted) const
  {
    u.update_ghost_values();
    ends.find(u.begin());
    histories.resize(law.n_history());
    double sum = 0.;
    for (const unsigned int i : of_nodes)
      {
        double     of_node = 0.;
        BondValues all{0., 1.}; // of the bonds, as if they were one, and their histories
        std::fill(histories.begin(), histories.end(), 0.);
        bonds.for_each(i, [&](const Bond &bond) {
          if (bond.spring == 0.)
            return;
          const double share = ends.is_fictitious(bond.neighbor) ? 1. : 0.5;
          if (!law.any())
            {
              const double product = kinematics.extension_moment(u.begin(), i, bond);
              all.product += product;
              of_node += share * LinearPeridynamicSolid::bond_energy(bond.spring, product);
              return;
            }
          const BondValues of_bond = values(u.begin(), i, bond);
          double *const    before  = history(bond);
          all.product += of_bond.product;
          for (unsigned int k = 0; k < histories.size(); ++k)
            histories[k] += before[k];
          of_node += share * bond.spring * law->energy(of_bond, before, accepted);
          if (accepted)
            law->accept(of_bond, before);
        });
        if (laws.volumetric && !accepted)
          of_node += LinearPeridynamicSolid::node_energy(laws.tension(i, all.product), all.product);
        if (laws.volumetric && law.any() && law->relaxes_dilatation())
          of_node +=
            laws.shear_tension(i, 1.) * (law->energy(all, histories.data(), accepted) -
                                         (accepted ? 0. : 0.5 * all.product * all.product));
        sum += of_node;
      }
    u.set_ghost_state(false);
    law.throw_faults(families.nodes().communicator());
    return Utilities::MPI::sum(sum, families.nodes().communicator());
  }


  template <int dim>
  double BondForces<dim>::largest_slope() const
  {
    double largest = 1.;
    for (const BondRows<dim> *rows : {&bonds.body, &bonds.beyond})
      for (const double slope : rows->nonlinear.slopes)
        largest = std::max(largest, slope);
    return largest;
  }


  template <int dim>
  void BondForces<dim>::linearize(const double *u, const Vector &tau)
  {
    ends.find(u);
    const bool has_slopes = law.any() && !law->is_linear();
    for (BondRows<dim> *rows : {&bonds.body, &bonds.beyond})
      rows->nonlinear.slopes.resize(has_slopes ? rows->size() : 0);
    const auto renew = [&](BondRows<dim> &rows, const unsigned int i, const Bond &bond) {
      const std::size_t k = bonds.place(bond.number);
      if (has_slopes)
        rows.nonlinear.slopes[k] = law->slope(values(u, i, bond), history(bond));
      if (!kinematics.is_full())
        return;
      const Tensor<1, dim> y   = ends.vector(i, bond.neighbor) + ends.change(u, i, bond.neighbor);
      rows.nonlinear.across[k] = force(u, i, bond, tau) * kinematics.length(bond) / y.norm();
      rows.moments[k]          = kinematics.direction(u, i, bond);
    };
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      bonds.for_each_stored(i, [&](const Bond &bond) { renew(bonds.body, i, bond); });
    visit_beyond([&](const unsigned int i, const Bond &bond) { renew(bonds.beyond, i, bond); });
  }


  template <int dim>
  void BondForces<dim>::add_geometric_forces(Vector &y, const double *x) const
  {
    if (ends.images)
      ends.images->begin_forces();
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      bonds.for_each(i, [&](const Bond &bond) {
        if (!bonds.is_whole(bond.number))
          return;
        Tensor<1, dim>        change = ends.change(x, i, bond.neighbor);
        const Tensor<1, dim> &p      = bond.moment;
        change -= (p * change) / (kinematics.length(bond) * kinematics.length(bond)) * p;
        subtract(y, i, bond.neighbor, stiffness_across(bond) * change);
      });
    if (ends.images)
      ends.images->pass_on(y);
  }


  template <int dim>
  double BondForces<dim>::largest_stretch(const double *u) const
  {
    double largest = kinematics.is_full() ? largest_of_stretches<dim>(rows_at(u, nullptr)) : 0.;
    if (law.any() && !law->is_linear())
      {
        ends.find(u);
        for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
          bonds.for_each(i, [&](const Bond &bond) {
            if (bond.spring != 0.)
              largest = std::max(largest, law->slope(values(u, i, bond), history(bond)) - 1.);
          });
      }
    return Utilities::MPI::max(largest, families.nodes().communicator());
  }


  template <int dim>
  std::size_t BondForces<dim>::memory_consumption() const
  {
    return (limits.capacity() + damage.capacity()) * sizeof(double) +
           nodes.capacity() * sizeof(nodes[0]) + exceeds.capacity();
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondForces);
} // namespace PeriDeal
