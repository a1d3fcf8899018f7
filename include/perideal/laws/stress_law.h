// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <perideal/scene/choices.h>

#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** What a law of stresses knows of the body around a point. */
  enum class StressState
  {
    three_dimensional, // plane strain is that, with strains out of the plane that are known
    plane_stress       // the stress out of the plane is zero, the strain follows
  };


  /** Of a body in two or three dimensions. */
  inline StressState stress_state_of(const unsigned int dim, const PlaneState plane)
  {
    return dim == 2 && plane == PlaneState::stress ? StressState::plane_stress :
                                                     StressState::three_dimensional;
  }


  /**
   * A law that makes a stress of a small strain and of what the point went through: at quadrature
   * points of finite elements, or wherever else a strain is known. Tensors are three-dimensional in
   * all dimensions. Of a point a law gets some parameters, which may differ from point to point,
   * and its state: numbers of the law as they were when the last step was accepted. It owns none of
   * them, so that a step that is given up leaves nothing behind.
   *
   * Where deformations are large (`Kinematics = full`) the strain is that of Green and Lagrange,
   * E = (F^T F - 1)/2, of the deformation gradient F = 1 + grad u, and the stress the second one of
   * Piola and Kirchhoff, S = dW/dE, so that no law can tell a rotation: P = F S is the force per
   * area of the undeformed body, F S F^T/det F that of the deformed one.
   */
  class StressLaw
  {
  public:
    using Tensor  = dealii::SymmetricTensor<2, 3>;
    using Tangent = dealii::SymmetricTensor<4, 3>;

    /** Per volume. */
    struct Response
    {
      Tensor stress;
      double stored     = 0.; // energy now
      double dissipated = 0.; // since the state that was accepted
      double stretch    = 1.; // out of a plane of stress, of large deformations

      bool has_symmetric_tangent = true; // the one that was asked for
    };

    /** What a law is asked about: a strain that is reached straight from the accepted one. */
    struct Trial
    {
      Tensor        strain; // less that by temperature; in plane stress in the plane alone
      const double *parameters;
      const double *state;                          // the accepted one
      double        time = 0., step = 0.;           // at its end, since the accepted one
      double        instant     = 1.;               // what may stand for a step of no time
      unsigned int  increment   = 1;                // which step
      double        length      = 0.;               // of the element around the point
      double        temperature = 0., warming = 0.; // at its end, since the accepted one
      unsigned int  element = 0, point = 0;

      dealii::Tensor<2, 3> displacement_gradient = {}; // F - 1, of large deformations
    };

    virtual ~StressLaw() = default;

    virtual unsigned int n_parameters() const = 0;

    /** The numbers of a state, which are 0 before anything has happened. */
    virtual unsigned int n_state() const = 0;

    /** update() may throw a UserError. */
    virtual bool may_fail() const
    {
      return false;
    }

    /**
     * The stress is the derivative of what is stored and dissipated by the strain.
     *
     * @param next    what the state becomes if this strain is accepted; another place than that is
     * @param tangent the derivative of the stress by the strain; null: not wanted
     */
    virtual Response update(const Trial &trial, double *next, Tangent *tangent) const = 0;

    /** Numbers of the state that results show, by the name of their field. */
    virtual std::vector<std::pair<std::string, unsigned int>> shown() const
    {
      return {};
    }
  };
} // namespace PeriDeal
