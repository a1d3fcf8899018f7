// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors


#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    Settings file(const std::string &name, const std::string &horizon = "0.3")
    {
      return {{"Domain/Shape", "mesh file"},
              {"Domain/Mesh file", std::string(PERIDEAL_SOURCE_DIR) + "/tests/data/" + name},
              {"Peridynamics/Horizon", horizon}};
    }


    void expect_refused(const Settings &settings, const std::vector<std::string> &parts)
    {
      SceneTests::expect_error([&] { Problem<2> problem(settings); }, parts);
    }


    template <int dim>
    void expect_measures(const Settings                       &settings,
                         const double                          volume,
                         const std::map<unsigned int, double> &sides)
    {
      for (const std::string placement : {"vertices", "cell centers"})
        {
          const Problem<dim> problem(settings + Settings{{"Domain/Nodes", placement}});
          const auto         all = measures_of(*problem.nodes);
          EXPECT_NEAR(all[256], volume, 1e-12) << placement;
          for (const auto &[id, measure] : sides)
            EXPECT_NEAR(all[id], measure, 1e-12) << placement << ", side " << id;
          EXPECT_FALSE(problem.nodes->lattice().has_value());
          EXPECT_EQ(problem.op().size().form, "stored");
        }
    }


    Settings insulated_crack(const std::string &mesh)
    {
      return file("two_materials.msh") + Settings{{"Cracks/Segments", "0,0.5 ; 2,0.5"},
                                                  {"Cracks/Mesh", mesh},
                                                  {"Boundary conditions/Dirichlet", "3: 0 ; 4: 1"}};
    }
  } // namespace


  TEST(MeshFile, volumes_and_sides)
  {
    expect_measures<2>(file("two_materials.msh"), 2., {{1, 1.}, {2, 1.}, {3, 2.}, {4, 2.}});
    expect_measures<3>(file("hexes.msh", "0.7"), 0.6, {{5, 1.}, {6, 1.}});
  }


  TEST(MeshFile, conserves_heat_on_irregular_nodes)
  {
    for (const std::string placement : {"vertices", "cell centers"})
      for (const std::string fraction : {"linear", "none"})
        {
          const Problem<3> problem(
            file("hexes.msh", "0.7") +
            Settings{{"Domain/Nodes", placement}, {"Peridynamics/Volume fraction", fraction}});
          expect_conservation(problem, placement + ", " + fraction);
        }
  }


  TEST(MeshFile, conducts_about_as_much_as_it_should)
  {
    // A linear temperature between left and right, 2 apart; calibrated on the mean of the full
    // families, so exact up to their scatter and, most of all, the cut families on the sides.
    const Settings sides{{"Boundary conditions/Dirichlet", "1: 0 ; 2: 1"}};
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      {
        const Problem<2> problem(file("two_materials.msh", "0.2") + sides, model);
        const double     heat = problem.op().balance(problem.steady(), 0., true).sides.at("2");
        EXPECT_NEAR(heat, 0.5, model == ModelKind::finite_elements ? 1e-10 : 0.1);
      }
  }


  TEST(MeshFile, cut_along_faces)
  {
    // The line y = 1/2 consists of faces: cut right through nothing is conducted any more.
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      {
        const Problem<2> problem(insulated_crack("faces"), model);
        const Vector     u = problem.steady();
        EXPECT_NEAR(problem.op().balance(u, 0., true).sides.at("4"), 0., 1e-10);
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          EXPECT_NEAR(u.local_element(i), problem.sides[i][1] > 0.5 ? 1. : 0., 1e-9);
      }
    expect_refused(file("two_materials.msh") +
                     Settings{{"Cracks/Segments", "0.3,0.4 ; 1.7,0.6"}, {"Cracks/Mesh", "faces"}},
                   {"'Mesh = faces'", "cell faces"});
  }


  TEST(MeshFile, same_on_every_number_of_processes)
  {
    for (const std::string mesh : {"faces", "pairs"})
      for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
        {
          const Problem<2> all(insulated_crack(mesh), model),
            alone(insulated_crack(mesh), model, MPI_COMM_SELF);
          const Vector r = all.residual(all.values(bumpy<2>)),
                       s = alone.residual(alone.values(bumpy<2>));
          EXPECT_LT(difference(all, r, alone, s), 1e-12 * s.linfty_norm());
          EXPECT_EQ(all.op().size().bonds, alone.op().size().bonds);
        }
  }


  TEST(MeshFile, materials_by_id)
  {
    // Two layers in series, 1 : 100, 0 below and 1 on top: heat 2/(0.5/1 + 0.5/100).
    const Settings layers =
      file("two_materials.msh") + Settings{{"Material/Phases/Regions", "upper: mesh(9)"},
                                           {"Material/Phases/Conductivity", "upper: 100"},
                                           {"Boundary conditions/Dirichlet", "3: 0 ; 4: 1"}};
    const double exact = 2. / (0.5 + 0.5 / 100.);
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      {
        const Problem<2> problem(layers, model);
        const double     heat = problem.op().balance(problem.steady(), 0., true).sides.at("4");
        EXPECT_NEAR(heat, exact, model == ModelKind::finite_elements ? 1e-10 : 0.3 * exact);
        for (const double y : {0.1, 0.4, 0.6, 0.9})
          EXPECT_EQ(problem.scene.material.conductivity.value(Point<2>(0.77, y)),
                    y > 0.5 ? 100. : 1.);
      }
    expect_refused(layers + Settings{{"Material/Phases/Regions", "upper: mesh(8)"}},
                   {"'Regions' in section 'Material/Phases'", "mesh(8)", "7, 9"});
    expect_refused({{"Material/Phases/Regions", "upper: mesh(9)"},
                    {"Material/Phases/Conductivity", "upper: 100"}},
                   {"'Regions' in section 'Material/Phases'", "mesh file"});
  }


  TEST(MeshFile, mistakes)
  {
    for (const std::string name : {"broken.msh", "hexes.msh", "missing.msh"})
      expect_refused(file(name), {"'Mesh file' in section 'Domain'", name});
  }
} // namespace PeriDeal
