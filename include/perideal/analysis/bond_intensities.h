// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/front_intensity.h>
#include <perideal/bonds/families.h>

#include <array>
#include <functional>
#include <vector>

namespace PeriDeal
{
  /**
   * Fields around a node by least squares: the polynomial through the node's own value that fits
   * those of its family best that no crack parts from it, each by the inverse square of its
   * distance. Its degree is 3, or less where few bonds are left. Derivatives are those of the
   * peridynamic differential operator (Madenci, Barut and Futch 2016) with that weight: they are of
   * the same order beside a crack as elsewhere.
   */
  template <int dim>
  class FamilyFit
  {
  public:
    /** Value k of a node known here, owned or ghost. */
    using Values = std::function<double(const unsigned int node, const unsigned int k)>;

    explicit FamilyFit(const Families<dim> &families);

    /** Take so many fields around an owned node. Not collective. */
    void fit(const unsigned int node, const unsigned int n_fields, const Values &values);

    /** Of field k, a distance away from the node. */
    double                 value(const unsigned int k, const dealii::Tensor<1, dim> &away) const;
    dealii::Tensor<1, dim> slope(const unsigned int k, const dealii::Tensor<1, dim> &away) const;

    /** Of the last fit; 0: too few bonds are left for any. */
    unsigned int degree() const
    {
      return n_terms == 0 ? 0 : degree_of(n_terms - 1);
    }

  private:
    using Powers = std::array<unsigned int, dim>;

    unsigned int degree_of(const unsigned int term) const;

    const Families<dim>                        &families;
    std::vector<Powers>                         terms; // by degree, without the constant
    std::vector<typename Families<dim>::Member> members;
    unsigned int                                n_terms = 0;
    double                                      scale   = 1.;
    std::vector<double>                         own;          // values of the node
    std::vector<std::vector<double>>            coefficients; // of each field
  };


  /**
   * CrackEndIntegral, in three dimensions FrontIntegral, of peridynamics alone: gradients are those
   * of FamilyFit, the stress follows from them by Hooke's law, and each node stands for its cell of
   * the lattice, which is integrated with 3 x 3 or 2 x 2 x 2 points. Beside the crack nothing is
   * left out.
   *
   * @param values of the displacements and, if it is warm, of the thermal strain in the plane
   *               (RingPoint); of nodes known here
   * @param t          of body forces
   * @param crack_time as for crack_end_integrals()
   * Collective.
   */
  template <int dim>
  std::vector<StressIntensity> bond_intensities(const Scene<dim>                      &scene,
                                                const Families<dim>                   &families,
                                                const typename FamilyFit<dim>::Values &values,
                                                const bool                             warm,
                                                const double                           t,
                                                const double                           crack_time);
} // namespace PeriDeal
