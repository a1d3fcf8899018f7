// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Cracks of solids along the axes, and the lattice on whose faces they lie.

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "scene_checks.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Places along an axis, as parts of the body's extent. */
    struct Places
    {
      std::vector<double> cracks, tips, points; // cracks across the axis; loaded or held points
    };


    constexpr double same = 1e-6; // of a cell


    /** The largest distance of such places from the faces of n equal cells, in cells. */
    double misfit(const std::vector<double> &places, const unsigned int n)
    {
      double most = 0.;
      for (const double place : places)
        most = std::max(most, std::abs(place * n - std::round(place * n)));
      return most;
    }


    /**
     * The number of cells as near as possible to the wanted one with which cracks lie on faces: one
     * with which tips and points do, too, or that with which tips are nearest to one.
     */
    std::optional<unsigned int> cells_on_faces(const Places      &places,
                                               const unsigned int wanted,
                                               const bool         fixed)
    {
      constexpr double near = 0.02; // of a cell
      const int        most = fixed ? 0 : std::max(3, static_cast<int>(std::lround(0.08 * wanted)));
      std::vector<unsigned int> possible;
      for (int k = 0; k <= most; ++k)
        for (const int n : {static_cast<int>(wanted) + k, static_cast<int>(wanted) - k})
          if (n > 1 && misfit(places.cracks, n) < same)
            possible.push_back(n);
      // Limits of tips and of points.
      const std::pair<double, double> limits[] = {{same, same},
                                                  {same, 1.},
                                                  {near, near},
                                                  {near, 1.}};
      for (const auto &[of_tips, of_points] : limits)
        for (const unsigned int n : possible)
          if (misfit(places.tips, n) < of_tips && misfit(places.points, n) < of_points)
            return n;
      if (possible.empty())
        return {};
      return *std::min_element(possible.begin(),
                               possible.end(),
                               [&](const auto n, const auto other) {
                                 return misfit(places.tips, n) < misfit(places.tips, other);
                               });
    }


    /** Some side or part is moved or loaded by formulas of the place. */
    bool varies_along_sides(const Scene<2> &scene)
    {
      const auto &conditions = scene.boundary_conditions;
      for (const auto *const list : {&conditions.displacement, &conditions.traction})
        for (const VectorCondition &condition : *list)
          for (const auto &value : condition.values)
            if (value && value->depends_on_position())
              return true;
      return false;
    }


    /** Some crack begins at a side of the body. */
    bool reaches_side(const Scene<2> &scene)
    {
      for (const auto &crack : scene.cracks.cracks)
        for (const Point<2> &end : crack)
          for (unsigned int d = 0; d < 2; ++d)
            if (const double slack = 1e-9 * (scene.domain.upper[d] - scene.domain.lower[d]);
                end[d] < scene.domain.lower[d] + slack || end[d] > scene.domain.upper[d] - slack)
              return true;
      return false;
    }


    /** What is computed can have cracks on faces and loses nothing by it. */
    bool can_lie_on_faces(const Scene<2> &scene)
    {
      const Domain<2>        &domain     = scene.domain;
      const Cracks<2>        &cracks     = scene.cracks;
      const SurfaceCorrection correction = scene.peridynamics.surface_correction;
      const bool              coupled    = runs(scene, ModelKind::coupled);
      if (!scene.deforms || cracks.cracks.empty() || cracks.change() ||
          cracks.through_tips == ThroughTips::in_part || !domain.is_box() || domain.has_voids() ||
          domain.has_extra_layers() || domain.coarsening.times > 0 || scene.material.breaks())
        return false;
      // Of two nodes at one place neither knows of which side a formula is meant to be.
      if (!scene.elasticity.temperature_change.is_constant() ||
          scene.elasticity.computes_temperature ||
          (varies_along_sides(scene) && reaches_side(scene)))
        return false;
      if (!coupled) // peridynamics alone is better off between rows of nodes
        return runs(scene, ModelKind::finite_elements) && !runs(scene, ModelKind::peridynamics);
      // Faces do not press on each other there, and factors beside cracks find nothing.
      return !scene.elasticity.contact && !domain.has_nodes_at_centers() &&
             scene.elasticity.is_static() && scene.coupling.exchanges() &&
             !scene.elasticity.has_full_kinematics() &&
             (correction == SurfaceCorrection::automatic || correction == SurfaceCorrection::none);
    }


    /** The axis that a crack lies across, if it runs along the other one. */
    std::optional<unsigned int> crossed_axis(const std::vector<Point<2>> &crack)
    {
      const Tensor<1, 2> way = crack[1] - crack[0];
      for (unsigned int d = 0; d < 2; ++d)
        if (std::abs(way[d]) <= 1e-9 * way.norm())
          return d;
      return {};
    }


    /** Along both axes, if all cracks run along one. */
    std::optional<std::array<Places, 2>> places_of(const Scene<2> &scene)
    {
      std::array<Places, 2> places;
      const Domain<2>      &domain = scene.domain;
      const auto            part   = [&](const Point<2> &p, const unsigned int d) {
        return (p[d] - domain.lower[d]) / (domain.upper[d] - domain.lower[d]);
      };
      for (const auto &crack : scene.cracks.cracks)
        {
          const auto across = crossed_axis(crack);
          if (!across)
            return {};
          const double place = part(crack[0], *across);
          if (place < 1e-9 || place > 1. - 1e-9)
            return {};
          places[*across].cracks.push_back(place);
          for (const Point<2> &end : crack)
            if (const double tip = part(end, 1 - *across); tip > 1e-9 && tip < 1. - 1e-9)
              places[1 - *across].tips.push_back(tip);
        }
      for (const Part &one : scene.boundary_conditions.parts)
        for (unsigned int d = 0; d < 2 && one.kind == Part::point; ++d)
          places[d].points.push_back(part(one.position<2>(), d));
      return places;
    }


    /** Cells with which all cracks lie on faces. */
    std::optional<std::array<unsigned int, 2>> cells_for(const Scene<2>              &scene,
                                                         const std::array<Places, 2> &places)
    {
      const bool                  fixed  = scene.cracks.nodes_on_cracks == NodesOnCracks::left;
      const Tensor<1, 2>          h      = scene.domain.spacing();
      const bool                  square = std::abs(h[0] / h[1] - 1.) < 0.01;
      std::array<unsigned int, 2> cells  = scene.domain.cells;
      // First across the most cracks: the other direction follows, so that squares stay squares.
      const unsigned int first = places[0].cracks.size() > places[1].cracks.size() ? 0 : 1;
      for (const unsigned int d : {first, 1 - first})
        {
          const double ratio = d != first && square ?
                                 static_cast<double>(cells[first]) / scene.domain.cells[first] :
                                 1.;
          const auto   n     = cells_on_faces(places[d], std::lround(ratio * cells[d]), fixed);
          if (!n)
            return {};
          cells[d] = *n;
        }
      return cells;
    }


    /** Moves ends to the nearest vertices. Returns the longest way as a part of its crack. */
    double move_ends(Scene<2> &scene)
    {
      const Domain<2>   &domain = scene.domain;
      const Tensor<1, 2> h      = domain.spacing();
      double             most   = 0.;
      for (auto &crack : scene.cracks.cracks)
        {
          const unsigned int along  = 1 - *crossed_axis(crack);
          const double       length = std::abs(crack[1][along] - crack[0][along]);
          for (Point<2> &end : crack)
            {
              const double place = (end[along] - domain.lower[along]) / h[along],
                           moved = std::round(place);
              if (place <= 0. || place >= domain.cells[along])
                continue;
              if (std::abs(place - moved) > same)
                most = std::max(most, std::abs(place - moved) * h[along] / length);
              end[along] = domain.lower[along] + moved * h[along];
            }
        }
      return most;
    }


    /** No crack has lost its length. */
    bool all_stay(const Scene<2> &scene, const std::array<unsigned int, 2> &cells)
    {
      const Domain<2> &domain = scene.domain;
      for (const auto &crack : scene.cracks.cracks)
        {
          const unsigned int d = 1 - *crossed_axis(crack);
          const double       h = (domain.upper[d] - domain.lower[d]) / cells[d];
          if (std::abs(crack[1][d] - crack[0][d]) < 2. * h)
            return false;
        }
      return true;
    }
  } // namespace


  template <int dim>
  void lay_cracks_on_faces(Scene<dim> &scene)
  {
    if (scene.cracks.mesh != CrackMesh::automatic)
      return;
    scene.cracks.mesh = CrackMesh::removed;
    if constexpr (dim == 2)
      {
        if (!can_lie_on_faces(scene))
          return;
        const auto places = places_of(scene);
        const auto cells  = places ? cells_for(scene, *places) :
                                     std::optional<std::array<unsigned int, 2>>();
        if (!cells || !all_stay(scene, *cells))
          return;
        const bool others  = *cells != scene.domain.cells;
        scene.domain.cells = *cells;
        scene.cracks.mesh  = CrackMesh::faces;
        const double moved = move_ends(scene);
        scene.domain.notes.push_back(
          "the cracks run along the axes and are cut into the mesh ('Mesh = faces' in section 'Cracks')" +
          (others ? ": 'Cells' in section 'Domain' are taken as " + std::to_string((*cells)[0]) +
                      ", " + std::to_string((*cells)[1]) + ", with which they lie on faces" :
                    std::string()) +
          (moved > 0. ? "; ends that lie on no vertex are moved to the nearest, by at most " +
                          rounded_text(100. * moved) + " % of the crack's length" :
                        std::string()) +
          ". 'Mesh = removed' keeps the mesh as given.");
      }
  }


  PERIDEAL_INSTANTIATE_FUNCTION(lay_cracks_on_faces);
} // namespace PeriDeal
