// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Families of the linear peridynamic solid that go on beyond the boundary of a mesh (`Surface
// correction = auto`).

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <perideal/bonds/boundary_images.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;
  using dealii::Tensor;
  using dealii::Triangulation;


  /** A mesh in a file for as long as this lives; sides as deal.II numbers them. */
  template <int dim>
  class MeshFile
  {
  public:
    MeshFile(const std::string &name, const Triangulation<dim> &mesh)
      : path(name + "_" + std::to_string(dim) + ".msh")
    {
      if (this_process() == 0)
        write(mesh);
      MPI_Barrier(MPI_COMM_WORLD);
    }

    ~MeshFile()
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (this_process() == 0)
        std::remove(path.c_str());
    }

    Settings settings(const double horizon) const
    {
      const std::string sides = dim == 2 ? "0: 0, 0" : "0: 0, 0, 0";
      return {{"Domain/Shape", "mesh file"},
              {"Domain/Mesh file", path},
              {"Peridynamics/Horizon", std::to_string(horizon)},
              {"Peridynamics/Surface correction", "auto"},
              {"Material/Young modulus", "3"},
              {"Material/Poisson ratio", "0.2"},
              {"Boundary conditions/Displacement", sides}};
    }

  private:
    void write(const Triangulation<dim> &mesh) const
    {
      // Gmsh goes around a quadrilateral.
      const std::array<unsigned int, 8> order{0, 1, 3, 2, 4, 5, 7, 6};
      std::vector<std::string>          elements;
      const auto add = [&](const unsigned int type, const unsigned int id, const auto &object) {
        std::ostringstream line;
        line << elements.size() + 1 << ' ' << type << " 2 " << id << ' ' << id;
        for (unsigned int k = 0; k < object->n_vertices(); ++k)
          line << ' ' << object->vertex_index(order[k]) + 1;
        elements.push_back(line.str());
      };
      for (const auto &cell : mesh.active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            add(dim == 2 ? 1 : 3, face->boundary_id(), face);
      for (const auto &cell : mesh.active_cell_iterators())
        add(dim == 2 ? 3 : 5, 99, cell);
      std::ofstream file(path);
      file.precision(17);
      file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.n_vertices() << '\n';
      for (unsigned int v = 0; v < mesh.n_vertices(); ++v)
        {
          file << v + 1;
          for (unsigned int d = 0; d < 3; ++d)
            file << ' ' << (d < dim ? mesh.get_vertices()[v][d] : 0.);
          file << '\n';
        }
      file << "$EndNodes\n$Elements\n" << elements.size() << '\n';
      for (const std::string &line : elements)
        file << line << '\n';
      file << "$EndElements\n";
    }

    const std::string path;
  };


  /** The mesh of box(). */
  template <int dim>
  void make_lattice(Triangulation<dim> &mesh)
  {
    const std::array<unsigned int, 3> n{dim == 2 ? 16u : 8u, dim == 2 ? 12u : 6u, 4u};
    Point<dim>                        upper;
    for (unsigned int d = 0; d < dim; ++d)
      upper[d] = 1. - 0.25 * d;
    dealii::GridGenerator::subdivided_hyper_rectangle(
      mesh,
      std::vector<unsigned int>(n.begin(), n.begin() + dim),
      Point<dim>(),
      upper,
      true);
  }


  /**
   * A quarter of a square with a hole, graded towards it, of irregular cells: curved, flat, convex.
   */
  void make_irregular(Triangulation<2> &mesh)
  {
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh,
                                                      {10, 16},
                                                      Point<2>(),
                                                      Point<2>(1., 1.),
                                                      true);
    dealii::GridTools::transform(
      [](const Point<2> &p) {
        const bool   inside = p[0] > 1e-9 && p[0] < 1. - 1e-9 && p[1] > 1e-9 && p[1] < 1. - 1e-9;
        const double s      = p[0] - 0.3 * p[0] * (1. - p[0]) +
                         (inside ? 0.02 * std::sin(57. * p[1] + 31. * p[0]) : 0.),
                     t   = p[1] + (inside ? 0.015 * std::sin(43. * p[0] - 71. * p[1]) : 0.);
        const double phi = 0.5 * dealii::numbers::PI * t, c = std::cos(phi), e = std::sin(phi);
        const double square = 1. / std::max(c, e), r = 0.4 * (1. - s) + square * s;
        return Point<2>(r * c, r * e);
      },
      mesh);
  }


  /** |K u|, v K u and the energy of u on another order of places. */
  template <int dim>
  std::array<double, 3> numbers_of(const Body<dim> &body)
  {
    const Vector u = body.values(bumpy_vector<dim>), y = body.product(u);
    return {y.l2_norm(), y * body.values(linear_field<dim>), body.op().energy(u)};
  }


  /**
   * Forces of a lattice and of the same mesh from a file are the same, with and without a plane of
   * symmetry.
   */
  template <int dim>
  void check_lattice(const bool symmetric)
  {
    Triangulation<dim> mesh;
    make_lattice(mesh);
    const MeshFile<dim> file("lattice", mesh);
    Settings            more{{"Peridynamics/Surface correction", "auto"},
                             {"Peridynamics/Calibration", "discrete"}}; // meshes have no other
    if (symmetric)
      more.push_back({"Boundary conditions/Symmetry", dim == 2 ? "bottom" : "back"});
    const Body<dim> lattice(box<dim>() + more, ModelKind::peridynamics);
    if (symmetric)
      more.back().second = dim == 2 ? "2" : "4";
    const Body<dim> body(file.settings(lattice.scene.horizon()) + more, ModelKind::peridynamics);
    const auto      found = numbers_of(body), expected = numbers_of(lattice);
    for (unsigned int n = 0; n < 3; ++n)
      EXPECT_NEAR(found[n] / expected[n], 1., 1e-11) << dim << "D, " << n;
  }
} // namespace


TEST(BoundaryImages, are_those_of_a_lattice)
{
  for (const bool symmetric : {false, true})
    {
      check_lattice<2>(symmetric);
      check_lattice<3>(symmetric);
    }
}


TEST(BoundaryImages, uniform_strain_on_irregular_nodes)
{
  Triangulation<2> mesh;
  make_irregular(mesh);
  const MeshFile<2>       file("irregular", mesh);
  const Body<2>           body(file.settings(0.2), ModelKind::peridynamics);
  const StateOperator<2> &op = *body.states;
  const Vector            u = body.values(linear_field<2>), b = body.values(bumpy_vector<2>),
               y = body.product(u), z = body.product(b);
  const std::vector<double> theta =
    nodal_dilatations(op.bonds(), body.values([](const Point<2> &p) { return p - Point<2>(); }));
  const auto tensors = op.tensors(u);
  for (unsigned int i = 0; i < theta.size(); ++i)
    {
      EXPECT_LT((tensors.strain[i] - symmetrize(some_gradient<2>())).norm(), 1e-11);
      EXPECT_NEAR(theta[i], 2., 1e-11);
    }
  // Forces balance, the stiffness is symmetric, the energy is that of the forces and positive.
  for (const Vector &motion : op.near_null_space())
    EXPECT_LT(std::abs(motion * y), 1e-11 * motion.linfty_norm() * y.l1_norm());
  EXPECT_NEAR((y * b) / (z * u), 1., 1e-11);
  EXPECT_NEAR(2. * op.energy(b) / (z * b), 1., 1e-11);
  EXPECT_GT(op.energy(b), 0.);
}


TEST(BoundaryImages, same_on_all_processes)
{
  Triangulation<2> mesh;
  make_irregular(mesh);
  const MeshFile<2> file("ranks", mesh);
  const Settings    settings =
    file.settings(0.17) + Settings{{"Boundary conditions/Symmetry", "2 ; 3"}};
  const Body<2> all(settings, ModelKind::peridynamics),
    one(settings, ModelKind::peridynamics, MPI_COMM_SELF);
  const auto found = numbers_of(all), expected = numbers_of(one);
  for (unsigned int n = 0; n < 3; ++n)
    EXPECT_NEAR(found[n] / expected[n], 1., 1e-12) << n;
}


/**
 * Half a body with a plane of symmetry, a crack across the plane, and the whole one: forces,
 * damage, and what breaks.
 */
TEST(BoundaryImages, half_a_body_breaks_as_the_whole_one)
{
  const auto make = [](Triangulation<2> &mesh, const bool whole) {
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh,
                                                      {whole ? 32u : 16u, 12u},
                                                      Point<2>(whole ? -1. : 0., 0.),
                                                      Point<2>(1., 0.75),
                                                      true);
    dealii::GridTools::transform(
      [](const Point<2> &p) {
        const double x = std::abs(p[0]), y = p[1];
        const double edge = x * (1. - x) * y * (0.75 - y);
        return Point<2>(p[0] * (1. + 0.6 * edge * std::sin(23. * x + 17. * y)),
                        y + 0.3 * edge * std::cos(29. * x * x - 13. * y));
      },
      mesh);
  };
  const auto field = [](const Point<2> &p) {
    Tensor<1, 2> u;
    u[0] = 0.02 * std::sin(2. * p[0]) * (1. + p[1]);
    u[1] = 0.02 * std::cos(3. * p[0]) * p[1] * p[1];
    return u;
  };
  Triangulation<2> mesh[2];
  make(mesh[0], false);
  make(mesh[1], true);
  const MeshFile<2> half_file("half", mesh[0]), whole_file("whole", mesh[1]);
  for (const bool cracked : {false, true})
    {
      const Settings more{{"Boundary conditions/Displacement", "1: 0, 0"},
                          {"Elasticity/Solver", "dynamics"},
                          {"Material/Critical stretch", "0.03"}};
      const auto     crack = [&](const std::string &text) {
        return cracked ? Settings{{"Cracks/Segments", text}, {"Elasticity/Contact", "false"}} :
                             Settings();
      };
      const Body<2> half(half_file.settings(0.17) + more + crack("0,0.412 ; 0.21,0.412") +
                           Settings{{"Boundary conditions/Symmetry", "0"}},
                         ModelKind::peridynamics,
                         MPI_COMM_SELF),
        whole(whole_file.settings(0.17) + more + crack("-0.21,0.412 ; 0.21,0.412") +
                Settings{{"Boundary conditions/Traction", "0: 0, 0"}},
              ModelKind::peridynamics,
              MPI_COMM_SELF);
      const Vector u = half.values(field), v = whole.values(field);
      for (const bool broken : {false, true})
        {
          if (broken)
            {
              const auto n_half = half.op().break_bonds(u, 0.), n = whole.op().break_bonds(v, 0.);
              EXPECT_GT(n_half, 100u);
              EXPECT_NEAR(static_cast<double>(n_half), 0.5 * n, 7.); // those that the plane halves
            }
          const Vector of_whole = whole.product(v);
          EXPECT_LT(difference(half, half.product(u), whole, of_whole, 1e-9),
                    1e-11 * of_whole.linfty_norm());
          const auto damage_half = half.states->breaking().damage(),
                     damage      = whole.states->breaking().damage();
          for_each_pair(
            half,
            whole,
            [&](const unsigned int i, const unsigned int k) {
              EXPECT_NEAR(damage_half[i], damage[k], 1e-12);
            },
            1e-9);
          EXPECT_EQ(damage_half.size(), 17u * 13u);
          EXPECT_NEAR(2. * half.op().energy(u) / whole.op().energy(v), 1., 1e-11);
        }
    }
}


namespace
{
  /** A square or cube from which a part is cut out; each plane of its boundary is a side. */
  template <int dim>
  void make_l_shape(Triangulation<dim> &mesh)
  {
    dealii::GridGenerator::hyper_L(mesh, -1., 1.); // its colors are not there in 3D
    for (const auto &face : mesh.active_face_iterators())
      for (unsigned int d = 0; d < dim && face->at_boundary(); ++d)
        if (std::abs(face->vertex(0)[d] - face->center()[d]) < 1e-9)
          face->set_boundary_id(3 * d + static_cast<unsigned int>(1.1 + face->center()[d]));
  }


  /** What a node and its images at its place fill of h^dim. */
  template <int dim>
  double filled(const Nodes<dim>                      &nodes,
                const std::vector<BoundaryImage<dim>> &images,
                const unsigned int                     m,
                const double                           h)
  {
    double volume = nodes.volume(m);
    for (const BoundaryImage<dim> &image : images)
      if (image.origin == m && image.place.distance(nodes.position(m)) < 1e-9)
        volume += image.volume;
    return volume / std::pow(h, dim);
  }


  /**
   * In the corner into a square or cube from which a part is cut out, the images of the node there
   * fill what the body lacks, alone and beside a side that the edge of the corner meets.
   */
  template <int dim>
  void check_reentrant_corner()
  {
    Triangulation<dim> mesh;
    make_l_shape(mesh);
    mesh.refine_global(dim == 2 ? 4 : 2);
    const MeshFile<dim> file("reentrant", mesh);
    const Body<dim>     body(file.settings(dim == 2 ? 0.3 : 0.8),
                         ModelKind::peridynamics,
                         MPI_COMM_SELF);
    const Nodes<dim>   &nodes  = *body.nodes;
    const double        h      = dim == 2 ? 1. / 16. : 1. / 4.;
    const auto          images = boundary_images<dim>(
      nodes,
      {},
      [](const dealii::types::boundary_id) { return true; },
      3. * h);
    unsigned int n_corners = 0;
    for (unsigned int m = 0; m < nodes.n_local(); ++m)
      {
        // Where all sides of the cut-out meet; in 3D on its edges, too, and where these end.
        unsigned int n_at_zero = 0;
        bool         beyond    = false;
        for (unsigned int d = 0; d < dim; ++d)
          {
            n_at_zero += std::abs(nodes.position(m)[d]) < 1e-9;
            beyond = beyond || nodes.position(m)[d] < -1e-9;
          }
        if (n_at_zero < 2 || beyond)
          continue;
        ++n_corners;
        EXPECT_NEAR(filled(nodes, images, m, h), 1., 1e-9) << nodes.position(m);
      }
    EXPECT_EQ(n_corners, dim == 2 ? 1u : 3u * 4u + 1u);
  }

  /** What node and images at its place fill of h^dim, at the origin. */
  template <int dim>
  double filled_at_origin(const Nodes<dim>                                            &nodes,
                          const std::vector<dealii::types::boundary_id>               &symmetry,
                          const std::function<bool(const dealii::types::boundary_id)> &goes_on,
                          const double                                                 h)
  {
    double     sum    = 0.;
    const auto images = boundary_images<dim>(nodes, symmetry, goes_on, 3. * h);
    for (unsigned int m = 0; m < nodes.n_local(); ++m)
      if (nodes.position(m).norm() < 1e-9)
        sum += filled(nodes, images, m, h);
    return sum;
  }


  /** The upper half of a notch of 90 degrees, its tip in the origin; sides of their direction. */
  Triangulation<2> half_notch()
  {
    Triangulation<2> mesh;
    const auto       quad = [](const std::vector<unsigned int> &vertices) {
      dealii::CellData<2> cell;
      std::copy(vertices.begin(), vertices.end(), cell.vertices.begin());
      return cell;
    };
    mesh.create_triangulation({{0., 0.}, {1., 0.}, {0., 1.}, {1., 1.}, {-1., 1.}, {-1., 2.}},
                              {quad({0, 1, 2, 3}), quad({4, 0, 5, 2})},
                              {});
    for (const auto &face : mesh.active_face_iterators())
      if (face->at_boundary())
        {
          const Point<2> p = face->center();
          face->set_boundary_id(p[1] < 1e-9 ? 1 : std::abs(p[0] + p[1]) < 1e-9 ? 2 : 0);
        }
    mesh.refine_global(4);
    return mesh;
  }
} // namespace


TEST(BoundaryImages, fill_reentrant_corners)
{
  check_reentrant_corner<2>();
  check_reentrant_corner<3>();
}


TEST(BoundaryImages, fill_reentrant_corners_in_planes_of_symmetry)
{
  const Triangulation<2> mesh = half_notch();
  const MeshFile<2>      file("half_notch", mesh);
  const Body<2>          body(file.settings(0.3), ModelKind::peridynamics, MPI_COMM_SELF);
  // Of the whole notch, whose nodes above and below the tip make parallelograms.
  const auto all = [](const dealii::types::boundary_id) { return true; };
  EXPECT_NEAR(filled_at_origin<2>(*body.nodes, {1}, all, 1. / 16.), 4. / 3., 1e-9);
}


TEST(BoundaryImages, fill_their_share_of_reentrant_corners_beside_sides_that_end)
{
  Triangulation<2> mesh;
  make_l_shape(mesh);
  mesh.refine_global(4);
  dealii::types::boundary_id ending = dealii::numbers::invalid_boundary_id;
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary() && std::abs(face->center()[0]) < 1e-9)
      ending = face->boundary_id();
  const MeshFile<2> file("ending", mesh);
  const Body<2>     body(file.settings(0.3), ModelKind::peridynamics, MPI_COMM_SELF);
  const auto goes_on = [ending](const dealii::types::boundary_id side) { return side != ending; };
  EXPECT_NEAR(filled_at_origin<2>(*body.nodes, {}, goes_on, 1. / 16.), 7. / 8., 1e-9);
}
