// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/base/clipped.h>
#include <perideal/base/instantiate.h>
#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/cracks.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

// How cracks grow: the entries `Growth`, `Paths` and `Growth step` of section `Cracks`.

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** "crack 2 (0,0 ; 1,0)" */
    template <int dim>
    std::string crack_name(const unsigned int index, const std::vector<Point<dim>> &crack)
    {
      constexpr unsigned int few = 8, shown = 3; // corners; of a disc there are many
      const unsigned int     n    = crack.size() > few ? shown : crack.size();
      std::string            name = "crack " + std::to_string(index + 1) + " (";
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          name += (d > 0 ? "," : i > 0 ? " ; " : "") + number_text(crack[i][d]);
      if (n < crack.size())
        name += " ; ... " + std::to_string(crack.size()) + " corners";
      return name + ")";
    }


    /** What is wrong with the shape of a polygon, or nothing. */
    std::string polygon_fault(const std::vector<Point<3>> &corners)
    {
      double size = 0.;
      for (unsigned int i = 0; i < corners.size(); ++i)
        for (unsigned int j = 0; j < i; ++j)
          {
            size = std::max(size, corners[i].distance(corners[j]));
            if (corners[i] == corners[j])
              return "has the same corner twice";
          }
      Tensor<1, 3> normal = doubled_area_vector(corners);
      if (normal.norm() <= 1e-12 * size * size)
        return "has no area";
      normal /= normal.norm();
      for (const Point<3> &corner : corners)
        if (std::abs((corner - corners[0]) * normal) > 1e-9 * size)
          return "is not planar";
      return "";
    }


    const char *end_or_corner(const int dim)
    {
      return dim == 3 ? "corner" : "end point";
    }


    bool is_disc(const std::string &piece)
    {
      const std::size_t colon = piece.find(':');
      return colon != std::string::npos && trimmed(piece.substr(0, colon)) == "disc";
    }


    /** Corners of a polygon in place of a circle. */
    template <int dim>
    std::vector<Point<dim>> disc(const std::string &piece, const std::string &where)
    {
      constexpr unsigned int    n  = 96;
      const double              pi = std::acos(-1.);
      const std::string         at = where + ", disc";
      const std::vector<double> c  = parse_numbers(name_and_value(piece, where).second,
                                                  7,
                                                  "numbers (centre, normal, radius)",
                                                  at);
      const Point<3>            center(c[0], c[1], c[2]);
      Tensor<1, 3>              normal({c[3], c[4], c[5]});
      if (!(normal.norm() > 0.))
        entry_error(at, "the normal has no direction: it is 0, 0, 0.");
      if (!(c[6] > 0.))
        entry_error(at, "the radius is " + number_text(c[6]) + ", needs one greater than 0.");
      normal /= normal.norm();
      // The axis that is least along the normal makes the first direction in the plane.
      unsigned int axis = 0;
      for (unsigned int d = 1; d < 3; ++d)
        if (std::abs(normal[d]) < std::abs(normal[axis]))
          axis = d;
      Tensor<1, 3> first = -normal[axis] * normal;
      first[axis] += 1.;
      first /= first.norm();
      const Tensor<1, 3>      second = cross_product_3d(normal, first);
      const double            radius = c[6] * std::sqrt(2. * pi / n / std::sin(2. * pi / n));
      std::vector<Point<dim>> corners(n);
      for (unsigned int k = 0; k < n; ++k)
        {
          const double   angle = 2. * pi * k / n;
          const Point<3> p = center + radius * (std::cos(angle) * first + std::sin(angle) * second);
          corners[k]       = point_of<dim>(p.begin_raw());
        }
      return corners;
    }
  } // namespace


  template <int dim>
  Cracks<dim>::Cracks()
    : SceneSection("Cracks")
  {
    declare("Segments", EntryType::list, "", "length") =
      "2D: `start ; end ; start ; end ; ...`, two points a crack.";
    declare("Polygons", EntryType::list, "", "length") =
      "3D: `corner ; corner ; corner ...`, the next polygon after `|`. Each must be planar. A penny-shaped crack is `disc: centre, normal, radius`, seven numbers: a regular "
      "polygon of 96 corners with the area of the circle, seen counterclockwise from where the normal points to.";
    declare("Interfaces", EntryType::list) =
      "Of a mesh file: lines (in 3D surfaces) between its cells that are cracks, by the names "
      "or numbers of their physical groups, several separated by `;`. They are cut into the "
      "mesh as with `Mesh = faces`.";
    declare(mesh, "Mesh", "auto", {"pairs", "faces", "removed", "auto"}) =
      "What finite elements and the mesh do with a crack: in cut cells the conductances of the "
      "node "
      "pairs that the crack does not separate; the crack lies on cell faces, which are doubled; "
      "or cut cells conduct nothing. `auto`: pairs; with `Physics = elasticity`, where pairs are not defined, faces for cracks in 2D that run along the axes and lie still, where bonds do not break and faces do not press on each other, else removed.";
    declare(nodes_on_cracks, "Nodes on cracks", "avoid", {"avoid", "left"}) =
      "A crack that runs along a row of nodes of the lattice: `avoid` takes up to three `Cells` more or fewer across it, with which it runs "
      "between rows; a note says so. `left`: nodes exactly on a crack belong to its left side, so that it acts half a cell beside its "
      "place. Meshes from files, images and lattices with `Coarsening` or `Extra layers` keep their cells.";
    declare("Transmission", EntryType::formula, "0", "1") =
      "Fraction that a cut bond still conducts, from 0 (insulated) to 1 (intact), or a formula of t: a crack that closes "
      "conducts again. A contact "
      "conductance H corresponds to t/(1-t) = H delta/(C kappa), C about 1.9 (horizon ratio "
      "2) to 2.4 "
      "(horizon ratio 3).";
    declare_if_given(contact_conductance,
                     "Contact conductance",
                     "",
                     "power/(area temperature)",
                     Bounds::not_negative.saying("a number of 0 or more")) =
      "Heat flux through the crack per difference of temperature, instead of Transmission.";
    declare("Growth", EntryType::list, "", "time, length/time") =
      "Ends that move: `end point: start time, velocity`, and after another comma the time at which it stops; several "
      "separated by `;`. End points are counted from 1 through Segments, in 3D corners through Polygons, whose corners may move outwards "
      "in their plane. What has been cut stays cut. Elastic bodies find their equilibrium with the cracks as they are then; in motion cracks "
      "grow between two steps. Nodes join the zone `cracks` of `Models = coupled` as a crack comes near them.";
    declare("Paths", EntryType::list, "", "time, length") =
      "Ends that move from point to point: `end point: time, position | time, position | ...`; several separated by "
      "`;`. The first position is that of the end itself, which rests until then.";
    declare(through_tips, "Bonds through tips", "auto", {"auto", "cut", "keep", "in part"}) =
      "Whether a bond that only touches a crack's tip is cut. `auto`: not with `Surface correction = energy`, else it is; each "
      "was measured to be the more accurate there. With `Physics = elasticity` bonds of `Scheme = exchange` without crack scaling are "
      "kept, all others cut. `in part`: bonds and removed cells about a tip lose a part of their stiffness, so that the crack is as long as "
      "given wherever in its cell its tip lies; with `Physics = elasticity` in 2D only, not on `faces` and not where cracks grow, heal or bonds break. "
      "Finite elements for diffusion always cut such pairs.";
    declare_if_given(growth_step, "Growth step", "", "length", Bounds::length) =
      "Farthest that a tip advances between two changes of the bonds; empty: a quarter of a node spacing. Bonds are cut "
      "too early or too late by at most the time that the tip needs for half of it.";
    parse();
  }


  template <int dim>
  void Cracks<dim>::parse_corners()
  {
    const std::string lines = "Segments", planes = "Polygons";
    if (!text(lines).empty() && dim != 2)
      error(lines,
            dim == 1 ? "cracks need 'Dimension' 2 or 3." :
                       "segments are cracks of 2D bodies; in 3D give 'Polygons'.");
    const std::vector<Point<dim>> points = parse_points<dim>(text(lines), where(lines));
    refuse(points.size() % 2 != 0,
           lines,
           "each crack needs two points (start ; end), found " + std::to_string(points.size()) +
             " points.");
    for (unsigned int i = 0; i < points.size(); i += 2)
      cracks.push_back({points[i], points[i + 1]});
    if (!text(planes).empty() && dim != 3)
      error(planes,
            dim == 1 ? "cracks need 'Dimension' 2 or 3." :
                       "polygons are cracks of 3D bodies; in 2D give 'Segments'.");
    for (const std::string &piece : split_list(text(planes), '|'))
      {
        const std::vector<Point<dim>> corners = is_disc(piece) ?
                                                  disc<dim>(piece, where(planes)) :
                                                  parse_points<dim>(piece, where(planes));
        const std::string name = crack_name(static_cast<unsigned int>(cracks.size()), corners);
        refuse(corners.size() < 3,
               planes,
               name + " needs three or more corners, found " + std::to_string(corners.size()) +
                 ".");
        if constexpr (dim == 3)
          if (const std::string fault = polygon_fault(corners); !fault.empty())
            error(planes, name + " " + fault + ".");
        cracks.push_back(corners);
      }
  }


  template <int dim>
  void Cracks<dim>::parse(const Physics physics)
  {
    cracks.clear();
    tips.clear();
    parse_corners();
    SceneSection::parse();
    if (mesh == CrackMesh::automatic && physics != Physics::elasticity)
      mesh = CrackMesh::pairs; // of solids the scene decides (lay_cracks_on_faces())
    parse_conductance();
    parse_growth();
    parse_paths();
    std::vector<double> stops; // of all tips
    for (const CrackTip<dim> &tip : tips)
      for (const auto &[time, point] : tip.path)
        stops.push_back(time);
    if (!stops.empty())
      {
        std::sort(stops.begin(), stops.end());
        stops.push_back(stops.back() + 1.);
        if (dim == 3)
          check_polygons(stops);
        else
          check_turns(stops.back());
      }
    for (unsigned int i = 0; i < cracks.size() && dim == 2; ++i)
      if (cracks[i][0] == cracks[i][1] && !grows(i))
        error("Segments",
              crack_name(i, cracks[i]) + " has no length, and no end of it grows ('Growth').");
    if (physics != Physics::elasticity && conduct() &&
        (mesh == CrackMesh::removed || (mesh == CrackMesh::faces && contact_conductance < 0.)))
      error("Mesh",
            std::string(mesh == CrackMesh::faces ?
                          "'faces' cuts the body along the crack, which then transmits nothing" :
                          "with 'removed' the cells along the crack conduct nothing") +
              "; with '" + (contact_conductance > 0. ? "Contact conductance" : "Transmission") +
              "' greater than 0 use 'pairs'" +
              (mesh == CrackMesh::faces ? ", or give a 'Contact conductance'." : "."));
    refuse(physics == Physics::elasticity && mesh == CrackMesh::pairs && !cracks.empty(),
           "Mesh",
           "'pairs' is for diffusion; with 'Physics = elasticity' use 'removed' or 'faces'.");
    refuse(physics == Physics::elasticity && conduct(),
           contact_conductance < 0. ? "Transmission" : "Contact conductance",
           "is for diffusion; cracks transmit no force with 'Physics = elasticity'.");
    if (mesh == CrackMesh::faces && !tips.empty())
      error("Mesh",
            std::string(
              "'faces' cuts the cracks into the mesh before the run; for cracks that grow use ") +
              (physics == Physics::elasticity ? "'removed'." : "'pairs' or 'removed'."));
  }


  template <int dim>
  void Cracks<dim>::parse_conductance()
  {
    transmission = Expression(text("Transmission"), where("Transmission"), "t");
    if (transmission.depends_on_position())
      error("Transmission",
            "found '" + text("Transmission") + "'; it may change with the time t only.");
    const double now = transmission.value(Point<dim>());
    if (now < 0. || now > 1.)
      error("Transmission",
            "found " + text("Transmission") +
              (transmission.is_constant() ? "" : ", which is " + number_text(now) + " at t = 0") +
              ", needs a number from 0 to 1.");
    refuse(contact_conductance >= 0. && (!transmission.is_constant() || now != 0.),
           "Contact conductance",
           "'Transmission' is given, too: give one of the two.");
  }


  template <int dim>
  double Cracks<dim>::distance_to_side(const types::boundary_id side) const
  {
    const unsigned int axis    = side / 2;
    double             nearest = std::numeric_limits<double>::max();
    for (const CrackPiece<dim> &piece : pieces(end_time))
      for (const Point<dim> &p : piece.corners)
        nearest =
          std::min(nearest, side % 2 == 0 ? p[axis] - lowest[axis] : highest[axis] - p[axis]);
    return nearest;
  }


  template <int dim>
  bool Cracks<dim>::grows(const unsigned int crack) const
  {
    return std::any_of(tips.begin(), tips.end(), [&](const CrackTip<dim> &tip) {
      return tip.crack == crack;
    });
  }


  template <int dim>
  void Cracks<dim>::check_inside() const
  {
    for (unsigned int i = 0; i < cracks.size(); ++i)
      if (clipped_to_box(cracks[i], lowest, highest).empty() && !grows(i))
        error(dim == 2 ? "Segments" : "Polygons",
              crack_name(i, cracks[i]) + " lies outside the body.");
    const auto is_inside = [&](const Point<dim> &p) {
      for (unsigned int d = 0; d < dim; ++d)
        if (p[d] < lowest[d] - 1e-9 * (highest[d] - lowest[d]) ||
            p[d] > highest[d] + 1e-9 * (highest[d] - lowest[d]))
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
                point_text(tip.at(t)) +
                ". Let it stop before: a fourth number in 'Growth' (3D: a fifth) is the time at which it does.");
      }
  }


  template <int dim>
  std::vector<std::string> Cracks<dim>::parts_outside(const Point<dim> &lower,
                                                      const Point<dim> &upper) const
  {
    constexpr double slack = 0.01; // of the body: cracks are drawn across its edge to be sure
    std::vector<std::string> found;
    for (unsigned int i = 0; i < cracks.size(); ++i)
      {
        double farthest = 0.;
        for (const Point<dim> &p : cracks[i])
          for (unsigned int d = 0; d < dim; ++d)
            farthest = std::max(farthest,
                                std::max(lower[d] - p[d], p[d] - upper[d]) / (upper[d] - lower[d]));
        if (farthest > slack)
          found.push_back(crack_name(i, cracks[i]) + " ('" + (dim == 2 ? "Segments" : "Polygons") +
                          "' in section 'Cracks') reaches out of the body, by " +
                          number_text(std::round(1000. * farthest) / 10.) +
                          " % of its extent. What is outside has no effect; check its corners.");
      }
    return found;
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
        const Tensor<1, dim> velocity = point_of<dim>(x.data() + 1);
        const Point<dim>     start    = cracks[tip.crack][tip.corner];
        tip.path                      = {{x[0], start}};
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
            const Point<dim> p = point_of<dim>(x.data() + 1);
            if (tip.path.empty() && p.distance(start) > 1e-9 * (1. + start.norm()))
              error("Paths",
                    "the path of " + std::string(end_or_corner(dim)) + " " + number +
                      " begins at " + point_text(p) + ", but that lies at " + point_text(start) +
                      ".");
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
                      "turns back at " + point_text(turn) +
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
  bool Cracks<dim>::on_side(const Point<dim> &p, const unsigned int side) const
  {
    const unsigned int d = side / 2;
    const double       x = side % 2 == 0 ? lowest[d] : highest[d];
    return std::abs(p[d] - x) <= 1e-9 * (highest[d] - lowest[d]);
  }


  PERIDEAL_INSTANTIATE_CLASS(class Cracks);
} // namespace PeriDeal
