// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/holes.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    struct PointOnRim
    {
      const Hole *hole;
      Point<2>    place;
    };


    /** The nearest points of a circle, or of each edge of a polygon. */
    std::vector<PointOnRim> nearest_on_rim(const Point<2> &p, const Hole &hole)
    {
      if (hole.corners.empty())
        return {{&hole, hole.point_on_rim(hole.place_on_rim(p))}};
      std::vector<PointOnRim> points;
      for (std::size_t i = 0; i < hole.corners.size(); ++i)
        {
          const Point<2>     a    = hole.corners[i];
          const Tensor<1, 2> edge = hole.corners[(i + 1) % hole.corners.size()] - a;
          points.push_back(
            {&hole, a + std::clamp((p - a) * edge / edge.norm_square(), 0., 1.) * edge});
        }
      return points;
    }


    /** The nearest point of the rims, of what of them lies in no other hole if there is any. */
    PointOnRim nearest_on_rims(const Point<2> &p, const std::vector<Hole> &holes, const double tiny)
    {
      PointOnRim nearest{};
      auto       least = std::make_pair(true, std::numeric_limits<double>::max());
      for (const Hole &hole : holes)
        for (const PointOnRim &point : nearest_on_rim(p, hole))
          {
            if (!least.first && p.distance(point.place) >= least.second)
              continue;
            const bool hidden = std::any_of(holes.begin(), holes.end(), [&](const Hole &other) {
              return &other != &hole && other.distance(point.place) < -tiny;
            });
            if (const auto found = std::make_pair(hidden, p.distance(point.place)); found < least)
              {
                nearest = point;
                least   = found;
              }
          }
      return nearest;
    }


    /**
     * Where the rim of a hole enters another one, along it from what is nearest to a point, in the
     * nearer direction and within a distance; the point if it does not.
     */
    Point<2> entry_from(const Point<2> &a, const Hole &hole, const Hole &other, const double within)
    {
      constexpr int n     = 64;
      const double  start = hole.place_on_rim(a);
      for (int k = 1; k <= n; ++k)
        for (const double direction : {1., -1.})
          if (double outside = (k - 1) * within / n, inside = k * within / n;
              other.contains(hole.point_on_rim(start + direction * inside)))
            {
              for (int halving = 0; halving < 50; ++halving)
                {
                  const double middle = 0.5 * (outside + inside);
                  const bool is_in = other.contains(hole.point_on_rim(start + direction * middle));
                  (is_in ? inside : outside) = middle;
                }
              return hole.point_on_rim(start + direction * outside);
            }
      return a;
    }


    /** Of a face what it has of the rims. */
    struct FaceShare
    {
      const RimFace &face;
      double        &rim;

      double distance(const Point<2> &p) const
      {
        const Tensor<1, 2> along = face.end - face.begin;
        const double       s     = (p - face.begin) * along / along.norm_square();
        return p.distance(face.begin + std::clamp(s, 0., 1.) * along);
      }
    };


    /**
     * Give the rim of a hole to faces, in pieces: each to the nearest of those whose outward normal
     * has its direction.
     * @param exists at a point, whether the body is there
     */
    template <typename Exists>
    void share_rim(const Hole                   &hole,
                   const Exists                 &exists,
                   const double                  longest_piece,
                   const std::vector<FaceShare> &shares)
    {
      std::vector<double> ends{0.};
      for (std::size_t i = 0; i < hole.corners.size(); ++i)
        ends.push_back(ends.back() +
                       hole.corners[i].distance(hole.corners[(i + 1) % hole.corners.size()]));
      if (hole.corners.empty())
        ends.push_back(hole.rim_length());
      for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        for (double k = 0., n = std::ceil((ends[i + 1] - ends[i]) / longest_piece); k < n; ++k)
          {
            double     a    = ends[i] + (ends[i + 1] - ends[i]) * k / n;
            double     b    = ends[i] + (ends[i + 1] - ends[i]) * (k + 1.) / n;
            const bool at_a = exists(hole.point_on_rim(a)), at_b = exists(hole.point_on_rim(b));
            if (!at_a && !at_b)
              continue;
            if (at_a != at_b)
              {
                double in = at_a ? a : b, out = at_a ? b : a;
                for (int halving = 0; halving < 50; ++halving)
                  {
                    const double middle                            = 0.5 * (in + out);
                    (exists(hole.point_on_rim(middle)) ? in : out) = middle;
                  }
                (at_a ? b : a) = in;
              }
            const double   middle = 0.5 * (a + b), aside = 1e-6 * longest_piece;
            const Point<2> p    = hole.point_on_rim(middle);
            Tensor<1, 2> inward = cross_product_2d(hole.point_on_rim(middle + 0.25 * (b - a)) - p);
            if (inward.norm() == 0.)
              continue;
            inward /= inward.norm();
            if (!hole.contains(p + aside * inward))
              inward *= -1.;
            const FaceShare *best  = nullptr;
            auto             least = std::make_pair(true, std::numeric_limits<double>::max());
            for (const FaceShare &share : shares)
              {
                const double same = share.face.outward * inward;
                // Of two at a corner the one that has more of the direction.
                if (const auto found =
                      std::make_pair(same < 1e-6, share.distance(p) - aside * same);
                    found < least)
                  {
                    best  = &share;
                    least = found;
                  }
              }
            if (best != nullptr)
              best->rim += b - a;
          }
    }
  } // namespace


  template <int dim>
  std::vector<double> Holes<dim>::rim_over_faces(const std::vector<RimFace> &faces,
                                                 const Point<2>             &lower,
                                                 const Point<2>             &upper) const
  {
    const std::vector<Hole>                 holes = all();
    std::vector<double>                     rims;               // what faces have of them
    std::vector<std::array<double, 2>>      ways(holes.size()); // along a rim, to and fro
    std::vector<std::array<std::size_t, 2>> hole_of;            // at both ends of a face
    double                                  shortest = std::numeric_limits<double>::max();
    for (const RimFace &face : faces)
      {
        const Point<2>  &a = face.begin, &b = face.end;
        const double     length = a.distance(b), tiny = 1e-9 * length;
        const PointOnRim from = nearest_on_rims(a, holes, tiny),
                         to   = nearest_on_rims(b, holes, tiny);
        shortest              = std::min(shortest, length);
        hole_of.push_back({{static_cast<std::size_t>(from.hole - holes.data()),
                            static_cast<std::size_t>(to.hole - holes.data())}});
        if (from.hole == to.hole)
          {
            const double whole = from.hole->rim_length();
            double way = from.hole->place_on_rim(to.place) - from.hole->place_on_rim(from.place);
            way -= std::round(way / whole) * whole;
            const bool forth = (way > 0.) == (cross_product_2d(b - a) * face.outward > 0.);
            ways[hole_of.back()[0]][forth ? 0 : 1] += std::abs(way);
          }
        if (a.distance(from.place) < tiny && b.distance(to.place) < tiny &&
            std::abs(from.hole->distance(a + 0.5 * (b - a))) < tiny)
          rims.push_back(length);
        else if (from.hole == to.hole)
          rims.push_back(from.hole->rim_between(from.place, to.place));
        else
          {
            const Point<2> joint = entry_from(from.place, *from.hole, *to.hole, 4. * length);
            rims.push_back(from.hole->rim_between(from.place, joint) +
                           to.hole->rim_between(joint, to.place));
          }
      }

    // Holes with joints, and where faces one after the other go to and fro along a rim: too thin or
    // sharp for that.
    std::vector<bool> is_sharp;
    for (std::size_t k = 0; k < holes.size(); ++k)
      is_sharp.push_back(std::min(ways[k][0], ways[k][1]) > 1e-9 * holes[k].rim_length() ||
                         std::any_of(listed.begin(), listed.end(), [&](const Hole &joint) {
                           return joint.text.empty() &&
                                  holes[k].distance(joint.corners[0] +
                                                    0.5 * (joint.corners[2] - joint.corners[0])) <
                                    0.501 * joint.corners[0].distance(joint.corners[2]);
                         }));
    for (bool any = true; any;)
      {
        any = false;
        for (const auto &[from, to] : hole_of)
          if (is_sharp[from] != is_sharp[to])
            is_sharp[from] = is_sharp[to] = any = true;
      }
    std::vector<FaceShare> shares;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (is_sharp[hole_of[f][0]])
        {
          rims[f] = 0.;
          shares.push_back({faces[f], rims[f]});
        }
    for (const Hole &hole : holes)
      if (is_sharp[&hole - holes.data()])
        share_rim(
          hole,
          [&](const Point<2> &p) {
            const double tiny = 1e-9 * shortest;
            for (unsigned int d = 0; d < 2; ++d)
              if (p[d] < lower[d] - tiny || p[d] > upper[d] + tiny)
                return false;
            return std::none_of(holes.begin(), holes.end(), [&](const Hole &other) {
              return &other != &hole && other.distance(p) < -tiny;
            });
          },
          shortest / 8.,
          shares);
    for (std::size_t f = 0; f < faces.size(); ++f)
      rims[f] /= faces[f].begin.distance(faces[f].end);
    return rims;
  }


  template std::vector<double> Holes<2>::rim_over_faces(const std::vector<RimFace> &,
                                                        const Point<2> &,
                                                        const Point<2> &) const;
  template std::vector<double> Holes<3>::rim_over_faces(const std::vector<RimFace> &,
                                                        const Point<2> &,
                                                        const Point<2> &) const;
} // namespace PeriDeal
