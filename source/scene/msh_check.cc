// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace PeriDeal
{
  using namespace dealii;

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

      /** "the hexahedron 7 of the nodes 1, 2, ..." */
      std::string title(const MshElement &element, const std::string &kind) const
      {
        return "the " + kind + " " + std::to_string(element.number) + " of the nodes " +
               nodes_of(element);
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
        const unsigned int end = dim == 1 ? 1 - corner :
                                 dim == 2 ? neighbors_2[corner][k] :
                                            neighbors_3[corner][k];
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
        if (dim != 2)
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
                      std::to_string(cell.n) + " different nodes of a " + cell_name + ".");
        int sign = 0;
        for (unsigned int corner = 0; corner < cell.n; ++corner)
          {
            const double s   = sine(cell, corner);
            const int    own = s > smallest_angle ? 1 : s < -smallest_angle ? -1 : 0;
            if (own == 0 && is_straight(cell, corner))
              continue;
            if (own == 0 || own == -sign)
              fault(cell,
                    title(cell, cell_name) +
                      " is folded, flat or has its nodes in a wrong order: found " +
                      (own == 0 ? "no angle" : "an angle that opens to the other side") +
                      " at its node " + std::to_string(mesh.numbers[cell.nodes[corner]]) +
                      ", expected corners that all point outwards.");
            sign = own;
          }
        if (sign == 0)
          fault(cell, title(cell, cell_name) + " is flat, expected one with an area.");
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
              fault(two,
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
            named.push_back(make_face({{n[0], n[1], n[2], n[3]}}, mesh.sides[s].n, s, false));
          }
        std::sort(named.begin(), named.end(), before);
        for (std::size_t k = 0; k < named.size(); ++k)
          {
            const MshElement &side = mesh.sides[named[k].element];
            const std::string who  = title(side, names[dim - 1]);
            const auto [first, last] =
              std::equal_range(faces.begin(),
                               faces.end(),
                               named[k],
                               [](const Face &a, const Face &b) { return a.nodes < b.nodes; });
            if (dim > 1 && (first == last || (dim == 3 && first->across != named[k].across)))
              fault(side,
                    who + " is found to be no " + face_name + " of a " + cell_name +
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
