// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "equilibrated_stress.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  SolidCell<dim>::SolidCell(const UnitCell<dim>      &unit,
                            const CellCorners<dim>   &corners,
                            const StressProblem<dim> &problem,
                            const Eigen::MatrixXd    &u)
    : at(unit.inside, corners)
    , force(at.points.size(), dim)
    , least(std::numeric_limits<double>::max())
  {
    std::array<Eigen::MatrixXd, dim> slopes; // along coordinates of the unit cell
    for (unsigned int d = 0; d < dim; ++d)
      slopes[d] = u.transpose() * unit.inside.shape_gradients[d];
    for (unsigned int q = 0; q < at.points.size(); ++q)
      {
        Matrix slope;
        for (unsigned int d = 0; d < dim; ++d)
          slope.col(d) = slopes[d].col(q);
        gradients.push_back(slope * at.maps[q].inverse());
        laws.push_back(problem.law(at.points[q]));
        stresses.push_back(laws[q].stress(gradients[q]));
        least = std::min(least, laws[q].least());
        for (unsigned int d = 0; d < dim; ++d)
          force(q, d) = problem.force(d, at.points[q]);
      }
  }


  double korn_constant(const CellCorners<2> &corners)
  {
    Point<2> middle;
    for (const Point<2> &corner : corners)
      middle += corner / double(corners.size());
    double outer = 0., inner = std::numeric_limits<double>::max();
    for (const Point<2> &corner : corners)
      outer = std::max(outer, corner.distance(middle));
    for (unsigned int f = 0; f < 4; ++f)
      {
        const Point<2> &a = corners[corner_of_face<2>(f, 0)], &b = corners[corner_of_face<2>(f, 1)];
        const Tensor<1, 2> along = b - a, to = middle - a;
        // The side turns left about the middle of a cell without folds, or right.
        const double turn = (f == 1 || f == 2 ? 1. : -1.) * (along[0] * to[1] - along[1] * to[0]);
        inner             = std::min(inner, turn / along.norm());
      }
    if (!(inner > 0.))
      return std::numeric_limits<double>::infinity();
    const double s = inner / outer;
    return 4. / (s * s) * (1. + std::sqrt(1. - s * s));
  }


  EquilibratedStress::EquilibratedStress(FluxMesh<2>            &mesh,
                                         const StressProblem<2> &problem,
                                         const Vector           &u)
    : mesh(mesh)
    , problem(problem)
    , u(u)
    , sums(mesh.dofs().get_triangulation().n_active_cells())
    , polynomials(mesh.unit.basis.k + 1)
  {
    VertexPatches<2> patches(mesh, 2);
    patches.solve([this](const Cell &cell) { return shares(cell); });
    finish(patches);
  }


  namespace
  {
    Eigen::MatrixXd numbers_of(const FluxMesh<2>       &mesh,
                               const FluxMesh<2>::Cell &cell,
                               const Vector            &u)
    {
      Eigen::MatrixXd numbers(mesh.dofs().get_fe().n_dofs_per_cell(), 2);
      for (unsigned int d = 0; d < 2; ++d)
        numbers.col(d) = mesh.numbers(cell, u, d, 2);
      return numbers;
    }


    /** As that of CondensedCells. */
    double size_of(const CellCorners<2> &corners)
    {
      double size = 0.;
      for (const Point<2> &corner : corners)
        size = std::max(size, corner.distance(corners[0]));
      return size;
    }
  } // namespace


  /** Of fluxes of momentum, -sigma. */
  VertexShares<2> EquilibratedStress::shares(const Cell &cell)
  {
    VertexShares<2> result;
    result.corners = corners_of<2>(cell);
    const SolidCell<2> in_cell(mesh.unit, result.corners, problem, numbers_of(mesh, cell, u));
    const auto [condensed, factor] = mesh.condensed.of(result.corners);
    const unsigned int     n = mesh.unit.basis.n_of_faces, n_hats = result.corners.size();
    const Eigen::MatrixXd &x = condensed->positions;
    result.loads             = Eigen::MatrixXd::Zero(2 * n, n_hats);
    result.given             = result.loads;
    result.means             = Eigen::MatrixXd::Zero(3, n_hats);
    for (unsigned int d = 0; d < 2; ++d)
      {
        Eigen::MatrixXd covariant(2, in_cell.laws.size());
        for (unsigned int q = 0; q < in_cell.laws.size(); ++q)
          covariant.col(q) =
            in_cell.at.maps[q].transpose() * in_cell.stresses[q].row(d).transpose();
        const HatLoads<2> hats(mesh.unit, in_cell.at, in_cell.force.col(d), covariant);
        result.loads.middleRows(d * n, n) =
          condensed->by_faces.transpose() * (hats.loads / factor) -
          condensed->mixed * hats.divergence;
        result.means.row(d) = hats.divergence.row(0);
        if (d == 0)
          result.means.row(2) += x.row(1) * hats.divergence;
        else
          result.means.row(2) -= x.row(0) * hats.divergence;
      }
    const std::vector<FacePlace> places = mesh.places(cell);
    for (unsigned int d = 0; d < 2; ++d)
      result.faces.insert(result.faces.end(), places.begin(), places.end());
    Sums &of_cell   = sums[cell->active_cell_index()];
    of_cell.balance = result.means.rowwise().sum();
    add_faces(cell, in_cell, result.corners, result);
    result.factor    = factor / in_cell.laws[0].shear;
    result.condensed = condensed;
    return result;
  }


  /** The tractions on the boundary that are given, and what projection leaves of them. */
  void EquilibratedStress::add_faces(const Cell           &cell,
                                     const SolidCell<2>   &in_cell,
                                     const CellCorners<2> &corners,
                                     VertexShares<2>      &shares)
  {
    if (!cell->at_boundary())
      return;
    const unsigned int     n = mesh.unit.basis.n_of_face, n_faces = mesh.unit.on_faces.size();
    const CellConstants<2> constants(corners);
    for (const unsigned int f : cell->face_indices())
      if (cell->at_boundary(f))
        {
          const UnitPoints<2>  &unit = mesh.unit.on_faces[f];
          const MappedPoints<2> at(unit, corners);
          const auto            side = cell->face(f)->boundary_id();
          const double          rim  = mesh.rim(cell->face(f));
          double                rest = 0.;
          if (problem.traction_ends(side, at))
            no_bound = "Tractions end within a face.";
          for (unsigned int d = 0; d < 2; ++d)
            {
              if (has_value(problem.displacement(d), side, at))
                {
                  shares.faces[d * n_faces + f].state = FacePlace::open;
                  continue;
                }
              Eigen::VectorXd density(at.points.size()), area(at.points.size());
              for (unsigned int q = 0; q < density.size(); ++q)
                {
                  area[q]    = at.area(q, f);
                  density[q] = rim * area[q] * problem.traction(d, side, at.points[q]);
                }
              const FaceLoad load                               = face_load(unit, density, area);
              shares.given.middleRows((d * n_faces + f) * n, n) = load.hats;
              rest += load.rest;
            }
          if (rest > 0.)
            sums[cell->active_cell_index()].of_sides +=
              constants.trace(corners, f) *
              std::sqrt(korn_constant(corners) * rest / in_cell.least);
        }
  }


  void EquilibratedStress::finish(const VertexPatches<2> &patches)
  {
    for (const Cell &cell : mesh.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          Sums &of_cell                = sums[cell->active_cell_index()];
          of_cell.outward              = patches.outward(cell);
          const auto         condensed = mesh.condensed.of(corners_of<2>(cell)).first;
          const unsigned int n = mesh.unit.basis.n_of_face, n_faces = mesh.unit.on_faces.size();
          Eigen::VectorXd    rest = -of_cell.balance;
          for (unsigned int d = 0; d < 2; ++d)
            for (unsigned int f = 0; f < n_faces; ++f)
              rest += PatchSolver::balances(*condensed, d, f, n, 2) *
                      of_cell.outward.segment((d * n_faces + f) * n, n);
          left += std::hypot(rest[0], rest[1]) + 4. * std::abs(rest[2]);
        }
    left = Utilities::MPI::sum(left, mesh.dofs().get_communicator());
  }


  std::shared_ptr<const CompositeStress> EquilibratedStress::composite(
    const CellCorners<2> &corners,
    const double          size,
    const double          ratio) const
  {
    constexpr double       steps = 64.;
    constexpr unsigned int most  = 200;
    const auto             key =
      std::make_pair(mesh.condensed.of(corners).first->id, std::lround(steps * ratio));
    if (const auto found = known.find(key); key.first >= 0 && found != known.end())
      return found->second;
    CellCorners<2> unit_size;
    for (unsigned int v = 0; v < corners.size(); ++v)
      unit_size[v] = Point<2>((corners[v] - corners[0]) / size);
    const double poincare = CellConstants<2>(unit_size).poincare;
    // Any numbers give stresses in balance; these serve many cells. What f has beside the
    // divergence counts by its root, and is of higher order.
    constexpr double more   = 4.;
    const double     weight = more * poincare * poincare * korn_constant(unit_size);
    const auto       result = std::make_shared<const CompositeStress>(polynomials,
                                                                unit_size,
                                                                FE_Q<2>(mesh.unit.basis.k),
                                                                key.second / steps,
                                                                weight);
    if (key.first >= 0 && known.size() < most)
      known.emplace(key, result);
    return result;
  }


  StressPart EquilibratedStress::part(const Cell &cell) const
  {
    const CellCorners<2>   corners = corners_of<2>(cell);
    const Sums            &of_cell = sums[cell->active_cell_index()];
    const double           size    = size_of(corners);
    const CellConstants<2> constants(corners);
    const double           korn = korn_constant(corners);
    const HookeAt<2>       first =
      problem.law(Point<2>(0.25 * (corners[0] + corners[1] + corners[2] + corners[3])));
    if (!(korn < std::numeric_limits<double>::infinity()))
      {
        no_bound = "A cell is not star-shaped about its middle.";
        return {};
      }
    const auto triangles = composite(corners, size, first.ratio());
    if (!triangles->is_sound())
      {
        no_bound = "A cell is too distorted.";
        return {};
      }
    const Eigen::MatrixXd numbers = numbers_of(mesh, cell, u).transpose() / size;
    const Eigen::MatrixXd by_x    = numbers * triangles->shape_gradients[0],
                          by_y    = numbers * triangles->shape_gradients[1];
    const unsigned int      n     = triangles->points.size();
    std::vector<HookeAt<2>> laws(problem.is_uniform() ? 1 : n, first);
    Eigen::MatrixXd         sigma(3, n), force(2, n);
    double                  least = first.least();
    for (unsigned int q = 0; q < n; ++q)
      {
        const Point<2> p = corners[0] + size * Tensor<1, 2>(triangles->points[q]);
        if (!problem.is_uniform())
          laws[q] = problem.law(p);
        const HookeAt<2> &law = laws[problem.is_uniform() ? 0 : q];
        Eigen::Matrix2d   gradient;
        gradient << by_x.col(q), by_y.col(q);
        const Eigen::Matrix2d stress = law.stress(gradient);
        sigma.col(q) << stress(0, 0), stress(1, 1), stress(0, 1);
        least = std::min(least, law.least());
        for (unsigned int d = 0; d < 2; ++d)
          force(d, q) = q > 0 && problem.has_constant_force() ? force(d, 0) :
                                                                size * problem.force(d, p);
      }
    const unsigned int    n_of_faces = mesh.unit.basis.n_of_faces;
    const Eigen::MatrixXd tractions =
      -Eigen::Map<const Eigen::MatrixXd>(of_cell.outward.data(), n_of_faces, 2) / size;
    const Eigen::VectorXd found  = triangles->numbers(tractions, sigma, force);
    const Eigen::MatrixXd more   = triangles->stress(found) - sigma;
    const Eigen::MatrixXd rest   = triangles->divergence(found) + force;
    double                square = 0., of_force = 0.;
    for (unsigned int q = 0; q < n; ++q)
      {
        Eigen::Matrix2d stress;
        stress << more(0, q), more(2, q), more(2, q), more(1, q);
        const double w = size * size * triangles->weights[q];
        square += w * laws[problem.is_uniform() ? 0 : q].complementary(stress);
        of_force += w * rest.col(q).squaredNorm() / (size * size);
      }
    StressPart result;
    result.stress = std::sqrt(square);
    result.all =
      result.stress + of_cell.of_sides + constants.poincare * std::sqrt(korn * of_force / least);
    return result;
  }


  template struct SolidCell<2>;
} // namespace PeriDeal
