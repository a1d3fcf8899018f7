// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/front_intensity.h>
#include <perideal/analysis/tip_field.h>
#include <perideal/laws/elasticity.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/zone.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double none = std::numeric_limits<double>::max();


    /** The closed line of the corners of a plane crack. */
    class Front
    {
    public:
      explicit Front(const std::vector<Point<3>> &corners)
        : corners(corners)
        , normal(doubled_area_vector(corners))
      {
        normal /= normal.norm();
        for (unsigned int i = 0; i < corners.size(); ++i)
          length += edge(i).norm();
      }

      unsigned int size() const
      {
        return corners.size();
      }

      Tensor<1, 3> edge(const unsigned int i) const
      {
        return corners[(i + 1) % size()] - corners[i];
      }

      Point<3> middle(const unsigned int i) const
      {
        return corners[i] + 0.5 * edge(i);
      }

      /** Out of the crack, in its plane. */
      Tensor<1, 3> outward(const Tensor<1, 3> &along) const
      {
        return cross_product_3d(along, normal) / along.norm();
      }

      /** So far along the line from the first corner. */
      Point<3> at(double way) const
      {
        way -= length * std::floor(way / length);
        for (unsigned int i = 0; i < size(); ++i)
          {
            const double on = edge(i).norm();
            if (way <= on)
              return corners[i] + way / on * edge(i);
            way -= on;
          }
        return corners[0];
      }

      /** From a place on the line straight through the crack to the line again. */
      double depth(const Point<3> &p, const Tensor<1, 3> &ahead) const
      {
        constexpr double   slack   = 1e-9;
        const Tensor<1, 3> along   = cross_product_3d(ahead, normal);
        double             nearest = none;
        for (unsigned int i = 0; i < size(); ++i)
          {
            const Tensor<1, 3> a = corners[i] - p, b = a + edge(i);
            const double       left = along * a, right = along * b;
            if ((left < 0.) == (right < 0.))
              continue;
            const double back = -ahead * (a + left / (left - right) * (b - a));
            if (back > slack * length)
              nearest = std::min(nearest, back);
          }
        return nearest;
      }

      const std::vector<Point<3>> &corners;
      Tensor<1, 3>                 normal;
      double                       length = 0.;
    };


    bool used(const Scene<3> &scene, const types::boundary_id side)
    {
      const auto &conditions = scene.boundary_conditions;
      const auto  given      = [&](const types::boundary_id id) {
        return find_condition(conditions.displacement, id) != nullptr ||
               find_condition(conditions.traction, id) != nullptr;
      };
      return given(side) ||
             std::any_of(conditions.parts.begin(), conditions.parts.end(), [&](const Part &part) {
               return part.kind == Part::of_side && part.side == side && given(part.id);
             });
    }


    /** Nothing but its normal displacement is given on a side: no shear acts on it. */
    bool is_free_or_slides(const Scene<3> &scene, const unsigned int side)
    {
      const auto *const held = find_condition(scene.boundary_conditions.displacement, side);
      if (held == nullptr)
        return !used(scene, side);
      for (unsigned int d = 0; d < 3; ++d)
        if (held->values[d].has_value() != (d == side / 2))
          return false;
      return true;
    }
  } // namespace


  namespace
  {
    /** Finds rings about places of the front of one crack. */
    class FrontRoom
    {
    public:
      FrontRoom(const Scene<3>                   &scene,
                const std::vector<CrackPiece<3>> &pieces,
                const CrackPiece<3>              &piece,
                const double                      horizon)
        : scene(scene)
        , pieces(pieces)
        , piece(piece)
        , front(piece.corners)
        , lower(scene.domain.extra.body_lower)
        , upper(scene.domain.extra.body_upper)
        , horizon(horizon)
      {
        for (unsigned int d = 0; d < 3; ++d)
          ring = std::max(ring, n_cells * scene.domain.spacing()[d]);
      }

      std::vector<FrontPlace> places() const
      {
        std::vector<FrontPlace> list;
        const auto              keep = [&](const std::optional<FrontPlace> &place) {
          if (place)
            list.push_back(*place);
        };
        if (is_curved())
          for (const double part : {0., 0.25, 0.5, 0.75})
            keep(on_curve(part));
        else
          for (unsigned int i = 0; i < front.size(); ++i)
            if (in_body(front.middle(i)))
              {
                const auto place = on_edge(i);
                keep(place ? place : across_body(i));
              }
        return list;
      }

    private:
      static constexpr double n_cells = 3., // in a ring
        margin                        = 0.9;

      /** A plane of symmetry that goes through a place, straight across its front. */
      bool is_mirror(const unsigned int side, const Point<3> &p, const Tensor<1, 3> &along) const
      {
        constexpr double   slack    = 1e-6;
        const auto        &list     = scene.boundary_conditions.symmetry;
        const unsigned int d        = side / 2;
        const double       to_plane = side % 2 == 0 ? p[d] - lower[d] : upper[d] - p[d];
        return std::find(list.begin(), list.end(), side) != list.end() &&
               std::abs(to_plane) < slack * (upper[d] - lower[d]) &&
               std::abs(along[d]) > (1. - slack) * along.norm();
      }

      /** In the box or on its sides, to round-off. */
      bool is_within(const Point<3> &p) const
      {
        return room_to_sides(p, {}) > -1e-9 * (upper - lower).norm();
      }

      /** Not at its sides either, where a crack has no front. */
      bool in_body(const Point<3> &p) const
      {
        return room_to_sides(p, {}) > 1e-9 * (upper - lower).norm();
      }

      /** Edges in the body are many and short. */
      bool is_curved() const
      {
        constexpr double       part    = 0.1;
        constexpr unsigned int many    = 8;
        unsigned int           n_edges = 0;
        double                 longest = 0.;
        for (unsigned int i = 0; i < front.size(); ++i)
          if (in_body(front.middle(i)))
            {
              ++n_edges;
              longest = std::max(longest, front.edge(i).norm());
            }
        return n_edges >= many && longest < part * front.length;
      }

      /** @param but sides across this direction */
      double room_to_sides(const Point<3> &p, const std::optional<unsigned int> but) const
      {
        double room = none;
        for (unsigned int d = 0; d < 3; ++d)
          if (!but || d != *but)
            room = std::min({room, p[d] - lower[d], upper[d] - p[d]});
        return room;
      }

      /** To loads, holes and other cracks. */
      double room_to_others(const Point<3> &p) const
      {
        double room = std::min(scene.domain.holes.distance(p), distance_to_parts(scene, p));
        for (const CrackPiece<3> &other : pieces)
          if (other.crack != piece.crack)
            room = std::min(room, distance_to_piece(other.corners, p));
        return room;
      }

      /** To the other edges in the body. */
      double room_to_edges(const unsigned int edge) const
      {
        const Point<3> p    = front.middle(edge);
        double         room = none;
        for (unsigned int i = 0; i < front.size(); ++i)
          if (i != edge && in_body(front.middle(i)))
            {
              const Point<3> &a = front.corners[i];
              const double    part =
                std::clamp(front.edge(i) * (p - a) / front.edge(i).norm_square(), 0., 1.);
              room = std::min(room, p.distance(a + part * front.edge(i)));
            }
        return room;
      }

      FrontPlace start(const Point<3> &p, const Tensor<1, 3> &along, const std::string &name) const
      {
        FrontPlace place;
        place.name   = "crack " + std::to_string(piece.crack + 1) + " " + name;
        place.place  = p;
        place.ahead  = front.outward(along);
        place.normal = front.normal;
        return place;
      }

      /** Sets radii; false: there is no room. */
      bool set_radii(FrontPlace &place, const double outer) const
      {
        place.outer = outer;
        place.inner = std::max(0.5 * outer, horizon);
        return place.outer - place.inner >= ring;
      }

      /** As long as it is wide. @param others what it has to keep clear of, whole */
      bool set_size(FrontPlace &place, const double others) const
      {
        const Tensor<1, 3> along = cross_product_3d(place.ahead, place.normal);
        double             outer = std::min(0.5 * margin * front.depth(place.place, place.ahead),
                                margin * others / std::sqrt(2.));
        for (unsigned int side = 0; side < 6; ++side)
          {
            const unsigned int d = side / 2;
            const double to = side % 2 == 0 ? place.place[d] - lower[d] : upper[d] - place.place[d];
            if (is_mirror(side, place.place, along))
              place.is_mirrored = true;
            else
              outer = std::min(
                outer,
                margin * to / (std::hypot(place.ahead[d], place.normal[d]) + std::abs(along[d])));
          }
        if (place.curvature != 0.) // far from the axis of the circle
          outer = std::min(outer, 0.75 / std::abs(place.curvature));
        place.half = outer;
        return set_radii(place, outer);
      }

      /** Sets the share; false: the front is not where the place has it. */
      bool follows(FrontPlace &place) const
      {
        constexpr double       apart = 0.25; // of the inner radius
        constexpr unsigned int n     = 4000;
        Tensor<1, 3>           slope;
        for (unsigned int i = 0; i < front.size(); ++i)
          {
            const Tensor<1, 3> edge = front.edge(i), out = front.outward(edge);
            const unsigned int n_steps =
              1 + static_cast<unsigned int>(n * edge.norm() / front.length);
            for (unsigned int k = 0; k < n_steps; ++k)
              {
                const Point<3> p = front.corners[i] + (k + 0.5) / n_steps * edge;
                const auto     x = place.local(p);
                if (std::abs(x.x_1) > place.outer || std::abs(x.s) > place.half ||
                    !is_within(p)) // the other half of a ring, beyond a plane of symmetry
                  continue;
                if (std::abs(x.x_1) > apart * place.inner)
                  return false;
                place.share +=
                  place.weight_at(x, slope) * (x.axes[0] * out) * edge.norm() / n_steps;
              }
          }
        return place.share > 0.;
      }

      std::optional<FrontPlace> on_curve(const double part) const
      {
        constexpr double nearby = 1. / 16.;
        const Point<3>   p      = front.at(part * front.length);
        const Point<3>   before = front.at((part - nearby) * front.length),
                       behind   = front.at((part + nearby) * front.length);
        if (!is_within(p))
          return {};
        FrontPlace place = start(p, behind - before, "front " + number_text(part));
        // The circle through three points.
        place.curvature = 2. * (cross_product_3d(p - before, behind - p) * front.normal) /
                          (p.distance(before) * p.distance(behind) * before.distance(behind));
        return set_size(place, room_to_others(p)) && follows(place) ? std::optional(place) :
                                                                      std::nullopt;
      }

      std::optional<FrontPlace> on_edge(const unsigned int i) const
      {
        const Point<3> p     = front.middle(i);
        FrontPlace     place = start(p, front.edge(i), "edge " + std::to_string(i + 1));
        return set_size(place, std::min(room_to_edges(i), room_to_others(p))) && follows(place) ?
                 std::optional(place) :
                 std::nullopt;
      }

      /** The edge as a whole, along an axis from side to side. */
      std::optional<FrontPlace> across_body(const unsigned int i) const
      {
        constexpr double   slack = 1e-9;
        const Point<3>     p     = front.middle(i);
        const Point<3>    &a = front.corners[i], &b = front.corners[(i + 1) % front.size()];
        const Tensor<1, 3> along = front.edge(i) / front.edge(i).norm();
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double to = slack * (upper[d] - lower[d]);
            if (std::abs(along[d]) < 1. - slack || std::min(a[d], b[d]) > lower[d] + to ||
                std::max(a[d], b[d]) < upper[d] - to || !is_free_or_slides(scene, 2 * d) ||
                !is_free_or_slides(scene, 2 * d + 1))
              continue;
            FrontPlace   place = start(p, front.edge(i), "edge " + std::to_string(i + 1));
            const double room  = std::min({room_to_sides(p, d),
                                           room_to_others(p),
                                           room_to_edges(i),
                                           0.5 * front.depth(p, place.ahead)});
            place.share        = upper[d] - lower[d];
            return set_radii(place, margin * room) ? std::optional(place) : std::nullopt;
          }
        return {};
      }

      const Scene<3>                   &scene;
      const std::vector<CrackPiece<3>> &pieces;
      const CrackPiece<3>              &piece;
      Front                             front;
      Point<3>                          lower, upper;
      double                            horizon, ring = 0.;
    };
  } // namespace


  std::vector<FrontIntegral> crack_end_integrals(const Scene<3> &scene,
                                                 const double    time,
                                                 const double    horizon)
  {
    std::vector<FrontIntegral> list;
    const Material            &material = scene.material;
    const bool                 is_plate = scene.domain.shape == Shape::box ||
                          scene.domain.shape == Shape::plate_with_hole;
    if (!scene.elasticity.is_static() || !is_plate || !material.uniform_moduli())
      return list;
    const std::vector<CrackPiece<3>> pieces   = scene.cracks.pieces(time);
    const bool                       of_bonds = horizon > 0. && scene.elasticity.is_bond_based();
    const double                     core = std::max(2. * scene.domain.spacing().norm(), horizon);
    double                           cell = 0.;
    for (unsigned int d = 0; d < 3; ++d)
      cell = std::max(cell, scene.domain.spacing()[d]);
    for (const CrackPiece<3> &piece : pieces)
      for (const FrontPlace &place : FrontRoom(scene, pieces, piece, horizon).places())
        {
          Moduli moduli = material.moduli(place.place);
          if (of_bonds) // have the given bulk modulus (bond_law())
            moduli = moduli_from(Modulus::bulk,
                                 moduli.bulk,
                                 Modulus::poisson,
                                 bond_based_poisson(3, scene.elasticity.plane));
          list.emplace_back(place, core, cell, moduli);
        }
    return list;
  }
} // namespace PeriDeal
