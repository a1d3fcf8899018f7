// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/energy_bound.h>
#include <perideal/operators/solid/elastic_elements.h>

#include <memory>
#include <string>

namespace PeriDeal
{
  /**
   * Guaranteed bounds of errors of finite elements Q2 and Q3 for linear elastic bodies at rest, in
   * the energy norm |v|^2 = int eps(v) : C eps(v), as EnergyBounds of diffusion
   * (doc/estimators.md): for any symmetric tau with div tau + f = 0 and the given tractions,
   * |u - u_h| <= |C^{-1/2} (tau - sigma_h)|. Problems around the vertices give tractions of all
   * cells in balance, of forces and of moments; a problem in each cell finds the stress.
   *
   * In two dimensions, for convex cells.
   */
  template <int dim>
  class ElasticBounds
  {
  public:
    /** Why a body cannot have them; empty if it can. Not collective. */
    static std::string why_not(const BodyParameters<dim> &body);

    /**
     * @param op    finite elements alone on @p dofs; these and the body must outlive this
     * @param solve with K, for what quadrature leaves where that counts
     *
     * Collective.
     */
    ElasticBounds(const ElasticElements<dim>    &op,
                  const dealii::DoFHandler<dim> &dofs,
                  const BodyParameters<dim>     &body,
                  const SolveSystem             &solve);

    ~ElasticBounds();

    /** @param u through distribute(); needs no ghosts. Collective. */
    EnergyBound of(const Vector &u, const double t = 0.) const;

  private:
    struct Parts;

    const std::unique_ptr<Parts> parts;
  };
} // namespace PeriDeal
