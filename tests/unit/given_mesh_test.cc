// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/grid/grid_tools.h>

#include <perideal/mesh/given_mesh.h>
#include <perideal/scene/scene.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace PeriDeal;

namespace
{
  /** The volume of a generator's mesh, its cells halved once or twice. */
  template <int dim>
  double volume_of(const std::string &generator,
                   const std::string &arguments,
                   const unsigned int halvings)
  {
    Scene<dim> scene;
    parse_scene<dim>(
      {"a.prm",
       "set Dimension = " + std::to_string(dim) +
         "\nset Models = finite elements\nsubsection Domain\n  set Shape = generator\n  set Generator = " +
         generator + "\n  set Generator arguments = " + arguments + "\nend\n"},
      scene);
    dealii::Triangulation<dim> mesh;
    {
      const GivenMesh<dim> given = given_mesh(scene.domain, MPI_COMM_SELF);
      mesh.create_triangulation(given.coarse.vertices, given.coarse.cells, dealii::SubCellData());
      given.mark(mesh); // nothing of it is needed later
    }
    mesh.refine_global(halvings);
    return dealii::GridTools::volume(mesh);
  }
} // namespace


TEST(GivenMeshes, round_sides_stay_round_as_cells_are_halved)
{
  struct Body
  {
    std::string generator, arguments;
    double      area;
  };
  const double pi = std::acos(-1.);
  for (const Body &body :
       {Body{"hyper_shell", "0, 0 : 0.5 : 1 : 12 : true", 0.75 * pi},
        Body{"hyper_ball", "0, 0 : 1 : true", pi},
        Body{"hyper_ball_balanced", "0, 0 : 1", pi},
        Body{"eccentric_hyper_shell", "0, 0 : 0.1, 0 : 0.4 : 1 : 12", 0.84 * pi},
        Body{"plate_with_a_hole",
             "0.4 : 1 : 1 : 1 : 1 : 1 : 0, 0 : 0 : 1 : 1 : 2 : false",
             16. - 0.16 * pi},
        Body{"channel_with_cylinder", "0.03 : 2 : 2.0 : false", 2.2 * 0.41 - 0.0025 * pi}})
    {
      SCOPED_TRACE(body.generator);
      const double coarse = volume_of<2>(body.generator, body.arguments, 1) - body.area,
                   fine   = volume_of<2>(body.generator, body.arguments, 3) - body.area;
      EXPECT_LT(std::abs(fine), 0.01 * body.area);
      EXPECT_NEAR(fine / coarse, 1. / 16., 0.02); // of second order
    }
  const double torus = 2. * pi * pi * 2. * 0.25;
  EXPECT_NEAR(volume_of<3>("torus", "2 : 0.5 : 6 : 6.283185307179586", 3), torus, 0.02 * torus);
  EXPECT_NEAR(volume_of<3>("cylinder", "1 : 2", 3), 4. * pi, 0.02 * 4. * pi);
}
