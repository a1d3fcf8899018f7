// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/fe/fe_q.h>

#include <perideal/mesh/cell_geometry.h>

#include <Eigen/Dense>
#include <array>
#include <map>
#include <memory>
#include <vector>

namespace PeriDeal
{
  /** Polynomials of a degree on the triangle 0 <= s, 0 <= r, s + r <= 1, orthonormal. */
  struct TrianglePolynomials
  {
    explicit TrianglePolynomials(const unsigned int degree);

    const unsigned int             degree, n; // how many
    std::vector<dealii::Point<2>>  points;    // of a quadrature rule
    Eigen::VectorXd                weights;
    Eigen::MatrixXd                values;    // rows: functions, columns: points
    std::array<Eigen::MatrixXd, 2> gradients; // by s and by r
    /** Legendre coefficients (rows) on the sides s + r = 1, from s = 1 on; r = 0; s = 0. */
    std::array<Eigen::MatrixXd, 3> on_sides;
  };


  /**
   * Symmetric stresses in a quadrilateral that give its sides any tractions: polynomials of one
   * degree more than those, in each of the four triangles that the sides make with the middle, with
   * continuous tractions between them (Johnson and Mercier 1978). A polynomial of all of the cell
   * could not, since at a corner the shear of both sides would have to agree. Of all these stresses
   * it finds the one for which
   *
   *   |tau - sigma|^2 - ratio |tr(tau - sigma)|^2 + weight |div tau + size f|^2
   *
   * is smallest, with lengths, and the divergence, in units of the size of the cell. Numbers: of
   * each triangle xx, yy, xy.
   */
  class CompositeStress
  {
  public:
    using Polynomials = TrianglePolynomials;

    /**
     * @param corners  of a cell of size 1
     * @param fe       of displacements, whose degree is that of the tractions
     * @param weight   as above
     */
    CompositeStress(const Polynomials     &polynomials,
                    const CellCorners<2>  &corners,
                    const dealii::FE_Q<2> &fe,
                    const double           ratio,
                    const double           weight);

    /**
     * @param tractions of x and y (columns), along sides in deal.II's order (rows): Legendre
     *                  coefficients of tau n, times the side's length in units of the size
     * @param stress    sigma at the points: xx, yy, xy
     * @param force     size f there
     */
    Eigen::VectorXd numbers(const Eigen::MatrixXd &tractions,
                            const Eigen::MatrixXd &stress,
                            const Eigen::MatrixXd &force) const;

    /** xx, yy, xy at the points. */
    Eigen::MatrixXd stress(const Eigen::VectorXd &numbers) const;

    Eigen::MatrixXd divergence(const Eigen::VectorXd &numbers) const;

    /** Can give any tractions, to round-off. */
    bool is_sound() const
    {
      return sound;
    }

    // The points from the first corner on, and their shares of the area.
    std::vector<dealii::Point<2>>  points;
    Eigen::VectorXd                weights;
    std::array<Eigen::MatrixXd, 2> shape_gradients; // of displacements, there

  private:
    struct Triangle
    {
      Eigen::Matrix2d map; // columns: the sides from the middle on
      double          area2;
      Eigen::MatrixXd by_x, by_y; // derivatives of the polynomials
    };

    void            place(const CellCorners<2> &corners, const dealii::FE_Q<2> &fe);
    Eigen::MatrixXd energy(const double ratio) const;
    Eigen::MatrixXd constraints(const CellCorners<2> &corners) const;
    void            add_traction(const unsigned int     triangle,
                                 const unsigned int     side,
                                 const Eigen::Vector2d &normal,
                                 const unsigned int     row,
                                 Eigen::MatrixXd       &rows) const;

    const Polynomials      &polynomials;
    const double            ratio, weight;
    std::array<Triangle, 4> triangles;
    Eigen::MatrixXd         by_tractions, by_loads;
    bool                    sound = true;
  };
} // namespace PeriDeal
