// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/mesh/mesh_builder.h>

#include <set>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;


  namespace
  {
    template <int dim>
    std::unique_ptr<dealii::Triangulation<dim>> mesh_of(
      const Settings &settings,
      const MPI_Comm  communicator = MPI_COMM_WORLD)
    {
      Scene<dim> scene;
      set(scene, settings);
      std::vector<std::string> notes;
      return build_mesh(scene, communicator, notes);
    }


    /** Measure of the boundary by id, over all processes. */
    template <int dim>
    std::map<unsigned int, double> boundary_measures(const dealii::Triangulation<dim> &mesh)
    {
      std::vector<double> own(256, 0.), all(256);
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary())
              {
                double measure = 1.;
                if constexpr (dim > 1)
                  measure = cell->face(f)->measure();
                own[std::min(cell->face(f)->boundary_id(), 255u)] += measure;
              }
      dealii::Utilities::MPI::sum(own, mesh.get_communicator(), all);
      std::map<unsigned int, double> measures;
      for (unsigned int id = 0; id < all.size(); ++id)
        if (all[id] > 0.)
          measures[id == 255 ? crack_boundary_id : id] = all[id];
      return measures;
    }


    /** Dofs of FE_Q(1), which count doubled vertices. */
    template <int dim>
    unsigned int n_vertices(const dealii::Triangulation<dim> &mesh)
    {
      dealii::DoFHandler<dim> dofs(mesh);
      dofs.distribute_dofs(dealii::FE_Q<dim>(1));
      return dofs.n_dofs();
    }


    Settings square(const std::string &cells, const std::string &cracks)
    {
      return {{"Domain/Cells", cells}, {"Cracks/Segments", cracks}, {"Cracks/Mesh", "faces"}};
    }
  } // namespace


  TEST(Mesh, sides_of_a_box)
  {
    const auto bar = mesh_of<1>({{"Domain/Cells", "7"}, {"Domain/Upper corner", "3"}});
    EXPECT_EQ(bar->n_global_active_cells(), 7u);
    EXPECT_EQ(boundary_measures(*bar), (std::map<unsigned int, double>{{0, 1.}, {1, 1.}}));

    const auto plate = mesh_of<2>({{"Domain/Cells", "6, 4"}, {"Domain/Upper corner", "3, 1"}});
    EXPECT_EQ(plate->n_global_active_cells(), 24u);
    auto sides = boundary_measures(*plate);
    ASSERT_EQ(sides.size(), 4u);
    for (const auto &[id, measure] : sides)
      EXPECT_NEAR(measure, id < 2 ? 1. : 3., 1e-13) << id;

    const auto brick =
      mesh_of<3>({{"Domain/Cells", "2, 4, 6"}, {"Domain/Upper corner", "1, 2, 3"}});
    EXPECT_EQ(brick->n_global_active_cells(), 48u);
    sides = boundary_measures(*brick);
    ASSERT_EQ(sides.size(), 6u);
    for (const auto &[id, measure] : sides)
      EXPECT_NEAR(measure, id < 2 ? 6. : id < 4 ? 3. : 2., 1e-13) << id;
  }


  TEST(Mesh, bars_are_shared_among_processes)
  {
    for (const std::string cells : {"40", "41"})
      {
        const auto   bar = mesh_of<1>({{"Domain/Cells", cells}});
        unsigned int own = 0;
        for (const auto &cell : bar->active_cell_iterators())
          own += cell->is_locally_owned() ? 1 : 0;
        EXPECT_NEAR(own, 40. / n_processes(), 1.) << cells;
      }
  }


  TEST(Mesh, boxes_are_few_coarse_cells_refined)
  {
    const auto mesh = mesh_of<2>({{"Domain/Cells", "48, 80"}});
    EXPECT_EQ(mesh->n_cells(0), 15u); // 48 = 3 x 16, 80 = 5 x 16
    EXPECT_EQ(mesh->n_global_levels(), 5u);
    EXPECT_EQ(mesh_of<2>({{"Domain/Cells", "9, 8"}})->n_global_levels(), 1u);
    EXPECT_EQ(mesh_of<3>({{"Domain/Cells", "8, 8, 4"}})->n_cells(0), 4u);
  }


  TEST(Mesh, crack_inside_opens_but_for_its_tips)
  {
    // 4 cells long: 5 vertices on it, the two tips stay closed.
    const auto mesh = mesh_of<2>(square("8, 8", "0.25,0.5 ; 0.75,0.5"));
    EXPECT_EQ(n_vertices(*mesh), 81u + 3u);
    EXPECT_NEAR(boundary_measures(*mesh)[crack_boundary_id], 1., 1e-13); // both faces
    // Not more refined than its tips allow: the coarse cells are quarters of the square.
    EXPECT_EQ(mesh->n_cells(0), 16u);
    // A crack one cell long has only tips.
    EXPECT_EQ(n_vertices(*mesh_of<2>(square("4, 4", "0.25,0.5 ; 0.5,0.5"))), 25u);
  }


  TEST(Mesh, cracks_that_leave_the_body_open_there)
  {
    // From the middle to the right side: three vertices on it, the tip closed.
    EXPECT_EQ(n_vertices(*mesh_of<2>(square("4, 4", "0.5,0.5 ; 1,0.5"))), 25u + 2u);
    // Given longer than the body.
    EXPECT_EQ(n_vertices(*mesh_of<2>(square("4, 4", "0.5,0.5 ; 1.7,0.5"))), 25u + 2u);
    // Right through: two bodies.
    EXPECT_EQ(n_vertices(*mesh_of<2>(square("4, 4", "-0.5,0.5 ; 1.5,0.5"))), 25u + 5u);
  }


  TEST(Mesh, crossing_cracks_make_four_copies)
  {
    const auto mesh = mesh_of<2>(square("8, 8", "0.25,0.5 ; 0.75,0.5 ; 0.5,0.25 ; 0.5,0.75"));
    // Each opens 3 vertices once; where they cross there are four copies.
    EXPECT_EQ(n_vertices(*mesh), 81u + 2u + 2u + 3u);
    EXPECT_NEAR(boundary_measures(*mesh)[crack_boundary_id], 2., 1e-13);
    // A T: three copies of the vertex where they meet.
    EXPECT_EQ(n_vertices(*mesh_of<2>(square("8, 8", "0.25,0.5 ; 0.75,0.5 ; 0.5,0.5 ; 0.5,0.75"))),
              81u + 2u + 2u + 1u);
  }


  TEST(Mesh, square_crack_in_3D)
  {
    const Settings box{{"Domain/Cells", "4, 4, 4"}, {"Cracks/Mesh", "faces"}};
    const auto     mesh =
      mesh_of<3>(box + Settings{{"Cracks/Polygons",
                                 "0.25,0.25,0.5 ; 0.75,0.25,0.5 ; 0.75,0.75,0.5 ; 0.25,0.75,0.5"}});
    EXPECT_EQ(n_vertices(*mesh), 125u + 1u); // only the vertex in its middle is not on its edge
    EXPECT_NEAR(boundary_measures(*mesh)[crack_boundary_id], 0.5, 1e-13);
    // An L: all corners of the face in its notch lie on the crack's edge, and yet it stays whole.
    const auto notched =
      mesh_of<3>(box + Settings{{"Cracks/Polygons",
                                 "0,0,0.5 ; 1,0,0.5 ; 1,0.25,0.5 ; 0.5,0.25,0.5 ; 0.5,0.75,0.5 ; "
                                 "0.75,0.75,0.5 ; 0.75,0.5,0.5 ; 1,0.5,0.5 ; 1,1,0.5 ; 0,1,0.5"}});
    EXPECT_NEAR(boundary_measures(*notched)[crack_boundary_id], 2. * (1. - 0.125 - 0.0625), 1e-12);
  }


  TEST(Mesh, crack_off_the_faces_is_an_error)
  {
    for (const std::string crack : {"0.25,0.5 ; 0.7,0.5",    // ends within a face
                                    "0.25,0.45 ; 0.75,0.45", // within cells
                                    "0.25,0.25 ; 0.75,0.75", // diagonal
                                    "0.5,0.5 ; 1.3,0.6"})
      SceneTests::expect_error([&] { mesh_of<2>(square("8, 8", crack)); },
                               {"'Mesh = faces'", "'Cracks'", "'Mesh = pairs'"});
    SceneTests::expect_error(
      [&] {
        mesh_of<3>({{"Domain/Cells", "4, 4, 4"},
                    {"Cracks/Mesh", "faces"},
                    {"Cracks/Polygons", "0.25,0.25,0.5 ; 0.75,0.25,0.5 ; 0.75,0.6,0.5"}});
      },
      {"'Mesh = faces'"});
  }


  TEST(Mesh, plate_with_hole)
  {
    const Settings plate{{"Domain/Shape", "plate with hole"},
                         {"Domain/Cells", "20, 20"},
                         {"Domain/Hole center", "0.5, 0.5"},
                         {"Domain/Hole radius", "0.2"}};
    const auto     mesh = mesh_of<2>(plate);
    unsigned int   n    = 0;
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j)
        n += std::hypot((i + 0.5) / 20 - 0.5, (j + 0.5) / 20 - 0.5) >= 0.2 ? 1 : 0;
    EXPECT_EQ(mesh->n_global_active_cells(), n);
    const auto measures = boundary_measures(*mesh);
    EXPECT_NEAR(measures.at(hole_boundary_id), 16 * 0.2 * 0.5, 1e-12); // a staircase: 4 diameters
    for (unsigned int side = 0; side < 4; ++side)
      EXPECT_NEAR(measures.at(side), 1., 1e-12);
    // A crack that starts at the hole.
    const auto cracked = mesh_of<2>(
      plate + Settings{{"Cracks/Segments", "0.5,0.5 ; 0.9,0.5"}, {"Cracks/Mesh", "faces"}});
    EXPECT_EQ(n_vertices(*cracked), n_vertices(*mesh) + 4u);
    EXPECT_NEAR(boundary_measures(*cracked).at(crack_boundary_id), 2. * 0.2, 1e-12);
  }


  namespace
  {
    /** Volumes add up to the body, shares of sides to their measure. */
    template <int dim>
    void expect_full_measure(const Settings                       &settings,
                             const double                          volume,
                             const std::map<unsigned int, double> &expected_sides)
    {
      for (const std::string placement : {"vertices", "cell centers"})
        {
          const Problem<dim> problem(settings + Settings{{"Domain/Nodes", placement}});
          const auto         all = measures_of(*problem.nodes);
          EXPECT_NEAR(all[256], volume, 1e-12 * volume) << placement;
          for (unsigned int id = 0; id < 256; ++id)
            {
              const auto   found  = expected_sides.find(id);
              const double length = found == expected_sides.end() ? 0. : found->second;
              EXPECT_NEAR(all[id], length, 1e-12) << placement << ", side " << id;
            }
        }
    }
  } // namespace


  TEST(Nodes, volumes_and_shares_add_up)
  {
    expect_full_measure<1>({{"Domain/Cells", "13"}, {"Domain/Upper corner", "2"}},
                           2.,
                           {{0, 1.}, {1, 1.}});
    expect_full_measure<2>(
      {{"Domain/Cells", "9, 14"}, {"Domain/Upper corner", "3, 1"}, {"Peridynamics/Horizon", "1"}},
      3.,
      {{0, 1.}, {1, 1.}, {2, 3.}, {3, 3.}});
    expect_full_measure<3>({{"Domain/Cells", "6, 5, 4"},
                            {"Domain/Upper corner", "1, 2, 1"},
                            {"Peridynamics/Horizon", "0.6"}},
                           2.,
                           {{0, 2.}, {1, 2.}, {2, 1.}, {3, 1.}, {4, 2.}, {5, 2.}});
    expect_full_measure<2>(square("16, 16", "0.25,0.5 ; 0.75,0.5"),
                           1.,
                           {{0, 1.}, {1, 1.}, {2, 1.}, {3, 1.}});
    expect_full_measure<2>({{"Domain/Shape", "plate with hole"},
                            {"Domain/Cells", "20, 20"},
                            {"Domain/Hole center", "0.5, 0.5"},
                            {"Domain/Hole shape", "square"},
                            {"Domain/Hole radius", "0.2"}},
                           1. - 0.16,
                           {{0, 1.}, {1, 1.}, {2, 1.}, {3, 1.}, {6, 1.6}});
  }


  TEST(Nodes, full_volume)
  {
    const Problem<2> problem({{"Domain/Cells", "9, 9"}, {"Peridynamics/Nodal volume", "full"}});
    for (unsigned int i = 0; i < problem.nodes->n_owned(); ++i)
      EXPECT_DOUBLE_EQ(problem.nodes->volume(i), 1. / 81.);
  }


  TEST(Nodes, own_points_beside_a_crack)
  {
    // Doubled nodes know on which side they are; no bond of 0.5 < y reaches below.
    const Problem<2>                              problem(square("16, 16", "-1,0.5 ; 2,0.5"));
    std::vector<typename DiffusionBonds<2>::Bond> bonds;
    EXPECT_TRUE(problem.nodes->has_doubled_nodes());
    for (unsigned int i = 0; i < problem.nodes->n_owned(); ++i)
      {
        bonds_of(problem.op()).diffusion_bonds().bonds_of(i, bonds);
        const bool above = problem.nodes->crack_point(i)[1] > 0.5;
        for (const auto &bond : bonds)
          EXPECT_EQ(bond.cut, (problem.nodes->crack_point(bond.neighbor)[1] > 0.5) != above);
      }
  }
} // namespace PeriDeal
