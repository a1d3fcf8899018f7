// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "composite_stress.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

#include "flux_basis.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_sides = 4;

    /** Corners of a side of a quadrilateral, in deal.II's order. */
    constexpr unsigned int corner_of_side[n_sides][2] = {{0, 2}, {1, 3}, {0, 1}, {2, 3}};

    /** Powers about the middle of the triangle, and their derivatives by s and r. */
    std::array<Eigen::VectorXd, 3> powers(const unsigned int degree, const Point<2> &p)
    {
      const double                   s = p[0] - 1. / 3., r = p[1] - 1. / 3.;
      const unsigned int             n = (degree + 1) * (degree + 2) / 2;
      std::array<Eigen::VectorXd, 3> result;
      result.fill(Eigen::VectorXd(n));
      for (unsigned int i = 0, k = 0; i <= degree; ++i)
        for (unsigned int j = 0; i + j <= degree; ++j, ++k)
          {
            result[0][k] = std::pow(s, i) * std::pow(r, j);
            result[1][k] = i == 0 ? 0. : i * std::pow(s, i - 1) * std::pow(r, j);
            result[2][k] = j == 0 ? 0. : j * std::pow(s, i) * std::pow(r, j - 1);
          }
      return result;
    }


    Eigen::Vector2d vector_of(const Point<2> &p)
    {
      return {p[0], p[1]};
    }
  } // namespace


  TrianglePolynomials::TrianglePolynomials(const unsigned int degree)
    : degree(degree)
    , n((degree + 1) * (degree + 2) / 2)
  {
    const QGauss<1>    line(degree + 2);
    const unsigned int n_points = line.size() * line.size();
    weights.resize(n_points);
    values.resize(n, n_points);
    gradients.fill(values);
    for (unsigned int q = 0; q < n_points; ++q)
      {
        const double a = line.point(q % line.size())[0], b = line.point(q / line.size())[0];
        points.emplace_back(a, (1. - a) * b);
        weights[q]    = line.weight(q % line.size()) * line.weight(q / line.size()) * (1. - a);
        const auto at = powers(degree, points.back());
        values.col(q) = at[0];
        gradients[0].col(q) = at[1];
        gradients[1].col(q) = at[2];
      }
    const Eigen::MatrixXd             mass = values * weights.asDiagonal() * values.transpose();
    const Eigen::LLT<Eigen::MatrixXd> factors(mass);
    const auto orthonormal = [&](Eigen::MatrixXd &of) { factors.matrixL().solveInPlace(of); };
    orthonormal(values);
    orthonormal(gradients[0]);
    orthonormal(gradients[1]);
    for (unsigned int side = 0; side < 3; ++side)
      {
        Eigen::MatrixXd at(n, line.size()), legendre(line.size(), degree + 1);
        for (unsigned int q = 0; q < line.size(); ++q)
          {
            const double x              = line.point(q)[0];
            at.col(q)                   = powers(degree,
                               side == 0 ? Point<2>(1. - x, x) :
                                                 side == 1 ? Point<2>(x, 0.) :
                                                             Point<2>(0., x))[0];
            const std::vector<double> p = legendre_polynomials(degree + 1, x);
            for (unsigned int l = 0; l <= degree; ++l)
              legendre(q, l) = line.weight(q) * p[l];
          }
        orthonormal(at);
        on_sides[side] = (at * legendre).transpose();
      }
  }


  CompositeStress::CompositeStress(const Polynomials    &polynomials,
                                   const CellCorners<2> &corners,
                                   const FE_Q<2>        &fe,
                                   const double          ratio,
                                   const double          weight)
    : polynomials(polynomials)
    , ratio(ratio)
    , weight(weight)
  {
    place(corners, fe);
    if (!sound)
      return;
    const Eigen::MatrixXd G = constraints(corners), H = energy(ratio);
    const unsigned int    n_modes = polynomials.degree + 1, n_given = fe.degree + 1;
    // x = G^+ t + Z y, and y for which the rest is smallest.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse;
    inverse.setThreshold(1e-10);
    inverse.compute(G);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> columns;
    columns.setThreshold(1e-10);
    columns.compute(G.transpose());
    const Eigen::MatrixXd Q          = columns.householderQ();
    const Eigen::MatrixXd Z          = Q.rightCols(G.cols() - columns.rank());
    const Eigen::MatrixXd particular = inverse.pseudoInverse().leftCols(2 * n_sides * n_modes);
    by_loads                         = Z * (Z.transpose() * H * Z).llt().solve(Z.transpose());
    const Eigen::MatrixXd by_all     = particular - by_loads * (H * particular);
    Eigen::MatrixXd       unit       = Eigen::MatrixXd::Zero(G.rows(), by_all.cols());
    unit.topRows(by_all.cols()).setIdentity();
    sound = (G * by_all - unit).cwiseAbs().maxCoeff() < 1e-9 * (1. + by_all.cwiseAbs().maxCoeff());
    // Those of lower degree are given, others are 0. Columns: x of all sides, then y.
    by_tractions.resize(G.cols(), 2 * n_sides * n_given);
    for (unsigned int d = 0; d < 2; ++d)
      for (unsigned int f = 0; f < n_sides; ++f)
        by_tractions.middleCols((d * n_sides + f) * n_given, n_given) =
          by_all.middleCols((2 * f + d) * n_modes, n_given);
  }


  /** Make the triangles, and find their points in the cell. */
  void CompositeStress::place(const CellCorners<2> &corners, const FE_Q<2> &fe)
  {
    Point<2> middle;
    for (const Point<2> &corner : corners)
      middle += corner / double(corners.size());
    const unsigned int n_points = polynomials.points.size();
    weights.resize(n_sides * n_points);
    shape_gradients.fill(Eigen::MatrixXd(fe.n_dofs_per_cell(), weights.size()));
    for (unsigned int f = 0; f < n_sides; ++f)
      {
        Triangle &triangle = triangles[f];
        for (unsigned int j = 0; j < 2; ++j)
          triangle.map.col(j) = vector_of(Point<2>(corners[corner_of_side[f][j]] - middle));
        triangle.area2 = std::abs(triangle.map.determinant());
        // Of a cell without folds all turn the way of the square's ones.
        const bool turns_left = f == 1 || f == 2;
        sound = sound && (triangle.map.determinant() > 0.) == turns_left && triangle.area2 > 1e-8;
        if (!sound)
          return;
        const Eigen::Matrix2d back = triangle.map.inverse();
        triangle.by_x =
          back(0, 0) * polynomials.gradients[0] + back(1, 0) * polynomials.gradients[1];
        triangle.by_y =
          back(0, 1) * polynomials.gradients[0] + back(1, 1) * polynomials.gradients[1];
        for (unsigned int q = 0; q < n_points; ++q)
          {
            const unsigned int    k = f * n_points + q;
            const Eigen::Vector2d x = triangle.map * vector_of(polynomials.points[q]);
            const Point<2>        p = middle + Point<2>(x[0], x[1]);
            Point<2>              unit(0.5, 0.5);
            sound = sound && unit_point<2>(corners, p, unit);
            points.push_back(Point<2>(p - corners[0]));
            weights[k]          = triangle.area2 * polynomials.weights[q];
            Eigen::Matrix2d map = Eigen::Matrix2d::Zero();
            for (unsigned int v = 0; v < corners.size(); ++v)
              {
                const Tensor<1, 2> g = GeometryInfo<2>::d_linear_shape_function_gradient(unit, v);
                map += vector_of(corners[v]) * Eigen::RowVector2d(g[0], g[1]);
              }
            const Eigen::Matrix2d of_unit = map.inverse().transpose();
            for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i)
              {
                const Tensor<1, 2>    g     = fe.shape_grad(i, unit);
                const Eigen::Vector2d there = of_unit * Eigen::Vector2d(g[0], g[1]);
                for (unsigned int d = 0; d < 2; ++d)
                  shape_gradients[d](i, k) = there[d];
              }
          }
      }
  }


  Eigen::MatrixXd CompositeStress::energy(const double ratio) const
  {
    const unsigned int n      = polynomials.n;
    Eigen::MatrixXd    result = Eigen::MatrixXd::Zero(12 * n, 12 * n);
    for (unsigned int f = 0; f < n_sides; ++f)
      {
        const Triangle       &triangle = triangles[f];
        const Eigen::VectorXd w        = triangle.area2 * polynomials.weights;
        const auto            product  = [&w](const Eigen::MatrixXd &a, const Eigen::MatrixXd &b) {
          return Eigen::MatrixXd(a * w.asDiagonal() * b.transpose());
        };
        const Eigen::MatrixXd mass = product(polynomials.values, polynomials.values),
                              xx   = weight * product(triangle.by_x, triangle.by_x),
                              yy   = weight * product(triangle.by_y, triangle.by_y),
                              xy   = weight * product(triangle.by_x, triangle.by_y);
        auto block                 = result.block(3 * n * f, 3 * n * f, 3 * n, 3 * n);
        // div = (d_x xx + d_y xy, d_y yy + d_x xy)
        block.block(0, 0, n, n)         = (1. - ratio) * mass + xx;
        block.block(n, n, n, n)         = (1. - ratio) * mass + yy;
        block.block(2 * n, 2 * n, n, n) = 2. * mass + xx + yy;
        block.block(0, n, n, n)         = -ratio * mass;
        block.block(n, 0, n, n)         = -ratio * mass;
        block.block(0, 2 * n, n, n)     = xy;
        block.block(2 * n, 0, n, n)     = xy.transpose();
        block.block(n, 2 * n, n, n)     = xy.transpose();
        block.block(2 * n, n, n, n)     = xy;
      }
    return result;
  }


  void CompositeStress::add_traction(const unsigned int     triangle,
                                     const unsigned int     side,
                                     const Eigen::Vector2d &normal,
                                     const unsigned int     row,
                                     Eigen::MatrixXd       &rows) const
  {
    const Eigen::MatrixXd &modes = polynomials.on_sides[side];
    const unsigned int     n = polynomials.n, n_modes = modes.rows(), first = 3 * n * triangle;
    rows.block(row, first, n_modes, n) += normal[0] * modes;
    rows.block(row, first + 2 * n, n_modes, n) += normal[1] * modes;
    rows.block(row + n_modes, first + n, n_modes, n) += normal[1] * modes;
    rows.block(row + n_modes, first + 2 * n, n_modes, n) += normal[0] * modes;
  }


  /** First the tractions on the sides, then what must be 0 between triangles. */
  Eigen::MatrixXd CompositeStress::constraints(const CellCorners<2> &corners) const
  {
    const unsigned int n_modes = polynomials.degree + 1;
    Eigen::MatrixXd    rows    = Eigen::MatrixXd::Zero(4 * n_sides * n_modes, 12 * polynomials.n);
    for (unsigned int f = 0; f < n_sides; ++f)
      {
        const Eigen::Vector2d along =
          vector_of(corners[corner_of_side[f][1]]) - vector_of(corners[corner_of_side[f][0]]);
        Eigen::Vector2d normal(along[1], -along[0]); // as long as the side
        if (normal.dot(triangles[f].map.col(0)) < 0.)
          normal = -normal;
        add_traction(f, 0, normal, 2 * f * n_modes, rows);
      }
    for (unsigned int v = 0; v < corners.size(); ++v)
      {
        double sign = 1.;
        for (unsigned int f = 0; f < n_sides; ++f)
          for (unsigned int j = 0; j < 2; ++j)
            if (corner_of_side[f][j] == v)
              {
                const Eigen::Vector2d along = triangles[f].map.col(j);
                add_traction(f,
                             1 + j,
                             sign * Eigen::Vector2d(along[1], -along[0]),
                             2 * (n_sides + v) * n_modes,
                             rows);
                sign = -1.;
              }
      }
    return rows;
  }


  Eigen::VectorXd CompositeStress::numbers(const Eigen::MatrixXd &tractions,
                                           const Eigen::MatrixXd &stress,
                                           const Eigen::MatrixXd &force) const
  {
    const unsigned int n = polynomials.n, n_points = polynomials.points.size();
    Eigen::VectorXd    loads(12 * n);
    for (unsigned int f = 0; f < n_sides; ++f)
      {
        const Triangle       &triangle = triangles[f];
        const Eigen::VectorXd w        = triangle.area2 * polynomials.weights;
        const auto            sigma    = stress.middleCols(f * n_points, n_points);
        const auto            g        = force.middleCols(f * n_points, n_points);
        const Eigen::VectorXd trace    = ratio * (sigma.row(0) + sigma.row(1)).transpose();
        const Eigen::VectorXd x        = weight * w.cwiseProduct(g.row(0).transpose()),
                              y        = weight * w.cwiseProduct(g.row(1).transpose());
        loads.segment(3 * n * f, n) =
          polynomials.values * w.cwiseProduct(sigma.row(0).transpose() - trace) - triangle.by_x * x;
        loads.segment(3 * n * f + n, n) =
          polynomials.values * w.cwiseProduct(sigma.row(1).transpose() - trace) - triangle.by_y * y;
        loads.segment(3 * n * f + 2 * n, n) =
          2. * (polynomials.values * w.cwiseProduct(sigma.row(2).transpose())) - triangle.by_y * x -
          triangle.by_x * y;
      }
    return by_tractions * Eigen::Map<const Eigen::VectorXd>(tractions.data(), tractions.size()) +
           by_loads * loads;
  }


  Eigen::MatrixXd CompositeStress::stress(const Eigen::VectorXd &numbers) const
  {
    const unsigned int n = polynomials.n, n_points = polynomials.points.size();
    Eigen::MatrixXd    result(3, n_sides * n_points);
    for (unsigned int f = 0; f < n_sides; ++f)
      for (unsigned int c = 0; c < 3; ++c)
        result.block(c, f * n_points, 1, n_points) =
          numbers.segment((3 * f + c) * n, n).transpose() * polynomials.values;
    return result;
  }


  Eigen::MatrixXd CompositeStress::divergence(const Eigen::VectorXd &numbers) const
  {
    const unsigned int n = polynomials.n, n_points = polynomials.points.size();
    Eigen::MatrixXd    result(2, n_sides * n_points);
    for (unsigned int f = 0; f < n_sides; ++f)
      {
        const auto xx = numbers.segment(3 * f * n, n), yy = numbers.segment((3 * f + 1) * n, n),
                   xy = numbers.segment((3 * f + 2) * n, n);
        result.block(0, f * n_points, 1, n_points) =
          xx.transpose() * triangles[f].by_x + xy.transpose() * triangles[f].by_y;
        result.block(1, f * n_points, 1, n_points) =
          yy.transpose() * triangles[f].by_y + xy.transpose() * triangles[f].by_x;
      }
    return result;
  }
} // namespace PeriDeal
