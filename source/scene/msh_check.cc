// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace PeriDeal
{
  namespace
  {
    using Vector3 = std::array<double, 3>;

    // Corners of the cells as Gmsh numbers them: the ends of the edges at each of them, which in
    // this order are right-handed, and the corners of the faces in the order in which they are seen
    // from outside counter-clockwise (in 2D: the body lies to the left).
    constexpr unsigned int neighbors_2[4][2] = {{1, 3}, {2, 0}, {3, 1}, {0, 2}};
    constexpr unsigned int neighbors_3[8][3] =
      {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
    constexpr unsigned int faces_3[6][4] =
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

    /** Edges that enclose less than this, in terms of the sine of their angle, are taken for
     * parallel. */
    constexpr double smallest_angle = 1e-8;

    /** Nodes closer than this, in terms of the extent of the mesh, are taken for one. */
    constexpr double smallest_length = 1e-12;


    constexpr const char *names[4] = {"point", "line", "quadrilateral", "hexahedron"};

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
                   const unsigned int                 element,
                   const bool                         flipped)
    {
      Face face{around, element, 0, true};
      std::fill(face.nodes.begin() + n, face.nodes.end(), invalid);
      std::sort(face.nodes.begin(), face.nodes.end());
      const unsigned int first =
        std::min_element(around.begin(), around.begin() + n) - around.begin();
      if (n == 2)
        face.positive = first == 0;
      else if (n == 4)
        {
          face.across   = around[(first + 2) % 4];
          face.positive = around[(first + 1) % 4] < around[(first + 3) % 4];
        }
      face.positive = face.positive != flipped;
      return face;
    }


    class Checker
    {
    public:
      Checker(MshMesh &mesh, const std::string &name, const unsigned int dim)
        : mesh(mesh)
        , name(name)
        , dim(dim)
        , cell_name(names[dim])
        , face_name(dim == 3 ? "face" :
                    dim == 2 ? "edge" :
                               "end")
      {}

      void check()
      {
        Vector3 size;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const auto ends =
              std::minmax_element(mesh.points.begin(),
                                  mesh.points.end(),
                                  [d](const Vector3 &a, const Vector3 &b) { return a[d] < b[d]; });
            size[d] = (*ends.second)[d] - (*ends.first)[d];
          }
        check_plane(size);
        extent = *std::max_element(size.begin(), size.begin() + dim);
        for (const MshElement &cell : mesh.cells)
          turned.push_back(orientation(cell) < 0);
        check_for_twins();
        make_faces();
        check_faces();
        check_sides();
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

      Vector3 edge(const MshElement &cell, const unsigned int from, const unsigned int to) const
      {
        Vector3 e;
        for (unsigned int d = 0; d < 3; ++d)
          e[d] = d < dim ? mesh.points[cell.nodes[to]][d] - mesh.points[cell.nodes[from]][d] : 0.;
        return e;
      }

      /** Volume (3D), area (2D) or length of what the edges at a corner span, over the product of
       * their lengths. 0 if one has no length. */
      double sine(const MshElement &cell, const unsigned int corner) const
      {
        const auto unit = [&](const unsigned int to) {
          Vector3      e      = edge(cell, corner, to);
          const double length = std::hypot(e[0], e[1], e[2]);
          for (double &x : e)
            x = length > smallest_length * extent ? x / length : 0.;
          return e;
        };
        if (dim == 1)
          return unit(1 - corner)[0] * (corner == 0 ? 1. : -1.);
        if (dim == 2)
          {
            const Vector3 a = unit(neighbors_2[corner][0]), b = unit(neighbors_2[corner][1]);
            return a[0] * b[1] - a[1] * b[0];
          }
        const Vector3 a = unit(neighbors_3[corner][0]), b = unit(neighbors_3[corner][1]),
                      c = unit(neighbors_3[corner][2]);
        return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
      }

      /**
       * A corner of a quadrilateral whose edges go on straight, as recombined triangles have it.
       */
      bool is_straight(const MshElement &cell, const unsigned int corner) const
      {
        if (dim != 2)
          return false;
        const Vector3 a      = edge(cell, corner, neighbors_2[corner][0]),
                      b      = edge(cell, corner, neighbors_2[corner][1]);
        const double lengths = std::hypot(a[0], a[1]) * std::hypot(b[0], b[1]);
        return lengths > std::pow(smallest_length * extent, 2) &&
               a[0] * b[0] + a[1] * b[1] < -0.5 * lengths;
      }

      /** 1, or -1 for a cell that is numbered the other way round. */
      int orientation(const MshElement &cell) const
      {
        for (unsigned int a = 0; a < cell.n; ++a)
          for (unsigned int b = 0; b < a; ++b)
            if (cell.nodes[a] == cell.nodes[b])
              msh_error(name,
                        cell.line,
                        "found node " + std::to_string(mesh.numbers[cell.nodes[a]]) +
                          " twice in element " + std::to_string(cell.number) + ", expected " +
                          std::to_string(cell.n) + " different nodes of a " + cell_name + ".");
        int sign = 0;
        for (unsigned int corner = 0; corner < cell.n; ++corner)
          {
            const double s   = sine(cell, corner);
            const int    own = s > smallest_angle ? 1 : s < -smallest_angle ? -1 : 0;
            if (own == 0 && is_straight(cell, corner))
              continue;
            if (own == 0 || own == -sign)
              msh_error(name,
                        cell.line,
                        "the " + cell_name + " " + std::to_string(cell.number) + " of the nodes " +
                          nodes_of(cell) +
                          " is folded, flat or has its nodes in a wrong order: found " +
                          (own == 0 ? "no angle" : "an angle that opens to the other side") +
                          " at its node " + std::to_string(mesh.numbers[cell.nodes[corner]]) +
                          ", expected corners that all point outwards.");
            sign = own;
          }
        if (sign == 0)
          msh_error(name,
                    cell.line,
                    "the " + cell_name + " " + std::to_string(cell.number) + " of the nodes " +
                      nodes_of(cell) + " is flat, expected one with an area.");
        return sign;
      }

      void check_for_twins() const
      {
        std::vector<std::pair<std::array<unsigned int, 8>, unsigned int>> sorted;
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          {
            sorted.emplace_back(mesh.cells[c].nodes, c);
            std::sort(sorted.back().first.begin(), sorted.back().first.end());
          }
        std::sort(sorted.begin(), sorted.end());
        for (std::size_t k = 1; k < sorted.size(); ++k)
          if (sorted[k].first == sorted[k - 1].first)
            {
              const MshElement &one = mesh.cells[sorted[k - 1].second],
                               &two = mesh.cells[sorted[k].second];
              msh_error(name,
                        two.line,
                        "the " + cell_name + " " + std::to_string(two.number) +
                          " has the same nodes as number " + text_of(one) +
                          ", expected each once (is a surface or volume in two physical groups?).");
            }
      }

      void make_faces()
      {
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          {
            const auto &nodes = mesh.cells[c].nodes;
            for (unsigned int f = 0; f < 2 * dim; ++f)
              {
                std::array<unsigned int, 4> around{};
                for (unsigned int k = 0; k < 1u << (dim - 1); ++k)
                  around[k] = nodes[dim == 1 ? f : dim == 2 ? (f + k) % 4 : faces_3[f][k]];
                Face face = make_face(around, 1u << (dim - 1), c, turned[c]);
                if (dim == 1)
                  face.positive = (f == 1) != turned[c];
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
              msh_error(name,
                        cell.line,
                        "found three cells with the same " + face_name + ", " +
                          text_of(mesh.cells[faces[k - 2].element]) + ", " + text_of(other) +
                          " and " + text_of(cell) + ", expected two at most.");
            if (one.positive == two.positive || one.across != two.across)
              msh_error(name,
                        cell.line,
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
            named.push_back(make_face({{n[0], n[1], n[2], n[3]}}, mesh.sides[s].n, s, false));
          }
        std::sort(named.begin(), named.end(), before);
        for (std::size_t k = 0; k < named.size(); ++k)
          {
            const MshElement &side  = mesh.sides[named[k].element];
            const std::string title = "the " + std::string(names[dim - 1]) + " " +
                                      std::to_string(side.number) + " of the nodes " +
                                      nodes_of(side);
            const auto [first, last] =
              std::equal_range(faces.begin(),
                               faces.end(),
                               named[k],
                               [](const Face &a, const Face &b) { return a.nodes < b.nodes; });
            if (dim > 1 && (first == last || (dim == 3 && first->across != named[k].across)))
              msh_error(name,
                        side.line,
                        title + " is found to be no " + face_name + " of a " + cell_name +
                          ", expected a piece of a side of the body.");
            if (dim > 1 && last - first == 2)
              inside.insert(named[k].element); // between two materials
            if (k == 0 || named[k - 1].nodes != named[k].nodes)
              continue;
            again.insert(named[k].element);
            if (mesh.sides[named[k - 1].element].id != side.id)
              msh_error(name,
                        side.line,
                        title + " is found to be in the physical groups " +
                          std::to_string(mesh.sides[named[k - 1].element].id) + " and " +
                          std::to_string(side.id) + ", expected one.");
          }
        std::vector<MshElement> outside;
        for (unsigned int s = 0; s < mesh.sides.size(); ++s)
          if (again.count(s) == 0)
            (inside.count(s) == 0 ? outside : mesh.interfaces).push_back(mesh.sides[s]);
        mesh.sides.swap(outside);
      }

      /** A mesh of two dimensions lies in the plane of x and y. */
      void check_plane(const Vector3 &size) const
      {
        for (unsigned int d = 0; d < dim; ++d)
          if (dim == 2 && size[d] <= smallest_length * size[2])
            msh_error(name,
                      mesh.cells.front().line,
                      "found a mesh in the plane of " + std::string(d == 0 ? "y" : "x") +
                        " and z, expected one in the plane of x and y: in two dimensions z is not "
                        "looked at. Turn the mesh.");
      }

      MshMesh           &mesh;
      const std::string &name;
      const unsigned int dim;
      const std::string  cell_name, face_name;
      double             extent = 0.;
      std::vector<bool>  turned; // by cell
      std::vector<Face>  faces;  // sorted
    };
  } // namespace


  void check_msh(MshMesh &mesh, const std::string &name, const unsigned int dim)
  {
    Checker(mesh, name, dim).check();
  }
} // namespace PeriDeal
