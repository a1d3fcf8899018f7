// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/body_parameters.h>

#include <map>

#include "equilibrated_flux.h"

namespace PeriDeal
{
  /** Hooke's law of an isotropic body at a place: sigma = C (eps - strain I). */
  template <int dim>
  struct HookeAt
  {
    using Matrix = Eigen::Matrix<double, dim, dim>;

    /** Of the gradient of a displacement. */
    Matrix stress(const Matrix &gradient) const;

    /** sigma : C^{-1} sigma of a symmetric one, without the thermal strain. */
    double complementary(const Matrix &stress) const;

    /** The smallest eigenvalue of C. */
    double least() const
    {
      return std::min(2. * shear, 2. * shear + dim * lambda);
    }

    /** Of tr in C^{-1} sigma = (sigma - ratio tr(sigma) I)/(2 G). */
    double ratio() const
    {
      return lambda / (2. * shear + dim * lambda);
    }

    double lambda = 0., shear = 0.5, strain = 0.;
  };


  /** -div sigma(u) = f at one time, with displacements and tractions on the sides. */
  template <int dim>
  class StressProblem
  {
  public:
    /** The body must outlive this. Not collective. */
    StressProblem(const BodyParameters<dim>     &body,
                  const dealii::DoFHandler<dim> &dofs,
                  const double                   time);

    HookeAt<dim> law(const dealii::Point<dim> &p) const;

    /** Whether it is the same everywhere, and the body force. */
    bool is_uniform() const
    {
      return uniform;
    }

    bool has_constant_force() const
    {
      return constant_force;
    }

    double force(const unsigned int component, const dealii::Point<dim> &p) const
    {
      const auto &given = body.initial_and_source.body_force;
      return given.empty() ? 0. : given[component].value(p, time);
    }

    /** What displaces sides in a direction. This must outlive it. */
    GivenValue<dim> displacement(const unsigned int component) const;

    double traction(const unsigned int               component,
                    const dealii::types::boundary_id side,
                    const dealii::Point<dim>        &p) const;

    /** A traction is given at some of the places on a side, and not at others. */
    bool traction_ends(const dealii::types::boundary_id side, const MappedPoints<dim> &at) const;

  private:
    HookeAt<dim> find_law(const dealii::Point<dim> &p) const;

    const BodyParameters<dim>                         &body;
    const double                                       time;
    std::map<dealii::types::boundary_id, unsigned int> mirrors; // sides of symmetry: normal to
    bool                                               uniform, constant_force;
    HookeAt<dim>                                       everywhere;
  };
} // namespace PeriDeal
