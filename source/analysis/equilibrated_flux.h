// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>
#include <perideal/operators/diffusion/cell_term.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "vertex_patches.h"

namespace PeriDeal
{
  /** The value that is given at a place on a side, if one is. */
  template <int dim>
  using GivenValue = std::function<std::optional<double>(const dealii::types::boundary_id,
                                                         const dealii::Point<dim> &)>;

  /** That of diffusion; the problem must outlive it. */
  template <int dim>
  GivenValue<dim> given_value(const FluxProblem<dim> &problem);

  /** A value is given on a face of the boundary. */
  template <int dim>
  bool has_value(const GivenValue<dim>           &value,
                 const dealii::types::boundary_id side,
                 const MappedPoints<dim>         &at);

  /** q into the body through transfer on a side, at a point. */
  template <int dim>
  double inflow(const FluxProblem<dim>          &problem,
                const dealii::types::boundary_id side,
                const dealii::Point<dim>        &p,
                const double                     u);

  /** The sum of the h there. */
  template <int dim>
  double transfer_coefficient(const FluxProblem<dim>          &problem,
                              const dealii::types::boundary_id side,
                              const dealii::Point<dim>        &p);


  /** What is given through a face of the boundary, made a polynomial of the face. */
  struct FaceLoad
  {
    Eigen::MatrixXd hats;      // coefficients of what leaves, times the hats of the corners
    double          rest = 0.; // square of what is no polynomial, over the face
  };

  /** @param entering per area of the unit face, at its points; @param area of these, likewise */
  template <int dim>
  FaceLoad face_load(const UnitPoints<dim> &unit,
                     const Eigen::VectorXd &entering,
                     const Eigen::VectorXd &area);


  /**
   * A flux sigma in balance with the loads, near -kappa grad u_h: normal components are continuous,
   *
   *   div sigma = projection of s,   -sigma n = projection of what enters where no value is given,
   *
   * with Raviart-Thomas elements of the degree of u_h (Braess and Schoeberl 2008; Ern and Vohralik
   * 2015). It is the sum over all vertices that do not hang of fluxes on the support of their hat
   * function psi, each nearest to -psi kappa grad u_h of those with the divergence of
   * psi s - grad psi . kappa grad u_h, which add up to 0 there where u_h solves the equations.
   */
  template <int dim>
  class EquilibratedFlux
  {
  public:
    using Cell = typename FluxMesh<dim>::Cell;

    /** @param u with ghosts. All must outlive this. Collective. */
    EquilibratedFlux(FluxMesh<dim> &mesh, const FluxProblem<dim> &problem, const Vector &u);

    /** The field in an owned cell. */
    CellField<dim> field(const Cell &cell) const;

    /**
     * (sigma + kappa grad u_h)/sqrt(kappa) at quadrature points of an owned cell, times the root of
     * their weights: its norm is that in the cell.
     */
    Eigen::MatrixXd difference(const Cell &cell, const CellField<dim> &field) const;

    /** What one owned cell adds to the bound beside it. */
    struct Oscillation
    {
      double cell    = 0.; // over the norm of the gradient in the cell
      double sides   = 0.; // square; over that on sides with a coefficient
      double stretch = 0.; // as CellConstants
    };

    const Oscillation &oscillation(const Cell &cell) const
    {
      return sums[cell->active_cell_index()].oscillation;
    }

    /** Sum of what is left of the balances of cells, from quadrature and the solver. */
    double imbalance() const
    {
      return left;
    }

    const FluxProblem<dim> &of_problem() const
    {
      return problem;
    }

    const Vector &solution() const
    {
      return u;
    }

  private:
    /** Of an owned cell. */
    struct Sums
    {
      Eigen::VectorXd loads, divergence; // in the end loads are the numbers of the flux
      Oscillation     oscillation;

      std::shared_ptr<const CondensedCell> condensed; // of cells that are unlike others
    };

    VertexShares<dim> shares(const Cell &cell);
    void              add_faces(const Cell             &cell,
                                const CellCorners<dim> &corners,
                                const Eigen::VectorXd  &numbers,
                                const double            conductivity,
                                std::vector<FacePlace> &places,
                                Eigen::MatrixXd        &given);
    void              finish(const VertexPatches<dim> &patches);

    FluxMesh<dim>          &mesh;
    const FluxProblem<dim> &problem;
    const Vector           &u;
    std::vector<Sums>       sums; // by active cell index
    double                  left = 0.;
  };
} // namespace PeriDeal
