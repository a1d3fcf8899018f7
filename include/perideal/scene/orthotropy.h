// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>

#include <perideal/scene/material.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** An entry of an orthotropic body, a list; the phases can have it, too. */
  struct OrthotropicEntry
  {
    std::string name, unit, words;
  };

  const std::vector<OrthotropicEntry> &orthotropic_entries();

  /**
   * The entries of section `Material` and of its phases. In plane stress those of the plane will
   * do, E1, E2, G12, nu12; others are then what they may be without effect in it. Throws UserError.
   */
  Material::Law::Orthotropy parse_orthotropy(const Material    &material,
                                             const Physics      physics,
                                             const unsigned int dim,
                                             const PlaneState   plane);

  /**
   * C_ijkl = R_ia R_jb R_kc R_ld C0_abcd, C0 the inverse of what Young's moduli, shear moduli and
   * Poisson ratios say in the body's own axes (eps_11 = s_11/E1 - nu12 s_22/E1 - nu13 s_33/E1). R
   * turns about z; in three dimensions about z, then about x as it is then, then about z as it is
   * then: R = Rz(a) Rx(b) Rz(c). Three-dimensional in two dimensions, too. Throws the UserError of
   * numbers that no body has at the point, or defers it (report_formula_error()).
   */
  template <int dim>
  dealii::SymmetricTensor<4, 3> orthotropic_stiffness(const Material::Law::Orthotropy &body,
                                                      const dealii::Point<dim>        &p);

  /** Voigt's mean of C over all directions, an isotropic body. */
  template <int dim>
  Moduli mean_moduli(const Material::Law::Orthotropy &body, const dealii::Point<dim> &p);
} // namespace PeriDeal
