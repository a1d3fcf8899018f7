// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The parts of an image that no side holds, and what the user should know of the image.

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/scene/lists.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "scene_checks.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Offset = std::array<int, 2>;

    std::string percent(const double share)
    {
      return rounded_text(100. * share) + " %";
    }


    /** Bonds of at least this length do not exist. */
    double reach_of_bonds(const Scene<2> &scene)
    {
      const Tensor<1, 2> h = scene.domain.spacing();
      return scene.peridynamics.sampling.volume_fraction == VolumeFraction::linear ?
               (scene.horizon() + 0.5 * std::min(h[0], h[1])) * (1. - 1e-9) :
               scene.horizon() * (1. + 1e-9);
    }


    /**
     * Half of the offsets between cells that are connected: those with a common face; for bonds
     * alone that may cross voids, all that they reach.
     */
    std::vector<Offset> connections(const Scene<2> &scene)
    {
      std::vector<Offset> list{{{1, 0}}, {{0, 1}}};
      if (runs(scene, ModelKind::finite_elements) || runs(scene, ModelKind::coupled) ||
          scene.peridynamics.treatment == BoundaryTreatment::exchange ||
          scene.peridynamics.across_voids != BondsAcrossVoids::keep)
        return list;
      const Tensor<1, 2> h       = scene.domain.spacing();
      const double       horizon = reach_of_bonds(scene);
      const int mx = static_cast<int>(horizon / h[0]), my = static_cast<int>(horizon / h[1]);
      list.clear();
      for (int j = 0; j <= my; ++j)
        for (int i = -mx; i <= mx; ++i)
          if ((j > 0 || i > 0) && std::hypot(i * h[0], j * h[1]) < horizon)
            list.push_back({{i, j}});
      return list;
    }


    /**
     * What holds on a side of the body or a part of it: components of the displacement, or in
     * component 0 a value of the diffusing quantity.
     */
    std::array<bool, 2> held_on_side(const Scene<2> &scene, const types::boundary_id side)
    {
      const auto         &conditions = scene.boundary_conditions;
      std::array<bool, 2> held{{false, false}};
      if (scene.deforms)
        {
          for (const VectorCondition &condition : conditions.displacement)
            if (conditions.side_of(condition.id) == side)
              for (unsigned int d = 0; d < 2; ++d)
                held[d] = held[d] || condition.values[d].has_value();
          for (const types::boundary_id id : conditions.symmetry)
            if (id == side)
              held[id / 2] = true;
        }
      else
        {
          for (const SideCondition &condition : conditions.dirichlet)
            held[0] = held[0] || conditions.side_of(condition.id) == side;
          for (const SurfaceTransfer &transfer : conditions.transfers)
            held[0] = held[0] ||
                      (transfer.fixes_level() && conditions.side_of(transfer.id) == side);
        }
      return held;
    }


    /** One of the connected parts. */
    struct ImagePart
    {
      std::vector<std::size_t> cells;
      Point<2>                 center;
      double                   size = 0.; // farthest cell from the centre, at least a cell
    };


    std::vector<ImagePart> find_parts(const PhaseMap &map, const std::vector<int> &part_of)
    {
      std::vector<ImagePart> parts;
      for (std::size_t c = 0; c < part_of.size(); ++c)
        if (part_of[c] >= 0)
          {
            if (part_of[c] == static_cast<int>(parts.size()))
              parts.emplace_back();
            parts[part_of[c]].cells.push_back(c);
          }
      for (ImagePart &part : parts)
        {
          for (const std::size_t c : part.cells)
            part.center += (map.center(c) - Point<2>()) / static_cast<double>(part.cells.size());
          part.size = std::hypot(map.spacing[0], map.spacing[1]);
          for (const std::size_t c : part.cells)
            part.size = std::max(part.size, map.center(c).distance(part.center));
        }
      return parts;
    }


    /**
     * Whether the sides that a part touches hold it against all rigid motions, or give its value.
     */
    class Holding
    {
    public:
      explicit Holding(const Scene<2> &scene)
        : scene(scene)
        , map(*scene.domain.image)
      {
        for (types::boundary_id side = 0; side <= hole_boundary_id; ++side)
          held[side] = held_on_side(scene, side);
      }

      bool holds(const ImagePart &part) const
      {
        if (!scene.deforms)
          return any_value(part);
        const bool centers = scene.domain.has_nodes_at_centers();
        const bool pd      = runs(scene, ModelKind::peridynamics),
                   others  = !pd || runs(scene, ModelKind::finite_elements);
        return ((!others && centers) || is_held(part, false)) &&
               (!(pd && centers) || is_held(part, true));
      }

    private:
      /**
       * Call visit(side, face number, place of the cell) for the faces of a part that end the body.
       */
      template <typename Visit>
      void for_each_face(const ImagePart &part, const Visit &visit) const
      {
        for (const std::size_t c : part.cells)
          {
            const auto [i, j] = map.place(c);
            for (unsigned int f = 0; f < 4; ++f)
              {
                const int step = f % 2 == 0 ? -1 : 1, k = i + (f < 2 ? step : 0),
                          l = j + (f < 2 ? 0 : step);
                if (map.phase(k, l) != PhaseMap::empty)
                  continue;
                const bool outside = k < 0 || l < 0 || k >= static_cast<int>(map.n_cells[0]) ||
                                     l >= static_cast<int>(map.n_cells[1]);
                visit(outside ? f : hole_boundary_id, f, i, j);
              }
          }
      }

      bool any_value(const ImagePart &part) const
      {
        bool any = false;
        for_each_face(part, [&](const unsigned int side, unsigned int, int, int) {
          any = any || held[side][0];
        });
        return any;
      }

      /** @param centers nodes are at the centres of cells, else at their corners */
      bool is_held(const ImagePart &part, const bool centers) const
      {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        for_each_face(
          part,
          [&](const unsigned int side, const unsigned int f, const int i, const int j) {
            for (int v = 0; v < (centers ? 1 : 2); ++v)
              {
                const double a = centers ? 0.5 :
                                 f < 2   ? f :
                                           v,
                             b = centers ? 0.5 :
                                 f < 2   ? v :
                                           f - 2;
                const double x = (map.lower[0] + (i + a) * map.spacing[0] - part.center[0]) /
                                 part.size,
                             y = (map.lower[1] + (j + b) * map.spacing[1] - part.center[1]) /
                                 part.size;
                for (unsigned int d = 0; d < 2; ++d)
                  if (held[side][d])
                    {
                      const Eigen::Vector3d row(d == 0 ? 1. : 0.,
                                                d == 1 ? 1. : 0.,
                                                d == 0 ? -y : x);
                      sum += row * row.transpose();
                    }
              }
          });
        const auto eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvalues();
        return eigenvalues[0] > 1e-10 * eigenvalues[2] && eigenvalues[2] > 0.;
      }

      const Scene<2>                                       &scene;
      const PhaseMap                                       &map;
      std::array<std::array<bool, 2>, hole_boundary_id + 1> held;
    };


    std::string describe(const std::vector<ImagePart> &islands)
    {
      constexpr std::size_t n_named = 5;
      std::string           text;
      for (std::size_t k = 0; k < std::min(n_named, islands.size()); ++k)
        text += (k > 0 ? ", " : "") + std::to_string(islands[k].cells.size()) +
                (islands[k].cells.size() == 1 ? " cell at " : " cells around ") +
                place_text(islands[k].center);
      if (islands.size() > n_named)
        text += " and " + std::to_string(islands.size() - n_named) + " more";
      return text;
    }


    /**
     * Hold an island at points that no other part shares: one of them in both directions, and
     * against turning the one farthest from it.
     */
    void pin(Scene<2> &scene, const std::vector<int> &part_of, const ImagePart &island)
    {
      const PhaseMap &map    = *scene.domain.image;
      const int       own    = part_of[island.cells.front()];
      const auto      is_own = [&](const int i, const int j) {
        for (int l = j - 1; l <= j; ++l)
          for (int k = i - 1; k <= i; ++k)
            if (map.phase(k, l) != PhaseMap::empty && part_of[map.index(k, l)] != own)
              return false;
        return true;
      };
      for (const bool at_center : {false, true})
        {
          std::vector<Point<2>> points;
          for (const std::size_t c : island.cells)
            {
              const auto [i, j] = map.place(c);
              if (at_center)
                points.push_back(map.center(c));
              else
                for (int v = 0; v < 4; ++v)
                  if (const int k = i + v % 2, l = j + v / 2; is_own(k, l))
                    points.emplace_back(map.lower[0] + k * map.spacing[0],
                                        map.lower[1] + l * map.spacing[1]);
            }
          if (points.empty())
            continue;
          const Point<2> first = points.front();
          const Point<2> last  = *std::max_element(points.begin(),
                                                  points.end(),
                                                  [&](const Point<2> &a, const Point<2> &b) {
                                                    return a.distance(first) <
                                                           b.distance(first) - 1e-9 * island.size;
                                                  });
          scene.domain.islands.pins.push_back({first, 0, at_center});
          scene.domain.islands.pins.push_back({first, 1, at_center});
          const Tensor<1, 2> arm = last - first;
          if (arm.norm() > 0.)
            scene.domain.islands.pins.push_back(
              {last, std::abs(arm[0]) >= std::abs(arm[1]) ? 1u : 0u, at_center});
        }
    }


    /** Parts that no side holds, the largest first. */
    struct Islands
    {
      std::vector<int>       part_of; // of each cell
      std::vector<ImagePart> parts;
      std::size_t            n_cells = 0, n_solid = 0; // of these parts, of all
    };


    Islands find_islands(const Scene<2> &scene)
    {
      const PhaseMap &map = *scene.domain.image;
      Islands         islands{map.parts(connections(scene)), {}, 0, 0};
      const Holding   holding(scene);
      for (const ImagePart &part : find_parts(map, islands.part_of))
        {
          islands.n_solid += part.cells.size();
          if (!holding.holds(part))
            {
              islands.parts.push_back(part);
              islands.n_cells += part.cells.size();
            }
        }
      std::stable_sort(
        islands.parts.begin(),
        islands.parts.end(),
        [](const ImagePart &a, const ImagePart &b) { return a.cells.size() > b.cells.size(); });
      return islands;
    }


    std::string number_of_parts(const Islands &islands)
    {
      return std::to_string(islands.parts.size()) +
             (islands.parts.size() == 1 ? " part" : " parts");
    }


    /** The steady temperature of a body, which keeps the parts that it holds. */
    void refuse_islands_of_heat(const Scene<2> &heat)
    {
      if (!heat.time.steady || !heat.domain.image->has_voids())
        return;
      const Islands islands = find_islands(heat);
      if (!islands.parts.empty())
        entry_error(
          heat.domain.where("Islands"),
          "no side holds the temperature of " + number_of_parts(islands) +
            " of the body in the image (" + describe(islands.parts) +
            "), whose steady state is not determined. Give conditions of the temperature on a side that each part touches, or compute it in time ('Steady = false' in section 'Time').");
    }


    void treat_islands(Scene<2> &scene)
    {
      Domain<2> &domain     = scene.domain;
      PhaseMap  &map        = *domain.image;
      const bool determined = scene.deforms ? !scene.elasticity.is_static() : !scene.time.steady;
      if (domain.islands.rule == IslandRule::pin && !scene.deforms)
        entry_error(domain.where("Islands"), "'pin' is for 'Physics = elasticity'; use 'remove'.");
      if ((determined && domain.islands.rule != IslandRule::remove) || !map.has_voids())
        return;
      const Islands found = find_islands(scene);
      if (found.parts.empty())
        return;
      const std::string parts = number_of_parts(found), what = describe(found.parts);
      if (domain.islands.rule == IslandRule::error)
        entry_error(domain.where("Islands"),
                    "no side holds " + parts + " of the body in the image (" + what + "), whose " +
                      (scene.deforms ? "displacement" : "steady state") +
                      " is not determined. Use '" + (scene.deforms ? "remove' or 'pin" : "remove") +
                      "', or give conditions on a side that each part touches.");
      if (2 * found.n_cells > found.n_solid && domain.islands.rule == IslandRule::remove)
        entry_error(domain.where("Islands"),
                    "'remove' would take away " + percent(double(found.n_cells) / found.n_solid) +
                      " of the body, because no side holds " + parts + " of it (" + what +
                      "). Give conditions on a side that the body touches.");
      for (const ImagePart &island : found.parts)
        if (domain.islands.rule == IslandRule::pin)
          pin(scene, found.part_of, island);
        else
          for (const std::size_t c : island.cells)
            map.phases[c] = PhaseMap::empty;
      domain.notes.push_back("no side holds " + parts + " of the image, " + what + ": " +
                             (domain.islands.rule == IslandRule::pin ? "pinned" : "removed") +
                             " ('Islands' in section 'Domain').");
    }


    void note_areas(Domain<2> &domain)
    {
      const PhaseMap                 map    = domain.image_of_body();
      const std::vector<std::size_t> counts = map.counts();
      std::string text = "the image has " + std::to_string(map.n_cells[0]) + " x " +
                         std::to_string(map.n_cells[1]) + " cells: ";
      for (std::size_t k = 0; k < counts.size(); ++k)
        if (k < map.names.size() || counts[k] > 0)
          text += (k > 0 ? ", " : "") + (k < map.names.size() ? map.names[k] : void_name) + " " +
                  percent(static_cast<double>(counts[k]) / map.phases.size()) + " (" +
                  std::to_string(counts[k]) + ")";
      domain.notes.push_back(text + ".");
    }


    /** Voids so thin that bonds along rows or columns of the image reach across them. */
    void note_thin_voids(Scene<2> &scene)
    {
      const PhaseMap &map = *scene.domain.image;
      if (!runs(scene, ModelKind::peridynamics) || !map.has_voids() ||
          scene.peridynamics.treatment == BoundaryTreatment::exchange ||
          scene.peridynamics.across_voids != BondsAcrossVoids::keep)
        return;
      const double horizon  = reach_of_bonds(scene);
      std::size_t  n_places = 0;
      int          widest   = 0;
      for (unsigned int d = 0; d < 2; ++d)
        for (unsigned int row = 0; row < map.n_cells[1 - d]; ++row)
          {
            int last = -1; // cell of the row that is not empty
            for (int k = 0; k < static_cast<int>(map.n_cells[d]); ++k)
              {
                const int r = static_cast<int>(row);
                if ((d == 0 ? map.phase(k, r) : map.phase(r, k)) == PhaseMap::empty)
                  continue;
                if (last >= 0 && k - last > 1 && (k - last) * map.spacing[d] < horizon)
                  {
                    ++n_places;
                    widest = std::max(widest, k - last - 1);
                  }
                last = k;
              }
          }
      if (n_places > 0)
        scene.domain.notes.push_back(
          "peridynamics: in " + std::to_string(n_places) +
          " places of rows and columns bonds reach across a void of up to " +
          std::to_string(widest) + (widest == 1 ? " cell" : " cells") +
          ", which is no gap to them. 'Bonds across voids = cut' (section 'Peridynamics') makes it one, and so does a smaller horizon or more cells ('Cells per pixel' in section 'Domain').");
    }
  } // namespace


  template <int dim>
  void check_image(Scene<dim> &scene)
  {
    if constexpr (dim == 2)
      if (scene.domain.image && !scene.domain.islands.cells_are_given)
        {
          treat_islands(scene);
          if (scene.heat)
            of_heat_problem([&] { refuse_islands_of_heat(*scene.heat); });
          note_areas(scene.domain);
          note_thin_voids(scene);
        }
  }


  PERIDEAL_INSTANTIATE_FUNCTION(check_image);
} // namespace PeriDeal
