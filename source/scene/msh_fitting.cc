// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "msh_fitting.h"

#include <deal.II/base/tensor.h>

#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

#include "msh_shapes.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Triple = std::array<unsigned int, 3>;

    constexpr unsigned int none = static_cast<unsigned int>(-1);

    /** Four nodes lie in a plane if their volume is less than this, in terms of the product of the
     * edges that span it. */
    constexpr double flat = 1e-6;


    /** A triangle of the surface and one of its edges, by nodes that are sorted. */
    struct EdgeOfTriangle
    {
      unsigned int a, b, opposite, cell;
    };


    /** An edge of the surface, in 2D a node. */
    struct Joint
    {
      unsigned int a, b;

      bool operator<(const Joint &other) const
      {
        return a < other.a || (a == other.a && b < other.b);
      }
      bool operator==(const Joint &other) const
      {
        return a == other.a && b == other.b;
      }
    };


    std::string text_of_middle(const MshMesh                   &mesh,
                               const std::vector<unsigned int> &nodes,
                               const unsigned int               dim)
    {
      std::string text;
      for (unsigned int d = 0; d < dim; ++d)
        {
          double x = 0.;
          for (const unsigned int node : nodes)
            x += mesh.points[node][d] / nodes.size();
          text += (d == 0 ? "(" : ", ") + rounded_text(x);
        }
      return text + ")";
    }


    class Fit
    {
    public:
      Fit(MshMesh                           &mesh,
          const std::vector<MshSurfaceFace> &surface,
          const std::string                 &name,
          const unsigned int                 dim)
        : mesh(mesh)
        , surface(surface)
        , name(name)
        , dim(dim)
      {
        for (const MshSurfaceFace &face : surface)
          if (dim == 3 && face.nodes[3] == none)
            triangles.push_back({{face.nodes[0], face.nodes[1], face.nodes[2]}, face.cell});
        std::sort(triangles.begin(), triangles.end());
      }

      void check()
      {
        if (!triangles.empty())
          {
            check_quadrilaterals();
            check_diagonals();
          }
        note_joints();
      }

    private:
      /** The cell of a triangle of the surface. */
      std::optional<unsigned int> cell_of(Triple nodes) const
      {
        std::sort(nodes.begin(), nodes.end());
        const auto found =
          std::lower_bound(triangles.begin(), triangles.end(), std::make_pair(nodes, 0u));
        if (found == triangles.end() || found->first != nodes)
          return std::nullopt;
        return found->second;
      }

      Tensor<1, 3> between(const unsigned int a, const unsigned int b) const
      {
        Tensor<1, 3> e;
        for (unsigned int d = 0; d < dim; ++d)
          e[d] = mesh.points[b][d] - mesh.points[a][d];
        return e;
      }

      std::string place_of(const std::vector<unsigned int> &nodes) const
      {
        return text_of_middle(mesh, nodes, dim);
      }

      std::string title(const unsigned int cell) const
      {
        return "the " + std::string(shape_of_cell(dim, mesh.cells[cell].n).name) + " " +
               std::to_string(mesh.cells[cell].number);
      }

      [[noreturn]] void refuse(const unsigned int               one,
                               const unsigned int               two,
                               const std::string               &what,
                               const std::vector<unsigned int> &nodes) const
      {
        msh_error(
          name,
          mesh.cells[one].line,
          "faces of " + title(one) + " and " + title(two) + " lie on each other at " +
            place_of(nodes) + ": found " + what +
            ", expected faces with the same corners on both sides. The body would be parted "
            "there; mesh it such that its parts fit.");
      }

      void check_quadrilaterals() const
      {
        for (const MshSurfaceFace &face : surface)
          for (unsigned int without = 0; without < 4 && face.nodes[3] != none; ++without)
            {
              Triple       nodes;
              unsigned int n = 0;
              for (unsigned int k = 0; k < 4; ++k)
                if (k != without)
                  nodes[n++] = face.nodes[k];
              if (const auto other = cell_of(nodes))
                refuse(*other,
                       face.cell,
                       "triangles against a quadrilateral",
                       {face.nodes.begin(), face.nodes.end()});
            }
      }

      /** Two triangles in a plane, and one that has the other diagonal of their quadrilateral. */
      void check_diagonals() const
      {
        std::vector<EdgeOfTriangle> edges;
        for (const auto &[n, cell] : triangles)
          {
            edges.push_back({n[0], n[1], n[2], cell});
            edges.push_back({n[0], n[2], n[1], cell});
            edges.push_back({n[1], n[2], n[0], cell});
          }
        std::sort(edges.begin(),
                  edges.end(),
                  [](const EdgeOfTriangle &one, const EdgeOfTriangle &two) {
                    return std::tie(one.a, one.b, one.opposite) <
                           std::tie(two.a, two.b, two.opposite);
                  });
        for (std::size_t k = 0; k < edges.size(); ++k)
          for (std::size_t l = k + 1;
               l < edges.size() && edges[l].a == edges[k].a && edges[l].b == edges[k].b;
               ++l)
            check_diagonal(edges[k], edges[l].opposite);
      }

      void check_diagonal(const EdgeOfTriangle &edge, const unsigned int beyond) const
      {
        const Tensor<1, 3> along = between(edge.a, edge.b), one = between(edge.a, edge.opposite),
                           two = between(edge.a, beyond);
        const double volume    = along * cross_product_3d(one, two);
        if (std::abs(volume) > flat * along.norm() * one.norm() * two.norm() ||
            cross_product_3d(along, one) * cross_product_3d(along, two) >= 0.)
          return;
        for (const unsigned int end : {edge.a, edge.b})
          if (const auto other = cell_of({{end, edge.opposite, beyond}}))
            refuse(*other,
                   edge.cell,
                   "triangles along the two diagonals of a quadrilateral",
                   {edge.a, edge.b, edge.opposite, beyond});
      }

      void note_joints()
      {
        std::vector<Joint> joints;
        for (const MshSurfaceFace &face : surface)
          {
            const auto &n = face.nodes;
            if (dim == 2)
              joints.insert(joints.end(), {{n[0], 0}, {n[1], 0}});
            else if (n[3] == none)
              joints.insert(joints.end(), {{n[0], n[1]}, {n[0], n[2]}, {n[1], n[2]}});
            else
              for (const auto &[a, b] : edges_of(face))
                joints.push_back({std::min(a, b), std::max(a, b)});
          }
        std::sort(joints.begin(), joints.end());
        std::size_t               n_found = 0;
        std::vector<unsigned int> first;
        for (std::size_t k = 0, next = 0; k < joints.size(); k = next)
          {
            while (next < joints.size() && joints[next] == joints[k])
              ++next;
            if (next - k <= 2)
              continue;
            ++n_found;
            if (first.empty())
              first = dim == 2 ? std::vector<unsigned int>{joints[k].a} :
                                 std::vector<unsigned int>{joints[k].a, joints[k].b};
          }
        const std::string things = dim == 2 ? "nodes" : "edges";
        if (n_found > 0)
          mesh.notes.push_back(
            "at " + std::to_string(n_found) + " " + things +
            " of the surface more than two of its " + (dim == 2 ? "edges" : "faces") +
            " meet, the first is at " + place_of(first) + ": there cells hang together by " +
            (dim == 2 ? "a point" : "a line") + " alone, or their faces do not fit.");
      }

      /** Of a quadrilateral, from the shape of its cell, since its corners are sorted. */
      std::vector<std::pair<unsigned int, unsigned int>> edges_of(const MshSurfaceFace &face) const
      {
        const MshElement                                  &cell  = mesh.cells[face.cell];
        const MshShape                                    &shape = shape_of_cell(dim, cell.n);
        std::vector<std::pair<unsigned int, unsigned int>> edges;
        for (unsigned int f = 0; f < shape.n_faces; ++f)
          {
            if (shape.n_of_face[f] != 4)
              continue;
            std::array<unsigned int, 4> around, sorted;
            for (unsigned int k = 0; k < 4; ++k)
              around[k] = cell.nodes[shape.faces[f][k]];
            sorted = around;
            std::sort(sorted.begin(), sorted.end());
            for (unsigned int k = 0; k < 4 && sorted == face.nodes; ++k)
              edges.emplace_back(around[k], around[(k + 1) % 4]);
          }
        return edges;
      }

      MshMesh                                     &mesh;
      const std::vector<MshSurfaceFace>           &surface;
      const std::string                           &name;
      const unsigned int                           dim;
      std::vector<std::pair<Triple, unsigned int>> triangles; // of the surface, sorted; cells
    };
  } // namespace


  void check_fit(MshMesh                           &mesh,
                 const std::vector<MshSurfaceFace> &surface,
                 const std::string                 &name,
                 const unsigned int                 dim)
  {
    Fit(mesh, surface, name, dim).check();
  }


  void note_pieces(MshMesh &mesh, const unsigned int dim)
  {
    std::vector<unsigned int> parent(mesh.points.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](unsigned int node) {
      while (parent[node] != node)
        node = parent[node] = parent[parent[node]];
      return node;
    };
    for (const MshElement &cell : mesh.cells)
      for (unsigned int k = 1; k < cell.n; ++k)
        parent[root(cell.nodes[k])] = root(cell.nodes[0]);
    std::map<unsigned int, std::pair<std::size_t, const MshElement *>> pieces; // their sizes
    for (const MshElement &cell : mesh.cells)
      {
        auto &[n, first] = pieces[root(cell.nodes[0])];
        first            = n++ == 0 ? &cell : first;
      }
    if (pieces.size() < 2)
      return;
    const auto &[n, first] =
      std::min_element(pieces.begin(), pieces.end(), [](const auto &one, const auto &two) {
        return one.second.first < two.second.first;
      })->second;
    mesh.notes.push_back(
      "the cells are " + std::to_string(pieces.size()) +
      " pieces that have no nodes in common, and are apart; the smallest has " + std::to_string(n) +
      (n == 1 ? " cell" : " cells") + ", the first of them at " +
      text_of_middle(mesh, {first->nodes.begin(), first->nodes.begin() + first->n}, dim) + ".");
  }
} // namespace PeriDeal
