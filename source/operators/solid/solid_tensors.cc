// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/solid_tensors.h>

#include <cmath>

#include "with_ghosts.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::vector<double> nodal_dilatations(const SolidBonds<dim> &bonds, const Vector &u)
  {
    std::vector<double> theta(bonds.families.nodes().n_owned(), 0.);
    if (const auto *const nodal = bonds.correspondence())
      {
        const auto strain = nodal->tensors(u).strain;
        for (unsigned int i = 0; i < theta.size(); ++i)
          theta[i] = bonds.laws[i].dilatation * (trace(strain[i]) / dim - bonds.thermal[i]);
        return theta;
      }
    u.update_ghost_values();
    bonds.ends.find(u.begin());
    for (unsigned int i = 0; i < theta.size(); ++i)
      theta[i] = sum_over_bonds(bonds.rows,
                                i,
                                [&](const auto &bond) {
                                  return bonds.kinematics.extension_moment(u.begin(), i, bond);
                                }) *
                 (bonds.laws[i].dilatation /
                  (bonds.laws.weighted.local_element(i) * bonds.families.nodes().volume(i)));
    u.set_ghost_state(false);
    return theta;
  }


  namespace
  {
    /** Of the bonds of the ordinary solid, one by one. */
    template <int dim>
    NodalTensors<dim> tensors_of_bonds(const SolidBonds<dim> &bonds,
                                       const Vector          &u,
                                       const Vector          &tau)
    {
      const auto *const          yielding       = bonds.yielding();
      const Nodes<dim>          &nodes          = bonds.families.nodes();
      const NodeLaws<dim>       &laws           = bonds.laws;
      const BondEnds<dim>       &ends           = bonds.ends;
      const BondKinematics<dim> &kinematics     = bonds.kinematics;
      const bool                 full           = kinematics.is_full();
      const bool                 several_phases = laws.several_phases;
      NodalTensors<dim>          result;
      result.stress.resize(nodes.n_owned());
      result.strain.resize(nodes.n_owned());
      u.update_ghost_values();
      ends.find(u.begin());
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        {
          Tensor<2, dim> gradient, shape, stress;
          bonds.rows.for_each(i, [&](const auto &bond) {
            const unsigned int   j      = bond.neighbor;
            const Tensor<1, dim> xi     = ends.vector(i, j);
            const Tensor<1, dim> eta    = ends.change(u.begin(), i, j);
            const double         x2     = xi.norm_square();
            const double         weight = full ? kinematics.length(bond) / std::sqrt(x2) :
                                                 (bond.moment * xi) / x2; // W
            gradient += weight * outer_product(eta, xi);
            shape += weight * outer_product(xi, xi);
            if (yielding != nullptr)
              {
                stress += weight * yielding->force(i, bond, several_phases) * outer_product(xi, xi);
                return;
              }
            const double product = bond.spring * bonds.forces.effective_moment(u.begin(), i, bond);
            // V_i V_j t/x of this end, or with several phases the mean of both; of a fictitious
            // node with that of which it is an image. What the spring has of this end:
            const unsigned int   o   = ends.origin(j);
            const double         own = laws.stiffness(i), other = laws.stiffness(o);
            const double         this_end = ends.is_fictitious(j) ? 1. : own / (own + other);
            const double         force    = several_phases ?
                                              weight * 0.5 *
                                     (tau.local_element(i) + tau.local_element(o) +
                                      product * this_end * (1. + other / own)) :
                                              weight * (tau.local_element(i) + product * this_end);
            const Tensor<1, dim> y        = full ? xi + eta : xi;
            stress += (full ? force * std::sqrt(x2) / y.norm() : force) * outer_product(y, y);
          });
          // Few bonds may be left, or none.
          const bool held = determinant(shape) > 1e-12 * std::pow(trace(shape) / dim, dim);
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


    /** What shear adds where displacements are @p relaxed for it, in place of u. */
    template <int dim>
    NodalTensors<dim> relaxed_tensors(const SolidBonds<dim> &bonds,
                                      const Vector          &u,
                                      const Vector          &relaxed)
    {
      if (const auto *const nodal = bonds.correspondence())
        {
          NodalTensors<dim> result = nodal->tensors(u);
          const auto        strain = nodal->tensors(relaxed).strain;
          for (unsigned int i = 0; i < result.stress.size(); ++i)
            {
              const SymmetricTensor<2, dim> change = strain[i] - result.strain[i];
              result.stress[i] += nodal->shapes.of_shear(i, change);
              if (dim == 2)
                result.out_of_plane[i] -= 2. / 3. * nodal->shapes[i].shear * trace(change);
            }
          return result;
        }
      Vector tau(bonds.families.nodes().partitioner());
      bonds.sums.find_tensions(tau.begin(), u.begin()); // of c = 1
      Vector tau_relaxed(tau);
      bonds.sums.find_tensions(tau_relaxed.begin(), relaxed.begin());
      for (unsigned int i = 0; i < tau.locally_owned_size(); ++i)
        {
          const double of_shear = LinearPeridynamicSolid::shear_factor(bonds.laws[i]);
          tau.local_element(i)  = bonds.laws[i].volumetric * tau.local_element(i) +
                                 of_shear * (tau_relaxed.local_element(i) - tau.local_element(i));
        }
      tau.update_ghost_values();
      NodalTensors<dim> result = tensors_of_bonds(bonds, relaxed, tau);
      result.strain            = tensors_of_bonds(bonds, u, tau).strain;
      return result;
    }
  } // namespace


  template <int dim>
  NodalTensors<dim> nodal_tensors(const SolidBonds<dim> &bonds, const Vector &u, const Vector &tau)
  {
    if (bonds.relaxing() != nullptr)
      {
        const WithGhosts ghosts(u);
        return relaxed_tensors(bonds, u, bonds.relaxing()->effective(u));
      }
    if (const auto *const nodal = bonds.correspondence())
      return nodal->tensors(u);
    return tensors_of_bonds(bonds, u, tau);
  }


  template <int dim>
  std::vector<SymmetricTensor<2, 3>> nodal_stresses(const SolidBonds<dim>     &bonds,
                                                    const BodyParameters<dim> &body,
                                                    const NodalTensors<dim>   &tensors)
  {
    const bool      in_strain = dim == 2 && body.elasticity.plane == PlaneState::strain;
    const Material &material  = body.material;
    const bool      knows_out_of_plane =
      bonds.correspondence() &&
      (material.law.kind != SolidLaw::linear || !material.law.orthotropy.young.empty());
    std::vector<SymmetricTensor<2, 3>> list(tensors.stress.size());
    for (unsigned int i = 0; i < list.size(); ++i)
      {
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            list[i][a][b] = tensors.stress[i][a][b];
        if (!in_strain)
          continue;
        double      &zz     = list[i][2][2];
        const double sum    = trace(tensors.stress[i]);
        const Moduli moduli = bonds.laws.moduli(i);
        if (bonds.yielding())
          zz = bonds.yielding()->out_of_plane(i);
        else if (knows_out_of_plane)
          zz = tensors.out_of_plane[i];
        else if (material.law.kind == SolidLaw::viscoelastic) // cold; bulk does not relax
          zz = 3. * moduli.bulk * trace(tensors.strain[i]) - sum;
        else
          zz = moduli.poisson() * sum - moduli.young() * bonds.thermal[i] /
                                          thermal_strain_factor(moduli, dim, body.elasticity.plane);
      }
    return list;
  }


  template <int dim>
  std::vector<Vector> nodal_tensions(const SolidBonds<dim> &bonds, const Vector &u)
  {
    const auto         &layout = bonds.families.nodes().partitioner();
    std::vector<Vector> values(2, Vector(layout));
    u.update_ghost_values();
    if (bonds.laws.volumetric && (bonds.kinematics.is_strained() || bonds.law.any()))
      bonds.forces.find_tensions(values[0].begin(), u.begin());
    else if (bonds.laws.volumetric)
      bonds.sums.find_tensions(values[0].begin(), u.begin());
    u.set_ghost_state(false);
    for (unsigned int i = 0; i < bonds.families.nodes().n_owned(); ++i)
      values[1].local_element(i) = bonds.laws.stiffness(i);
    for (Vector &of : values)
      of.update_ghost_values();
    return values;
  }


  template <int dim>
  std::vector<Vector> nodal_stress_components(const SolidBonds<dim>     &bonds,
                                              const BodyParameters<dim> &body,
                                              const Vector              &u)
  {
    const std::vector<Vector> tensions =
      bonds.by_family ? std::vector<Vector>(1, Vector(bonds.families.nodes().partitioner())) :
                        nodal_tensions(bonds, u);
    const auto stress = nodal_stresses(bonds, body, nodal_tensors(bonds, u, tensions.front()));
    std::vector<Vector> components(SymmetricTensor<2, 3>::n_independent_components,
                                   Vector(bonds.families.nodes().partitioner()));
    for (unsigned int k = 0; k < components.size(); ++k)
      {
        for (unsigned int i = 0; i < stress.size(); ++i)
          components[k].local_element(i) = stress[i].access_raw_entry(k);
        components[k].update_ghost_values();
      }
    return components;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(nodal_dilatations);
  PERIDEAL_INSTANTIATE_FUNCTION(nodal_tensors);
  PERIDEAL_INSTANTIATE_FUNCTION(nodal_stresses);
  PERIDEAL_INSTANTIATE_FUNCTION(nodal_tensions);
  PERIDEAL_INSTANTIATE_FUNCTION(nodal_stress_components);
} // namespace PeriDeal
