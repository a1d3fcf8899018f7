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


    /** Of each cell the number of its group, -1 where a face of the group is open. */
    template <typename Part>
    std::vector<int> closed_groups(const std::vector<PatchCell> &cells,
                                   const std::vector<Part>      &parts)
    {
      std::vector<int>  group(cells.size());
      std::vector<char> open(cells.size(), 0);
      std::iota(group.begin(), group.end(), 0);
      const auto join = [&](const int a, const int b) {
        std::replace(group.begin(), group.end(), std::max(a, b), std::min(a, b));
      };
      for (const Part &a : parts)
        for (const Part &b : parts)
          if (a.unknown == b.unknown && group[a.cell] != group[b.cell])
            join(group[a.cell], group[b.cell]);
      for (const Part &part : parts)
        if (cells[part.cell].faces[part.face].state == FacePlace::open)
          open[group[part.cell]] = 1;
      std::map<int, int> numbers;
      std::vector<int>   result;
      for (const int g : group)
        result.push_back(open[g] ? -1 : numbers.try_emplace(g, numbers.size()).first->second);
      return result;
    }


    /** Faces of cells around a vertex that are one. */
    struct OneFace
    {
      std::vector<std::pair<unsigned int, unsigned int>> members; // cell, face
      double                                             share = 0.;
    };
  } // namespace


  PatchSolver::PatchSolver(const unsigned int n_coordinates, const unsigned int k)
    : n_coordinates(n_coordinates)
    , k(k)
    , n_of_face(n_coordinates == 0 ? 1 :
                n_coordinates == 1 ? k + 1 :
                                     (k + 1) * (k + 1))
  {}


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
    std::vector<OneFace>                                        faces;
    std::vector<std::array<dealii::types::global_dof_index, 4>> keys;
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int f = 0; f < cells[c].faces.size(); ++f)
        {
          const FacePlace &face = cells[c].faces[f];
          if (face.state == FacePlace::given)
            continue;
          const bool  shared = face.state == FacePlace::shared;
          std::size_t one    = faces.size();
          if (shared)
            one = std::find(keys.begin(), keys.end(), face.key) - keys.begin();
          if (one == faces.size())
            {
              faces.emplace_back();
              keys.push_back(face.key);
              if (!shared)
                keys.back().fill(numbers::invalid_dof_index);
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
                                      const unsigned int            n_unknown,
                                      const std::vector<int>       &groups) const
  {
    const unsigned int n_fluxes = n_unknown * n_of_face, n_cells = cells.size();
    const unsigned int n = n_fluxes + n_cells + *std::max_element(groups.begin(), groups.end()) + 1;
    Eigen::MatrixXd    matrix = Eigen::MatrixXd::Zero(n, n);
    for (const Part &a : parts)
      {
        for (const Part &b : parts)
          if (a.cell == b.cell)
            {
              Eigen::MatrixXd block = (a.sign * b.sign * factors[a.cell]) *
                                      cells[a.cell].condensed->stiffness.block(a.face * n_of_face,
                                                                               b.face * n_of_face,
                                                                               n_of_face,
                                                                               n_of_face);
              if (a.transformation != nullptr)
                block = a.transformation->transpose() * block;
              if (b.transformation != nullptr)
                block = block * *b.transformation;
              matrix.block(a.unknown * n_of_face, b.unknown * n_of_face, n_of_face, n_of_face) +=
                block;
            }
        Eigen::RowVectorXd mean = Eigen::RowVectorXd::Unit(n_of_face, 0);
        if (a.transformation != nullptr)
          mean = a.transformation->row(0);
        matrix.block(n_fluxes + a.cell, a.unknown * n_of_face, 1, n_of_face) += a.sign * mean;
        matrix.block(a.unknown * n_of_face, n_fluxes + a.cell, n_of_face, 1) +=
          a.sign * mean.transpose();
      }
    for (unsigned int c = 0; c < n_cells; ++c)
      if (groups[c] >= 0)
        {
          matrix(n_fluxes + n_cells + groups[c], n_fluxes + c) = 1.;
          matrix(n_fluxes + c, n_fluxes + n_cells + groups[c]) = 1.;
        }
    return matrix;
  }


  std::shared_ptr<const PatchSolver::LU> PatchSolver::factorization(
    const std::vector<PatchCell> &cells,
    const std::vector<double>    &factors,
    const std::vector<Part>      &parts,
    const unsigned int            n_unknown,
    const std::vector<int>       &groups)
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
        key.push_back(part.cell + 256 * (part.face + 8 * part.unknown));
        key.push_back(code);
      }
    key.insert(key.end(), groups.begin(), groups.end());
    const auto found = known.find(key);
    if (found != known.end())
      return found->second;
    auto lu = std::make_shared<const LU>(matrix(cells, factors, parts, n_unknown, groups));
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
    const std::vector<int>  groups    = closed_groups(cells, parts);
    // Any factors give fluxes in balance; these serve many vertices.
    std::vector<double> factors;
    for (const PatchCell &cell : cells)
      factors.push_back(std::exp2(
        std::round(factor_steps * std::log2(cell.factor / cells[0].factor)) / factor_steps));
    const auto                   lu       = factorization(cells, factors, parts, n_unknown, groups);
    const unsigned int           n_fluxes = n_unknown * n_of_face;
    Eigen::VectorXd              rhs      = Eigen::VectorXd::Zero(lu->rows());
    std::vector<Eigen::VectorXd> fluxes(cells.size());
    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        fluxes[c]         = cells[c].given;
        rhs[n_fluxes + c] = cells[c].mean;
        for (unsigned int f = 0; f < cells[c].faces.size(); ++f)
          rhs[n_fluxes + c] -= cells[c].given[f * n_of_face];
      }
    for (const Part &part : parts)
      {
        const PatchCell &cell = cells[part.cell];
        const auto rows = cell.condensed->stiffness.middleRows(part.face * n_of_face, n_of_face);
        Eigen::VectorXd loads =
          cell.loads.segment(part.face * n_of_face, n_of_face) - rows * cell.given;
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
