// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/study/lattice_ladder.h>
#include <perideal/study/naming.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    std::string joined(const CellCounts &cells, const std::string &separator)
    {
      std::string text;
      for (const unsigned int n : cells)
        text += (text.empty() ? "" : separator) + std::to_string(n);
      return text;
    }
  } // namespace


  bool corners_on_planes(const CrackedBox &box, const unsigned int direction, const unsigned int n)
  {
    constexpr double slack  = 1e-7; // of a cell
    const double     lower  = box.lower[direction];
    const double     length = box.upper[direction] - lower;
    for (const auto &crack : box.cracks)
      for (const auto &corner : crack)
        {
          const double s = std::clamp((corner[direction] - lower) / length, 0., 1.) * n;
          if (std::abs(s - std::round(s)) > slack)
            return false;
        }
    return true;
  }


  template <int dim>
  CrackedBox cracked_box(const Scene<dim> &scene)
  {
    CrackedBox box;
    for (unsigned int d = 0; d < dim; ++d)
      {
        box.lower.push_back(scene.domain.lower[d]);
        box.upper.push_back(scene.domain.upper[d]);
        box.cells.push_back(scene.domain.cells[d]);
      }
    for (const auto &crack : scene.cracks.cracks)
      {
        box.cracks.emplace_back();
        for (const dealii::Point<dim> &corner : crack)
          {
            box.cracks.back().emplace_back();
            for (unsigned int d = 0; d < dim; ++d)
              box.cracks.back().back().push_back(corner[d]);
          }
      }
    return box;
  }

  template CrackedBox cracked_box(const Scene<1> &);
  template CrackedBox cracked_box(const Scene<2> &);
  template CrackedBox cracked_box(const Scene<3> &);


  std::string to_text(const CellCounts &cells)
  {
    return joined(cells, ", ");
  }


  std::string lattice_name(const CellCounts &cells)
  {
    return joined(cells, " x ");
  }


  std::vector<CellCounts> parse_ladder(const std::string &text,
                                       const std::string &option,
                                       const unsigned int dim,
                                       const std::size_t  at_least)
  {
    const std::string where = "command line: " + option + " '" + text + "'";
    const std::string needed =
      "; needs lattices as 'Cells' has them, " + std::to_string(dim) +
      (dim == 1 ? " number" : " numbers") + " each, from coarse to fine, separated by '|': \"" +
      to_text(CellCounts(dim, 20)) + " | " + to_text(CellCounts(dim, 40)) + "\".";
    std::vector<CellCounts> ladder;
    for (const std::string &lattice : split_list(text, '|'))
      {
        CellCounts cells;
        for (const std::string &count : split_list(lattice, ','))
          {
            AssertThrow(!count.empty() &&
                          count.find_first_not_of("0123456789") == std::string::npos &&
                          count.size() < 9 && std::stoul(count) > 0,
                        UserError(where + ": '" + count + "' is no number of cells" + needed));
            cells.push_back(static_cast<unsigned int>(std::stoul(count)));
          }
        AssertThrow(cells.size() == dim,
                    UserError(where + ": '" + lattice + "' has " + std::to_string(cells.size()) +
                              (cells.size() == 1 ? " number" : " numbers") + needed));
        for (unsigned int d = 0; d < dim && !ladder.empty(); ++d)
          AssertThrow(cells[d] > ladder.back()[d],
                      UserError(where + ": '" + lattice + "' is not finer than '" +
                                to_text(ladder.back()) + "' in every direction" + needed));
        ladder.push_back(cells);
      }
    AssertThrow(ladder.size() >= at_least,
                UserError(where + ": found " + std::to_string(ladder.size()) + ", needs " +
                          std::to_string(at_least) + " or more" + needed));
    return ladder;
  }


  std::vector<CellCounts> default_ladder(const CellCounts &cells, const unsigned int n_rungs)
  {
    constexpr unsigned int  fewest = 8;
    std::vector<CellCounts> ladder;
    for (unsigned int k = n_rungs; k-- > 0;)
      {
        CellCounts rung;
        for (const unsigned int n : cells)
          {
            // the nearest count of the same parity
            const double half = 0.5 * (n / std::exp2(k) - n % 2);
            rung.push_back(2 * static_cast<unsigned int>(std::lround(half)) + n % 2);
          }
        if (*std::min_element(rung.begin(), rung.end()) >= fewest || k == 0)
          ladder.push_back(rung);
      }
    return ladder;
  }


  bool along_axes(const CrackedBox &box)
  {
    const auto same = [&](const double a, const double b, const unsigned int d) {
      return std::abs(a - b) <= 1e-9 * (box.upper[d] - box.lower[d]);
    };
    for (const auto &crack : box.cracks)
      {
        unsigned int n_normals = 0;
        for (unsigned int d = 0; d < box.dim(); ++d)
          n_normals += std::all_of(crack.begin(), crack.end(), [&](const auto &corner) {
            return same(corner[d], crack[0][d], d);
          });
        if (n_normals != 1)
          return false;
        for (std::size_t c = 0; c < crack.size(); ++c)
          {
            unsigned int n_changes = 0;
            for (unsigned int d = 0; d < box.dim(); ++d)
              n_changes += same(crack[c][d], crack[(c + 1) % crack.size()][d], d) ? 0 : 1;
            if (n_changes > 1)
              return false;
          }
      }
    return true;
  }


  std::optional<CellCounts> nearest_fitting(const CrackedBox  &box,
                                            const CellCounts  &cells,
                                            const bool         on_faces,
                                            const unsigned int multiple)
  {
    if (on_faces && !along_axes(box))
      return {};
    CellCounts fitting;
    for (unsigned int d = 0; d < box.dim(); ++d)
      {
        const unsigned int n = cells[d], farthest = std::max({2u, n / 5, multiple});
        const auto         fits = [&](const unsigned int count) {
          return count > 0 && count % multiple == 0 &&
                 (!on_faces || corners_on_planes(box, d, count / multiple));
        };
        unsigned int found = 0;
        for (unsigned int k = 0; k <= farthest && found == 0; ++k)
          found = k < n && fits(n - k) ? n - k : fits(n + k) ? n + k : 0;
        if (found == 0)
          return {};
        fitting.push_back(found);
      }
    return fitting;
  }


  double estimated_bonds(const CrackedBox &box, const CellCounts &cells, const double ratio)
  {
    std::vector<double> h;
    double              n_nodes = 1.;
    for (unsigned int d = 0; d < box.dim(); ++d)
      {
        h.push_back((box.upper[d] - box.lower[d]) / cells[d]);
        n_nodes *= cells[d] + 1.;
      }
    const double     smallest = *std::min_element(h.begin(), h.end());
    const double     reach    = (ratio + 0.5) * smallest;
    std::vector<int> most, offset;
    for (const double spacing : h)
      most.push_back(static_cast<int>(reach / spacing));
    for (const int m : most)
      offset.push_back(-m);
    double n_neighbors = -1.; // the node itself
    while (true)
      {
        double square = 0.;
        for (unsigned int d = 0; d < box.dim(); ++d)
          square += offset[d] * h[d] * offset[d] * h[d];
        n_neighbors += square < reach * reach ? 1. : 0.;
        unsigned int d = 0;
        while (d < box.dim() && ++offset[d] > most[d])
          {
            offset[d] = -most[d];
            ++d;
          }
        if (d == box.dim())
          return 0.5 * n_nodes * n_neighbors;
      }
  }


  double nodal_error(const std::vector<double> &values,
                     const std::vector<double> &reference,
                     const CellCounts          &cells,
                     const bool                 with_gaps)
  {
    AssertDimension(values.size(), reference.size());
    std::size_t n_vertices = 1;
    for (const unsigned int n : cells)
      n_vertices *= n + 1;
    const std::size_t n_components = values.size() / n_vertices;
    double            difference = 0., size = 0., volume = 0.;
    for (std::size_t k = 0; k < values.size(); ++k)
      {
        if (with_gaps && std::isnan(reference[k]))
          continue;
        double      v    = 1.;
        std::size_t rest = k / n_components;
        for (const unsigned int n : cells)
          {
            const std::size_t i = rest % (n + 1);
            v *= i == 0 || i == n ? 0.5 : 1.;
            rest /= n + 1;
          }
        difference += v * (values[k] - reference[k]) * (values[k] - reference[k]);
        size += v * reference[k] * reference[k];
        volume += v;
      }
    return std::sqrt(difference / (size > 0. ? size : volume));
  }
} // namespace PeriDeal
