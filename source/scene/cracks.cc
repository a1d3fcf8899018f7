// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/base/clipped.h>
#include <perideal/scene/cracks.h>
#include <perideal/scene/known_variables.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
      Tensor<1, 3> normal; // twice the vector area
      for (unsigned int i = 1; i + 1 < corners.size(); ++i)
        normal += cross_product_3d(corners[i] - corners[0], corners[i + 1] - corners[0]);
      if (normal.norm() <= 1e-12 * size * size)
        return "has no area";
      normal /= normal.norm();
      for (const Point<3> &corner : corners)
        if (std::abs((corner - corners[0]) * normal) > 1e-9 * size)
          return "is not planar";
      return "";
    }
  } // namespace


  namespace
  {
    const std::string disc_word = "disc";


    bool is_disc(const std::string &piece)
    {
      const std::size_t colon = piece.find(':');
      return colon != std::string::npos && trimmed(piece.substr(0, colon)) == disc_word;
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
          for (unsigned int d = 0; d < dim; ++d)
            corners[k][d] = p[d];
        }
      return corners;
    }
  } // namespace


  template <int dim>
  Cracks<dim>::Cracks()
    : SceneSection("Cracks")
  {
    declare("Segments",
            EntryType::list,
            "",
            "length",
            "2D: `start ; end ; start ; end ; ...`, two points a crack.");
    declare(
      "Polygons",
      EntryType::list,
      "",
      "length",
      "3D: `corner ; corner ; corner ...`, the next polygon after `|`. Each must be planar. A penny-shaped crack is `disc: centre, normal, radius`, seven numbers: a regular "
      "polygon of 96 corners with the area of the circle, seen counterclockwise from where the normal points to.");
    declare(
      "Interfaces",
      EntryType::list,
      "",
      "",
      "Of a mesh file: lines (in 3D surfaces) between its cells that are cracks, by the names "
      "or numbers of their physical groups, several separated by `;`. They are cut into the "
      "mesh as with `Mesh = faces`.");
    declare(
      "Mesh",
      EntryType::choice,
      "auto",
      "",
      "What finite elements and the mesh do with a crack: in cut cells the conductances of the "
      "node "
      "pairs that the crack does not separate; the crack lies on cell faces, which are doubled; "
      "or cut cells conduct nothing. `auto`: pairs; with `Physics = elasticity`, where pairs are not defined, faces for cracks in 2D that run along the axes and lie still, where bonds do not break and faces do not press on each other, else removed.",
      {"pairs", "faces", "removed", "auto"});
    declare(
      "Nodes on cracks",
      EntryType::choice,
      "avoid",
      "",
      "A crack that runs along a row of nodes of the lattice: `avoid` takes up to three `Cells` more or fewer across it, with which it runs "
      "between rows; a note says so. `left`: nodes exactly on a crack belong to its left side, so that it acts half a cell beside its "
      "place. Meshes from files, images and lattices with `Coarsening` or `Extra layers` keep their cells.",
      {"avoid", "left"});
    declare(
      "Transmission",
      EntryType::formula,
      "0",
      "1",
      "Fraction that a cut bond still conducts, from 0 (insulated) to 1 (intact), or a formula of t: a crack that closes "
      "conducts again. A contact "
      "conductance H corresponds to t/(1-t) = H delta/(C kappa), C about 1.9 (horizon ratio "
      "2) to 2.4 "
      "(horizon ratio 3).");
    declare("Contact conductance",
            EntryType::text,
            "",
            "power/(area temperature)",
            "Heat flux through the crack per difference of temperature, instead of Transmission.");
    declare_growth();
  }


  template <int dim>
  void Cracks<dim>::parse_segments()
  {
    if (text("Segments").empty())
      return;
    if (dim != 2)
      error("Segments",
            dim == 1 ? "cracks need 'Dimension' 2 or 3." :
                       "segments are cracks of 2D bodies; in 3D give 'Polygons'.");
    const std::vector<Point<dim>> points = parse_points<dim>(text("Segments"), where("Segments"));
    if (points.size() % 2 != 0)
      error("Segments",
            "each crack needs two points (start ; end), found " + std::to_string(points.size()) +
              " points.");
    for (unsigned int i = 0; i < points.size(); i += 2)
      cracks.push_back({points[i], points[i + 1]});
  }


  template <int dim>
  void Cracks<dim>::parse_polygons()
  {
    if (text("Polygons").empty())
      return;
    if (dim != 3)
      error("Polygons",
            dim == 1 ? "cracks need 'Dimension' 2 or 3." :
                       "polygons are cracks of 3D bodies; in 2D give 'Segments'.");
    for (const std::string &piece : split_list(text("Polygons"), '|'))
      {
        const std::vector<Point<dim>> corners = is_disc(piece) ?
                                                  disc<dim>(piece, where("Polygons")) :
                                                  parse_points<dim>(piece, where("Polygons"));
        const std::string name = crack_name(static_cast<unsigned int>(cracks.size()), corners);
        if (corners.size() < 3)
          error("Polygons",
                name + " needs three or more corners, found " + std::to_string(corners.size()) +
                  ".");
        if constexpr (dim == 3)
          {
            const std::string fault = polygon_fault(corners);
            refuse(!fault.empty(), "Polygons", name + " " + fault + ".");
          }
        cracks.push_back(corners);
      }
  }


  template <int dim>
  void Cracks<dim>::parse(const Physics physics)
  {
    cracks.clear();
    tips.clear();
    parse_segments();
    parse_polygons();
    mesh = choice<CrackMesh>("Mesh");
    if (mesh == CrackMesh::automatic && physics != Physics::elasticity)
      mesh = CrackMesh::pairs; // of solids the scene decides (lay_cracks_on_faces())
    through_tips    = choice<ThroughTips>("Bonds through tips");
    nodes_on_cracks = choice<NodesOnCracks>("Nodes on cracks");
    parse_conductance();
    parse_growth();
    parse_paths();
    check_tips();
    for (unsigned int i = 0; i < cracks.size() && dim == 2; ++i)
      if (cracks[i][0] == cracks[i][1] &&
          std::none_of(tips.begin(), tips.end(), [&](const auto &tip) { return tip.crack == i; }))
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
    const KnownVariables known("t");
    transmission = Expression(text("Transmission"), where("Transmission"));
    if (transmission.depends_on_position())
      error("Transmission",
            "found '" + text("Transmission") + "'; it may change with the time t only.");
    const double now = transmission.value(Point<dim>());
    if (now < 0. || now > 1.)
      error("Transmission",
            "found " + text("Transmission") +
              (transmission.is_constant() ? "" : ", which is " + number_text(now) + " at t = 0") +
              ", needs a number from 0 to 1.");
    contact_conductance = -1.;
    if (text("Contact conductance").empty())
      return;
    if (!transmission.is_constant() || now != 0.)
      error("Contact conductance", "'Transmission' is given, too: give one of the two.");
    contact_conductance = parse_number(text("Contact conductance"), where("Contact conductance"));
    if (contact_conductance < 0.)
      error("Contact conductance",
            "found " + text("Contact conductance") + ", needs a number of 0 or more.");
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
  void Cracks<dim>::check_inside(const Point<dim> &lower, const Point<dim> &upper) const
  {
    for (unsigned int i = 0; i < cracks.size(); ++i)
      {
        const std::vector<Point<dim>> inside = clipped_to_box(cracks[i], lower, upper);
        const bool grows =
          std::any_of(tips.begin(), tips.end(), [&](const auto &tip) { return tip.crack == i; });
        if (inside.empty() && !grows)
          error(dim == 2 ? "Segments" : "Polygons",
                crack_name(i, cracks[i]) + " lies outside the body.");
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


  template class Cracks<1>;
  template class Cracks<2>;
  template class Cracks<3>;
} // namespace PeriDeal
