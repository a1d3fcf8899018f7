// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/scene/lists.h>
#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cmath>

#include "msh_shapes.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    struct Group
    {
      std::size_t n       = 0;
      double      measure = 0.;
    };


    /** Length of a line, area of a quadrilateral, 1 of a point. */
    double measure_of_side(const MshMesh &mesh, const MshElement &side)
    {
      const auto between = [&](const unsigned int a, const unsigned int b) {
        Tensor<1, 3> e;
        for (unsigned int d = 0; d < mesh.dim; ++d)
          e[d] = mesh.points[side.nodes[b]][d] - mesh.points[side.nodes[a]][d];
        return e;
      };
      return side.n == 1 ? 1. :
             side.n == 2 ? between(0, 1).norm() :
                           0.5 * cross_product_3d(between(0, 2), between(1, 3)).norm();
    }


    std::string name_of(const MshMesh &mesh, const unsigned int dimension, const int id)
    {
      for (const auto &[key, number] : mesh.ids)
        if (key.first == dimension && number == id && key.second != std::to_string(id))
          return "'" + key.second + "' (" + std::to_string(id) + ")";
      return id == 0 ? "without a name" : std::to_string(id);
    }


    /** @param extent of the mesh, beside which round-off is 0 */
    std::string place_text(const MshQuality::Place &p, const unsigned int dim, const double extent)
    {
      std::string text;
      for (unsigned int d = 0; d < dim; ++d)
        text +=
          (d == 0 ? "(" : ", ") + rounded_text(std::abs(p[d]) < 1e-12 * extent ? 0. : p[d], 6);
      return text + ")";
    }


    /** "left (1): 20 faces, area 4" for each group. */
    std::string text_of(const MshMesh              &mesh,
                        const std::map<int, Group> &groups,
                        const unsigned int          dimension,
                        const std::string          &things,
                        const std::string          &measure)
    {
      std::string text;
      for (const auto &[id, group] : groups)
        text += (text.empty() ? "" : "; ") + name_of(mesh, dimension, id) + ": " +
                std::to_string(group.n) + " " + things +
                (measure.empty() ? "" : ", " + measure + " " + rounded_text(group.measure, 6));
      return text.empty() ? "none" : text;
    }


    std::map<int, Group> groups_of(const MshMesh &mesh, const std::vector<MshElement> &sides)
    {
      std::map<int, Group> groups;
      for (const MshElement &side : sides)
        {
          ++groups[side.id].n;
          groups[side.id].measure += measure_of_side(mesh, side);
        }
      return groups;
    }
  } // namespace


  std::vector<std::string> describe_msh(const MshMesh &mesh, const std::string &name)
  {
    const unsigned int       dim      = mesh.dim;
    const MshQuality         quality  = quality_of_msh(mesh, dim);
    const char *const        cells[]  = {"", "lines", "quadrilaterals", "hexahedra"},
                      *const faces[]  = {"", "points", "edges", "faces"},
                      *const volume[] = {"", "length", "area", "volume"};
    double                   extent   = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      extent = std::max(extent, quality.upper[d] - quality.lower[d]);
    std::vector<std::string> lines;
    lines.push_back("mesh '" + name + "': " + std::to_string(mesh.cells.size()) + " " + cells[dim] +
                    (mesh.n_divided > 0 ?
                       ", divided from " + std::to_string(mesh.n_divided) + " cells of the file" :
                       "") +
                    ", " + std::to_string(mesh.points.size()) + " nodes, " + volume[dim] + " " +
                    rounded_text(quality.volume, 6));
    lines.push_back("  size: from " + place_text(quality.lower, dim, extent) + " to " +
                    place_text(quality.upper, dim, extent));
    lines.push_back("  edges: " + rounded_text(quality.smallest) + " to " +
                    rounded_text(quality.largest) + ", median " + rounded_text(quality.median) +
                    (dim > 1 ?
                       "; the worst corner spans " + rounded_text(quality.worst, 2) +
                         " of a right one, at " + place_text(quality.worst_at, dim, extent) :
                       ""));
    const std::map<int, Group> sides = groups_of(mesh, mesh.sides);
    double                     rest  = mesh.surface;
    for (const auto &[id, group] : sides)
      rest -= group.measure;
    lines.push_back(
      "  sides: " + text_of(mesh, sides, dim - 1, faces[dim], dim > 1 ? volume[dim - 1] : "") +
      (rest > 1e-9 * mesh.surface ?
         "; in no group: " + std::string(volume[dim - 1]) + " " + rounded_text(rest, 6) :
         ""));
    std::map<int, Group> regions;
    for (const MshElement &cell : mesh.cells)
      ++regions[cell.id].n;
    lines.push_back("  regions: " + text_of(mesh, regions, dim, "cells", ""));
    if (!mesh.interfaces.empty())
      lines.push_back(
        "  interfaces: " +
        text_of(mesh, groups_of(mesh, mesh.interfaces), dim - 1, faces[dim], volume[dim - 1]));
    std::map<int, Group> places;
    for (const MshElement &place : mesh.places)
      if (place.id != 0)
        ++places[place.id].n;
    if (!places.empty())
      lines.push_back("  points: " + text_of(mesh, places, 0, "nodes", ""));
    const double three = 3. * quality.median, longest = 1.1 * quality.largest;
    lines.push_back("  'Horizon = " + rounded_text(std::max(three, longest)) + "' fits: " +
                    (three >= longest ?
                       "three median edges" :
                       "a tenth more than the longest edge, which three median edges (" +
                         rounded_text(three) + ") are not") +
                    ".");
    return lines;
  }
} // namespace PeriDeal
