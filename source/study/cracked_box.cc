// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/study/cracked_box.h>

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

  PERIDEAL_INSTANTIATE_FUNCTION(cracked_box);


  std::string to_text(const CellCounts &cells)
  {
    return joined(cells, ", ");
  }


  std::string lattice_name(const CellCounts &cells)
  {
    return joined(cells, " x ");
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
} // namespace PeriDeal
