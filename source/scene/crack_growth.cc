// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// How cracks grow: the entries `Growth`, `Paths` and `Growth step` of section `Cracks`.

#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/cracks.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::string place(const Point<dim> &p)
    {
      std::string text = "(";
      for (unsigned int d = 0; d < dim; ++d)
        text += (d > 0 ? ", " : "") + number_text(p[d]);
      return text + ")";
    }


    const char *end_or_corner(const int dim)
    {
      return dim == 3 ? "corner" : "end point";
    }
  } // namespace


  template <int dim>
  void Cracks<dim>::declare_growth()
  {
    declare(
      "Growth",
      EntryType::list,
      "",
      "time, length/time",
      "Ends that move: `end point: start time, velocity`, and after another comma the time at which it stops; several "
      "separated by `;`. End points are counted from 1 through Segments, in 3D corners through Polygons, whose corners may move outwards "
      "in their plane. What has been cut stays cut. Elastic bodies find their equilibrium with the cracks as they are then; in motion cracks "
      "grow between two steps. Nodes join the zone `cracks` of `Models = coupled` as a crack comes near them.");
    declare(
      "Paths",
      EntryType::list,
      "",
      "time, length",
      "Ends that move from point to point: `end point: time, position | time, position | ...`; several separated by "
      "`;`. The first position is that of the end itself, which rests until then.");
    declare(
      "Bonds through tips",
      EntryType::choice,
      "auto",
      "",
      "Whether a bond that only touches a crack's tip is cut. `auto`: not with `Surface correction = energy`, else it is; each "
      "was measured to be the more accurate there. With `Physics = elasticity` bonds of `Scheme = exchange` without crack scaling are "
      "kept, all others cut. `in part`: bonds and removed cells about a tip lose a part of their stiffness, so that the crack is as long as "
      "given wherever in its cell its tip lies; with `Physics = elasticity` in 2D only, not on `faces` and not where cracks grow, heal or bonds break. "
      "Finite elements for diffusion always cut such pairs.",
      {"auto", "cut", "keep", "in part"});
    declare(
      "Growth step",
      EntryType::text,
      "",
      "length",
      "Farthest that a tip advances between two changes of the bonds; empty: a quarter of a node spacing. Bonds are cut "
      "too early or too late by at most the time that the tip needs for half of it.");
  }


  template <int dim>
  CrackTip<dim> Cracks<dim>::tip_of(const std::string &number, const std::string &entry) const
  {
    unsigned int n_points = 0;
    for (const auto &crack : cracks)
      n_points += crack.size();
    if (n_points == 0)
      error(entry, "there is no crack that could grow; give 'Segments' or, in 3D, 'Polygons'.");
    const unsigned int k = parse_whole_number(number, where(entry));
    if (k == 0 || k > n_points)
      error(entry,
            std::string("there is no ") + end_or_corner(dim) + " " + number +
              "; they are numbered from 1 to " + std::to_string(n_points) + ".");
    CrackTip<dim> tip;
    tip.corner  = k - 1;
    tip.by_path = entry == "Paths";
    for (tip.crack = 0; tip.corner >= cracks[tip.crack].size(); ++tip.crack)
      tip.corner -= cracks[tip.crack].size();
    for (const CrackTip<dim> &other : tips)
      if (other.crack == tip.crack && other.corner == tip.corner)
        error(entry,
              std::string(end_or_corner(dim)) + " " + number +
                " is named twice in 'Growth' and 'Paths'.");
    return tip;
  }


  template <int dim>
  void Cracks<dim>::parse_growth()
  {
    growth_step = -1.;
    if (!text("Growth step").empty())
      {
        growth_step = parse_number(text("Growth step"), where("Growth step"));
        if (!(growth_step > 0.))
          error("Growth step",
                "found " + text("Growth step") + ", needs a length greater than 0 (or nothing).");
      }
    for (const std::string &item : split_list(text("Growth"), ';'))
      {
        const auto [number, value] = name_and_value(item, where("Growth"));
        CrackTip<dim>     tip      = tip_of(number, "Growth");
        const std::size_t n_given  = split_list(value, ',').size();
        if (n_given != dim + 1 && n_given != dim + 2)
          error("Growth",
                "'" + item + "' needs a start time and " + std::to_string(dim) +
                  " components of a velocity, and may name the time at which the tip stops.");
        const std::vector<double> x =
          parse_numbers(value, static_cast<unsigned int>(n_given), "numbers", where("Growth"));
        Tensor<1, dim> velocity;
        for (unsigned int d = 0; d < dim; ++d)
          velocity[d] = x[d + 1];
        const Point<dim> start = cracks[tip.crack][tip.corner];
        tip.path               = {{x[0], start}};
        refuse(x[0] < 0., "Growth", "'" + item + "' starts before t = 0.");
        refuse(velocity.norm() == 0., "Growth", "'" + item + "' has no velocity.");
        if (n_given == dim + 2)
          {
            refuse(!(x[dim + 1] > x[0]), "Growth", "'" + item + "' stops before it starts.");
            tip.path.emplace_back(x[dim + 1], start + (x[dim + 1] - x[0]) * velocity);
          }
        else
          tip.last_velocity = velocity;
        tips.push_back(tip);
      }
  }


  template <int dim>
  void Cracks<dim>::let_grow(const unsigned int    crack,
                             const unsigned int    corner,
                             const Tensor<1, dim> &velocity,
                             const double          from,
                             const double          to)
  {
    AssertIndexRange(crack, cracks.size());
    AssertIndexRange(corner, cracks[crack].size());
    const Point<dim> start = cracks[crack][corner];
    CrackTip<dim>    tip{crack, corner, {{from, start}}, {}, false};
    tip.path.emplace_back(to, start + (to - from) * velocity);
    tips.push_back(tip);
    end_time = std::max(end_time, to);
  }


  template <int dim>
  void Cracks<dim>::parse_paths()
  {
    for (const std::string &item : split_list(text("Paths"), ';'))
      {
        const auto [number, value] = name_and_value(item, where("Paths"));
        CrackTip<dim>    tip       = tip_of(number, "Paths");
        const Point<dim> start     = cracks[tip.crack][tip.corner];
        for (const std::string &stop : split_list(value, '|'))
          {
            const std::vector<double> x =
              parse_numbers(stop, dim + 1, "numbers (a time and a position)", where("Paths"));
            Point<dim> p;
            for (unsigned int d = 0; d < dim; ++d)
              p[d] = x[d + 1];
            if (tip.path.empty() && p.distance(start) > 1e-9 * (1. + start.norm()))
              error("Paths",
                    "the path of " + std::string(end_or_corner(dim)) + " " + number +
                      " begins at " + place(p) + ", but that lies at " + place(start) + ".");
            if (x[0] < 0. || (!tip.path.empty() && !(x[0] > tip.path.back().first)))
              error("Paths",
                    "the times of " + std::string(end_or_corner(dim)) + " " + number +
                      " have to ascend from 0 or later; found " + number_text(x[0]) + ".");
            tip.path.emplace_back(x[0], tip.path.empty() ? start : p);
          }
        if (tip.path.size() < 2)
          error("Paths",
                "'" + item +
                  "' names no position to go to: give at least two pairs of time and position.");
        tips.push_back(tip);
      }
  }


  template <int dim>
  void Cracks<dim>::tip_error(const CrackTip<dim> &tip, const std::string &what) const
  {
    unsigned int number = tip.corner + 1;
    for (unsigned int crack = 0; crack < tip.crack; ++crack)
      number += cracks[crack].size();
    error(tip.by_path ? "Paths" : "Growth",
          std::string(end_or_corner(dim)) + " " + std::to_string(number) + " " + what);
  }


  template <int dim>
  void Cracks<dim>::check_tips() const
  {
    std::vector<double> stops; // of all tips
    for (const CrackTip<dim> &tip : tips)
      for (const auto &[time, point] : tip.path)
        stops.push_back(time);
    if (stops.empty())
      return;
    std::sort(stops.begin(), stops.end());
    stops.push_back(stops.back() + 1.);
    if (dim == 3)
      check_polygons(stops);
    else
      check_turns(stops.back());
  }


  template <int dim>
  void Cracks<dim>::check_turns(const double last) const
  {
    // On a way back the left side would be the other one.
    const std::vector<CrackPiece<dim>> line = crack_pieces(cracks, tips, last);
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      {
        if (line[k].crack != line[k + 1].crack)
          continue;
        const Point<dim>    &turn   = line[k].corners[1];
        const Tensor<1, dim> before = turn - line[k].corners[0],
                             next   = line[k + 1].corners[1] - turn;
        if ((before / before.norm() + next / next.norm()).norm() > 1e-9)
          continue;
        for (const CrackTip<dim> &tip : tips)
          if (tip.crack == line[k].crack &&
              std::any_of(tip.path.begin(), tip.path.end(), [&](const auto &stop) {
                return stop.second == turn;
              }))
            tip_error(tip,
                      "turns back at " + place(turn) +
                        " along its own crack; cracks grow, they do not heal.");
      }
  }


  template <int dim>
  void Cracks<dim>::check_polygons(const std::vector<double> &stops) const
  {
    for (const CrackTip<dim> &tip : tips)
      {
        const CrackGeometry<dim> start(cracks[tip.crack]);
        const auto               off_plane = [&](const Tensor<1, dim> &way) {
          return std::abs(way * start.normal()) > 1e-9 * way.norm();
        };
        bool leaves = off_plane(tip.last_velocity);
        for (std::size_t k = 1; k < tip.path.size(); ++k)
          leaves = leaves || off_plane(tip.path[k].second - tip.path[k - 1].second);
        if (leaves)
          tip_error(tip, "leaves the plane of its polygon.");
        // A polygon whose corners move outwards holds all it has ever been.
        for (std::size_t k = 0; k + 1 < stops.size(); ++k)
          {
            const auto later = crack_pieces(cracks, tips, stops[k + 1]);
            if (!CrackGeometry<dim>(later[tip.crack].corners).contains(tip.at(stops[k])))
              tip_error(tip, "moves into its polygon; cracks grow, they do not heal.");
          }
      }
  }


  template <int dim>
  bool Cracks<dim>::change() const
  {
    return !tips.empty() || (!cracks.empty() && transmission.depends_on_time());
  }


  template <int dim>
  bool Cracks<dim>::conduct() const
  {
    return !transmission.is_constant() || transmission.value(Point<dim>()) > 0. ||
           contact_conductance > 0.;
  }


  template <int dim>
  std::vector<CrackPiece<dim>> Cracks<dim>::pieces(const double t, const bool cut_at_tips) const
  {
    auto pieces = crack_pieces(cracks, tips, t);
    for (CrackPiece<dim> &piece : pieces)
      {
        const std::size_t n = piece.corners.size();
        piece.closed.assign(n, cut_at_tips || !in_box);
        for (std::size_t i = 0; i < n && in_box; ++i)
          for (unsigned int side = 0; side < 2 * dim; ++side)
            if (on_side(piece.corners[i], side) &&
                (dim == 2 || on_side(piece.corners[(i + 1) % n], side)))
              piece.closed[i] = true;
      }
    return pieces;
  }


  template <int dim>
  bool Cracks<dim>::cuts_bonds_at_tips(const SurfaceCorrection correction) const
  {
    return through_tips == ThroughTips::cut ||
           (through_tips == ThroughTips::automatic && correction != SurfaceCorrection::energy);
  }


  template <int dim>
  void Cracks<dim>::set_box(const Point<dim> &lower, const Point<dim> &upper)
  {
    lowest  = lower;
    highest = upper;
    in_box  = true;
  }


  template <int dim>
  bool Cracks<dim>::on_side(const Point<dim> &p, const unsigned int side) const
  {
    const unsigned int d = side / 2;
    const double       x = side % 2 == 0 ? lowest[d] : highest[d];
    return std::abs(p[d] - x) <= 1e-9 * (highest[d] - lowest[d]);
  }


  template <int dim>
  void Cracks<dim>::check_tips_inside(const Point<dim> &lower,
                                      const Point<dim> &upper,
                                      const double      end_time) const
  {
    const auto is_inside = [&](const Point<dim> &p) {
      for (unsigned int d = 0; d < dim; ++d)
        if (p[d] < lower[d] - 1e-9 * (upper[d] - lower[d]) ||
            p[d] > upper[d] + 1e-9 * (upper[d] - lower[d]))
          return false;
      return true;
    };
    for (const CrackTip<dim> &tip : tips)
      {
        std::vector<double> times;
        for (const auto &[time, point] : tip.path)
          if (time < end_time)
            times.push_back(time);
        times.push_back(end_time);
        for (const double t : times)
          if (!is_inside(tip.at(t)))
            tip_error(
              tip,
              "has left the body at t = " + number_text(t) + ", where it is at " +
                place(tip.at(t)) +
                ". Let it stop before: a fourth number in 'Growth' (3D: a fifth) is the time at which it does.");
      }
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template bool          Cracks<dim>::cuts_bonds_at_tips(const SurfaceCorrection) const;           \
  template void          Cracks<dim>::declare_growth();                                            \
  template CrackTip<dim> Cracks<dim>::tip_of(const std::string &, const std::string &) const;      \
  template void          Cracks<dim>::parse_growth();                                              \
  template void          Cracks<dim>::parse_paths();                                               \
  template void          Cracks<dim>::let_grow(const unsigned int,                                 \
                                      const unsigned int,                                 \
                                      const Tensor<1, dim> &,                             \
                                      const double,                                       \
                                      const double);                                      \
  template void          Cracks<dim>::tip_error(const CrackTip<dim> &, const std::string &) const; \
  template void          Cracks<dim>::check_tips() const;                                          \
  template void          Cracks<dim>::check_turns(const double) const;                             \
  template void          Cracks<dim>::check_polygons(const std::vector<double> &) const;           \
  template bool          Cracks<dim>::change() const;                                              \
  template bool          Cracks<dim>::conduct() const;                                             \
  template void          Cracks<dim>::set_box(const Point<dim> &, const Point<dim> &);             \
  template std::vector<CrackPiece<dim>> Cracks<dim>::pieces(const double, const bool) const;       \
  template void                         Cracks<dim>::check_tips_inside(const Point<dim> &,         \
                                               const Point<dim> &,         \
                                               const double) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
