// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "flux_cells.h"

#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  UnitPoints<dim>::UnitPoints(const FiniteElement<dim>      &fe,
                              const std::vector<Point<dim>> &points,
                              const std::vector<double>     &given_weights)
    : weights(Eigen::Map<const Eigen::VectorXd>(given_weights.data(), given_weights.size()))
    , hats(GeometryInfo<dim>::vertices_per_cell, points.size())
    , shapes(fe.n_dofs_per_cell(), points.size())
  {
    hat_gradients.fill(hats);
    shape_gradients.fill(shapes);
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        for (unsigned int v = 0; v < hats.rows(); ++v)
          {
            hats(v, q) = GeometryInfo<dim>::d_linear_shape_function(points[q], v);
            const Tensor<1, dim> gradient =
              GeometryInfo<dim>::d_linear_shape_function_gradient(points[q], v);
            for (unsigned int d = 0; d < dim; ++d)
              hat_gradients[d](v, q) = gradient[d];
          }
        for (unsigned int i = 0; i < shapes.rows(); ++i)
          {
            shapes(i, q)                  = fe.shape_value(i, points[q]);
            const Tensor<1, dim> gradient = fe.shape_grad(i, points[q]);
            for (unsigned int d = 0; d < dim; ++d)
              shape_gradients[d](i, q) = gradient[d];
          }
      }
  }


  template <int dim>
  UnitCell<dim>::UnitCell(const FiniteElement<dim> &fe)
    : basis(fe.degree)
    , lifting_element(fe.degree + 2)
    , quadrature(fe.degree + 3)
    , inside(fe, quadrature.get_points(), quadrature.get_weights())
    , lifting(lifting_element, quadrature.get_points(), quadrature.get_weights())
    , fluxes(basis.n, quadrature.size())
  {
    inside.products.resize(basis.n_divergence, quadrature.size());
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      {
        const Point<dim> &p = quadrature.point(q);
        fluxes.col(q)       = basis.values(p);
        inside.products.col(q) =
          legendre_products(basis.k + 1, std::vector<double>(p.begin_raw(), p.end_raw()));
      }
    for (unsigned int i = 0; i < basis.n; ++i)
      numbers_along[basis.direction[i]].push_back(i);
    for (unsigned int d = 0; d < dim; ++d)
      {
        along[d].resize(numbers_along[d].size(), quadrature.size());
        for (unsigned int i = 0; i < numbers_along[d].size(); ++i)
          along[d].row(i) = fluxes.row(numbers_along[d][i]);
      }
    const QGauss<1>    line(fe.degree + 3);
    const unsigned int n = dim == 1 ? 1 : dim == 2 ? line.size() : line.size() * line.size();
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        std::vector<Point<dim>> points(n);
        std::vector<double>     weights(n, 1.);
        Eigen::MatrixXd         products(basis.n_of_face, n);
        for (unsigned int q = 0; q < n; ++q)
          {
            std::vector<double> coordinates;
            unsigned int        rest = q;
            for (unsigned int d = 0; d < dim; ++d)
              if (d == f / 2)
                points[q][d] = f % 2;
              else
                {
                  points[q][d] = line.point(rest % line.size())[0];
                  weights[q] *= line.weight(rest % line.size());
                  rest /= line.size();
                  coordinates.push_back(points[q][d]);
                }
            products.col(q) = legendre_products(basis.k + 1, coordinates);
          }
        on_faces.emplace_back(fe, points, weights);
        on_faces.back().products = products;
      }
  }


  template <int dim>
  MappedPoints<dim>::MappedPoints(const UnitPoints<dim> &unit, const CellCorners<dim> &corners)
    : points(unit.hats.cols())
    , maps(points.size())
    , determinants(points.size())
  {
    Eigen::Matrix<double, dim, GeometryInfo<dim>::vertices_per_cell> x;
    for (unsigned int v = 0; v < corners.size(); ++v)
      for (unsigned int d = 0; d < dim; ++d)
        x(d, v) = corners[v][d];
    using Columns              = Eigen::Matrix<double, dim, Eigen::Dynamic>;
    const Columns            p = x * unit.hats;
    std::array<Columns, dim> gradients;
    for (unsigned int d = 0; d < dim; ++d)
      gradients[d] = x * unit.hat_gradients[d];
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        for (unsigned int d = 0; d < dim; ++d)
          {
            points[q][d]   = p(d, q);
            maps[q].col(d) = gradients[d].col(q);
          }
        determinants[q] = maps[q].determinant();
      }
  }


  template <int dim>
  double MappedPoints<dim>::area(const unsigned int q, const unsigned int face) const
  {
    return std::abs(determinants[q]) * maps[q].inverse().row(face / 2).norm();
  }


  template <int dim>
  CellField<dim>::CellField(const UnitCell<dim>    &unit,
                            const CellCorners<dim> &corners,
                            const FluxProblem<dim> &problem,
                            const Eigen::VectorXd  &u,
                            const bool              with_source)
    : at(unit.inside, corners)
    , conductivity(at.points.size())
    , source(at.points.size())
    , values(unit.inside.shapes.transpose() * u)
    , gradient(dim, at.points.size())
  {
    for (unsigned int d = 0; d < dim; ++d)
      gradient.row(d) = u.transpose() * unit.inside.shape_gradients[d];
    const auto &kappa    = problem.material->conductivity;
    const bool  constant = !with_source || problem.source.is_constant();
    source.setConstant(with_source && constant ? problem.source.value(Point<dim>(), problem.time) :
                                                 0.);
    conductivity.setConstant(kappa.is_constant() ? kappa.value(at.points[0]) : 1.);
    for (unsigned int q = 0; q < at.points.size(); ++q)
      {
        if (!kappa.is_constant())
          conductivity[q] = kappa.value(at.points[q]);
        if (!constant)
          source[q] = problem.source.value(at.points[q], problem.time);
      }
  }


  namespace
  {
    /** The map and its determinant at a point of the unit cell. */
    template <int dim>
    Eigen::Matrix<double, dim, dim> map_at(const CellCorners<dim> &corners, const Point<dim> &p)
    {
      Eigen::Matrix<double, dim, dim> map = Eigen::Matrix<double, dim, dim>::Zero();
      for (unsigned int v = 0; v < corners.size(); ++v)
        {
          const Tensor<1, dim> gradient = GeometryInfo<dim>::d_linear_shape_function_gradient(p, v);
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = 0; b < dim; ++b)
              map(a, b) += corners[v][a] * gradient[b];
        }
      return map;
    }


    /**
     * Bounds of the determinant, which is of second degree in each coordinate, from its
     * coefficients with Bernstein polynomials.
     */
    template <int dim>
    std::pair<double, double> range_of_determinant(const CellCorners<dim> &corners)
    {
      constexpr unsigned int n = dim == 1 ? 3 : dim == 2 ? 9 : 27;
      std::array<double, n>  values;
      for (unsigned int i = 0; i < n; ++i)
        {
          Point<dim>   p;
          unsigned int rest = i;
          for (unsigned int d = 0; d < dim; ++d)
            {
              p[d] = 0.5 * (rest % 3);
              rest /= 3;
            }
          values[i] = map_at<dim>(corners, p).determinant();
        }
      for (unsigned int d = 0, stride = 1; d < dim; ++d, stride *= 3)
        for (unsigned int i = 0; i < n; ++i)
          if (i / stride % 3 == 1)
            values[i] = 2. * values[i] - 0.5 * (values[i - stride] + values[i + stride]);
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      return {*least, *most};
    }
  } // namespace


  template <int dim>
  CellConstants<dim>::CellConstants(const CellCorners<dim> &corners)
  {
    const auto [least, most] = range_of_determinant<dim>(corners);
    double largest           = 0.; // of |F|^2, which is convex and so largest at a corner
    double diameter          = 0.;
    for (unsigned int v = 0; v < corners.size(); ++v)
      {
        const auto map = map_at<dim>(corners, GeometryInfo<dim>::unit_cell_vertex(v));
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>> squares(
          map.transpose() * map,
          Eigen::EigenvaluesOnly);
        largest = std::max(largest, squares.eigenvalues()[dim - 1]);
        for (unsigned int w = 0; w < v; ++w)
          diameter = std::max(diameter, corners[v].distance(corners[w]));
      }
    least_volume = least;
    stretch      = least > 0. ? largest / least : std::numeric_limits<double>::infinity();
    // On the unit cell the constant is 1/pi; in a convex one that of Payne and Weinberger (1960).
    poincare = std::sqrt(most * stretch) / numbers::PI;
    if (dim < 3 && least > 0.)
      poincare = std::min(poincare, diameter / numbers::PI);
  }


  template <int dim>
  double CellConstants<dim>::trace(const CellCorners<dim> &corners, const unsigned int face) const
  {
    // On the unit cell v(0)^2 <= |v|^2 + 2 |v| |v'| along each line, and |v| <= |grad v|/pi.
    double area = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      if (d != face / 2)
        {
          double edge = 0.;
          for (unsigned int v = 0; v < corners.size(); ++v)
            if (((v >> face / 2) & 1) == face % 2 && ((v >> d) & 1) == 0)
              edge = std::max(edge, corners[v].distance(corners[v | (1u << d)]));
          area *= edge;
        }
    return std::sqrt(area * stretch * (1. / numbers::PI + 2.) / numbers::PI);
  }


  namespace
  {
    /** Positions and moments of a cell of size 1. */
    template <int dim>
    void add_places(const UnitCell<dim>    &unit,
                    const CellCorners<dim> &corners,
                    CondensedCell          &condensed)
    {
      Point<dim> middle;
      for (const Point<dim> &corner : corners)
        middle += corner / double(corners.size());
      const auto coordinates = [&](const MappedPoints<dim> &at) {
        Eigen::MatrixXd x(at.points.size(), dim);
        for (unsigned int q = 0; q < at.points.size(); ++q)
          for (unsigned int d = 0; d < dim; ++d)
            x(q, d) = at.points[q][d] - middle[d];
        return x;
      };
      const auto of = [&](const UnitPoints<dim> &points) {
        return Eigen::MatrixXd((points.products * points.weights.asDiagonal() *
                                coordinates(MappedPoints<dim>(points, corners)))
                                 .transpose());
      };
      condensed.positions = of(unit.inside);
      condensed.moments.resize(dim, unit.basis.n_of_faces);
      for (unsigned int f = 0; f < unit.on_faces.size(); ++f)
        condensed.moments.middleCols(f * unit.basis.n_of_face, unit.basis.n_of_face) =
          of(unit.on_faces[f]);
    }
  } // namespace


  template <int dim>
  std::pair<std::shared_ptr<const CondensedCell>, double> CondensedCells<dim>::of(
    const CellCorners<dim> &corners)
  {
    constexpr double       per_size = 1e7;
    constexpr unsigned int most     = 500;
    double                 size     = 0.;
    for (const Point<dim> &corner : corners)
      size = std::max(size, corner.distance(corners[0]));
    CellCorners<dim>  unit_size;
    std::vector<long> key;
    for (unsigned int v = 0; v < corners.size(); ++v)
      {
        unit_size[v] = Point<dim>((corners[v] - corners[0]) / size);
        for (unsigned int d = 0; d < dim; ++d)
          key.push_back(std::lround(per_size * unit_size[v][d]));
      }
    const double factor = std::pow(size, 2. - dim);
    const auto   found  = known.find(key);
    if (found != known.end())
      return {found->second, factor};
    const MappedPoints<dim> at(unit.inside, unit_size);
    const unsigned int      n = unit.basis.n, n_points = at.points.size();
    Eigen::MatrixXd         mass = Eigen::MatrixXd::Zero(n, n);
    const auto             &with = unit.numbers_along;
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int e = 0; e <= d; ++e)
        {
          Eigen::VectorXd metric(n_points);
          for (unsigned int q = 0; q < n_points; ++q)
            metric[q] = unit.inside.weights[q] * at.maps[q].col(d).dot(at.maps[q].col(e)) /
                        at.determinants[q];
          if (metric.cwiseAbs().maxCoeff() < 1e-14)
            continue;
          const Eigen::MatrixXd block =
            unit.along[d] * metric.asDiagonal() * unit.along[e].transpose();
          for (unsigned int i = 0; i < with[d].size(); ++i)
            for (unsigned int j = 0; j < with[e].size(); ++j)
              {
                mass(with[d][i], with[e][j]) = block(i, j);
                mass(with[e][j], with[d][i]) = block(i, j);
              }
        }
    auto condensed = std::make_shared<CondensedCell>(unit.basis, mass);
    add_places(unit, unit_size, *condensed);
    if (known.size() < most)
      {
        condensed->id = known.size();
        known.emplace(key, condensed);
      }
    return {condensed, factor};
  }


  namespace
  {
    /** Which corner, middle of an edge or of all of a face a point is, in halves of the face. */
    template <int dim, typename Cell>
    std::array<int, 2> halves_on_face(const Cell        &cell,
                                      const unsigned int face,
                                      const Point<dim>  &p)
    {
      std::array<int, 2> best{};
      double             nearest = std::numeric_limits<double>::max();
      for (int i = 0; i < (dim == 3 ? 9 : 3); ++i)
        {
          const std::array<int, 2> at{i % 3, i / 3};
          Point<dim>               there;
          for (unsigned int c = 0; c < GeometryInfo<dim>::vertices_per_cell / 2; ++c)
            {
              double weight = 1.;
              for (unsigned int a = 0; a < dim - 1; ++a)
                weight *= (c >> a) & 1 ? 0.5 * at[a] : 1. - 0.5 * at[a];
              there += weight * cell->vertex(corner_of_face<dim>(face, c));
            }
          if (there.distance(p) < nearest)
            {
              nearest = there.distance(p);
              best    = at;
            }
        }
      return best;
    }
  } // namespace


  template <int dim>
  FacePlace place_of_face(const typename DoFHandler<dim>::active_cell_iterator &cell,
                          const unsigned int                                    face)
  {
    constexpr unsigned int                  n      = GeometryInfo<dim>::vertices_per_cell / 2;
    typename DoFHandler<dim>::cell_iterator larger = cell;
    unsigned int                            face_of_larger = face;
    FacePlace                               place;
    place.state = cell->at_boundary(face) ? FacePlace::given : FacePlace::shared;
    if constexpr (dim > 1)
      if (!cell->at_boundary(face) && cell->neighbor_is_coarser(face))
        {
          larger         = cell->neighbor(face);
          face_of_larger = cell->neighbor_of_coarser_neighbor(face).first;
        }
    std::array<types::global_dof_index, n> vertices;
    for (unsigned int j = 0; j < n; ++j)
      vertices[j] = larger->vertex_dof_index(corner_of_face<dim>(face_of_larger, j), 0);
    const unsigned int lowest =
      std::min_element(vertices.begin(), vertices.end()) - vertices.begin();
    const bool swapped = n == 4 && vertices[lowest ^ (n / 4)] > vertices[lowest ^ (n / 2)];
    // Of a place on the larger face, in halves of it.
    const auto ordered = [&](std::array<int, 2> at) {
      for (unsigned int a = 0; a < dim - 1; ++a)
        if ((lowest >> a) & 1)
          at[a] = 2 - at[a];
      if (swapped)
        std::swap(at[0], at[1]);
      return at;
    };
    const auto of_corner = [&](const unsigned int j) {
      if (larger == typename DoFHandler<dim>::cell_iterator(cell))
        return ordered({2 * static_cast<int>(j & 1), 2 * static_cast<int>(j >> 1)});
      return ordered(
        halves_on_face<dim>(larger, face_of_larger, cell->vertex(corner_of_face<dim>(face, j))));
    };
    place.origin = of_corner(0);
    for (unsigned int a = 0; a < dim - 1; ++a)
      {
        const std::array<int, 2> end = of_corner(1u << a);
        for (unsigned int c = 0; c < dim - 1; ++c)
          place.steps[2 * a + c] = end[c] - place.origin[c];
      }
    std::sort(vertices.begin(), vertices.end());
    place.key.fill(numbers::invalid_dof_index);
    std::copy(vertices.begin(), vertices.end(), place.key.begin());
    return place;
  }


  template <int dim>
  HatLoads<dim>::HatLoads(const UnitCell<dim> &unit, const CellField<dim> &field)
    : HatLoads(unit, field.at, field.source, field.gradient * field.conductivity.asDiagonal())
  {}


  template <int dim>
  HatLoads<dim>::HatLoads(const UnitCell<dim>     &unit,
                          const MappedPoints<dim> &at,
                          const Eigen::VectorXd   &source,
                          const Eigen::MatrixXd   &covariant)
    : divergence(unit.basis.n_divergence, GeometryInfo<dim>::vertices_per_cell)
    , loads(unit.basis.n, GeometryInfo<dim>::vertices_per_cell)
  {
    const unsigned int n_points = source.size();
    const auto        &inside   = unit.inside;
    Eigen::MatrixXd    flux(dim, n_points); // J F^{-1} F^{-T} of it
    for (unsigned int q = 0; q < n_points; ++q)
      {
        const Eigen::Matrix<double, dim, dim> back = at.maps[q].inverse();
        flux.col(q) = at.determinants[q] * (back * (back.transpose() * covariant.col(q)));
      }
    const Eigen::VectorXd weighted =
      inside.weights.cwiseProduct(at.determinants).cwiseProduct(source);
    Eigen::MatrixXd of_hats = weighted.asDiagonal() * inside.hats.transpose();
    for (unsigned int d = 0; d < dim; ++d)
      of_hats -= inside.weights.cwiseProduct(flux.row(d).transpose()).asDiagonal() *
                 inside.hat_gradients[d].transpose();
    divergence = inside.products * of_hats;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const Eigen::MatrixXd of_row =
          inside.weights.cwiseProduct(covariant.row(d).transpose()).asDiagonal() *
          inside.hats.transpose();
        const Eigen::MatrixXd along = unit.along[d] * of_row;
        for (unsigned int i = 0; i < along.rows(); ++i)
          loads.row(unit.numbers_along[d][i]) = -along.row(i);
      }
  }


#define INSTANTIATE(dim)                                                                        \
  template struct UnitPoints<dim>;                                                              \
  template struct UnitCell<dim>;                                                                \
  template struct MappedPoints<dim>;                                                            \
  template struct CellField<dim>;                                                               \
  template struct CellConstants<dim>;                                                           \
  template class CondensedCells<dim>;                                                           \
  template struct HatLoads<dim>;                                                                \
  template FacePlace place_of_face<dim>(const typename DoFHandler<dim>::active_cell_iterator &, \
                                        const unsigned int);
  PERIDEAL_FOR_EACH_DIM(INSTANTIATE)
#undef INSTANTIATE
} // namespace PeriDeal
