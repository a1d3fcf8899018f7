// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/scene/lists.h>
#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "msh_fitting.h"
#include "msh_shapes.h"
#include "msh_touching.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Vector3 = std::array<double, 3>;

    /** Edges that enclose less than this, in terms of the sine of their angle, are taken for
     * parallel. */
    constexpr double smallest_angle = 1e-8;

    /** Nodes closer than this, in terms of the extent of the mesh, are taken for one. */
    constexpr double smallest_length = 1e-12;


    constexpr unsigned int invalid = static_cast<unsigned int>(-1);


    struct Face
    {
      std::array<unsigned int, 4> nodes; // sorted; unused ones are invalid
      unsigned int                element;
      unsigned int                across;   // 3D: opposite to the lowest node
      bool                        positive; // which way it is passed through, seen from outside
    };


    bool before(const Face &a, const Face &b)
    {
      return a.nodes < b.nodes || (a.nodes == b.nodes && a.element < b.element);
    }


    /** @param around the corners as they follow each other, seen from outside */
    Face make_face(const std::array<unsigned int, 4> &around,
                   const unsigned int                 n,
                   const unsigned int                 element)
    {
      Face face{around, element, 0, true};
      std::fill(face.nodes.begin() + n, face.nodes.end(), invalid);
      std::sort(face.nodes.begin(), face.nodes.end());
      const unsigned int first =
        std::min_element(around.begin(), around.begin() + n) - around.begin();
      if (n == 2)
        face.positive = first == 0;
      else if (n > 2)
        face.positive = around[(first + 1) % n] < around[(first + n - 1) % n];
      if (n == 4)
        face.across = around[(first + 2) % 4];
      return face;
    }


    class Checker
    {
    public:
      Checker(MshMesh &mesh, const std::string &name, const unsigned int dim)
        : mesh(mesh)
        , name(name)
        , dim(dim)
        , face_name(dim == 3 ? "face" :
                    dim == 2 ? "edge" :
                               "end")
      {}

      void check()
      {
        Vector3 low, high;
        low.fill(1e300);
        high.fill(-1e300);
        for (const MshElement &cell : mesh.cells)
          for (unsigned int k = 0; k < cell.n; ++k)
            for (unsigned int d = 0; d < 3; ++d)
              {
                low[d]  = std::min(low[d], mesh.points[cell.nodes[k]][d]);
                high[d] = std::max(high[d], mesh.points[cell.nodes[k]][d]);
              }
        for (unsigned int d = 0; d < dim; ++d)
          extent = std::max(extent, high[d] - low[d]);
        check_plane(low, high);
        for (MshElement &cell : mesh.cells)
          if (orientation(cell) < 0)
            turn_around(cell);
        check_for_twins();
        make_faces();
        check_faces();
        check_sides();
        find_touching();
        note_pieces(mesh, dim);
      }

    private:
      std::string text_of(const MshElement &element) const
      {
        return std::to_string(element.number) + " (line " + std::to_string(element.line) + ")";
      }

      std::string nodes_of(const MshElement &element) const
      {
        std::string text;
        for (unsigned int k = 0; k < element.n; ++k)
          text += (k == 0            ? "" :
                   k + 1 < element.n ? ", " :
                                       " and ") +
                  std::to_string(mesh.numbers[element.nodes[k]]);
        return text;
      }

      const MshShape &shape_of(const MshElement &cell) const
      {
        return shape_of_cell(dim, cell.n);
      }

      /** "the hexahedron 7 of the nodes 1, 2, ..." */
      std::string title(const MshElement &element, const unsigned int dimension) const
      {
        return "the " + std::string(msh_shape(dimension, element.n)) + " " +
               std::to_string(element.number) + " of the nodes " + nodes_of(element);
      }

      [[noreturn]] void fault(const MshElement &element, const std::string &what) const
      {
        msh_error(name, element.line, what);
      }

      /** From a corner of a cell along the k-th edge there. */
      Tensor<1, 3> edge(const MshElement  &cell,
                        const unsigned int corner,
                        const unsigned int k) const
      {
        const unsigned int end = shape_of(cell).neighbors[corner][k];
        Tensor<1, 3>       e;
        for (unsigned int d = 0; d < dim; ++d)
          e[d] = mesh.points[cell.nodes[end]][d] - mesh.points[cell.nodes[corner]][d];
        return e;
      }

      /** Volume (3D), area (2D) or length of what the edges at a corner span, over the product of
       * their lengths. 0 if one has no length. */
      double sine(const MshElement &cell, const unsigned int corner) const
      {
        Tensor<1, 3> edges[3];
        for (unsigned int k = 0; k < 3; ++k)
          if (k >= dim)
            edges[k][k] = 1.;
          else if (const Tensor<1, 3> e = edge(cell, corner, k);
                   e.norm() > smallest_length * extent)
            edges[k] = e / e.norm();
        return edges[0] * cross_product_3d(edges[1], edges[2]) *
               (dim == 1 && corner == 1 ? -1. : 1.);
      }

      /**
       * A corner of a quadrilateral whose edges go on straight, as recombined triangles have it.
       */
      bool is_straight(const MshElement &cell, const unsigned int corner) const
      {
        if (cell.n != 4 || dim != 2)
          return false;
        const Tensor<1, 3> a = edge(cell, corner, 0), b = edge(cell, corner, 1);
        const double       lengths = a.norm() * b.norm();
        return lengths > std::pow(smallest_length * extent, 2) && a * b < -0.5 * lengths;
      }

      /** 1, or -1 for a cell that is numbered the other way round. */
      int orientation(const MshElement &cell) const
      {
        for (unsigned int a = 0; a < cell.n; ++a)
          for (unsigned int b = 0; b < a; ++b)
            if (cell.nodes[a] == cell.nodes[b])
              fault(cell,
                    "found node " + std::to_string(mesh.numbers[cell.nodes[a]]) +
                      " twice in element " + std::to_string(cell.number) + ", expected " +
                      std::to_string(cell.n) + " different nodes of a " + shape_of(cell).name +
                      ".");
        int sign = 0;
        for (unsigned int corner = 0; corner < cell.n; ++corner)
          {
            const double s   = sine(cell, corner);
            const int    own = s > smallest_angle ? 1 : s < -smallest_angle ? -1 : 0;
            if (own == 0 && is_straight(cell, corner))
              continue;
            if (own == 0 || own == -sign)
              fault(cell,
                    title(cell, dim) +
                      " is folded, flat or has its nodes in a wrong order: found " +
                      (own == 0 ? "no angle" : "an angle that opens to the other side") +
                      " at its node " + std::to_string(mesh.numbers[cell.nodes[corner]]) +
                      ", expected corners that all point outwards.");
            sign = own;
          }
        if (sign == 0)
          fault(cell, title(cell, dim) + " is flat, expected one with an area.");
        return sign;
      }

      /** Number a cell the other way round. */
      void turn_around(MshElement &cell) const
      {
        auto &n = cell.nodes;
        if (cell.n == 6 || cell.n == 8)
          for (unsigned int k = 0; k < cell.n / 2; ++k)
            std::swap(n[k], n[k + cell.n / 2]);
        else if (cell.n == 4 && dim == 2)
          std::swap(n[1], n[3]);
        else
          std::swap(n[dim - 1], n[dim == 1 ? 1 : dim]);
      }

      void check_for_twins() const
      {
        std::vector<std::pair<std::array<unsigned int, 8>, unsigned int>> sorted;
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          {
            sorted.emplace_back(mesh.cells[c].nodes, c);
            auto &nodes = sorted.back().first;
            std::fill(nodes.begin() + mesh.cells[c].n, nodes.end(), invalid);
            std::sort(nodes.begin(), nodes.end());
          }
        std::sort(sorted.begin(), sorted.end());
        for (std::size_t k = 1; k < sorted.size(); ++k)
          if (sorted[k].first == sorted[k - 1].first)
            {
              const MshElement &one = mesh.cells[sorted[k - 1].second],
                               &two = mesh.cells[sorted[k].second];
              fault(two,
                    "the " + std::string(shape_of(two).name) + " " + std::to_string(two.number) +
                      " has the same nodes as number " + text_of(one) +
                      ", expected each once (is a surface or volume in two physical groups?).");
            }
      }

      void make_faces()
      {
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          {
            const auto     &nodes = mesh.cells[c].nodes;
            const MshShape &shape = shape_of(mesh.cells[c]);
            for (unsigned int f = 0; f < shape.n_faces; ++f)
              {
                std::array<unsigned int, 4> around{};
                for (unsigned int k = 0; k < shape.n_of_face[f]; ++k)
                  around[k] = nodes[shape.faces[f][k]];
                Face face = make_face(around, shape.n_of_face[f], c);
                if (dim == 1)
                  face.positive = f == 1;
                faces.push_back(face);
              }
          }
        std::sort(faces.begin(), faces.end(), before);
      }

      /** The faces with the same nodes: of one cell or, inside of the body, two. */
      void check_faces() const
      {
        for (std::size_t k = 1; k < faces.size(); ++k)
          {
            const Face &one = faces[k - 1], &two = faces[k];
            if (one.nodes != two.nodes)
              continue;
            const MshElement &cell = mesh.cells[two.element], &other = mesh.cells[one.element];
            if (k > 1 && faces[k - 2].nodes == two.nodes)
              fault(cell,
                    "found three cells with the same " + face_name + ", " +
                      text_of(mesh.cells[faces[k - 2].element]) + ", " + text_of(other) + " and " +
                      text_of(cell) + ", expected two at most.");
            if (one.positive == two.positive || one.across != two.across)
              fault(cell,
                    "the cells " + text_of(other) + " and " + text_of(cell) +
                      (dim == 3 ? " share a " : " share an ") + face_name +
                      (one.across != two.across ? " whose nodes they take in different orders" :
                                                  " and lie on the same side of it") +
                      ": found a folded mesh, expected that cells do not overlap.");
          }
      }

      void check_sides()
      {
        std::vector<Face>      named;
        std::set<unsigned int> inside, again; // elements of two groups with one name
        for (unsigned int s = 0; s < mesh.sides.size(); ++s)
          {
            const auto &n = mesh.sides[s].nodes;
            named.push_back(make_face({{n[0], n[1], n[2], n[3]}}, mesh.sides[s].n, s));
          }
        std::sort(named.begin(), named.end(), before);
        for (std::size_t k = 0; k < named.size(); ++k)
          {
            const MshElement &side = mesh.sides[named[k].element];
            const std::string who  = title(side, dim - 1);
            const auto [first, last] =
              std::equal_range(faces.begin(),
                               faces.end(),
                               named[k],
                               [](const Face &a, const Face &b) { return a.nodes < b.nodes; });
            if (dim > 1 && (first == last || (dim == 3 && first->across != named[k].across)))
              fault(side,
                    who + " is found to be no " + face_name + " of a " +
                      (dim == 3 && side.n == 3 ? "tetrahedron or wedge" :
                                                 shape_of(mesh.cells.front()).name) +
                      ", expected a piece of a side of the body.");
            if (dim > 1 && last - first == 2)
              inside.insert(named[k].element); // between two materials
            if (k == 0 || named[k - 1].nodes != named[k].nodes)
              continue;
            again.insert(named[k].element);
            if (mesh.sides[named[k - 1].element].id != side.id)
              fault(side,
                    who + " is found to be in the physical groups " +
                      std::to_string(mesh.sides[named[k - 1].element].id) + " and " +
                      std::to_string(side.id) + ", expected one.");
          }
        std::vector<MshElement> outside;
        for (unsigned int s = 0; s < mesh.sides.size(); ++s)
          if (again.count(s) == 0)
            (inside.count(s) == 0 ? outside : mesh.interfaces).push_back(mesh.sides[s]);
        mesh.sides.swap(outside);
      }

      /** In 2D its length. */
      double area(const Face &face) const
      {
        const auto between = [&](const unsigned int a, const unsigned int b) {
          Tensor<1, 3> e;
          for (unsigned int d = 0; d < dim; ++d)
            e[d] = mesh.points[b][d] - mesh.points[a][d];
          return e;
        };
        const auto &n = face.nodes;
        if (dim == 2)
          return between(n[0], n[1]).norm();
        if (n[3] == invalid)
          return 0.5 * cross_product_3d(between(n[0], n[1]), between(n[0], n[2])).norm();
        unsigned int beside[2], m = 0; // the corners that are not across
        for (unsigned int k = 1; k < 4; ++k)
          if (n[k] != face.across && m < 2)
            beside[m++] = n[k];
        return 0.5 *
               cross_product_3d(between(n[0], face.across), between(beside[0], beside[1])).norm();
      }

      /** Where pieces of the surface touch that share no nodes, or whose faces do not fit. */
      void find_touching()
      {
        std::vector<MshEdge>        edges;
        std::vector<MshSurfaceFace> around;
        for (std::size_t k = 0; k < faces.size(); ++k)
          {
            const auto &n = faces[k].nodes;
            if ((k > 0 && faces[k - 1].nodes == n) ||
                (k + 1 < faces.size() && faces[k + 1].nodes == n))
              continue;
            mesh.surface += dim > 1 ? area(faces[k]) : 0.;
            around.push_back({n, faces[k].element});
            for (unsigned int a = 0; a < 4 && n[a] != invalid; ++a)
              for (unsigned int b = a + 1; b < 4 && n[b] != invalid; ++b)
                if (n[3] == invalid ||
                    (a == 0 ? faces[k].across != n[b] :
                              faces[k].across == n[a] || faces[k].across == n[b]))
                  edges.emplace_back(n[a], n[b]);
          }
        if (dim == 1)
          return;
        check_fit(mesh, around, name, dim);
        mesh.touching = touching_nodes(mesh, edges, dim);
      }

      /** A mesh of two dimensions lies in the plane of x and y, or one parallel to it; one of one
       * dimension along x. */
      void check_plane(const Vector3 &low, const Vector3 &high) const
      {
        for (unsigned int d = 0; d < dim; ++d)
          if (dim == 2 && high[d] - low[d] <= smallest_length * (high[2] - low[2]))
            msh_error(name,
                      mesh.cells.front().line,
                      "found a mesh in the plane of " + std::string(d == 0 ? "y" : "x") +
                        " and z, expected one in the plane of x and y: in two dimensions z is not "
                        "looked at. Turn the mesh.");
        constexpr double round_off = 1e-4; // lengths are wrong by the square of it
        for (unsigned int d = dim; d < 3; ++d)
          if (high[d] - low[d] > round_off * extent)
            msh_error(name,
                      mesh.cells.front().line,
                      "found " + std::string(1, "xyz"[d]) + " from " + rounded_text(low[d]) +
                        " to " + rounded_text(high[d]) + " in a mesh of dimension " +
                        std::to_string(dim) + ", expected one " +
                        (dim == 2 ? "in the plane of x and y: z is not looked at." :
                                    "along x: y and z are not looked at."));
      }

      MshMesh           &mesh;
      const std::string &name;
      const unsigned int dim;
      const std::string  face_name;
      double             extent = 0.;
      std::vector<Face>  faces; // sorted
    };
  } // namespace


  void check_msh(MshMesh &mesh, const std::string &name, const unsigned int dim)
  {
    Checker(mesh, name, dim).check();
  }
} // namespace PeriDeal
