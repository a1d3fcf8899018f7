// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/solid/bond_kinematics.h>

#include <algorithm>
#include <cmath>

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
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      rows.for_each_stored(i, [&](const Bond &bond) { lengths.push_back(bond.moment.norm()); });
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
    const double *const t = tau.begin();
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      {
        Tensor<1, dim> force;
        rows.for_each_stored(i, [&](const Bond &bond) {
          const Tensor<1, dim> along = deformed_bond(u, i, bond.neighbor);
          const double size = bond.spring * extension_moment(u, i, bond) + t[i] + t[bond.neighbor];
          force += size * length(bond) / along.norm() * along;
        });
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) = -force[d];
      }
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
  double BondKinematics<dim>::largest_stretch(const double *u, const BondState &state) const
  {
    double largest = 0.;
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      rows.for_each_stored(i, [&](const Bond &bond) {
        if (state.is_whole(bond.number))
          largest = std::max(largest,
                             std::abs(deformed_bond(u, i, bond.neighbor).norm() /
                                        families.neighbors().bond_vector(i, bond.neighbor).norm() -
                                      1.));
      });
    return Utilities::MPI::max(largest, families.nodes().communicator());
  }


  template <int dim>
  void BondKinematics<dim>::release(const std::size_t number)
  {
    rows.release(number);
    if (full)
      lengths[number] = across[number] = 0.;
  }


  template class BondKinematics<1>;
  template class BondKinematics<2>;
  template class BondKinematics<3>;
} // namespace PeriDeal
