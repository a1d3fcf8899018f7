// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/base/smallest_eigenvalue.h>

namespace PeriDeal
{
  /*
   * Numbers of a node of correspondence (operators/solid/correspondence.h) that follow from its
   * stiffness.
   */

  /** What is in the body of a three-dimensional stiffness. */
  template <int dim>
  dealii::SymmetricTensor<4, dim> in_body(const dealii::SymmetricTensor<4, 3> &full)
  {
    dealii::SymmetricTensor<4, dim> part;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = c; d < dim; ++d)
            part[a][b][c][d] = full[a][b][c][d];
    return part;
  }


  /** Of a stiffness, or a compliance: the shear modulus of its mean over all directions. */
  template <int dim>
  double mean_shear(const dealii::SymmetricTensor<4, dim> &C)
  {
    if (dim == 1)
      return 0.5 * C[0][0][0][0];
    double trace = 0., of_volume = 0.;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = 0; b < dim; ++b)
        {
          trace += C[a][b][a][b];
          of_volume += C[a][a][b][b];
        }
    return (trace - of_volume / dim) / (dim * (dim + 1.) - 2.);
  }


  /** A shear modulus by which no shear is much stiffer than in the body: Reuss's mean. */
  template <int dim>
  double soft_shear(const dealii::SymmetricTensor<4, dim> &C)
  {
    return 0.25 / mean_shear(invert(C));
  }


  /**
   * Whether the bonds that are left of a node are enough for a gradient: too few would make it so
   * stiff that steps are no longer stable. At a face of a crack half of M is left.
   * @param M of these bonds @param weight q V of the body before
   */
  template <int dim>
  bool bonds_hold(const dealii::SymmetricTensor<2, dim> &M, const double weight)
  {
    constexpr double few = 0.35;
    return dim * smallest_eigenvalue(M) > few * weight;
  }


  /** c, of what the gradient does not tell of a family. @param q sum omega x^2 V */
  template <int dim>
  double stabilizer(const double shear, const double q)
  {
    return dim * (dim + 2.) * shear / q;
  }
} // namespace PeriDeal
