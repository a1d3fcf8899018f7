// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/grid/grid_tools.h>

#include <perideal/analysis/phase_statistics.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/operators/solid/state_operator.h>

#include "image_test_tools.h"

namespace PeriDeal
{
  using namespace ImageTests;
  using namespace OperatorTests;
  using dealii::Point;
  using SceneTests::expect_parts;
  using SceneTests::message_of;

  namespace
  {
    const std::vector<std::string> small{"9950", "9550", "9999"};
  } // namespace


  TEST(Image, colors_and_ranges)
  {
    const ImageColors colors(
      "silver: rgb(255,255,255) ; oxide: 40..140 ; void: 0 ; void: rgb(255,0,0)",
      30.,
      "'E'");
    EXPECT_EQ(colors.names(), (std::vector<std::string>{"silver", "oxide"}));
    EXPECT_EQ(colors.phase_of({250, 240, 250, 255}), 0);
    EXPECT_EQ(colors.phase_of({40, 40, 40, 255}), 1);
    EXPECT_EQ(colors.phase_of({140, 140, 140, 255}), 1);
    EXPECT_EQ(colors.phase_of({0, 200, 0, 255}), 1); // its grey is 117
    EXPECT_EQ(colors.phase_of({10, 10, 10, 255}), ImageColors::empty);
    EXPECT_EQ(colors.phase_of({240, 10, 10, 255}), ImageColors::empty);
    EXPECT_EQ(colors.phase_of({255, 255, 255, 127}), ImageColors::empty);
    EXPECT_EQ(colors.phase_of({180, 180, 180, 255}), ImageColors::unknown);
    EXPECT_EQ(colors.color_of(1), (Pixel{90, 90, 90, 255}));
    for (const auto &[text, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"a: rgb(1,2)", {"phase 'a'", "three numbers"}},
           {"a: rgb(1,2,300)", {"phase 'a'", "300", "255"}},
           {"a: red", {"phase 'a'", "red", "rgb(255,128,0)"}},
           {"a: 9..3", {"phase 'a'", "ends before"}},
           {"a: 1..5 ; b: 5..9", {"'a'", "'b'", "overlapping"}},
           {"a: 7 ; b: rgb(7,7,7)", {"'a'", "'b'", "same colour"}},
           {"void: 0", {"void", "nothing is left"}}})
      expect_parts(message_of([&] { ImageColors(text, 0., "'E'"); }), parts);
  }


  TEST(Image, phases_of_cells)
  {
    const Image image(small);
    Scene<2>    scene;
    fill(scene,
         image.settings({{"Material/Phases/Conductivity", "fibre: 3"},
                         {"Material/Conductivity", "2"},
                         {"Domain/Lower corner", "10, 20"},
                         {"Domain/Pixel size", "0.5"}}));
    EXPECT_EQ(scene.domain.cells, (std::array<unsigned int, 2>{{4, 3}}));
    EXPECT_EQ(scene.domain.upper, Point<2>(12., 21.5));
    EXPECT_EQ(scene.domain.nodes, NodePlacement::cell_centers);
    const PhaseMap &map = *scene.domain.image;
    EXPECT_EQ(map.counts(), (std::vector<std::size_t>{7, 3, 2}));
    const auto &conductivity = scene.material.conductivity;
    EXPECT_EQ(conductivity.value(Point<2>(10.25, 20.25)),
              2.); // the lowest row is the last of the file
    EXPECT_EQ(conductivity.value(Point<2>(10.75, 20.75)), 3.);
    EXPECT_EQ(conductivity.value(Point<2>(11.25, 21.25)), 3.);
    EXPECT_EQ(map.at(11.75, 20.75), PhaseMap::empty);
    EXPECT_EQ(map.at(9., 20.75), PhaseMap::empty);
    EXPECT_EQ(map.at(11., 21.), 1);    // corner of three cells of fibre and one of matrix
    EXPECT_EQ(map.at(11.75, 20.5), 0); // the edge of an empty cell
    EXPECT_EQ(map.at(10.5, 20.75), 0); // matrix and fibre: the one named first
    const Picture picture = map.picture();
    EXPECT_EQ(picture.at(2, 0), (Pixel{50, 50, 50, 255}));
    EXPECT_EQ(picture.at(3, 0), (Pixel{0, 0, 0, 0}));
    EXPECT_EQ(
      make_phase_map(picture, ImageColors("matrix: 90 ; fibre: 50", 0., "'E'"), 1, 1, "'E'").phases,
      map.phases);
  }


  TEST(Image, blocks_of_pixels_and_of_cells)
  {
    // Of a block of 2 x 2 the lower right pixel, of 3 x 3 the middle one.
    const Image image({"99559", "95999", "95559", "99909"});
    Scene<2>    two, three, half;
    fill(two,
         image.settings({{"Domain/Pixels per cell", "2"}, {"Peridynamics/Horizon ratio", "1"}}));
    EXPECT_EQ(two.domain.cells, (std::array<unsigned int, 2>{{2, 2}}));
    EXPECT_EQ(two.domain.image->phases, (std::vector<int>{0, PhaseMap::empty, 1, 0}));
    EXPECT_EQ(two.domain.upper, Point<2>(4., 4.));
    expect_parts(two.domain.notes.front(), {"1 columns", "0 rows"});
    fill(three,
         image.settings({{"Domain/Pixels per cell", "3"}, {"Peridynamics/Horizon ratio", "1"}}));
    EXPECT_EQ(three.domain.image->phases, (std::vector<int>{1}));
    fill(half, image.settings({{"Domain/Cells per pixel", "2"}}));
    EXPECT_EQ(half.domain.cells, (std::array<unsigned int, 2>{{10, 8}}));
    for (unsigned int j = 0; j < 8; ++j)
      for (unsigned int i = 0; i < 10; ++i)
        EXPECT_EQ(half.domain.image->phase(i, j),
                  std::vector<std::string>({"99909", "95559", "95999", "99559"})[j / 2][i / 2] ==
                      '9' ?
                    0 :
                    (i / 2 == 3 && j / 2 == 0 ? PhaseMap::empty : 1));
  }


  TEST(Image, mesh_without_empty_cells)
  {
    const Image image({"9999", "9009", "9999"});
    for (const std::string placement : {"auto", "vertices"})
      {
        const Problem<2> problem(image.settings({{"Domain/Nodes", placement},
                                                 {"Peridynamics/Horizon ratio", "2"},
                                                 {"Peridynamics/Boundary treatment", "none"}}));
        const auto       all = measures_of(*problem.nodes);
        EXPECT_EQ(problem.mesh->n_global_active_cells(), 10u);
        EXPECT_NEAR(all[256], 10., 1e-12);
        EXPECT_NEAR(all[0], 3., 1e-12);
        EXPECT_NEAR(all[2], 4., 1e-12);
        EXPECT_NEAR(all[hole_boundary_id], 6., 1e-12);
        EXPECT_EQ(problem.nodes->n_global(), placement == "auto" ? 10u : 20u);
      }
  }


  TEST(Image, extra_layers)
  {
    const Image image(small);
    Scene<2>    plain, nearest, named;
    fill(plain, image.settings(elastic()));
    fill(nearest,
         image.settings(elastic() + Settings{{"Domain/Extra layers", "left: 2 ; top: 1"}}));
    fill(named,
         image.settings(elastic() + Settings{{"Domain/Extra layers", "1"},
                                             {"Domain/Extra layers phase", "fibre"}}));
    EXPECT_EQ(nearest.domain.cells, (std::array<unsigned int, 2>{{6, 4}}));
    EXPECT_EQ(nearest.domain.lower, Point<2>(-2., 0.));
    EXPECT_EQ(nearest.domain.upper, Point<2>(4., 4.));
    EXPECT_EQ(nearest.domain.extra.body_lower, Point<2>(0., 0.));
    EXPECT_EQ(nearest.domain.extra.body_upper, Point<2>(4., 3.));
    EXPECT_TRUE(nearest.domain.shows(Point<2>(0.5, 2.5)));
    EXPECT_FALSE(nearest.domain.shows(Point<2>(0.5, 3.5)));
    EXPECT_FALSE(nearest.domain.shows(Point<2>(-0.5, 0.5)));
    const PhaseMap &map = *plain.domain.image;
    for (const Scene<2> *scene : {&nearest, &named})
      {
        EXPECT_EQ(scene->domain.image_of_body().phases, map.phases);
        EXPECT_EQ(scene->domain.image_of_body().lower, map.lower);
        for (std::size_t cell = 0; cell < map.phases.size(); ++cell)
          {
            const Point<2> p = map.center(cell);
            EXPECT_EQ(scene->domain.image->at(p[0], p[1]), map.phases[cell]);
          }
      }
    for (double y = 0.5; y < 3.; ++y)
      for (const double x : {-1.5, -0.5})
        EXPECT_EQ(nearest.domain.image->at(x, y), map.at(0.5, y));
    for (double x = 0.5; x < 4.; ++x)
      EXPECT_EQ(nearest.domain.image->at(x, 3.5), map.at(x, 2.5));
    EXPECT_EQ(nearest.domain.image->at(-1.5, 3.5), map.at(0.5, 2.5));
    for (const Point<2> &p : {Point<2>(-0.5, 1.5), Point<2>(4.5, 3.5), Point<2>(1.5, -0.5)})
      EXPECT_EQ(named.domain.image->at(p[0], p[1]), 1);
    const auto with = [&](const Settings &more) { return fault(image.settings(elastic(more))); };
    expect_parts(with({{"Domain/Extra layers", "-1"}}), {"'Extra layers' in section 'Domain'"});
    expect_parts(with({{"Domain/Extra layers", "lef: 1"}}),
                 {"'Extra layers' in section 'Domain'", "'lef'", "'left'"});
    expect_parts(with({{"Domain/Extra layers phase", "fibre"}}),
                 {"'Extra layers phase'", "'Extra layers' is 0"});
    expect_parts(with({{"Domain/Extra layers", "2"}, {"Domain/Extra layers phase", "fiber"}}),
                 {"'Extra layers phase'", "'fiber'", "'fibre'"});
    expect_parts(fault(image.settings({{"Domain/Extra layers", "2"}})),
                 {"'Extra layers'", "'Physics = elasticity'"});
  }


  TEST(Image, conducts_in_series)
  {
    // Columns of 1, 3 and 1 in series between 0 and 1, three high: heat 3/(4/1 + 2/3).
    const Image      image({"995599", "995599", "995599"});
    const Settings   layers = image.settings({{"Material/Phases/Conductivity", "fibre: 3"},
                                              {"Boundary conditions/Dirichlet", "left: 0 ; right: 1"},
                                              {"Time/Steady", "true"}});
    const Problem<2> problem(layers, ModelKind::finite_elements);
    EXPECT_NEAR(problem.op().balance(problem.steady(), 0., true).sides.at("right"),
                3. / (4. + 2. / 3.),
                1e-10);
    const Problem<2> all(layers + Settings{{"Domain/Cells per pixel", "3"}}),
      alone(layers + Settings{{"Domain/Cells per pixel", "3"}},
            ModelKind::peridynamics,
            MPI_COMM_SELF);
    const Vector v = all.steady();
    EXPECT_LT(difference(all, v, alone, alone.steady()), 1e-9);
    EXPECT_NEAR(all.op().balance(v, 0., true).sides.at("right"), 3. / (4. + 2. / 3.), 0.12);
  }


  TEST(Image, bonds_across_voids)
  {
    const Image    image({"999099", "999099", "999099"});
    const Settings body  = image.settings({{"Peridynamics/Boundary treatment", "none"}});
    const auto     bonds = [&](const std::string &rule) {
      const Problem<2> problem(body + Settings{{"Peridynamics/Bonds across voids", rule}});
      return problem.op().size().bonds;
    };
    // A block of 3 x 3 and one of 2 x 3; m = 3 reaches three columns on, and half a cell farther.
    EXPECT_GT(bonds("keep"), bonds("cut"));
    EXPECT_EQ(bonds("auto"), bonds("cut"));
    EXPECT_EQ(bonds("cut"), 36u + 15u);
  }


  TEST(Image, mistakes)
  {
    const Image image(small);
    const auto  with = [&](const std::string &entry, const std::string &text) {
      return fault(image.settings({{"Domain/" + entry, text}}));
    };
    expect_parts(with("Image", "missing.png"),
                 {"'Image' in section 'Domain'", "missing.png", "there is no file"});
    expect_parts(with("Image", ""), {"'Image' in section 'Domain'", "empty"});
    expect_parts(with("Image colors", ""),
                 {"'Image colors'", "rgb(90,90,90) (7 pixels)", "rgb(50,50,50) (3 pixels)"});
    expect_parts(with("Image colors", "matrix: 90 ; void: 0"),
                 {"'Image colors'",
                  "3 pixels",
                  "rgb(50,50,50)",
                  "column 3, row 1",
                  "69.3 from 'matrix'",
                  "'Color tolerance'"});
    expect_parts(with("Image colors", "oxide: 200 ; void: 0..150"),
                 {"'Image colors'", "no pixel", "material"});
    expect_parts(with("Color tolerance", "-1"), {"'Color tolerance'"});
    expect_parts(with("Pixels per cell", "0"), {"'Pixels per cell'", "1 to 1000"});
    expect_parts(with("Pixels per cell", "4"), {"'Pixels per cell'", "4 x 3"});
    expect_parts(with("Pixel size", "-2"), {"'Pixel size'", "greater than 0"});
    expect_parts(with("Upper corner", "4, 3"), {"'Pixel size'", "'Upper corner'"});
    expect_parts(with("Cells", "4, 3"), {"'Cells'", "'Pixels per cell'"});
    expect_parts(with("Shape", "box"), {"'Image'", "'box'"});
    expect_parts(fault(image.settings({{"Material/Phases/Conductivity", "fiber: 3"}})),
                 {"'Conductivity' in section 'Material/Phases'", "'fiber'", "'fibre'"});
    expect_parts(fault(image.settings({{"Material/Phases/Regions", "fibre: x"},
                                       {"Material/Phases/Conductivity", "fibre: 3"}})),
                 {"'Regions' in section 'Material/Phases'", "'fibre'", "'Image colors'"});
    expect_parts(fault(image.settings({{"Domain/Islands", "pin"}})), {"'Islands'", "elasticity"});
    expect_parts(message_of([&] { Problem<1>(image.settings()); }), {"'Shape'", "'Dimension' 2"});
  }


  /** A void of one cell, all corners nodes: bonds and conductances of a plate with that hole. */
  TEST(Image, void_of_one_cell)
  {
    std::vector<std::string> rows(11, std::string(11, '9'));
    rows[5][5] = '0';
    const Image      image(rows);
    const Settings   both{{"Domain/Nodes", "vertices"},
                        {"Peridynamics/Horizon ratio", "3"},
                        {"Coupling/Zone", "everywhere"},
                        {"Boundary conditions/Dirichlet", "left: 0 ; right: 1"}};
    const Problem<2> from_image(image.settings(both), ModelKind::coupled);
    const Problem<2> plate(Settings{{"Domain/Shape", "plate with hole"},
                                    {"Domain/Lower corner", "0, 0"},
                                    {"Domain/Upper corner", "11, 11"},
                                    {"Domain/Cells", "11, 11"},
                                    {"Domain/Hole center", "5.5, 5.5"},
                                    {"Domain/Hole radius", "0.4"}} +
                             both,
                           ModelKind::coupled);
    EXPECT_EQ(from_image.op().size().bonds, plate.op().size().bonds);
    EXPECT_LE(largest_difference(from_image.op().diagonal(), plate.op().diagonal()), 1e-12);
  }


  TEST(Image, statistics_of_phases)
  {
    // 200 samples of volume 1 in one phase, of uniaxial stress 1 to 200, dealt out to the
    // processes; one sample elsewhere.
    const unsigned int        rank = this_process(), n = n_processes();
    std::vector<StressSample> samples;
    for (unsigned int k = 1; k <= 200; ++k)
      if (k % n == rank)
        {
          samples.push_back({1, 1., {}});
          samples.back().stress[0][0] = k;
        }
    if (rank == 0)
      {
        samples.push_back({-1, 50., {}});
        samples.back().stress[1][1] = -3.;
      }
    const auto list = phase_statistics(samples, {"empty", "solid"}, MPI_COMM_WORLD);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].name, "solid");
    EXPECT_NEAR(list[0].volume_fraction, 0.8, 1e-14);
    EXPECT_NEAR(list[0].mean_stress[0][0], 100.5, 1e-12);
    EXPECT_NEAR(list[0].mean_von_mises, 100.5, 1e-12);
    // Two samples, 1 %, are as large or larger.
    EXPECT_NEAR(list[0].highest_percentile, 199., 1e-12);
    EXPECT_NEAR(list[0].largest_von_mises, 200., 1e-12);
    EXPECT_EQ(list[1].name, "elsewhere");
    EXPECT_NEAR(list[1].mean_stress[1][1], -3., 1e-14);
    EXPECT_TRUE(phase_statistics(samples, {}, MPI_COMM_WORLD).empty());
  }
} // namespace PeriDeal
