// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/solid/bond_kinematics.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  BondKinematics<dim>::BondKinematics(const Families<dim>  &families,
                                      SolidRows<dim>       &rows,
                                      const ThermalStrains &thermal,
                                      const bool            full)
    : families(families)
    , rows(rows)
    , thermal(thermal)
    , full(full)
  {}


  template <int dim>
  void BondKinematics<dim>::keep_lengths()
  {
    if (!full)
      return;
    across.resize(rows.n_stored(), 0.);
    lengths.reserve(rows.n_stored());
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      rows.for_each_stored(i, [&](const Bond &bond) { lengths.push_back(bond.moment.norm()); });
    nodes.resize(families.nodes().n_local());
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        nodes[i].numbers[d] = families.nodes().position(i)[d];
  }


  template <int dim>
  void BondKinematics<dim>::take(const double *u, const Vector *tau) const
  {
    using Node = DeformedRows::Node;
    seen       = false;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        double *const to = nodes[i].numbers;
        for (unsigned int d = 0; d < dim; ++d)
          to[Node::displacement + d] = u[dim * i + d];
        to[Node::strain] = thermal[i];
        if (tau != nullptr)
          to[Node::tau] = tau->local_element(i);
      }
  }


  template <int dim>
  DeformedRows BondKinematics<dim>::all_rows() const
  {
    DeformedRows all;
    rows.show(all);
    all.nodes    = nodes.data();
    all.lengths  = lengths.data();
    all.strained = thermal.any();
    return all;
  }


  template <int dim>
  void BondKinematics<dim>::watch(std::vector<double> of_nodes)
  {
    Assert(full, ExcInternalError());
    limits = std::move(of_nodes);
    exceeds.resize(limits.size());
    seen = false;
  }


  template <int dim>
  const unsigned char *BondKinematics<dim>::exceeding(const double *u) const
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
  Tensor<1, dim> BondKinematics<dim>::deformed_bond(const double      *u,
                                                    const unsigned int i,
                                                    const unsigned int j) const
  {
    Tensor<1, dim> bond = families.neighbors().bond_vector(i, j);
    for (unsigned int d = 0; d < dim; ++d)
      bond[d] += u[dim * j + d] - u[dim * i + d];
    return bond;
  }


  template <int dim>
  double BondKinematics<dim>::strained_extension_moment(const double      *u,
                                                        const unsigned int i,
                                                        const Bond        &bond) const
  {
    const unsigned int   j      = bond.neighbor;
    const Tensor<1, dim> xi     = families.neighbors().bond_vector(i, j);
    const double         strain = thermal.of_bond(i, j);
    Tensor<1, dim>       eta;
    for (unsigned int d = 0; d < dim; ++d)
      eta[d] = u[dim * j + d] - u[dim * i + d];
    if (!full)
      return bond.moment * eta - strain * (bond.moment * xi);
    // |Y| - |xi| without the difference of two nearly equal numbers
    const double x = xi.norm();
    return lengths[bond.number] * ((2. * xi + eta) * eta / ((xi + eta).norm() + x) - strain * x);
  }


  template <int dim>
  void BondKinematics<dim>::find_tensions(double              *tau,
                                          const double        *u,
                                          const NodeLaws<dim> &laws) const
  {
    if (full)
      {
        take(u, nullptr);
        sum_extensions<dim>(all_rows(), tau, nullptr);
        for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
          tau[i] = laws.tension(i, tau[i]);
        return;
      }
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      {
        double sum = 0.;
        rows.for_each(i, [&](const Bond &bond) { sum += extension_moment(u, i, bond); });
        tau[i] = laws.tension(i, sum);
      }
  }


  template <int dim>
  void BondKinematics<dim>::find_forces(Vector &y, const double *u, const Vector &tau) const
  {
    take(u, &tau);
    sum_forces<dim>(all_rows(),
                    limits.empty() ? nullptr : limits.data(),
                    y.begin(),
                    exceeds.data());
    seen = !limits.empty();
  }


  template <int dim>
  void BondKinematics<dim>::find_forces_of(const std::vector<unsigned int> &of_nodes,
                                           double                          *y,
                                           const double                    *u,
                                           const Vector                    &tau) const
  {
    take(u, &tau);
    DeformedRows rows_of_nodes = all_rows();
    for (const unsigned int i : of_nodes)
      {
        rows_of_nodes.begin = i;
        rows_of_nodes.end   = i + 1;
        sum_forces<dim>(rows_of_nodes, nullptr, y, nullptr);
      }
  }


  template <int dim>
  double BondKinematics<dim>::energy_of_extensions(const double *u) const
  {
    double            sum = 0.;
    const Nodes<dim> &own = families.nodes();
    if (full)
      {
        std::vector<double> sums(own.n_owned()), squares(own.n_owned());
        take(u, nullptr);
        sum_extensions<dim>(all_rows(), sums.data(), squares.data());
        for (const double square : squares)
          sum += 0.25 * square;
        return sum;
      }
    for (unsigned int i = 0; i < own.n_owned(); ++i)
      rows.for_each(i, [&](const Bond &bond) {
        const double product = extension_moment(u, i, bond);
        sum += 0.25 * bond.spring * product * product;
      });
    return sum;
  }


  template <int dim>
  void BondKinematics<dim>::linearize(const double *u, const Vector &tau)
  {
    const double *const t = tau.begin();
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      rows.for_each_stored(i, [&](const Bond &bond) {
        const Tensor<1, dim> along = deformed_bond(u, i, bond.neighbor);
        const double size = bond.spring * extension_moment(u, i, bond) + t[i] + t[bond.neighbor];
        rows.set_moment(bond.number, length(bond) / along.norm() * along);
        across[bond.number] = size * length(bond) / along.norm();
      });
  }


  template <int dim>
  void BondKinematics<dim>::add_geometric_forces(Vector          &y,
                                                 const double    *x,
                                                 const BondState &state) const
  {
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      rows.for_each_stored(i, [&](const Bond &bond) {
        if (!state.is_whole(bond.number))
          return;
        const double *const   v = x + dim * bond.neighbor;
        const Tensor<1, dim> &p = bond.moment;
        Tensor<1, dim>        change;
        for (unsigned int d = 0; d < dim; ++d)
          change[d] = v[d] - x[dim * i + d];
        change -= (p * change) / (length(bond) * length(bond)) * p;
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) -= stiffness_across(bond) * change[d];
      });
  }


  template <int dim>
  double BondKinematics<dim>::largest_stretch(const double *u) const
  {
    take(u, nullptr);
    return Utilities::MPI::max(largest_of_stretches<dim>(all_rows()),
                               families.nodes().communicator());
  }


  template <int dim>
  void BondKinematics<dim>::release(const std::size_t number)
  {
    rows.release(number);
    if (full)
      lengths[number] = across[number] = 0.;
  }


  template <int dim>
  std::size_t BondKinematics<dim>::memory_consumption() const
  {
    return (lengths.capacity() + across.capacity() + limits.capacity()) * sizeof(double) +
           nodes.capacity() * sizeof(nodes[0]) + exceeds.capacity();
  }


  template class BondKinematics<1>;
  template class BondKinematics<2>;
  template class BondKinematics<3>;
} // namespace PeriDeal
