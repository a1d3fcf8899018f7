// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What follows from the displacements, and what a solver asks for beside K u.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/interleaved.h>
#include <perideal/operators/spectrum.h>
#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void StateOperator<dim>::find_diagonal()
  {
    // The energy is 1/4 sum over directed bonds of s (p . eta)^2 + 1/2 sum m_k (sum p . eta)^2 with
    // m = c d/(q^2 V).
    const Nodes<dim>   &nodes = bonds.nodes();
    std::vector<double> factor(nodes.n_local());
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const double q = weighted.local_element(i);
        factor[i]      = volumetric ?
                           laws[i].law.volumetric * laws[i].law.dilatation / (q * q * nodes.volume(i)) :
                           0.;
      }
    unsigned int regular = numbers::invalid_unsigned_int; // the first of those that are all alike
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const bool     is_regular = lattice && on_lattice[i] && lattice->is_regular(i);
        Tensor<1, dim> sum, diagonal;
        if (is_regular && regular != numbers::invalid_unsigned_int)
          {
            for (unsigned int d = 0; d < dim; ++d)
              stiffness_diagonal.local_element(dim * i + d) =
                stiffness_diagonal.local_element(dim * regular + d);
            continue;
          }
        for_each_bond(i, [&](const Bond &bond) {
          sum += bond.moment;
          for (unsigned int d = 0; d < dim; ++d)
            diagonal[d] += (bond.spring + factor[bond.neighbor]) * bond.moment[d] * bond.moment[d];
        });
        for (unsigned int d = 0; d < dim; ++d)
          stiffness_diagonal.local_element(dim * i + d) = diagonal[d] + factor[i] * sum[d] * sum[d];
        if (is_regular)
          regular = i;
      }
    add_images_to_diagonal(factor);
    // Nodes without bonds, all of them broken: any positive number.
    for (unsigned int i = 0; i < stiffness_diagonal.locally_owned_size(); ++i)
      if (!(stiffness_diagonal.local_element(i) > 0.))
        stiffness_diagonal.local_element(i) =
          laws[i / dim].law.extension * std::pow(nodes.volume(i / dim), 1. - 2. / dim);
    conditions->mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  Spectrum StateOperator<dim>::spectrum() const
  {
    // Rows of |K|: twice the springs, and for the dilatations |c_ij| summed over both of their
    // ends.
    const Nodes<dim> &nodes = bonds.nodes();
    source.zero_out_ghost_values();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double         length = 0.;
        Tensor<1, dim> sum;
        for_each_bond(i, [&](const Bond &bond) {
          length += bond.moment.norm();
          sum += bond.moment;
        });
        const double q = weighted.local_element(i);
        source.local_element(i) =
          volumetric ? std::abs(laws[i].law.volumetric) * laws[i].law.dilatation *
                         (length + (beyond ? beyond->sum_of_lengths(i) : 0.) + sum.norm()) /
                         (q * q * nodes.volume(i)) :
                       0.;
      }
    source.update_ghost_values();
    double       bound  = 0.;
    const Vector images = rows_of_images(volumetric);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double         row = images.local_element(i);
        Tensor<1, dim> sum;
        for_each_bond(i, [&](const Bond &bond) {
          row += 2. * bond.spring * bond.moment.norm_square() +
                 source.local_element(bond.neighbor) * bond.moment.norm();
          sum += bond.moment;
        });
        for (std::size_t k = starts[i]; full && k < starts[i + 1]; ++k)
          row += 2. * std::abs(across[k]);
        row += source.local_element(i) * sum.norm();
        bound =
          std::max(bound, std::sqrt(static_cast<double>(dim)) * row / mass.local_element(dim * i));
      }
    bound = Utilities::MPI::max(bound, nodes.communicator());
    return {bound, sharp_bound(*this, bound, [&](Vector &vector) { fill_noise(vector); })};
  }


  template <int dim>
  double StateOperator<dim>::energy(const Vector &u) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    u.update_ghost_values();
    if (volumetric && (full || any_thermal))
      find_strained_dilatation_forces(u);
    else if (volumetric)
      find_dilatation_forces(u);
    double sum = energy_of_images(u);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        for_each_bond(i, [&](const Bond &bond) {
          const double product = extension_moment(u.begin(), i, bond);
          sum += 0.25 * bond.spring * product * product;
        });
        const StateLaw &law = laws[i].law;
        if (volumetric && law.volumetric != 0.)
          {
            const double theta = tau.local_element(i) * weighted.local_element(i) / law.volumetric;
            sum += 0.5 * law.volumetric / law.dilatation * nodes.volume(i) * theta * theta;
          }
      }
    u.set_ghost_state(false);
    return Utilities::MPI::sum(sum, nodes.communicator());
  }


  template <int dim>
  void StateOperator<dim>::dilatations(const Vector &u, std::vector<double> &theta) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    u.update_ghost_values();
    theta.assign(nodes.n_owned(), 0.);
    if (beyond)
      beyond->find_images(u.begin());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        for_each_bond(i,
                      [&](const Bond &bond) { theta[i] += extension_moment(u.begin(), i, bond); });
        if (beyond)
          beyond->for_each_of(i, [&](const auto &bond) {
            theta[i] += beyond->extension_moment(bond, u.begin());
          });
        theta[i] *= laws[i].law.dilatation / (weighted.local_element(i) * nodes.volume(i));
      }
    u.set_ghost_state(false);
  }


  template <int dim>
  NodalTensors<dim> StateOperator<dim>::tensors(const Vector &u) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    NodalTensors<dim> result;
    result.stress.resize(nodes.n_owned());
    result.strain.resize(nodes.n_owned());
    u.update_ghost_values();
    if (volumetric && (full || any_thermal))
      find_strained_dilatation_forces(u);
    else if (volumetric)
      find_dilatation_forces(u);
    if (beyond)
      beyond->find_images(u.begin());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        Tensor<2, dim> gradient, shape, stress;
        for_each_bond(i, [&](const Bond &bond) {
          const unsigned int   j  = bond.neighbor;
          const Tensor<1, dim> xi = bonds.neighbors().bond_vector(i, j);
          Tensor<1, dim>       eta;
          for (unsigned int d = 0; d < dim; ++d)
            eta[d] = u.begin()[dim * j + d] - u.begin()[dim * i + d];
          const double x2      = xi.norm_square();
          const double weight  = full ? bond.length / std::sqrt(x2) : (bond.moment * xi) / x2; // W
          const double product = extension_moment(u.begin(), i, bond); // W x e
          gradient += weight * outer_product(eta, xi);
          shape += weight * outer_product(xi, xi);
          // V_i V_j t/x, of this end or the mean of both
          const double own   = laws[i].law.extension / weighted.local_element(i);
          const double other = laws[j].law.extension / weighted.local_element(j);
          const double force =
            several_phases ?
              0.5 * (weight * (tau.local_element(i) + tau.local_element(j)) +
                     bond.spring * weight * product) :
              weight * (tau.local_element(i) + bond.spring * product * own / (own + other));
          const Tensor<1, dim> y = xi + eta;
          if (full)
            stress += force * std::sqrt(x2) / y.norm() * outer_product(y, y);
          else
            stress += force * outer_product(xi, xi);
        });
        if (beyond)
          beyond->for_each_of(i, [&](const auto &bond) {
            const Tensor<1, dim> xi  = beyond->bond_vector(bond),
                                 eta = beyond->change(bond, u.begin());
            const double x2          = xi.norm_square();
            const double weight      = beyond->length(bond) / std::sqrt(x2);
            // With several phases the mean with that of the node that it is an image of.
            const unsigned int o     = beyond->origin(bond.image);
            const double       other = several_phases ?
                                         laws[o].law.extension / weighted.local_element(o) /
                                     (laws[i].law.extension / weighted.local_element(i)) :
                                         1.;
            const double       tension =
              !volumetric    ? 0. :
                    several_phases ? 0.5 * (tau.local_element(i) + tau.local_element(o)) :
                                     tau.local_element(i);
            const double force = weight * (tension + 0.5 * (1. + other) * bond.spring *
                                                       beyond->extension_moment(bond, u.begin()));
            gradient += weight * outer_product(eta, xi);
            shape += weight * outer_product(xi, xi);
            const Tensor<1, dim> y = full ? xi + eta : xi;
            stress += (full ? force * std::sqrt(x2) / y.norm() : force) * outer_product(y, y);
          });
        // Few bonds may be left, or none.
        const bool           held = determinant(shape) > 1e-12 * std::pow(trace(shape) / dim, dim);
        const Tensor<2, dim> slopes = held ? gradient * invert(shape) : Tensor<2, dim>();
        result.strain[i]            = symmetrize(slopes);
        result.stress[i]            = symmetrize(stress) / nodes.volume(i);
        if (!full)
          continue;
        result.strain[i] += 0.5 * symmetrize(transpose(slopes) * slopes);
        result.stress[i] /= determinant(Tensor<2, dim>(unit_symmetric_tensor<dim>()) + slopes);
      }
    u.set_ghost_state(false);
    return result;
  }


  template <int dim>
  void StateOperator<dim>::surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    // Springs between the nearest nodes, diagonals of cells included, as stiff as the bond-based
    // solid.
    const Nodes<dim>         &nodes = bonds.nodes();
    const IndexSet            owned = unknowns->locally_owned_range();
    std::vector<std::size_t>  first{0};
    std::vector<unsigned int> near; // neighbours, of unbroken bonds
    std::vector<bool>         damaged(nodes.n_owned(), false);
    Vector                    sums(nodes.partitioner());
    const auto                is_near = [&](const unsigned int i, const Tensor<1, dim> &xi) {
      if (!nodes.lattice())
        return xi.norm() < 1.8 * std::pow(nodes.volume(i), 1. / dim);
      bool is = true;
      for (unsigned int d = 0; d < dim; ++d)
        is = is && std::abs(xi[d]) < 1.5 * nodes.lattice()->spacing[d];
      return is;
    };
    std::vector<LatticeBond> close; // those that are near
    std::copy_if(lattice_bonds.begin(),
                 lattice_bonds.end(),
                 std::back_inserter(close),
                 [](const LatticeBond &bond) {
                   return std::all_of(bond.offset.begin(), bond.offset.end(), [](const int n) {
                     return std::abs(n) <= 1;
                   });
                 });
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const auto add_near = [&](const Bond &bond) {
          const Tensor<1, dim> xi = bonds.neighbors().bond_vector(i, bond.neighbor);
          if (!is_near(i, xi) && !is_near(bond.neighbor, xi))
            return;
          // As q, that of the body before bonds broke.
          sums.local_element(i) += nodes.volume(bond.neighbor) * xi.norm_square();
          if (bond.whole)
            near.push_back(bond.neighbor);
          else
            damaged[i] = true;
        };
        if (!on_lattice.empty() && on_lattice[i])
          for_each_lattice_bond(i, close, add_near);
        else
          for_each_bond(i, add_near);
        first.push_back(near.size());
      }
    sums.update_ghost_values();
    Vector marked;
    initialize_vector(marked);
    conditions->mask(marked, 1.);
    marked.update_ghost_values();

    TrilinosWrappers::SparsityPattern    pattern(owned,
                                              nodes.communicator(),
                                              dim * (dim == 3 ? 27 :
                                                        dim == 2 ? 9 :
                                                                   3));
    std::vector<types::global_dof_index> columns;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        columns.clear();
        for (unsigned int d = 0; d < dim; ++d)
          columns.push_back(unknowns->local_to_global(dim * i + d));
        for (std::size_t n = first[i]; n < first[i + 1]; ++n)
          for (unsigned int d = 0; d < dim; ++d)
            columns.push_back(unknowns->local_to_global(dim * near[n] + d));
        for (unsigned int d = 0; d < dim; ++d)
          pattern.add_entries(columns[d], columns.begin(), columns.end());
      }
    pattern.compress();
    matrix.reinit(pattern);
    const auto stiffness_of = [&](const unsigned int i) {
      const Moduli moduli = scene.material.moduli(nodes.position(i));
      return bond_law(moduli, dim, scene.elasticity.plane).extension;
    };
    std::vector<double> extension(nodes.n_local());
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      extension[i] = stiffness_of(i);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        Tensor<2, dim> own;
        const auto     add = [&](const unsigned int j, const Tensor<2, dim> &block) {
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e < dim; ++e)
              {
                const unsigned int row = dim * i + d, column = dim * j + e;
                const bool         held = marked.local_element(row) > 0. ||
                                  marked.local_element(column) > 0.;
                const double value = !held ? block[d][e] : (row == column ? 1. : 0.);
                matrix.set(unknowns->local_to_global(row),
                           unknowns->local_to_global(column),
                           value);
              }
        };
        for (std::size_t n = first[i]; n < first[i + 1]; ++n)
          {
            const unsigned int   j  = near[n];
            const Tensor<1, dim> xi = bonds.neighbors().bond_vector(i, j);
            const double         spring =
              nodes.volume(i) * nodes.volume(j) *
              (extension[i] / sums.local_element(i) + extension[j] / sums.local_element(j)) /
              xi.norm_square();
            const Tensor<2, dim> block = spring * outer_product(xi, xi);
            own += block;
            add(j, -block);
          }
        // Between cell centres a plane of symmetry holds nodes by bonds to their own images.
        if (beyond)
          beyond->for_each_of(i, [&](const auto &bond) {
            const Tensor<1, dim> xi = beyond->bond_vector(bond);
            if (bond.whole && beyond->is_own_image(bond) && is_near(i, xi))
              own += 4. * nodes.volume(i) * beyond->volume(bond.image) * extension[i] /
                     sums.local_element(i) / xi.norm_square() * outer_product(xi, xi);
          });
        // Springs alone would not hold every node, and hardly those that few are left of.
        const double share = own == Tensor<2, dim>() ? 1. : damaged[i] ? 1e-2 : 1e-8;
        for (unsigned int d = 0; d < dim; ++d)
          own[d][d] += share * stiffness_diagonal.local_element(dim * i + d);
        add(i, own);
      }
    matrix.compress(VectorOperation::insert);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                 \
  template void     StateOperator<dim>::find_diagonal();                                          \
  template Spectrum StateOperator<dim>::spectrum() const;                                         \
  template double   StateOperator<dim>::energy(const Vector &) const;                             \
  template void     StateOperator<dim>::dilatations(const Vector &, std::vector<double> &) const; \
  template NodalTensors<dim> StateOperator<dim>::tensors(const Vector &) const;                   \
  template void              StateOperator<dim>::surrogate(TrilinosWrappers::SparseMatrix &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
