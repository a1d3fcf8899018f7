// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/fitted_plate.h>
#include <perideal/mesh/given_mesh.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/cell_lines.h>
#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void GivenMesh<dim>::mark(Triangulation<dim> &mesh) const
  {
    for (const auto &[id, manifold] : manifolds)
      if (manifold)
        mesh.set_manifold(id, *manifold);
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      {
        const auto index = static_cast<unsigned int>(cell->index());
        if (const auto of_cell = cells.find(index); of_cell != cells.end())
          cell->set_manifold_id(of_cell->second);
        for (const unsigned int f : cell->face_indices())
          {
            if (const auto round = faces.find({index, f}); round != faces.end())
              cell->face(f)->set_all_manifold_ids(round->second);
            if (!cell->face(f)->at_boundary())
              continue;
            const auto side = sides.find({index, f});
            cell->face(f)->set_boundary_id(side != sides.end() ? side->second : crack_boundary_id);
          }
      }
    for (const auto &[id, manifold] : manifolds)
      if (!manifold)
        if constexpr (dim > 1)
          {
            TransfiniteInterpolationManifold<dim> between; // knows the mesh that it is of
            between.initialize(mesh);
            mesh.set_manifold(id, between);
          }
  }


  namespace
  {
    template <int dim>
    bool is_transfinite(const Manifold<dim> &manifold)
    {
      if constexpr (dim > 1)
        return dynamic_cast<const TransfiniteInterpolationManifold<dim> *>(&manifold) != nullptr;
      else
        return false;
    }


    /** A mesh on one process, as lists. */
    template <int dim>
    GivenMesh<dim> described(const Triangulation<dim> &mesh)
    {
      GivenMesh<dim> given;
      SubCellData    faces;
      std::tie(given.coarse.vertices, given.coarse.cells, faces) =
        GridTools::get_coarse_mesh_description(mesh);
      for (const types::manifold_id id : mesh.get_manifold_ids())
        if (id != numbers::flat_manifold_id)
          given.manifolds.emplace(
            id,
            is_transfinite(mesh.get_manifold(id)) ? nullptr : mesh.get_manifold(id).clone());
      for (const auto &cell : mesh.active_cell_iterators())
        {
          const unsigned int index = cell->active_cell_index();
          if (cell->manifold_id() != numbers::flat_manifold_id)
            given.cells[index] = cell->manifold_id();
          for (const unsigned int f : cell->face_indices())
            {
              if (cell->face(f)->at_boundary())
                given.sides[{index, f}] = cell->face(f)->boundary_id();
              if (cell->face(f)->manifold_id() != numbers::flat_manifold_id)
                given.faces[{index, f}] = cell->face(f)->manifold_id();
            }
        }
      return given;
    }


    /** Numbers that the first process has, to all. Collective. */
    template <typename Number>
    void share(std::vector<Number> &numbers, const MPI_Comm communicator)
    {
      std::size_t n = Utilities::MPI::broadcast(communicator, numbers.size());
      numbers.resize(n);
      constexpr std::size_t most = 1u << 30; // bytes at once
      for (std::size_t done = 0; done < n; done += most / sizeof(Number))
        MPI_Bcast(numbers.data() + done,
                  static_cast<int>(std::min(n - done, most / sizeof(Number)) * sizeof(Number)),
                  MPI_BYTE,
                  0,
                  communicator);
    }


    /** Nodes of the cells and sides of a mesh file, behind the number of their group. */
    std::vector<unsigned int> listed(const std::vector<MshElement> &elements)
    {
      std::vector<unsigned int> list;
      for (const MshElement &element : elements)
        {
          list.push_back(element.id);
          list.insert(list.end(), element.nodes.begin(), element.nodes.begin() + element.n);
        }
      return list;
    }


    /** Points, cells and sides of a mesh file, which the first process reads. Collective. */
    template <int dim>
    std::tuple<std::vector<double>, std::vector<unsigned int>, std::vector<unsigned int>>
    lists_of_file(const std::string &file_name,
                  const std::string &scene_folder,
                  const MPI_Comm     communicator)
    {
      std::vector<double>       points;
      std::vector<unsigned int> cells, sides;
      std::string               message;
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            const auto mesh = read_msh(file_name, scene_folder, dim);
            for (const auto &p : mesh->points)
              points.insert(points.end(), p.begin(), p.begin() + dim);
            cells = listed(mesh->cells);
            sides = listed(mesh->sides);
          }
        catch (const UserError &error)
          {
            message = error.message();
          }
      throw_on_all_if_any(communicator, message);
      share(points, communicator);
      share(cells, communicator);
      share(sides, communicator);
      return {std::move(points), std::move(cells), std::move(sides)};
    }


    template <int dim>
    using Corners = std::array<unsigned int, GeometryInfo<dim>::vertices_per_face>;

    /** Faces by their corners, and which of them are at the boundary: with the numbers of sides. */
    template <int dim>
    std::map<typename GivenMesh<dim>::FaceKey, types::boundary_id> sides_of_cells(
      const std::vector<CellData<dim>> &cells,
      const std::vector<unsigned int>  &named)
    {
      using Key                                   = typename GivenMesh<dim>::FaceKey;
      constexpr auto                            n = GeometryInfo<dim>::vertices_per_face;
      std::vector<std::pair<Corners<dim>, Key>> faces;
      faces.reserve(cells.size() * GeometryInfo<dim>::faces_per_cell);
      for (unsigned int c = 0; c < cells.size(); ++c)
        for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell; ++f)
          {
            Corners<dim> corners;
            for (unsigned int v = 0; v < n; ++v)
              corners[v] = cells[c].vertices[GeometryInfo<dim>::face_to_cell_vertices(f, v)];
            std::sort(corners.begin(), corners.end());
            faces.emplace_back(corners, Key(c, f));
          }
      std::sort(faces.begin(), faces.end());
      std::map<Corners<dim>, unsigned int> ids;
      for (std::size_t s = 0; s < named.size(); s += n + 1)
        {
          Corners<dim> corners;
          std::copy_n(named.begin() + s + 1, n, corners.begin());
          std::sort(corners.begin(), corners.end());
          ids[corners] = named[s];
        }
      std::map<Key, types::boundary_id> sides;
      for (std::size_t k = 0; k < faces.size(); ++k)
        {
          if (k + 1 < faces.size() && faces[k].first == faces[k + 1].first)
            {
              ++k;
              continue;
            }
          const auto id          = ids.find(faces[k].first);
          const auto otherwise   = dim == 1 ? faces[k].second.second : 0;
          sides[faces[k].second] = id != ids.end() ? id->second : otherwise;
        }
      return sides;
    }


    template <int dim>
    GivenMesh<dim> mesh_of_file(const std::string &file_name,
                                const std::string &scene_folder,
                                const MPI_Comm     communicator)
    {
      constexpr unsigned int n           = GeometryInfo<dim>::vertices_per_cell;
      constexpr unsigned int in_order[8] = {0, 1, 3, 2, 4, 5, 7, 6}; // of Gmsh's corners
      const auto [points, cells, sides] = lists_of_file<dim>(file_name, scene_folder, communicator);
      GivenMesh<dim> given;
      for (std::size_t i = 0; i < points.size(); i += dim)
        {
          Point<dim> p;
          std::copy_n(points.begin() + i, dim, p.begin_raw());
          given.coarse.vertices.push_back(p);
        }
      for (std::size_t c = 0; c < cells.size(); c += n + 1)
        {
          CellData<dim> cell;
          cell.material_id = cells[c];
          for (unsigned int v = 0; v < n; ++v)
            cell.vertices[v] = cells[c + 1 + in_order[v]];
          given.coarse.cells.push_back(cell);
        }
      if constexpr (dim > 1)
        GridTools::consistently_order_cells(given.coarse.cells);
      given.sides = sides_of_cells<dim>(given.coarse.cells, sides);
      SubCellData none;
      GridTools::delete_unused_vertices(given.coarse.vertices, given.coarse.cells, none);
      return given;
    }


    /** What deal.II says in an exception, in one line. */
    std::string reason_of(const std::exception &error)
    {
      std::istringstream lines(error.what());
      std::string        line, reason;
      bool               follows = false;
      while (std::getline(lines, line))
        if (line.find("Additional information") != std::string::npos)
          follows = true;
        else if (line.find("Stacktrace") != std::string::npos || line.find("-----") == 0)
          follows = false;
        else if (follows && line.find_first_not_of(' ') != std::string::npos)
          reason += (reason.empty() ? "" : " ") + line.substr(line.find_first_not_of(' '));
      constexpr std::size_t longest = 160; // else it is a pattern that nobody reads
      return reason.size() < longest ? reason : "";
    }


    template <int dim>
    GivenMesh<dim> mesh_of_generator(const Domain<dim> &domain)
    {
      Triangulation<dim> mesh;
      try
        {
          GridGenerator::generate_from_name_and_arguments(mesh,
                                                          domain.files.generator,
                                                          domain.files.arguments);
        }
      catch (const std::exception &error)
        {
          const std::string reason = reason_of(error);
          domain.refuse(
            true,
            "Generator arguments",
            "'" + domain.files.arguments + "': deal.II makes no mesh of dimension " +
              std::to_string(dim) + " by '" + domain.files.generator + "' from them" +
              (reason.empty() ?
                 ". It needs all arguments of the function of that name in deal.II's GridGenerator." :
                 ": " + reason));
        }
      domain.refuse(mesh.n_active_cells() == 0 || !mesh.all_reference_cells_are_hyper_cube(),
                    "Generator",
                    "'" + domain.files.generator +
                      "' makes other cells than quadrilaterals and hexahedra.");
      for (const auto &cell : mesh.active_cell_iterators())
        domain.refuse(!(cell->measure() > 0.),
                      "Generator arguments",
                      "'" + domain.files.arguments + "': '" + domain.files.generator +
                        "' makes cells from them that are turned inside out.");
      if (mesh.n_levels() == 1)
        return described(mesh);
      Triangulation<dim> flat; // some are refined once
      GridGenerator::flatten_triangulation(mesh, flat);
      for (const types::manifold_id id : mesh.get_manifold_ids())
        if (id != numbers::flat_manifold_id)
          flat.set_manifold(id, mesh.get_manifold(id));
      return described(flat);
    }


    template <int dim>
    void set_sides_of_plate(const Domain<dim> &domain, Triangulation<dim> &mesh)
    {
      for (const auto &cell : mesh.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            face->set_boundary_id(side_of_box(domain, face->center()));
    }


    /** The number of the circle that holds all vertices of a face, from 0, or -1. */
    template <int dim, typename Face>
    int circle_of(const std::vector<Hole> &holes, const Face &face)
    {
      for (unsigned int k = 0; k < holes.size(); ++k)
        {
          bool on_rim = holes[k].corners.empty();
          for (unsigned int v = 0; on_rim && v < GeometryInfo<dim>::vertices_per_face; ++v)
            {
              const Point<dim> p = face->vertex(v);
              on_rim = std::abs(holes[k].distance(Point<2>(p[0], p[1]))) < 1e-9 * holes[k].radius;
            }
          if (on_rim)
            return k;
        }
      return -1;
    }


    /** The rims of circles stay round as cells are halved. */
    template <int dim>
    void make_rims_round(const std::vector<Hole> &holes, Triangulation<dim> &mesh)
    {
      std::vector<bool> used(holes.size(), false);
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == hole_boundary_id)
            if (const int k = circle_of<dim>(holes, cell->face(f)); k >= 0)
              {
                cell->face(f)->set_all_manifold_ids(k + 1);
                used[k] = true;
              }
      for (unsigned int k = 0; k < holes.size(); ++k)
        if (used[k])
          {
            if constexpr (dim == 2)
              mesh.set_manifold(k + 1, SphericalManifold<2>(holes[k].center));
            else
              {
                const Point<dim> center(holes[k].center[0], holes[k].center[1], 0.);
                mesh.set_manifold(k + 1,
                                  CylindricalManifold<dim>(Point<dim>::unit_vector(2), center));
              }
          }
    }


    Triangulation<2> mesh_of(const FittedPlate &plate)
    {
      std::vector<CellData<2>> cells;
      for (const auto &corners : plate.cells)
        {
          CellData<2> cell;
          cell.vertices = {corners[0], corners[1], corners[3], corners[2]};
          cells.push_back(cell);
        }
      GridTools::consistently_order_cells(cells);
      Triangulation<2> mesh;
      mesh.create_triangulation(plate.vertices, cells, SubCellData());
      return mesh;
    }


    template <int dim>
    GivenMesh<dim> mesh_of_plate(const Domain<dim> &domain)
    {
      if constexpr (dim > 1)
        {
          const std::vector<Hole> holes = domain.holes.all();
          Triangulation<2>        plane = mesh_of(fitted_plate({domain.lower[0], domain.lower[1]},
                                                        {domain.upper[0], domain.upper[1]},
                                                        {{domain.cells[0], domain.cells[1]}},
                                                        holes,
                                                        domain.where("Rims")));
          Triangulation<dim>      mesh;
          if constexpr (dim == 2)
            mesh.copy_triangulation(plane);
          else
            {
              GridGenerator::extrude_triangulation(plane,
                                                   domain.cells[2] + 1,
                                                   domain.upper[2] - domain.lower[2],
                                                   mesh);
              Tensor<1, dim> up;
              up[2] = domain.lower[2];
              GridTools::shift(up, mesh);
            }
          set_sides_of_plate(domain, mesh);
          make_rims_round(holes, mesh);
          return described(mesh);
        }
      else
        {
          AssertThrow(false, ExcInternalError());
          return {};
        }
    }


    template <int dim>
    GivenMesh<dim> mesh_of_lines(const Domain<dim> &domain)
    {
      const auto                lines = cell_lines(domain);
      std::vector<unsigned int> n(domain.cells.begin(), domain.cells.end());
      Point<dim>                last;
      for (unsigned int d = 0; d < dim; ++d)
        last[d] = n[d];
      Triangulation<dim> mesh;
      GridGenerator::subdivided_hyper_rectangle(mesh, n, Point<dim>(), last);
      GridTools::transform(
        [&](const Point<dim> &number) {
          Point<dim> p;
          for (unsigned int d = 0; d < dim; ++d)
            p[d] = lines[d][std::lround(number[d])];
          return p;
        },
        mesh);
      if constexpr (dim > 1)
        set_sides_of_plate(domain, mesh);
      return described(mesh);
    }
  } // namespace


  template <int dim>
  GivenMesh<dim> given_mesh(const Domain<dim> &domain, const MPI_Comm communicator)
  {
    if (domain.shape == Shape::mesh_file)
      return mesh_of_file<dim>(domain.files.mesh, domain.files.folder, communicator);
    if (domain.shape == Shape::generator)
      return mesh_of_generator(domain);
    return domain.is_box() ? mesh_of_lines(domain) : mesh_of_plate(domain);
  }


#define PERIDEAL_TEMPLATES(dim)   \
  template struct GivenMesh<dim>; \
  template GivenMesh<dim> given_mesh(const Domain<dim> &, const MPI_Comm);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
