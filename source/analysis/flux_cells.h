// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>

#include <perideal/base/types.h>
#include <perideal/mesh/cell_geometry.h>
#include <perideal/mesh/part_faces.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/material.h>

#include <Eigen/Dense>
#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "vertex_patch.h"

namespace PeriDeal
{
  /** -div(kappa grad u) = s with what is given on the sides, at one time. */
  template <int dim>
  struct FluxProblem
  {
    const Material                                *material = nullptr;
    std::shared_ptr<const BoundaryConditions<dim>> conditions;
    Expression                                     source;
    double                                         time = 0.;
  };


  /** Functions at the points of a quadrature rule of the unit cell, or of one of its faces. */
  template <int dim>
  struct UnitPoints
  {
    UnitPoints(const dealii::FiniteElement<dim>      &fe,
               const std::vector<dealii::Point<dim>> &points,
               const std::vector<double>             &weights);

    Eigen::VectorXd                  weights;
    Eigen::MatrixXd                  hats, shapes; // rows: functions, columns: points
    std::array<Eigen::MatrixXd, dim> hat_gradients, shape_gradients;
    Eigen::MatrixXd                  products; // Legendre, of the cell or of the face's coordinates
  };


  /** Finite elements, hats of the vertices, fluxes, all on the unit cell. */
  template <int dim>
  struct UnitCell
  {
    explicit UnitCell(const dealii::FiniteElement<dim> &fe);

    const FluxBasis<dim>         basis;
    const dealii::FE_Q<dim>      lifting_element; // of values on sides
    const dealii::QGauss<dim>    quadrature;
    UnitPoints<dim>              inside, lifting; // the same points
    std::vector<UnitPoints<dim>> on_faces;
    Eigen::MatrixXd              fluxes; // at the points inside

    /** Those with one component each, and their numbers. */
    std::array<Eigen::MatrixXd, dim>           along;
    std::array<std::vector<unsigned int>, dim> numbers_along;
  };


  /** A cell mapped from the unit cell, at points. */
  template <int dim>
  struct MappedPoints
  {
    MappedPoints(const UnitPoints<dim> &unit, const CellCorners<dim> &corners);

    /** Area of the mapped face, per area of the unit face. */
    double area(const unsigned int q, const unsigned int face) const;

    using Map = Eigen::Matrix<double, dim, dim>;

    std::vector<dealii::Point<dim>> points;
    std::vector<Map>                maps; // F
    Eigen::VectorXd                 determinants;
  };


  /** A field in a cell, and the conductivity. */
  template <int dim>
  struct CellField
  {
    CellField(const UnitCell<dim>    &unit,
              const CellCorners<dim> &corners,
              const FluxProblem<dim> &problem,
              const Eigen::VectorXd  &u,
              const bool              with_source = true);

    MappedPoints<dim> at;
    Eigen::VectorXd   conductivity, source, values;
    Eigen::MatrixXd   gradient; // with respect to coordinates of the unit cell; rows: components
  };


  /** Constants of inequalities that hold in a mapped cell, whatever its shape. */
  template <int dim>
  struct CellConstants
  {
    explicit CellConstants(const CellCorners<dim> &corners);

    /** For some c: |v - c| in the face <= trace |grad v| in the cell. */
    double trace(const CellCorners<dim> &corners, const unsigned int face) const;

    double stretch;      // |grad v|^2 on the unit cell <= stretch |grad v|^2
    double poincare;     // for some c: |v - c| <= poincare |grad v|
    double least_volume; // of the determinant of the map
  };


  /** Cells condensed, once for all that are alike but for their size. */
  template <int dim>
  class CondensedCells
  {
  public:
    explicit CondensedCells(const UnitCell<dim> &unit)
      : unit(unit)
    {}

    /** The cell, and the factor of its stiffness, for conductivity 1. */
    std::pair<std::shared_ptr<const CondensedCell>, double> of(const CellCorners<dim> &corners);

  private:
    const UnitCell<dim>                                              &unit;
    std::map<std::vector<long>, std::shared_ptr<const CondensedCell>> known;
  };


  /** Number of the vertex of a cell that is the jth of a face. */
  template <int dim>
  unsigned int corner_of_face(const unsigned int face, const unsigned int j)
  {
    const unsigned int d = face / 2;
    return ((j >> d) << (d + 1)) | ((face % 2) << d) | (j & ((1u << d) - 1));
  }


  template <int dim, typename Cell>
  CellCorners<dim> corners_of(const Cell &cell)
  {
    CellCorners<dim> corners;
    for (unsigned int v = 0; v < corners.size(); ++v)
      corners[v] = cell->vertex(v);
    return corners;
  }


  /** Where a face of a cell lies; the cell with the numbers of its vertices. */
  template <int dim>
  FacePlace place_of_face(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
                          const unsigned int                                            face);


  /** What hats make of the loads and the flux of u_h in a cell. */
  template <int dim>
  struct HatLoads
  {
    /** Columns: hats. */
    HatLoads(const UnitCell<dim> &unit, const CellField<dim> &field);

    /** The same of any flux in place of kappa grad u; @param covariant F^T times it, at points */
    HatLoads(const UnitCell<dim>     &unit,
             const MappedPoints<dim> &at,
             const Eigen::VectorXd   &source,
             const Eigen::MatrixXd   &covariant);

    Eigen::MatrixXd divergence; // Legendre coefficients of J (hat f - grad hat . kappa grad u)
    Eigen::MatrixXd loads;      // minus the integral of hat kappa grad u . flux
  };
} // namespace PeriDeal
