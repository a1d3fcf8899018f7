// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/solid/solid_tensors.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::vector<double> nodal_dilatations(const SolidBonds<dim> &bonds, const Vector &u)
  {
    std::vector<double> theta(bonds.families.nodes().n_owned(), 0.);
    u.update_ghost_values();
    if (bonds.beyond)
      bonds.beyond->images().find(u.begin());
    for (unsigned int i = 0; i < theta.size(); ++i)
      {
        bonds.rows.for_each(i, [&](const auto &bond) {
          theta[i] += bonds.kinematics.extension_moment(u.begin(), i, bond);
        });
        if (bonds.beyond)
          bonds.beyond->for_each_of(i, [&](const auto &bond) {
            theta[i] += bonds.beyond->extension_moment(bond, u.begin());
          });
        theta[i] *= bonds.laws[i].dilatation /
                    (bonds.laws.weighted.local_element(i) * bonds.families.nodes().volume(i));
      }
    u.set_ghost_state(false);
    return theta;
  }


  template <int dim>
  NodalTensors<dim> nodal_tensors(const SolidBonds<dim> &bonds, const Vector &u, const Vector &tau)
  {
    const Families<dim>        &families       = bonds.families;
    const Nodes<dim>           &nodes          = families.nodes();
    const NodeLaws<dim>        &laws           = bonds.laws;
    const BondKinematics<dim>  &kinematics     = bonds.kinematics;
    const FictitiousBonds<dim> *beyond         = bonds.beyond.get();
    const bool                  full           = kinematics.is_full();
    const bool                  several_phases = laws.several_phases;
    NodalTensors<dim>           result;
    result.stress.resize(nodes.n_owned());
    result.strain.resize(nodes.n_owned());
    u.update_ghost_values();
    if (beyond)
      beyond->images().find(u.begin());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        Tensor<2, dim> gradient, shape, stress;
        bonds.rows.for_each(i, [&](const auto &bond) {
          const unsigned int   j  = bond.neighbor;
          const Tensor<1, dim> xi = families.neighbors().bond_vector(i, j);
          Tensor<1, dim>       eta;
          for (unsigned int d = 0; d < dim; ++d)
            eta[d] = u.begin()[dim * j + d] - u.begin()[dim * i + d];
          const double x2      = xi.norm_square();
          const double weight  = full ? kinematics.length(bond) / std::sqrt(x2) :
                                        (bond.moment * xi) / x2;                  // W
          const double product = kinematics.extension_moment(u.begin(), i, bond); // W x e
          gradient += weight * outer_product(eta, xi);
          shape += weight * outer_product(xi, xi);
          // V_i V_j t/x, of this end or the mean of both
          const double own   = laws.stiffness(i);
          const double other = laws.stiffness(j);
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
            const unsigned int o     = beyond->images()[bond.image].origin;
            const double       other = several_phases ? laws.stiffness(o) / laws.stiffness(i) : 1.;
            const double       tension = several_phases ?
                                           0.5 * (tau.local_element(i) + tau.local_element(o)) :
                                           tau.local_element(i);
            const double       force   = weight * (tension + 0.5 * (1. + other) * bond.spring *
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


#define PERIDEAL_INSTANTIATE(dim)                                                          \
  template std::vector<double> nodal_dilatations(const SolidBonds<dim> &, const Vector &); \
  template NodalTensors<dim> nodal_tensors(const SolidBonds<dim> &, const Vector &, const Vector &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
