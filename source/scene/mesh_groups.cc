// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/scene/mesh_groups.h>
#include <perideal/scene/msh_file.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <set>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::string name_of(const MshMesh &mesh, const unsigned int dimension, const int id)
    {
      for (const auto &[key, number] : mesh.ids)
        if (key.first == dimension && number == id)
          return key.second;
      return std::to_string(id);
    }


    /** The groups of a dimension that these elements are in. */
    MeshGroups::Numbers numbers_of(const MshMesh                 &mesh,
                                   const unsigned int             dimension,
                                   const std::vector<MshElement> &elements)
    {
      std::set<int> ids;
      for (const MshElement &element : elements)
        ids.insert(element.id);
      MeshGroups::Numbers found;
      for (const int id : ids)
        found.emplace(name_of(mesh, dimension, id), id);
      return found;
    }


    MeshGroups groups_of(const MshMesh &mesh, const unsigned int dim, const bool faces)
    {
      MeshGroups groups;
      groups.sides      = numbers_of(mesh, dim - 1, mesh.sides);
      groups.interfaces = numbers_of(mesh, dim - 1, mesh.interfaces);
      groups.materials  = numbers_of(mesh, dim, mesh.cells);
      // A number is that of a side; files number the groups of each dimension by themselves.
      for (const MshElement &place : mesh.places)
        if (const std::string name = name_of(mesh, 0, place.id);
            name.find_first_not_of("0123456789") != std::string::npos)
          {
            auto                   &places = groups.points[name];
            const MeshGroups::Place p      = mesh.points[place.nodes[0]];
            if (std::find(places.begin(), places.end(), p) == places.end())
              places.push_back(p);
          }
      for (const MshElement &face : mesh.interfaces)
        if (faces)
          {
            std::vector<MeshGroups::Place> corners;
            for (unsigned int k = 0; k < face.n; ++k)
              corners.push_back(mesh.points[face.nodes[k]]);
            groups.faces[face.id].push_back(corners);
          }
      return groups;
    }
  } // namespace


  MeshGroups read_mesh_groups(const std::string &file_name,
                              const std::string &folder,
                              const unsigned int dim,
                              const bool         faces,
                              const MPI_Comm     communicator)
  {
    MeshGroups  groups;
    std::string message;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          groups = groups_of(*read_msh(file_name, folder, dim), dim, faces);
        }
      catch (const UserError &error)
        {
          message = error.message();
        }
    throw_on_all_if_any(communicator, message);
    groups.sides      = Utilities::MPI::broadcast(communicator, groups.sides);
    groups.materials  = Utilities::MPI::broadcast(communicator, groups.materials);
    groups.points     = Utilities::MPI::broadcast(communicator, groups.points);
    groups.interfaces = Utilities::MPI::broadcast(communicator, groups.interfaces);
    groups.faces      = Utilities::MPI::broadcast(communicator, groups.faces);
    return groups;
  }


  std::string text_of_groups(const MeshGroups::Numbers &groups)
  {
    std::string text;
    for (const auto &[name, id] : groups)
      text += (text.empty() ? "" : ", ") +
              (name == std::to_string(id) ? name : name + " (" + std::to_string(id) + ")");
    return text.empty() ? "none" : text;
  }


  std::optional<unsigned int> number_of_group(const MeshGroups::Numbers &groups,
                                              const std::string         &name)
  {
    if (const auto found = groups.find(name); found != groups.end())
      return found->second;
    for (const auto &group : groups)
      if (std::to_string(group.second) == name)
        return group.second;
    return std::nullopt;
  }
} // namespace PeriDeal
