// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <map>

#include "equilibrated_flux.h"

namespace PeriDeal
{
  /**
   * What values on sides have that the finite elements of a solution cannot have, continued into
   * the cells there: with elements of two degrees more, whose other numbers are 0.
   */
  template <int dim>
  class ValueLifting
  {
  public:
    using Cell = typename FluxMesh<dim>::Cell;

    /** @param value none: there is nothing. The mesh must outlive this. Not collective. */
    ValueLifting(const FluxMesh<dim> &mesh, GivenValue<dim> value);

    /** Of the elements in an owned cell, in which u has these; empty where there is nothing. */
    Eigen::VectorXd numbers(const Cell &cell, const Eigen::VectorXd &of_u) const;

    /** At the points inside the cell, with respect to coordinates of the unit cell. */
    Eigen::MatrixXd gradient(const Eigen::VectorXd &numbers) const;

    /** At the points on a face. */
    Eigen::VectorXd values_on_face(const Eigen::VectorXd &numbers, const unsigned int face) const;

    /** A value ends within a face of this process. */
    bool is_cut() const
    {
      return cut;
    }

  private:
    /** Add the sides with values that hold at points of a cell; the cell is at the boundary. */
    template <typename Visit>
    void for_each_side(const Cell &cell, const Visit &visit) const;

    const FluxMesh<dim>                      &mesh;
    const GivenValue<dim>                     value;
    Eigen::MatrixXd                           shapes; // of u_h at the support points
    std::map<int, dealii::types::boundary_id> lines;  // in 3D: those of sides with values
    bool                                      cut = false;
  };
} // namespace PeriDeal
