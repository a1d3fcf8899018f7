// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/geometry_info.h>

#include <perideal/base/clipped.h>
#include <perideal/base/instantiate.h>
#include <perideal/mesh/crack_faces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    constexpr unsigned int n_face_vertices = (dim == 1) ? 1 : (1 << (dim - 1));

    template <int dim>
    using FaceKey = std::array<unsigned int, n_face_vertices<dim>>;

    /** The vertices of face f of a cell, in deal.II's order. */
    template <int dim>
    FaceKey<dim> face_vertices(const CellData<dim> &cell, const unsigned int f)
    {
      FaceKey<dim> face;
      for (unsigned int v = 0; v < face.size(); ++v)
        face[v] = cell.vertices[GeometryInfo<dim>::face_to_cell_vertices(f, v)];
      return face;
    }

    template <int dim>
    double face_measure(const std::vector<Point<dim>> &p, const FaceKey<dim> &face)
    {
      if constexpr (dim == 2)
        return p[face[0]].distance(p[face[1]]);
      else if constexpr (dim == 3)
        return 0.5 * cross_product_3d(p[face[3]] - p[face[0]], p[face[2]] - p[face[1]]).norm();
      else
        return 1.;
    }

    template <int dim>
    bool on_crack(const std::vector<Point<dim>> &p,
                  const FaceKey<dim>            &face,
                  const CrackGeometry<dim>      &crack)
    {
      Point<dim> center;
      for (const unsigned int v : face)
        center += (p[v] - Point<dim>()) / static_cast<double>(face.size());
      // The centre too: all corners of a face may touch the edge of a crack that is not convex.
      return crack.contains(center) &&
             std::all_of(face.begin(), face.end(), [&](const unsigned int v) {
               return crack.contains(p[v]);
             });
    }


    /** Length of a segment, area of a planar polygon. */
    template <int dim>
    double measure(const std::vector<Point<dim>> &corners)
    {
      if (corners.size() < 2)
        return 0.;
      if constexpr (dim == 3)
        {
          Tensor<1, dim> doubled_area;
          for (std::size_t i = 1; i + 1 < corners.size(); ++i)
            doubled_area += cross_product_3d(corners[i] - corners[0], corners[i + 1] - corners[0]);
          return 0.5 * doubled_area.norm();
        }
      double longest = 0.;
      for (const Point<dim> &p : corners)
        longest = std::max(longest, p.distance(corners[0]));
      return longest;
    }


    /** Outward normal of face f, not of unit length. */
    template <int dim>
    Tensor<1, dim> face_normal(const std::vector<Point<dim>> &p,
                               const FaceKey<dim>            &face,
                               const Tensor<1, dim>          &outward)
    {
      Tensor<1, dim> normal;
      if constexpr (dim == 2)
        normal = cross_product_2d(p[face[1]] - p[face[0]]);
      else if constexpr (dim == 3)
        normal = cross_product_3d(p[face[3]] - p[face[0]], p[face[2]] - p[face[1]]);
      return normal * outward < 0. ? -normal : normal;
    }


    /** The middle of a cell, and the distance of its farthest corner from there. */
    template <int dim>
    std::pair<Point<dim>, double> ball_around(const std::vector<Point<dim>> &p,
                                              const CellData<dim>           &cell)
    {
      Point<dim> center;
      for (const unsigned int v : cell.vertices)
        center += (p[v] - Point<dim>()) / static_cast<double>(cell.vertices.size());
      double size = 0.;
      for (const unsigned int v : cell.vertices)
        size = std::max(size, p[v].distance(center));
      return {center, size};
    }


    template <int dim>
    bool is_near(const CrackGeometry<dim>      &crack,
                 const std::vector<Point<dim>> &p,
                 const CellData<dim>           &cell)
    {
      const auto [center, size] = ball_around(p, cell);
      return crack.is_near(center, 1.01 * size);
    }


    /** How much of a crack a cell holds, its faces included. */
    template <int dim>
    double measure_in_cell(const std::vector<Point<dim>> &p,
                           const CellData<dim>           &cell,
                           const CrackGeometry<dim>      &crack)
    {
      constexpr double slack    = 1e-8; // outwards, relative to the cell: its faces belong to it
      const auto [center, size] = ball_around(p, cell);
      if (!crack.is_near(center, 1.01 * size))
        return 0.;
      std::vector<Point<dim>> part = crack.corners();
      for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell && !part.empty(); ++f)
        {
          const FaceKey<dim> face = face_vertices<dim>(cell, f);
          Point<dim>         middle;
          for (const unsigned int v : face)
            middle += (p[v] - Point<dim>()) / static_cast<double>(face.size());
          const Tensor<1, dim> outward = middle - center;
          part = clipped<dim>(part, middle + slack * outward, face_normal<dim>(p, face, outward));
        }
      return measure<dim>(part);
    }

    /**
     * The (at most two) cells on each face, by the face's sorted vertices.
     * @param crack if given, of the faces near it
     */
    template <int dim>
    std::map<FaceKey<dim>, std::vector<unsigned int>> cells_of_faces(
      const CoarseMesh<dim>    &mesh,
      const CrackGeometry<dim> *crack = nullptr)
    {
      std::map<FaceKey<dim>, std::vector<unsigned int>> cells;
      for (unsigned int c = 0; c < mesh.cells.size(); ++c)
        if (crack == nullptr || is_near(*crack, mesh.vertices, mesh.cells[c]))
          for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell; ++f)
            {
              FaceKey<dim> key = face_vertices<dim>(mesh.cells[c], f);
              std::sort(key.begin(), key.end());
              cells[key].push_back(c);
            }
      return cells;
    }

    /**
     * Group number of each of the cells around one vertex, cells being joined by the given pairs.
     */
    std::vector<unsigned int> connected_groups(
      const std::vector<unsigned int>                          &cells,
      const std::vector<std::pair<unsigned int, unsigned int>> &joined)
    {
      std::vector<unsigned int> group(cells.size());
      std::iota(group.begin(), group.end(), 0u);
      const auto index = [&](const unsigned int c) {
        return std::find(cells.begin(), cells.end(), c) - cells.begin();
      };
      for (const auto &[a, b] : joined)
        {
          const unsigned int keep = group[index(a)], drop = group[index(b)];
          for (unsigned int &g : group)
            if (g == drop)
              g = keep;
        }
      return group;
    }
  } // namespace


  template <int dim>
  double measure_on_faces(const CoarseMesh<dim> &mesh, const CrackGeometry<dim> &crack)
  {
    double sum = 0.;
    for (const auto &[key, cells] : cells_of_faces(mesh, &crack))
      if (cells.size() == 2 && on_crack(mesh.vertices, key, crack))
        for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell; ++f)
          {
            // Once more through the cell, since the area needs the vertices in their order around
            // the face.
            const FaceKey<dim> ordered = face_vertices<dim>(mesh.cells[cells[0]], f);
            FaceKey<dim>       sorted  = ordered;
            std::sort(sorted.begin(), sorted.end());
            if (sorted == key)
              sum += face_measure<dim>(mesh.vertices, ordered);
          }
    return sum;
  }


  template <int dim>
  bool lies_on_faces(const CoarseMesh<dim> &mesh, const CrackGeometry<dim> &crack)
  {
    const double on_faces  = measure_on_faces(mesh, crack);
    const auto   is_all_of = [&](const double whole) {
      return std::abs(on_faces - whole) <= 1e-6 * crack.measure();
    };
    if (is_all_of(crack.measure()))
      return true;
    // What lies outside of the body needs no face.
    double held = 0.;
    for (const CellData<dim> &cell : mesh.cells)
      held += measure_in_cell<dim>(mesh.vertices, cell, crack);
    return is_all_of(0.5 * held);
  }


  template <int dim>
  void cut_along_faces(CoarseMesh<dim> &mesh, const std::vector<CrackGeometry<dim>> &cracks)
  {
    std::map<unsigned int, std::vector<std::pair<unsigned int, unsigned int>>> joined;
    std::map<unsigned int, std::vector<unsigned int>>                          around;
    const auto faces = cells_of_faces(mesh);
    for (const auto &[key, cells] : faces)
      if (cells.size() == 2)
        {
          bool cut = false;
          for (const CrackGeometry<dim> &crack : cracks)
            cut = cut || on_crack(mesh.vertices, key, crack);
          for (const unsigned int v : key)
            if (cut)
              around[v];
            else
              joined[v].emplace_back(cells[0], cells[1]);
        }
    for (unsigned int c = 0; c < mesh.cells.size(); ++c)
      for (const unsigned int v : mesh.cells[c].vertices)
        if (const auto entry = around.find(v); entry != around.end())
          entry->second.push_back(c);

    for (const auto &[v, cells] : around)
      {
        const std::vector<unsigned int>      group = connected_groups(cells, joined[v]);
        std::map<unsigned int, unsigned int> vertex_of_group{{group[0], v}};
        for (unsigned int i = 1; i < cells.size(); ++i)
          {
            const auto [entry, is_new] =
              vertex_of_group.try_emplace(group[i],
                                          static_cast<unsigned int>(mesh.vertices.size()));
            if (is_new)
              {
                const Point<dim> copy = mesh.vertices[v];
                mesh.vertices.push_back(copy);
              }
            std::replace(mesh.cells[cells[i]].vertices.begin(),
                         mesh.cells[cells[i]].vertices.end(),
                         v,
                         entry->second);
          }
      }
  }


  PERIDEAL_INSTANTIATE_FUNCTION(measure_on_faces);
  PERIDEAL_INSTANTIATE_FUNCTION(lies_on_faces);
  PERIDEAL_INSTANTIATE_FUNCTION(cut_along_faces);
} // namespace PeriDeal
