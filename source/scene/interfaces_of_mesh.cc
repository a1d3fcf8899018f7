// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What a mesh file gives names to.

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/msh_file.h>

#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "scene_checks.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Place = MeshGroups::Place;

    constexpr std::size_t most_points = 100; // of a group; their formula has to be short

    /** What stands before the colons of an entry, or between them; of mistakes anything. */
    std::vector<std::string> names_in(const std::string &text)
    {
      std::vector<std::string> names;
      for (const std::string &piece : split_list(text, ';'))
        if (const auto parts = split_list(piece, ':'); !parts.empty())
          for (const std::string &name : split_list(parts.front(), ','))
            names.push_back(unquoted(name));
      return names;
    }


    /** Some condition is on a part of this name, which is not one of the scene's own. */
    bool is_asked_for(const SceneSection &conditions, const std::string &name)
    {
      bool asked = false;
      for (const Entry &entry : conditions.entries())
        {
          const std::vector<std::string> names = names_in(entry.text);
          if (!has(names, name))
            continue;
          if (entry.name == "Parts")
            return false;
          asked = true;
        }
      return asked;
    }


    /** A point, or several as a region of the nodes that lie there. */
    template <int dim>
    Part part_of(const std::string &name, const std::vector<Place> &places)
    {
      Part part;
      part.name  = name;
      part.kind  = places.size() == 1 ? Part::point : Part::region;
      part.place = places.front();
      if (part.kind == Part::point)
        return part;
      double      extent = 0.;
      std::string squares;
      for (const Place &place : places)
        {
          std::string square;
          for (unsigned int d = 0; d < dim; ++d)
            {
              extent = std::max(extent, std::abs(place[d] - places.front()[d]));
              square += std::string(d == 0 ? "(" : " + (") + "xyz"[d] + " - (" +
                        rounded_text(place[d], 17) + "))^2";
            }
          squares += (squares.empty() ? "" : ", ") + square;
        }
      part.inside =
        Expression(rounded_text(1e-18 * extent * extent, 6) + " - min(" + squares + ")", name);
      return part;
    }


    /** `mesh(steel)` with the number of the group in place of its name. */
    std::string with_number(const std::string         &region,
                            const MeshGroups::Numbers &materials,
                            const std::string         &where)
    {
      const std::size_t open = region.find('('), close = region.rfind(')');
      if (trimmed(region.substr(0, open)) != "mesh" || close == std::string::npos || close < open)
        return region;
      const std::string name = unquoted(trimmed(region.substr(open + 1, close - open - 1)));
      if (name.empty() || (materials.count(name) == 0 &&
                           name.find_first_not_of("0123456789.+-eE ") == std::string::npos))
        return region;
      const auto number = number_of_group(materials, name);
      if (!number)
        {
          std::vector<std::string> known;
          for (const auto &group : materials)
            known.push_back(group.first);
          entry_error(where,
                      "'" + region +
                        "' is no physical group of cells in the mesh file; they are: " +
                        text_of_groups(materials) + "." + did_you_mean(name, known));
        }
      return "mesh(" + std::to_string(*number) + ")";
    }


    void number_materials(Phases &phases, const MeshGroups::Numbers &materials)
    {
      std::string numbered;
      bool        any = false;
      for (const std::string &piece : split_list(phases.text("Regions"), ';'))
        {
          const auto [name, region] = name_and_value(piece, phases.where("Regions"));
          const std::string value =
            with_number(region, materials, phases.where("Regions") + ", phase '" + name + "'");
          any = any || value != region;
          numbered += (numbered.empty() ? "" : " ; ") + quoted_if_needed(name) + ": " + value;
        }
      if (any)
        phases.set("Regions", numbered);
    }


    /** The longest lines that edges make, each from an end or a place where three meet. */
    std::vector<std::vector<Place>> lines_of(const std::vector<std::vector<Place>> &edges)
    {
      std::map<Place, std::vector<std::size_t>> at;
      for (std::size_t e = 0; e < edges.size(); ++e)
        for (const Place &end : edges[e])
          at[end].push_back(e);
      std::vector<bool>               used(edges.size(), false);
      std::vector<std::vector<Place>> lines;
      const auto                      follow = [&](Place from, std::size_t e) {
        lines.push_back({from});
        for (;;)
          {
            used[e] = true;
            from    = edges[e][edges[e][0] == from ? 1 : 0];
            lines.back().push_back(from);
            const auto &around = at.at(from);
            if (around.size() != 2)
              return;
            e = around[around[0] == e ? 1 : 0];
            if (used[e])
              return;
          }
      };
      for (const bool closed : {false, true})
        for (std::size_t e = 0; e < edges.size(); ++e)
          for (const Place &end : edges[e])
            if (!used[e] && (closed || at.at(end).size() != 2))
              follow(end, e);
      return lines;
    }


    Tensor<1, 3> normal_of(const std::vector<Place> &corners)
    {
      const Tensor<1, 3> normal =
        cross_product_3d(point_of<3>(corners[2].data()) - point_of<3>(corners[0].data()),
                         point_of<3>(corners[3].data()) - point_of<3>(corners[1].data()));
      return normal / normal.norm();
    }


    /** Whether a point is in the plane of a face, as accurately as files have it. */
    bool lies_in_plane(const std::vector<Place> &face, const Place &p)
    {
      const Tensor<1, 3> way  = point_of<3>(p.data()) - point_of<3>(face[0].data());
      const double       size = point_of<3>(face[2].data()).distance(point_of<3>(face[0].data()));
      return std::abs(way * normal_of(face)) <= 1e-9 * std::max(size, way.norm());
    }


    /** The corners of a closed line of edges, without those in the middle of a straight side. */
    std::vector<Place> without_straight(const std::vector<Place> &loop)
    {
      std::vector<Place> corners;
      const std::size_t  n = loop.size();
      for (std::size_t i = 0; i < n; ++i)
        {
          const Tensor<1, 3> before = point_of<3>(loop[i].data()) -
                                      point_of<3>(loop[(i + n - 1) % n].data()),
                             next =
                               point_of<3>(loop[(i + 1) % n].data()) - point_of<3>(loop[i].data());
          if ((before / before.norm() - next / next.norm()).norm() > 1e-12)
            corners.push_back(loop[i]);
        }
      return corners;
    }


    /** The polygons of faces that lie in one plane and hang together; each face if they make more
     * than one rim. */
    std::vector<std::vector<Place>> polygons_of(const std::vector<std::vector<Place>> &faces)
    {
      using Edge      = std::pair<Place, Place>;
      const auto edge = [&](const std::size_t f, const unsigned int k) {
        const Place &a = faces[f][k], &b = faces[f][(k + 1) % 4];
        return a < b ? Edge(a, b) : Edge(b, a);
      };
      std::map<Edge, std::vector<std::size_t>> beside;
      for (std::size_t f = 0; f < faces.size(); ++f)
        for (unsigned int k = 0; k < 4; ++k)
          beside[edge(f, k)].push_back(f);
      std::vector<std::vector<Place>> polygons;
      std::vector<bool>               used(faces.size(), false);
      for (std::size_t first = 0; first < faces.size(); ++first)
        {
          if (used[first])
            continue;
          std::vector<std::size_t> patch{first};
          std::map<Edge, int>      n_of;
          used[first] = true;
          for (std::size_t i = 0; i < patch.size(); ++i)
            for (unsigned int k = 0; k < 4; ++k)
              {
                ++n_of[edge(patch[i], k)];
                for (const std::size_t f : beside.at(edge(patch[i], k)))
                  if (!used[f] &&
                      std::all_of(faces[f].begin(), faces[f].end(), [&](const Place &p) {
                        return lies_in_plane(faces[first], p);
                      }))
                    {
                      used[f] = true;
                      patch.push_back(f);
                    }
              }
          std::vector<std::vector<Place>> rim;
          for (const auto &[ends, n] : n_of)
            if (n == 1)
              rim.push_back({ends.first, ends.second});
          auto loops = lines_of(rim);
          if (loops.size() == 1 && loops[0].front() == loops[0].back())
            {
              loops[0].pop_back();
              polygons.push_back(without_straight(loops[0]));
            }
          else
            for (const std::size_t f : patch)
              polygons.push_back(faces[f]);
        }
      return polygons;
    }
  } // namespace


  namespace
  {
    /** A plate with fitted rims has the sides of a box, and its holes. */
    MeshGroups::Numbers sides_of_plate(const unsigned int dim)
    {
      MeshGroups::Numbers sides = {{"hole", hole_boundary_id}};
      for (unsigned int k = 0; k < 2 * dim; ++k)
        sides.emplace(box_side_names()[k], k);
      return sides;
    }
  } // namespace


  namespace
  {
    /** What was made of the file, which has been read. Collective. */
    template <int dim>
    void add_notes_of_mesh(Domain<dim> &domain)
    {
      const auto              &files = domain.files;
      std::vector<std::string> notes;
      if (Utilities::MPI::this_mpi_process(files.communicator) == 0)
        notes = read_msh(files.mesh, files.folder, dim)->notes;
      notes = Utilities::MPI::broadcast(files.communicator, notes);
      domain.notes.insert(domain.notes.end(), notes.begin(), notes.end());
    }
  } // namespace


  template <int dim>
  MeshGroups take_groups_of_mesh(Scene<dim> &scene)
  {
    MeshGroups               groups;
    const Domain<dim>       &domain     = scene.domain;
    BoundaryConditions<dim> &conditions = scene.boundary_conditions;
    conditions.physical_names.clear();
    conditions.parts.clear();
    if (domain.holes.fitted())
      conditions.physical_names = sides_of_plate(dim);
    if (domain.files.mesh.empty())
      return groups;
    groups = read_mesh_groups(domain.files.mesh,
                              domain.files.folder,
                              dim,
                              !scene.cracks.text("Interfaces").empty(),
                              domain.files.communicator);
    add_notes_of_mesh(scene.domain);
    conditions.physical_names = groups.sides;
    for (const auto &[name, places] : groups.points)
      if (groups.sides.count(name) == 0 && is_asked_for(conditions, name))
        {
          conditions.refuse(places.size() > most_points,
                            "Parts",
                            "the physical points '" + name + "' of the mesh file are " +
                              std::to_string(places.size()) + "; at most " +
                              std::to_string(most_points) +
                              " are one part. Name a line or surface, or give a 'region'.");
          conditions.parts.push_back(part_of<dim>(name, places));
        }
    number_materials(scene.material.phases, groups.materials);
    return groups;
  }


  template <int dim>
  void add_interfaces(Scene<dim> &scene, const MeshGroups &groups)
  {
    Cracks<dim>                   &cracks = scene.cracks;
    const std::string              entry  = "Interfaces";
    const std::vector<std::string> names  = split_list(cracks.text(entry), ';');
    if (names.empty())
      return;
    cracks.refuse(scene.domain.files.mesh.empty(),
                  entry,
                  "names groups of a mesh file, but 'Shape' in section 'Domain' is another.");
    cracks.refuse(dim == 1, entry, "cracks need 'Dimension' 2 or 3.");
    cracks.refuse(!cracks.tips.empty(),
                  entry,
                  "are cut into the mesh before the run; with cracks that grow ('Growth', 'Paths') "
                  "give 'Segments' or 'Polygons' instead.");
    const std::string mesh = cracks.text("Mesh");
    cracks.refuse(mesh != "auto" && mesh != "faces",
                  "Mesh",
                  "found '" + mesh +
                    "'; 'Interfaces' lie on faces of the mesh: use 'faces' or 'auto'.");
    cracks.refuse(cracks.conduct() && cracks.contact_conductance < 0.,
                  "Transmission",
                  "is the part that cut bonds keep; of 'Interfaces', which are cut into the mesh, "
                  "give the 'Contact conductance' instead.");
    std::vector<unsigned int> numbers;
    for (const std::string &name : names)
      {
        const auto number = number_of_group(groups.interfaces, unquoted(name));
        if (!number)
          {
            const bool is_side = number_of_group(groups.sides, unquoted(name)).has_value();
            cracks.refuse(true,
                          entry,
                          (is_side ? "'" + name +
                                       "' lies on the surface of the body, where there is nothing "
                                       "to part" :
                                     "unknown group '" + name + "'") +
                            "; those between two cells are: " + text_of_groups(groups.interfaces) +
                            ".");
          }
        cracks.refuse(has(numbers, *number), entry, "'" + name + "' is named twice.");
        numbers.push_back(*number);
        const auto &faces = groups.faces.at(*number);
        for (const auto &face : faces)
          if (dim == 3 && !lies_in_plane(face, face[3]))
            cracks.refuse(true,
                          entry,
                          "'" + name + "' has a face that is not plane, at (" +
                            number_text(face[0][0]) + ", " + number_text(face[0][1]) + ", " +
                            number_text(face[0][2]) +
                            "). Cracks consist of plane pieces: divide the surface into plane "
                            "faces.");
        for (const auto &piece : dim == 2 ? lines_of(faces) : polygons_of(faces))
          {
            std::vector<Point<dim>> crack;
            for (const Place &corner : piece)
              crack.push_back(point_of<dim>(corner.data()));
            cracks.cracks.push_back(crack);
          }
      }
    cracks.mesh = CrackMesh::faces;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(take_groups_of_mesh);
  PERIDEAL_INSTANTIATE_FUNCTION(add_interfaces);
} // namespace PeriDeal
