// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds of the deformed body, their tangent, and the viscosity in them.

#include <deal.II/base/mpi.h>

#include <perideal/operators/spectrum.h>
#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Tensor<1, dim> StateOperator<dim>::deformed_bond(const double      *u,
                                                   const unsigned int i,
                                                   const unsigned int j) const
  {
    Tensor<1, dim> bond = bonds.neighbors().bond_vector(i, j);
    for (unsigned int d = 0; d < dim; ++d)
      bond[d] += u[dim * j + d] - u[dim * i + d];
    return bond;
  }


  template <int dim>
  double StateOperator<dim>::strained_extension_moment(const double      *u,
                                                       const unsigned int i,
                                                       const Bond        &bond) const
  {
    const unsigned int   j       = bond.neighbor;
    const Tensor<1, dim> xi      = bonds.neighbors().bond_vector(i, j);
    const double         thermal = 0.5 * (laws[i].thermal + laws[j].thermal);
    Tensor<1, dim>       eta;
    for (unsigned int d = 0; d < dim; ++d)
      eta[d] = u[dim * j + d] - u[dim * i + d];
    if (!full)
      return bond.moment * eta - thermal * (bond.moment * xi);
    // |Y| - |xi| without the difference of two nearly equal numbers
    const double x = xi.norm();
    return bond.length * ((2. * xi + eta) * eta / ((xi + eta).norm() + x) - thermal * x);
  }


  template <int dim>
  void StateOperator<dim>::find_strained_dilatation_forces(const Vector &u) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double sum = 0.;
        for_each_bond(i, [&](const Bond &bond) { sum += extension_moment(u.begin(), i, bond); });
        const StateLaw &law  = laws[i].law;
        const double    q    = weighted.local_element(i);
        tau.local_element(i) = law.volumetric * law.dilatation * sum / (q * q * nodes.volume(i));
      }
    add_images_to_dilatations(u, true);
    tau.update_ghost_values();
  }


  template <int dim>
  void StateOperator<dim>::sum_deformed_forces(Vector &y, const Vector &u) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    if (volumetric)
      find_strained_dilatation_forces(u);
    const double *const t = tau.begin();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        Tensor<1, dim> force;
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
          {
            const Tensor<1, dim> bond = deformed_bond(u.begin(), i, neighbors[k]);
            const double         size =
              springs[k] * extension_moment(u.begin(), i, stored_bond(k)) + t[i] + t[neighbors[k]];
            force += size * lengths[k] / bond.norm() * bond;
          }
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) = -force[d];
      }
    add_strained_image_forces(y, u);
  }


  template <int dim>
  void StateOperator<dim>::find_forces(Vector &y, const Vector &u) const
  {
    if (!full)
      {
        multiply(y, u);
        return;
      }
    u.update_ghost_values();
    sum_deformed_forces(y, u);
    u.set_ghost_state(false);
  }


  template <int dim>
  bool StateOperator<dim>::nonlinear() const
  {
    return full;
  }


  template <int dim>
  void StateOperator<dim>::linearize(const Vector &u)
  {
    if (!full)
      return;
    const Nodes<dim> &nodes = bonds.nodes();
    u.update_ghost_values();
    if (volumetric)
      find_strained_dilatation_forces(u);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
        {
          const Tensor<1, dim> bond = deformed_bond(u.begin(), i, neighbors[k]);
          const double         size = springs[k] * extension_moment(u.begin(), i, stored_bond(k)) +
                              tau.local_element(i) + tau.local_element(neighbors[k]);
          moments[k] = lengths[k] / bond.norm() * bond;
          across[k]  = size * lengths[k] / bond.norm();
        }
    linearize_images(u);
    u.set_ghost_state(false);
  }


  template <int dim>
  void StateOperator<dim>::add_geometric_forces(Vector &y, const Vector &x) const
  {
    const double *const u = x.begin();
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
        {
          if (!state.is_whole(k))
            continue;
          const double *const   v = u + dim * neighbors[k];
          const Tensor<1, dim> &p = moments[k];
          Tensor<1, dim>        change;
          for (unsigned int d = 0; d < dim; ++d)
            change[d] = v[d] - u[dim * i + d];
          change -= (p * change) / (lengths[k] * lengths[k]) * p;
          for (unsigned int d = 0; d < dim; ++d)
            y.local_element(dim * i + d) -= across[k] * change[d];
        }
    add_geometric_image_forces(y, x);
  }


  template <int dim>
  void StateOperator<dim>::damping_force(Vector &y, const Vector &v) const
  {
    v.update_ghost_values();
    const double *const x = v.begin();
    if (lattice)
      lattice->forces(y.begin(), x, nullptr);
    for (const unsigned int i : stored_nodes)
      {
        Tensor<1, dim> force;
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
          {
            double product = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              product += moments[k][d] * (x[dim * neighbors[k] + d] - x[dim * i + d]);
            force += springs[k] * product * moments[k];
          }
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) = -force[d];
      }
    if (beyond)
      {
        beyond->find_images(x);
        beyond->add_forces(y, v, nullptr);
      }
    v.set_ghost_state(false);
    conditions->mask(y);
  }


  template <int dim>
  double StateOperator<dim>::damping_bound() const
  {
    // Gershgorin with the norms of the blocks.
    double       bound  = 0.;
    const Vector images = rows_of_images(false);
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      {
        double row = images.local_element(i);
        for_each_bond(i, [&](const Bond &bond) {
          row += 2. * bond.spring * bond.moment.norm_square();
        });
        bound = std::max(bound, row / mass.local_element(dim * i));
      }
    return Utilities::MPI::max(bound, bonds.nodes().communicator());
  }


  template <int dim>
  void StateOperator<dim>::fill_noise(Vector &vector) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      vector.local_element(i) = position_noise(nodes.position(i / dim)) * (1. + i % dim);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                    \
  template Tensor<1, dim> StateOperator<dim>::deformed_bond(const double *,                          \
                                                            const unsigned int,                      \
                                                            const unsigned int) const;               \
  template double         StateOperator<dim>::strained_extension_moment(const double *,              \
                                                                const unsigned int,          \
                                                                const Bond &) const;         \
  template void           StateOperator<dim>::find_strained_dilatation_forces(const Vector &) const; \
  template void           StateOperator<dim>::find_forces(Vector &, const Vector &) const;           \
  template bool           StateOperator<dim>::nonlinear() const;                                     \
  template void           StateOperator<dim>::linearize(const Vector &);                             \
  template void           StateOperator<dim>::add_geometric_forces(Vector &, const Vector &) const;  \
  template void           StateOperator<dim>::damping_force(Vector &, const Vector &) const;         \
  template double         StateOperator<dim>::damping_bound() const;                                 \
  template void           StateOperator<dim>::fill_noise(Vector &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
