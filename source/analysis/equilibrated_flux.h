// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>
#include <perideal/operators/diffusion/cell_term.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/vector.hpp>

#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "flux_cells.h"

namespace PeriDeal
{
  /** What all fluxes on the mesh of finite elements share. */
  template <int dim>
  class FluxMesh
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** Vertices that do not hang, and what their hats are at those of a cell. */
    using Hat        = Eigen::Matrix<double, dealii::GeometryInfo<dim>::vertices_per_cell, 1>;
    using HatsInCell = std::vector<std::pair<dealii::types::global_dof_index, Hat>>;

    /** op must outlive this. Collective. */
    FluxMesh(const FieldOperator<dim> &op, const BodyParameters<dim> &body);

    const dealii::DoFHandler<dim> &dofs() const
    {
      return cells_of(op).dof_handler();
    }

    HatsInCell hats(const Cell &cell) const;

    /** Those of all faces of a cell. */
    std::vector<FacePlace> places(const Cell &cell) const;

    /** The process that owns a vertex. */
    unsigned int owner(const dealii::types::global_dof_index vertex) const;

    /** Numbers of a field, which has ghosts, at the unknowns of a cell. */
    Eigen::VectorXd numbers(const Cell &cell, const Vector &u) const;

    const UnitCell<dim>   unit;
    const RimFactors<dim> rim;
    CondensedCells<dim>   condensed;

  private:
    Cell linear_cell(const Cell &cell) const
    {
      return {&linear->get_triangulation(), cell->level(), cell->index(), linear.get()};
    }

    const FieldOperator<dim>                      &op;
    const std::unique_ptr<dealii::DoFHandler<dim>> linear;
    const HangingNodes<dim>                        hanging;
    std::vector<dealii::types::global_dof_index>   begins; // vertices of each process
  };


  /** A value is given on a face of the boundary. */
  template <int dim>
  bool has_value(const BoundaryConditions<dim>   &conditions,
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
    /** A cell of a vertex of another process. */
    struct Message
    {
      dealii::types::global_dof_index vertex = 0;
      unsigned int                    cell = 0, corner = 0;
      double                          factor = 1., mean = 0.;
      std::vector<FacePlace>          faces;
      std::vector<double>             loads, given;
      std::vector<dealii::Point<dim>> corners;

      template <class Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &vertex &cell &corner &factor &mean &faces &loads &given &corners;
      }
    };

    /** What comes back of it. */
    struct Return
    {
      unsigned int        cell = 0;
      std::vector<double> outward;

      template <class Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &cell &outward;
      }
    };

    /** Of an owned cell. */
    struct Sums
    {
      Eigen::VectorXd outward, loads, divergence; // in the end loads are the numbers of the flux
      Oscillation     oscillation;

      std::shared_ptr<const CondensedCell> condensed; // of cells that are unlike others
    };

    void add(const Cell &cell);
    void add_faces(const Cell             &cell,
                   const CellCorners<dim> &corners,
                   const Eigen::VectorXd  &numbers,
                   const double            conductivity,
                   std::vector<FacePlace> &places,
                   Eigen::MatrixXd        &given);
    void deal_out(const CellCorners<dim>                   &corners,
                  const typename FluxMesh<dim>::HatsInCell &hats,
                  const Eigen::RowVectorXd                 &means,
                  const Eigen::MatrixXd                    &loads,
                  const Eigen::MatrixXd                    &given,
                  PatchCell                                &piece);
    void exchange_messages();
    void take_found();
    void finish();

    using Vertex = dealii::types::global_dof_index;

    FluxMesh<dim>                                     &mesh;
    const FluxProblem<dim>                            &problem;
    const Vector                                      &u;
    std::vector<Sums>                                  sums;     // by active cell index
    std::unordered_map<Vertex, unsigned int>           expected; // cells of owned vertices
    std::unordered_map<Vertex, std::vector<PatchCell>> patches;
    std::map<unsigned int, std::vector<Message>>       messages;
    std::map<unsigned int, std::vector<Return>>        returns;
    std::vector<PatchCell>                             found; // of owned vertices
    PatchSolver                                        solver;
    double                                             left = 0.;
    unsigned int                                       process;
  };
} // namespace PeriDeal
