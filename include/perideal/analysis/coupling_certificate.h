// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/cell_term.h>
#include <perideal/operators/solid/elastic_elements.h>

#include <optional>
#include <string>

namespace PeriDeal
{
  /**
   * What a coupling is worth, found out before the run on the body without its cracks, with values
   * (of elastic bodies displacements) prescribed on its whole surface.
   *
   * The patch errors are the largest differences between the solution of the coupled model and that
   * of finite elements for the boundary values and sources of a linear, a quadratic and a cubic
   * field, over the largest value of the field: what the coupling adds to the error of finite
   * elements.
   */
  struct CouplingCertificate
  {
    double linear = 0., quadratic = 0., cubic = 0.;
    double asymmetry         = 0.; // the largest of |(K - K^T) x|/|K x| for some fields x of noise
    double lowest_eigenvalue = 0.; // of C^{-1} K, the rate of the slowest decay
    // Eigenvalue of what is left of a cell, in units of its conductivity or shear modulus; infinite
    // if all cells are whole.
    double lowest_remainder = 0.;
    double zone_share       = 0.; // of the body's volume
    double kept_share       = 1.; // of the bonds' strength that distorted cells leave
    // Of elastic bodies: the largest |m . K x|/(max |m| sum |K x|) for the rigid motions m and a
    // field x of noise.
    std::optional<double> unbalanced;
    unsigned long long    n_bonds_of_full = 0,
                       n_nonzeros_of_full = 0; // peridynamics everywhere; 0: not known

    /**
     * What is wrong, or nothing: a linear field that is not exact to 1e-10, a negative eigenvalue,
     * forces that do not balance.
     */
    std::string fault() const;

    /** Throws UserError if there is a fault(): exchange, which has none, must not run with it. */
    void require_sound() const;
  };


  /** Collective. */
  template <int dim>
  CouplingCertificate examine_coupling(const FieldOperator<dim> &op, const bool symmetric);

  /** For couplings without mirrors(). Collective. */
  template <int dim>
  CouplingCertificate examine_coupling(const ElasticElements<dim> &op);
} // namespace PeriDeal
