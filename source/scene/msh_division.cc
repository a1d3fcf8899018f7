// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "msh_shapes.h"

namespace PeriDeal
{
  namespace
  {
    using Nodes = std::vector<unsigned int>;

    struct HashOfFace
    {
      std::size_t operator()(const std::array<unsigned int, 4> &nodes) const
      {
        std::uint64_t hash = 0;
        for (const unsigned int node : nodes)
          hash = (hash ^ node) * 0x9E3779B97F4A7C15u;
        return hash ^ (hash >> 32);
      }
    };


    /** Corners of a cell along one direction: the lower one, both (the middle), the upper one. */
    constexpr unsigned int lower = 1, middle = 3, upper = 2;

    /**
     * Which corner of a hexahedron (in 2D of a quadrilateral) is at these ends of its directions.
     */
    constexpr unsigned int corner_at[2][2][2] = {{{0, 4}, {3, 7}}, {{1, 5}, {2, 6}}};


    class Divider
    {
    public:
      Divider(MshMesh &mesh, const unsigned int dim)
        : mesh(mesh)
        , dim(dim)
      {}

      void divide()
      {
        find_edges();
        mesh.n_divided = mesh.cells.size();
        std::vector<MshElement> cells;
        cells.reserve(4 * mesh.cells.size());
        for (const MshElement &cell : mesh.cells)
          divide(cell, dim, cells);
        mesh.cells.swap(cells);
        for (auto *const list : {&mesh.sides, &mesh.interfaces})
          {
            std::vector<MshElement> sides;
            for (const MshElement &side : *list)
              divide(side, dim - 1, sides);
            list->swap(sides);
          }
      }

    private:
      static std::uint64_t key(const unsigned int a, const unsigned int b)
      {
        return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
      }

      unsigned int edge_of(const unsigned int a, const unsigned int b)
      {
        const auto [entry, is_new] = edges.insert({key(a, b), parent.size()});
        if (is_new)
          parent.push_back(entry->second);
        return entry->second;
      }

      unsigned int root(unsigned int edge)
      {
        while (parent[edge] != edge)
          edge = parent[edge] = parent[parent[edge]];
        return edge;
      }

      /** Opposite edges of a quadrilateral are halved both or not at all. */
      void join_opposite(const Nodes &face)
      {
        for (unsigned int k = 0; k < 2; ++k)
          parent[root(edge_of(face[k], face[k + 1]))] =
            root(edge_of(face[k + 2], face[(k + 3) % 4]));
      }

      /** Which edges stay whole: those along wedges that no triangle has, and those opposite to
       * them. */
      void find_edges()
      {
        const auto is_wedge = [](const MshElement &cell) { return cell.n == 6; };
        if (dim < 3 || std::none_of(mesh.cells.begin(), mesh.cells.end(), is_wedge))
          return;
        std::vector<unsigned int> along, around;
        for (const MshElement &cell : mesh.cells)
          {
            const MshShape &shape = shape_of_cell(dim, cell.n);
            for (unsigned int f = 0; f < shape.n_faces; ++f)
              {
                Nodes face;
                for (unsigned int k = 0; k < shape.n_of_face[f]; ++k)
                  face.push_back(cell.nodes[shape.faces[f][k]]);
                if (face.size() == 4)
                  join_opposite(face);
                else
                  for (unsigned int k = 0; k < 3; ++k)
                    around.push_back(edge_of(face[k], face[(k + 1) % 3]));
              }
            for (unsigned int k = 0; k < 3 && is_wedge(cell); ++k)
              along.push_back(edge_of(cell.nodes[k], cell.nodes[k + 3]));
          }
        is_whole.assign(parent.size(), false);
        for (const unsigned int edge : along)
          is_whole[root(edge)] = true;
        for (const unsigned int edge : around)
          is_whole[root(edge)] = false;
      }

      bool is_halved(const unsigned int a, const unsigned int b)
      {
        return is_whole.empty() || !is_whole[root(edge_of(a, b))];
      }

      unsigned int add_point(const Nodes &corners)
      {
        std::array<double, 3> p{};
        for (unsigned int d = 0; d < 3; ++d)
          {
            for (const unsigned int node : corners)
              p[d] += mesh.points[node][d];
            p[d] /= corners.size();
          }
        mesh.points.push_back(p);
        mesh.numbers.push_back(0);
        return mesh.points.size() - 1;
      }

      /** The point in the middle of these: a corner, or that of an edge or a face, which its other
       * cell has, too. */
      unsigned int shared_point(const Nodes &corners)
      {
        if (corners.size() == 1)
          return corners[0];
        const bool of_edge = corners.size() == 2;
        if (of_edge)
          if (const auto found = middles.find(key(corners[0], corners[1])); found != middles.end())
            return found->second;
        std::array<unsigned int, 4> face;
        face.fill(static_cast<unsigned int>(-1));
        if (!of_edge)
          {
            std::copy(corners.begin(), corners.end(), face.begin());
            std::sort(face.begin(), face.end());
            if (const auto found = centers.find(face); found != centers.end())
              return found->second;
          }
        const unsigned int point = add_point(corners);
        if (of_edge)
          middles.emplace(key(corners[0], corners[1]), point);
        else
          centers.emplace(face, point);
        return point;
      }

      /** @param is_cell whether all corners make the middle of a cell, which no other has */
      unsigned int point(const Nodes &corners, const bool is_cell)
      {
        if (!is_cell)
          return shared_point(corners);
        if (center == 0)
          center = add_point(corners);
        return center;
      }

      void add(const MshElement &parent, const Nodes &nodes, std::vector<MshElement> &to) const
      {
        MshElement child = parent;
        child.n          = nodes.size();
        child.nodes.fill(0);
        std::copy(nodes.begin(), nodes.end(), child.nodes.begin());
        to.push_back(child);
      }

      void divide(const MshElement        &element,
                  const unsigned int       dimension,
                  std::vector<MshElement> &to)
      {
        center = 0; // no middle of a cell has this number: nodes come first
        if (element.n == 1u << dimension && !(dimension == 3 && element.n == 4))
          divide_box(element, dimension, to);
        else if (element.n == 6)
          divide_wedge(element, to);
        else
          divide_simplex(element, dimension, to);
      }

      /** A line, a quadrilateral or a hexahedron: edges are passed from a corner to a middle, so
       * that cells are ordered as deal.II wants them. */
      void divide_box(const MshElement        &element,
                      const unsigned int       dimension,
                      std::vector<MshElement> &to)
      {
        std::vector<std::array<unsigned int, 2>> pieces[3]; // by direction: begin and end
        for (unsigned int d = 0; d < 3; ++d)
          {
            const unsigned int end = d == 0 ? 1 : dimension == 1 ? 1 : d == 1 ? 3 : 4;
            if (d >= dimension)
              pieces[d] = {{lower, lower}};
            else if (is_halved(element.nodes[0], element.nodes[end]))
              pieces[d] = {{lower, middle}, {upper, middle}};
            else
              pieces[d] = {{lower, upper}};
          }
        const auto at = [&](const unsigned int x, const unsigned int y, const unsigned int z) {
          Nodes corners;
          for (unsigned int k = 0; k < 2; ++k)
            for (unsigned int j = 0; j < 2; ++j)
              for (unsigned int i = 0; i < 2; ++i)
                if ((x >> i & 1) != 0 && (y >> j & 1) != 0 && (z >> k & 1) != 0)
                  corners.push_back(element.nodes[corner_at[i][j][k]]);
          return point(corners, dimension == dim && corners.size() == element.n);
        };
        for (const auto &z : pieces[2])
          for (const auto &y : pieces[1])
            for (const auto &x : pieces[0])
              {
                const bool turned = ((x[0] == upper) != (y[0] == upper)) != (z[0] == upper);
                Nodes      nodes;
                for (unsigned int k = 0; k < (dimension == 3 ? 2 : 1); ++k)
                  for (unsigned int corner = 0; corner < (dimension == 1 ? 2 : 4); ++corner)
                    {
                      const bool first = corner == 1 || corner == 2, // along the first direction
                        second         = corner > 1;
                      const bool swap  = turned && dimension > 1;
                      nodes.push_back(at(x[swap ? second : first], y[swap ? first : second], z[k]));
                    }
                add(element, nodes, to);
              }
      }

      /** A triangle or a tetrahedron: a cell at each corner. */
      void divide_simplex(const MshElement        &element,
                          const unsigned int       dimension,
                          std::vector<MshElement> &to)
      {
        const MshShape &shape = shape_of_cell(dimension, element.n);
        const Nodes     all(element.nodes.begin(), element.nodes.begin() + element.n);
        for (unsigned int corner = 0; corner < element.n; ++corner)
          {
            const auto        *next = shape.neighbors[corner];
            const unsigned int v = element.nodes[corner], a = element.nodes[next[0]],
                               b = element.nodes[next[1]];
            Nodes nodes          = {v,
                                    shared_point({v, a}),
                                    point({v, a, b}, dim == 2),
                                    shared_point({v, b})};
            if (dimension == 3)
              {
                const unsigned int c = element.nodes[next[2]];
                for (const unsigned int one : {shared_point({v, c}),
                                               shared_point({v, a, c}),
                                               point(all, true),
                                               shared_point({v, b, c})})
                  nodes.push_back(one);
              }
            add(element, nodes, to);
          }
      }

      void divide_wedge(const MshElement &element, std::vector<MshElement> &to)
      {
        const auto at = [&](const Nodes &corners, const unsigned int height) {
          Nodes nodes;
          for (unsigned int k = 0; k < 2; ++k)
            for (const unsigned int corner : corners)
              if ((height >> k & 1) != 0)
                nodes.push_back(element.nodes[corner + 3 * k]);
          return point(nodes, nodes.size() == 6);
        };
        std::vector<std::array<unsigned int, 2>> heights = {{lower, upper}};
        if (is_halved(element.nodes[0], element.nodes[3]))
          heights = {{lower, middle}, {upper, middle}};
        for (const auto &ends : heights)
          for (unsigned int corner = 0; corner < 3; ++corner)
            {
              unsigned int a = (corner + 1) % 3, b = (corner + 2) % 3;
              if (ends[0] == upper)
                std::swap(a, b);
              Nodes nodes;
              for (const unsigned int height : ends)
                for (const Nodes &corners :
                     {Nodes{corner}, Nodes{corner, a}, Nodes{corner, a, b}, Nodes{corner, b}})
                  nodes.push_back(at(corners, height));
              add(element, nodes, to);
            }
      }

      MshMesh           &mesh;
      const unsigned int dim;
      unsigned int       center = 0; // of the cell that is divided
      /** Edges that are halved together have one root; whether they are whole, by root. */
      std::unordered_map<std::uint64_t, unsigned int>                           edges;
      std::vector<unsigned int>                                                 parent;
      std::vector<bool>                                                         is_whole;
      std::unordered_map<std::uint64_t, unsigned int>                           middles;
      std::unordered_map<std::array<unsigned int, 4>, unsigned int, HashOfFace> centers;
    };
  } // namespace


  void divide_msh(MshMesh &mesh, const unsigned int dim)
  {
    const bool has_others =
      std::any_of(mesh.cells.begin(), mesh.cells.end(), [dim](const MshElement &cell) {
        return cell.n != 1u << dim;
      });
    if (has_others)
      Divider(mesh, dim).divide();
  }
} // namespace PeriDeal
