// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/quadratic_elements.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** What the error of a solution cannot exceed, and what that is made of. */
  struct EnergyBound
  {
    double bound = 0.; // of |u - u_h|, |v|^2 = int kappa |grad v|^2 + int_sides h v^2
    double norm  = 0.; // |u_h|

    double flux        = 0.; // |kappa^{-1/2} (sigma + kappa grad u_h)|
    double oscillation = 0.; // what source and given fluxes that are no polynomials add to it
    double values      = 0.; // of what values on sides have that elements cannot have
    double remainder   = 0.; // of what quadrature and the solver leave

    std::vector<double> cells; // parts of flux^2 of owned cells, by active cell index
    double              seconds = 0.;
    std::string         reservation; // what is not bounded, if something is not; empty: guaranteed

    /** The bound over the norm of u_h. */
    double relative() const
    {
      return norm > 0. ? bound / norm : 0.;
    }
  };


  /** What enters through a side. */
  struct FlowBound
  {
    double      value = 0.;             // of u_h, as in a balance
    double      lower = 0., upper = 0.; // the true one is between these
    double      seconds = 0.;
    std::string reservation; // as of EnergyBound
  };


  /**
   * Guaranteed bounds of errors of steady diffusion with finite elements Q1 to Q3, by the theorem
   * of Prager and Synge (doc/estimators.md): for any sigma whose divergence is the source and that
   * has the given fluxes on the sides, |u - u_h| <= |kappa^{-1/2} (sigma + kappa grad u_h)|. Here
   * sigma is an equilibrated flux from problems around the vertices.
   *
   * Guaranteed means: but for round-off; for source, conductivity and conditions as quadrature of
   * degree 2 p + 5 sees them, and values on sides as polynomials of degree p + 2 do; in cells
   * without folds. Cracks have to be faces of the mesh, and to let nothing through.
   */
  template <int dim>
  class EnergyBounds
  {
  public:
    /** Why a body cannot have them; empty if it can. Not collective. */
    static std::string why_not(const BodyParameters<dim> &body);

    /**
     * @param op    without a coupling; it and the body must outlive this
     * @param solve with K, for what quadrature leaves where that counts, and for flows
     *
     * Collective.
     */
    EnergyBounds(const FieldOperator<dim>  &op,
                 const BodyParameters<dim> &body,
                 const SolveSystem         &solve);

    ~EnergyBounds();

    /** @param u through distribute(); needs no ghosts. Collective. */
    EnergyBound of(const Vector &u, const double t = 0.) const;

    /**
     * What enters through a side with a value or a transfer. Where a side with a value meets
     * another one, it is what K u - f sums up: with the share of the first faces of the others that
     * a field has which is 1 on the side and falls to 0 along them. Throws UserError for other
     * names. Takes one solution with K. Collective.
     */
    FlowBound of_flow_through(const std::string &side, const Vector &u, const double t = 0.) const;

  private:
    struct Parts;

    const std::unique_ptr<Parts> parts;
  };
} // namespace PeriDeal
