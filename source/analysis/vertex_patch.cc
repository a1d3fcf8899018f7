// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "vertex_patch.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <tuple>

namespace PeriDeal
{
  using namespace dealii;

  double FacePlace::share(const unsigned int n_coordinates) const
  {
    double product = 1.;
    for (unsigned int a = 0; a < n_coordinates; ++a)
      product *= 0.5 * (std::abs(steps[2 * a]) + std::abs(steps[2 * a + 1]));
    return product;
  }


  namespace
  {
    /** Steps of factors between neighbours that count as the same. */
    constexpr double factor_steps = 64.;

    /** Numbers in factorizations that are kept. */
    constexpr std::size_t most_kept = 10000000;


    /** The place of a face in the coordinates of the whole face of another cell. */
    std::array<int, 6> place_on(const FacePlace   &face,
                                const FacePlace   &other,
                                const unsigned int n_coordinates)
    {
      std::array<int, 6> place{};
      for (unsigned int a = 0; a < n_coordinates; ++a)
        for (unsigned int c = 0; c < n_coordinates; ++c)
          if (const int step = other.steps[2 * a + c]; step != 0)
            {
              place[a] = 2 * (face.origin[c] - other.origin[c]) / step;
              for (unsigned int b = 0; b < n_coordinates; ++b)
                place[2 + 2 * b + a] = 2 * face.steps[2 * b + c] / step;
            }
      return place;
    }


    bool is_whole_face(const std::array<int, 6> &place, const unsigned int n_coordinates)
    {
      for (unsigned int a = 0; a < n_coordinates; ++a)
        if (place[a] != 0 || place[2 + 3 * a] != 2)
          return false;
      return true;
    }


    /**
     * What no fluxes can do: columns are such combinations of the balances whose rows these are.
     */
    Eigen::MatrixXd combinations_without_flux(const Eigen::MatrixXd &balances)
    {
      constexpr double      negligible = 1e-12;
      const Eigen::VectorXd norms      = balances.rowwise().norm();
      const double          largest    = norms.size() > 0 ? norms.maxCoeff() : 0.;
      Eigen::VectorXd       scales(norms.size());
      for (unsigned int i = 0; i < norms.size(); ++i)
        scales[i] = norms[i] > 1e-9 * largest ? 1. / norms[i] : 1.;
      const Eigen::MatrixXd                                scaled = scales.asDiagonal() * balances;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(scaled * scaled.transpose());
      unsigned int                                         n = 0;
      while (n < norms.size() && squares.eigenvalues()[n] < negligible)
        ++n;
      return scales.asDiagonal() * squares.eigenvectors().leftCols(n);
    }


    /** Faces of cells around a vertex that are one. */
    struct OneFace
    {
      std::vector<std::pair<unsigned int, unsigned int>> members; // cell, face
      double                                             share = 0.;
    };
  } // namespace


  PatchSolver::PatchSolver(const unsigned int n_coordinates,
                           const unsigned int k,
                           const unsigned int n_components)
    : n_coordinates(n_coordinates)
    , k(k)
    , n_components(n_components)
    , n_of_face(n_coordinates == 0 ? 1 :
                n_coordinates == 1 ? k + 1 :
                                     (k + 1) * (k + 1))
    , n_of_faces(2 * (n_coordinates + 1) * n_of_face)
    , n_balances(n_components + n_components * (n_components - 1) / 2)
  {}


  Eigen::MatrixXd PatchSolver::balances(const CondensedCell &cell,
                                        const unsigned int   component,
                                        const unsigned int   face,
                                        const unsigned int   n_of_face,
                                        const unsigned int   n_components)
  {
    Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(n_components + n_components * (n_components - 1) / 2, n_of_face);
    result(component, 0) = 1.;
    unsigned int row     = n_components;
    for (unsigned int i = 0; i < n_components; ++i)
      for (unsigned int j = i + 1; j < n_components; ++j, ++row)
        if (component == i)
          result.row(row) = cell.moments.row(j).segment(face * n_of_face, n_of_face);
        else if (component == j)
          result.row(row) = -cell.moments.row(i).segment(face * n_of_face, n_of_face);
    return result;
  }


  const Eigen::MatrixXd *PatchSolver::transformation(const std::array<int, 6> &place)
  {
    if (is_whole_face(place, n_coordinates))
      return nullptr;
    const auto [entry, is_new] = transformations.try_emplace(place);
    if (is_new)
      {
        const QGauss<1>    line(k + 1);
        const unsigned int n    = line.size();
        double             area = 1.;
        for (unsigned int a = 0; a < n_coordinates; ++a)
          area *= 0.5 * (std::abs(place[2 + 2 * a]) + std::abs(place[3 + 2 * a]));
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n_of_face, n_of_face);
        for (unsigned int q = 0; q < (n_coordinates == 2 ? n * n : n); ++q)
          {
            std::vector<double> own(n_coordinates), other(n_coordinates);
            double              weight = area;
            for (unsigned int a = 0; a < n_coordinates; ++a)
              {
                const unsigned int i = a == 0 ? q % n : q / n;
                own[a]               = line.point(i)[0];
                weight *= line.weight(i);
              }
            for (unsigned int c = 0; c < n_coordinates; ++c)
              {
                other[c] = 0.5 * place[c];
                for (unsigned int a = 0; a < n_coordinates; ++a)
                  other[c] += 0.5 * place[2 + 2 * a + c] * own[a];
              }
            matrix +=
              weight * legendre_products(k + 1, own) * legendre_products(k + 1, other).transpose();
          }
        entry->second = matrix;
      }
    return &entry->second;
  }


  std::vector<PatchSolver::Part> PatchSolver::parts_of(const std::vector<PatchCell> &cells,
                                                       unsigned int                 &n_unknown)
  {
    std::vector<OneFace>                                                                 faces;
    std::vector<std::pair<unsigned int, std::array<dealii::types::global_dof_index, 4>>> keys;
    const unsigned int n_faces = n_of_faces / n_of_face;
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int f = 0; f < cells[c].faces.size(); ++f)
        {
          const FacePlace &face = cells[c].faces[f];
          if (face.state == FacePlace::given)
            continue;
          const bool  shared = face.state == FacePlace::shared;
          const auto  key    = std::make_pair(f / n_faces, face.key);
          std::size_t one    = faces.size();
          if (shared)
            one = std::find(keys.begin(), keys.end(), key) - keys.begin();
          if (one == faces.size())
            {
              faces.emplace_back();
              keys.push_back(key);
              if (!shared)
                keys.back().second.fill(numbers::invalid_dof_index);
            }
          const double share = face.share(n_coordinates);
          // The larger one comes first.
          if (share > 0.9 && !faces[one].members.empty() &&
              cells[faces[one].members[0].first].faces[faces[one].members[0].second].share(
                n_coordinates) < 0.9)
            faces[one].members.insert(faces[one].members.begin(), {c, f});
          else
            faces[one].members.emplace_back(c, f);
          faces[one].share += shared ? share : 2.;
        }
    std::vector<Part> parts;
    n_unknown = 0;
    for (const OneFace &face : faces)
      if (face.share > 1.99)
        {
          const auto &[first_cell, first_face] = face.members[0];
          for (unsigned int m = 0; m < face.members.size(); ++m)
            {
              const auto &[c, f] = face.members[m];
              Part part{c, f, n_unknown, m == 0 ? 1. : -1., {}, nullptr};
              part.place =
                place_on(cells[c].faces[f], cells[first_cell].faces[first_face], n_coordinates);
              part.transformation = m == 0 ? nullptr : transformation(part.place);
              parts.push_back(part);
            }
          ++n_unknown;
        }
    return parts;
  }


  Eigen::MatrixXd PatchSolver::matrix(const std::vector<PatchCell> &cells,
                                      const std::vector<double>    &factors,
                                      const std::vector<Part>      &parts,
                                      const unsigned int            n_unknown) const
  {
    const unsigned int n_fluxes = n_unknown * n_of_face, n_cells = cells.size();
    const unsigned int n_faces = n_of_faces / n_of_face;
    Eigen::MatrixXd    energy  = Eigen::MatrixXd::Zero(n_fluxes, n_fluxes);
    Eigen::MatrixXd    balance = Eigen::MatrixXd::Zero(n_cells * n_balances, n_fluxes);
    for (const Part &a : parts)
      {
        const unsigned int   component = a.face / n_faces, face = a.face % n_faces;
        const CondensedCell &of_cell = *cells[a.cell].condensed;
        for (const Part &b : parts)
          if (a.cell == b.cell && component == b.face / n_faces)
            {
              Eigen::MatrixXd block = (a.sign * b.sign * factors[a.cell]) *
                                      of_cell.stiffness.block(face * n_of_face,
                                                              (b.face % n_faces) * n_of_face,
                                                              n_of_face,
                                                              n_of_face);
              if (a.transformation != nullptr)
                block = a.transformation->transpose() * block;
              if (b.transformation != nullptr)
                block = block * *b.transformation;
              energy.block(a.unknown * n_of_face, b.unknown * n_of_face, n_of_face, n_of_face) +=
                block;
            }
        Eigen::MatrixXd rows = a.sign * balances(of_cell, component, face, n_of_face, n_components);
        if (a.transformation != nullptr)
          rows = rows * *a.transformation;
        balance.block(a.cell * n_balances, a.unknown * n_of_face, n_balances, n_of_face) += rows;
      }
    const Eigen::MatrixXd without = combinations_without_flux(balance);
    const unsigned int    n       = n_fluxes + balance.rows();
    Eigen::MatrixXd       matrix  = Eigen::MatrixXd::Zero(n + without.cols(), n + without.cols());
    matrix.topLeftCorner(n_fluxes, n_fluxes)                  = energy;
    matrix.block(n_fluxes, 0, balance.rows(), n_fluxes)       = balance;
    matrix.block(0, n_fluxes, n_fluxes, balance.rows())       = balance.transpose();
    matrix.block(n_fluxes, n, balance.rows(), without.cols()) = without;
    matrix.block(n, n_fluxes, without.cols(), balance.rows()) = without.transpose();
    return matrix;
  }


  std::shared_ptr<const PatchSolver::LU> PatchSolver::factorization(
    const std::vector<PatchCell> &cells,
    const std::vector<double>    &factors,
    const std::vector<Part>      &parts,
    const unsigned int            n_unknown)
  {
    Key  key;
    bool keeps = n_kept < most_kept;
    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        keeps = keeps && cells[c].condensed->id >= 0;
        key.push_back(cells[c].condensed->id);
        key.push_back(std::lround(factor_steps * std::log2(factors[c])));
      }
    for (const Part &part : parts)
      {
        std::int64_t code = part.sign > 0. ? 0 : 1;
        for (const int place : part.place)
          code = 8 * code + place + 3;
        key.push_back(part.cell + 256 * (part.face + 32 * part.unknown));
        key.push_back(code);
      }
    const auto found = known.find(key);
    if (found != known.end())
      return found->second;
    auto lu = std::make_shared<const LU>(matrix(cells, factors, parts, n_unknown));
    if (keeps)
      {
        n_kept += lu->matrixLU().size();
        known.emplace(key, lu);
      }
    return lu;
  }


  std::vector<Eigen::VectorXd> PatchSolver::solve(std::vector<PatchCell> &cells)
  {
    std::sort(cells.begin(), cells.end(), [](const PatchCell &a, const PatchCell &b) {
      return std::tie(a.corner, a.owner, a.cell) < std::tie(b.corner, b.owner, b.cell);
    });
    unsigned int            n_unknown = 0;
    const std::vector<Part> parts     = parts_of(cells, n_unknown);
    // Any factors give fluxes in balance; these serve many vertices.
    std::vector<double> factors;
    for (const PatchCell &cell : cells)
      factors.push_back(std::exp2(
        std::round(factor_steps * std::log2(cell.factor / cells[0].factor)) / factor_steps));
    const auto                   lu       = factorization(cells, factors, parts, n_unknown);
    const unsigned int           n_fluxes = n_unknown * n_of_face, n_faces = n_of_faces / n_of_face;
    Eigen::VectorXd              rhs = Eigen::VectorXd::Zero(lu->rows());
    std::vector<Eigen::VectorXd> fluxes(cells.size());
    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        fluxes[c]  = cells[c].given;
        auto means = rhs.segment(n_fluxes + c * n_balances, n_balances);
        means      = cells[c].means;
        for (unsigned int f = 0; f < cells[c].faces.size(); ++f)
          means -=
            balances(*cells[c].condensed, f / n_faces, f % n_faces, n_of_face, n_components) *
            cells[c].given.segment(f * n_of_face, n_of_face);
      }
    for (const Part &part : parts)
      {
        const PatchCell   &cell      = cells[part.cell];
        const unsigned int component = part.face / n_faces;
        const auto         rows =
          cell.condensed->stiffness.middleRows((part.face % n_faces) * n_of_face, n_of_face);
        Eigen::VectorXd loads = cell.loads.segment(part.face * n_of_face, n_of_face) -
                                rows * cell.given.segment(component * n_of_faces, n_of_faces);
        if (part.transformation != nullptr)
          loads = part.transformation->transpose() * loads;
        rhs.segment(part.unknown * n_of_face, n_of_face) += part.sign * factors[part.cell] * loads;
      }
    const Eigen::VectorXd solution = lu->solve(rhs);
    for (const Part &part : parts)
      {
        const Eigen::VectorXd flux = solution.segment(part.unknown * n_of_face, n_of_face);
        auto                  own  = fluxes[part.cell].segment(part.face * n_of_face, n_of_face);
        if (part.transformation != nullptr)
          own += part.sign * (*part.transformation * flux);
        else
          own += part.sign * flux;
      }
    return fluxes;
  }
} // namespace PeriDeal
