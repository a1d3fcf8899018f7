// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/laws/stress_law.h>
#include <perideal/operators/coupling/node_families.h>
#include <perideal/scene/body_parameters.h>

#include <vector>

namespace PeriDeal
{
  /** The linear law of the scene at a place and its temperature, in plane stress in the plane. */
  template <int dim>
  StressLaw::Tangent linear_stiffness(const BodyParameters<dim> &body,
                                      const dealii::Point<dim>  &p,
                                      const double               temperature);


  /** Families have a law of stresses that is not linear: no matrix and no list has them. */
  template <int dim>
  bool has_nodal_law(const BodyParameters<dim> &body)
  {
    return body.elasticity.is_correspondence() && body.material.law.kind != SolidLaw::linear;
  }


  /**
   * What the family of a node of correspondence (Correspondence) adds to a body of the linear law,
   * as a matrix: with the symbols there, s the thermal strain of the node, and b_k = M^-1 a_k, a_k
   * the factor of u_k in sum W du xi^T, its energy is
   *
   *   V/2 (eps - s I) : C : (eps - s I) + c/2 (sum W |du|^2 - G M : G),   G = sum_k u_k b_k^T,
   *   K_kl = V b_k . C . b_l + c (L_kl - a_k . b_l) I,   L that of sum W |du|^2.
   */
  template <int dim>
  class NodalFamily
  {
  public:
    using Family = typename NodeFamilies<dim>::Family;

    /** Of a bond to the next node of the family. */
    struct Bond
    {
      dealii::Tensor<1, dim> moment; // W xi
      double                 weight; // W
    };

    NodalFamily(const BodyParameters<dim> &body, const dealii::Point<dim> &p);

    /**
     * @param bonds  to the nodes of the family behind its own
     * @param strain s
     * @param share  of the energy that counts
     */
    void add_to(Family                  &family,
                const std::vector<Bond> &bonds,
                const double             volume,
                const double             strain,
                const double             share) const;

  private:
    dealii::SymmetricTensor<4, dim> stiffness;
    double                          shear;
  };
} // namespace PeriDeal
