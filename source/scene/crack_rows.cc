// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Cracks that run along rows of nodes, and the lattice beside which they do not.

#include <deal.II/base/bounding_box.h>

#include <perideal/base/instantiate.h>
#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "scene_checks.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Of a spacing: nodes closer to a crack count as lying on it. */
    constexpr double on_row = 1e-3;

    /** Of a spacing: in a lattice that is chosen, nodes are farther from the crack than this. */
    constexpr double off_row = 0.05;

    /** Of the lattice lines through a crack: those with a node there if it runs along a row. */
    constexpr double share_of_row = 0.3;

    template <int dim>
    using Cells = std::common_type_t<std::array<unsigned int, dim>>; // not deduced

    /** The axis that a crack lies across. */
    template <int dim>
    unsigned int axis_across(const CrackGeometry<dim> &crack)
    {
      unsigned int axis = 0;
      for (unsigned int d = 1; d < dim; ++d)
        if (std::abs(crack.normal()[d]) > std::abs(crack.normal()[axis]) + 1e-9)
          axis = d;
      return axis;
    }


    /** Distance of a place on a lattice line from the nearest node inside, in spacings. */
    double distance_from_node(const double       place,
                              const unsigned int n_cells,
                              const double       shift,
                              const double       far)
    {
      const double number = std::round(place - shift);
      return number < 1. - 2. * shift || number > n_cells - 1. ? far :
                                                                 std::abs(place - shift - number);
    }


    /** Whether a crack runs along a row of nodes: many lattice lines across it have one on it. */
    template <int dim>
    bool runs_along_row(const CrackGeometry<dim> &crack,
                        const Domain<dim>        &domain,
                        const Cells<dim>         &cells,
                        const bool                at_centers,
                        const double              close)
    {
      const unsigned int   axis  = axis_across(crack);
      const double         shift = at_centers ? 0.5 : 0.;
      Tensor<1, dim>       h;
      std::array<int, dim> first{}, last{};
      const auto [low, high] = BoundingBox<dim>(crack.corners()).get_boundary_points();
      for (unsigned int d = 0; d < dim; ++d)
        {
          h[d]              = (domain.upper[d] - domain.lower[d]) / cells[d];
          const auto number = [&](const double x) {
            return std::clamp((x - domain.lower[d]) / h[d] - shift, -1., cells[d] + 1.);
          };
          first[d] = std::max(0, static_cast<int>(std::ceil(number(low[d]) - 1e-6)));
          last[d]  = std::min(static_cast<int>(cells[d] - (at_centers ? 1 : 0)),
                             static_cast<int>(std::floor(number(high[d]) + 1e-6)));
        }
      first[axis] = last[axis] = 0;
      unsigned int n_lines = 0, n_nodes = 0;
      const auto   visit = [&](const std::array<int, dim> &line) {
        Point<dim> p  = crack.corners()[0];
        double     up = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != axis)
            {
              p[d] = domain.lower[d] + (line[d] + shift) * h[d];
              up -= crack.normal()[d] / crack.normal()[axis] * (p[d] - crack.corners()[0][d]);
            }
        p[axis] += up;
        if (!crack.contains(p))
          return;
        ++n_lines;
        n_nodes +=
          distance_from_node((p[axis] - domain.lower[axis]) / h[axis], cells[axis], shift, 1.) <
          close;
      };
      std::array<int, dim> line = first;
      for (unsigned int d = 0; d < dim;)
        {
          if (d == 0)
            visit(line);
          if (++line[d] <= last[d])
            d = 0;
          else
            {
              line[d] = first[d];
              ++d;
            }
        }
      return n_nodes > 0 && n_nodes >= share_of_row * n_lines && (n_nodes > 1 || n_lines == 1);
    }


    /**
     * The first piece (of those across an axis, if that is given) that runs along a row of nodes.
     */
    template <int dim>
    const CrackGeometry<dim> *first_along_row(const std::vector<CrackGeometry<dim>> &pieces,
                                              const Domain<dim>                     &domain,
                                              const Cells<dim>                      &cells,
                                              const bool                             at_centers,
                                              const double                           close,
                                              const unsigned int                     axis = dim)
    {
      for (const CrackGeometry<dim> &piece : pieces)
        if ((axis == dim || axis == axis_across(piece)) &&
            runs_along_row(piece, domain, cells, at_centers, close))
          return &piece;
      return nullptr;
    }


    /** Cells as near as possible to the domain's with which no crack runs along a row of nodes. */
    template <int dim>
    std::optional<Cells<dim>> cells_off_cracks(const std::vector<CrackGeometry<dim>> &pieces,
                                               const Domain<dim>                     &domain,
                                               const bool                             at_centers)
    {
      Cells<dim> cells = domain.cells;
      for (unsigned int round = 0; round < dim; ++round)
        {
          const CrackGeometry<dim> *const piece =
            first_along_row(pieces, domain, cells, at_centers, on_row);
          if (piece == nullptr)
            return cells;
          const unsigned int axis  = axis_across(*piece);
          bool               found = false;
          for (const int change : {1, -1, 2, -2, 3, -3})
            {
              Cells<dim> other = cells;
              if (static_cast<int>(cells[axis]) + change < 2 || found)
                continue;
              other[axis] += change;
              found = first_along_row(pieces, domain, other, at_centers, off_row, axis) == nullptr;
              if (found)
                cells = other;
            }
          if (!found)
            return {};
        }
      if (first_along_row(pieces, domain, cells, at_centers, on_row) != nullptr)
        return {};
      return cells;
    }


    template <int dim>
    std::string text_of(const Cells<dim> &cells)
    {
      std::string text;
      for (unsigned int d = 0; d < dim; ++d)
        text += (d > 0 ? ", " : "") + std::to_string(cells[d]);
      return text;
    }


    /** Thin holes remove cells of this very lattice, which come last (HoleCells). */
    bool has_joints(const std::vector<Hole> &listed)
    {
      return !listed.empty() && listed.back().text.empty();
    }
  } // namespace


  template <int dim>
  void keep_cracks_off_nodes(Scene<dim> &scene)
  {
    if (dim == 1 || scene.cracks.cracks.empty() || !scene.domain.has_lattice() ||
        scene.cracks.on_faces())
      return;
    const auto pieces = make_crack_geometries(
      scene.cracks.pieces(scene.cracks.tips.empty() ? 0. : scene.time.end_time));
    // In the middle of a body a crack lies on a row of vertices or of centres, for any cells.
    const bool at_centers =
      scene.domain.has_nodes_at_centers() &&
      (runs(scene, ModelKind::peridynamics) || runs(scene, ModelKind::coupled));
    const CrackGeometry<dim> *const piece =
      first_along_row(pieces, scene.domain, scene.domain.cells, at_centers, on_row);
    if (piece == nullptr)
      return;
    const std::string name = "Crack " + std::to_string(piece->crack + 1) +
                             " (section 'Cracks') runs along a row of " +
                             (at_centers ? "cell centres" : "nodes") + " of " +
                             text_of<dim>(scene.domain.cells) + " cells";
    const bool left  = scene.cracks.nodes_on_cracks == NodesOnCracks::left;
    const bool fixed = left || scene.domain.is_image() || scene.domain.coarsening.times > 0 ||
                       scene.domain.has_extra_layers() || has_joints(scene.domain.holes.listed);
    const auto cells = fixed ? std::optional<Cells<dim>>() :
                               cells_off_cracks(pieces, scene.domain, at_centers);
    if (cells)
      {
        scene.domain.notes.push_back(
          name + ": 'Cells' in section 'Domain' are taken as " + text_of<dim>(*cells) +
          ", with which it lies between rows. 'Nodes on cracks = left' keeps them as given.");
        scene.domain.cells = *cells;
      }
    else
      scene.domain.notes.push_back(
        name + ". These nodes belong to its left side, and it acts like a crack half a cell, " +
        number_text(0.5 * scene.domain.spacing()[axis_across(*piece)]) +
        ", farther to the right. " +
        (left ? "Without 'Nodes on cracks = left'" : "Other 'Cells' (section 'Domain')") +
        ", or with 'Mesh = faces' for a crack on cell faces, it lies where it is.");
  }


  PERIDEAL_INSTANTIATE_FUNCTION(keep_cracks_off_nodes);
} // namespace PeriDeal
