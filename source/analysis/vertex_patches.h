// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>
#include <perideal/operators/parts/hanging_nodes.h>
#include <perideal/scene/body_parameters.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/vector.hpp>

#include <functional>
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

    /** @param dofs of elements with one component; must outlive this. Collective. */
    FluxMesh(const dealii::DoFHandler<dim> &dofs, const BodyParameters<dim> &body);

    const dealii::DoFHandler<dim> &dofs() const
    {
      return elements;
    }

    HatsInCell hats(const Cell &cell) const;

    /** Those of all faces of a cell. */
    std::vector<FacePlace> places(const Cell &cell) const;

    /** The process that owns a vertex. */
    unsigned int owner(const dealii::types::global_dof_index vertex) const;

    /**
     * Numbers of a component of a field, which has ghosts and so many at each node, interleaved, at
     * the unknowns of a cell.
     */
    Eigen::VectorXd numbers(const Cell        &cell,
                            const Vector      &u,
                            const unsigned int component    = 0,
                            const unsigned int n_components = 1) const;

    const UnitCell<dim>   unit;
    const RimFactors<dim> rim;
    CondensedCells<dim>   condensed;

  private:
    Cell linear_cell(const Cell &cell) const
    {
      return {&linear->get_triangulation(), cell->level(), cell->index(), linear.get()};
    }

    const dealii::DoFHandler<dim>                 &elements;
    const std::unique_ptr<dealii::DoFHandler<dim>> linear;
    const HangingNodes<dim>                        hanging;
    std::vector<dealii::types::global_dof_index>   begins; // vertices of each process
  };


  /** What a cell has for the problems of its vertices; columns: hats of its corners. */
  template <int dim>
  struct VertexShares
  {
    CellCorners<dim>                     corners;
    Eigen::MatrixXd                      means, loads, given; // as in PatchCell
    double                               factor = 1.;
    std::vector<FacePlace>               faces;
    std::shared_ptr<const CondensedCell> condensed;
  };


  /**
   * Fluxes, of one component or several, as sums over all vertices that do not hang of fluxes on
   * the support of their hat function (PatchSolver). The process that owns a vertex solves its
   * problem.
   */
  template <int dim>
  class VertexPatches
  {
  public:
    using Cell   = typename FluxMesh<dim>::Cell;
    using Shares = std::function<VertexShares<dim>(const Cell &)>;

    /** The mesh must outlive this. Not collective. */
    VertexPatches(FluxMesh<dim> &mesh, const unsigned int n_components);

    /** @param shares of owned cells. Collective. */
    void solve(const Shares &shares);

    /** The fluxes through the faces of an owned cell, of each component in turn. */
    const Eigen::VectorXd &outward(const Cell &cell) const
    {
      return sums[cell->active_cell_index()];
    }

  private:
    /** A cell of a vertex of another process. */
    struct Message
    {
      dealii::types::global_dof_index vertex = 0;
      unsigned int                    cell = 0, corner = 0;
      double                          factor = 1.;
      std::vector<FacePlace>          faces;
      std::vector<double>             means, loads, given;
      std::vector<dealii::Point<dim>> corners;

      template <class Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &vertex &cell &corner &factor &faces &means &loads &given &corners;
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

    void deal_out(const Cell &cell, const VertexShares<dim> &shares);
    void exchange_messages();
    void take_found();

    using Vertex = dealii::types::global_dof_index;

    FluxMesh<dim>                                     &mesh;
    std::vector<Eigen::VectorXd>                       sums;     // by active cell index
    std::unordered_map<Vertex, unsigned int>           expected; // cells of owned vertices
    std::unordered_map<Vertex, std::vector<PatchCell>> patches;
    std::map<unsigned int, std::vector<Message>>       messages;
    std::map<unsigned int, std::vector<Return>>        returns;
    std::vector<PatchCell>                             found; // of owned vertices
    PatchSolver                                        solver;
    unsigned int                                       process;
  };
} // namespace PeriDeal
