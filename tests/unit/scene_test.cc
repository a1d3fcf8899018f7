// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/scene_lines.h>

#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace SceneTests;
  using dealii::Point;


  TEST(Scenes, all_entries)
  {
    Scene<2>    scene;
    const auto &bc = scene.boundary_conditions;
    parse_scene<2>({"a.prm", R"(
set Title = A # comment
set Models = peridynamics, finite elements
subsection Domain
  set Lower corner = -1, -2
  set Upper corner = 1, \
                     2
  set Cells = 10, 40
  set Nodes = cell centers
end
subsection Material
  set Conductivity = 1 + x^2
  set Density = 2
  set Heat capacity = 3 + y
  set Interface rule = harmonic
end
subsection Initial and source
  set Initial value = x
  set Source = t
end
subsection Boundary conditions
  set Dirichlet = top: 100*max(x, 0); bottom: -100
  set Flux = right: 3*t
  set Convection = left: 25, 20
end
subsection Cracks
  set Segments = -0.5,0 ; 0.5,0 ; 0.2,0.3 ; 0.4,0.5
  set Transmission = 0.25
end
subsection Peridynamics
  set Horizon ratio = 4
  set Kernel = constant
  set Kernel exponent = 1
  set Volume fraction = exact
  set Calibration = analytic
  set Self term = paper
  set Nodal volume = full
  set Boundary treatment = fictitious mirror
  set Layer rows = 2
  set Flux treatment = extrapolation
  set Surface correction = crack scaling
  set Operator form = stored
end
subsection Finite elements
  set Capacity = consistent
end
subsection Time
  set End time = 2
  set Stepper = crank nicolson
  set Time step = 0.01
  set Tolerance = 1e-6
end
subsection Solver
  set Tolerance = 1e-8
  set Maximum iterations = 77
end
subsection Output
  set Fields = hdf5
  set Write at = 1.5, 0.5, 7, 2, 0.5
  set Probes = 0,0.1 ; 0.5,0.1
  set Line = 0,-1 ; 0,1 ; 5
  set Grid = 2, 3 ; 1, 1
end
subsection Reference
  set Solution = x*t
end
subsection Units
  set Length = cm
end
)"},
                   scene);
    EXPECT_EQ(scene.general.title, "A");
    EXPECT_EQ(scene.general.models,
              (std::vector<ModelKind>{ModelKind::peridynamics, ModelKind::finite_elements}));
    EXPECT_EQ(scene.domain.lower, Point<2>(-1., -2.));
    EXPECT_EQ(scene.domain.upper, Point<2>(1., 2.));
    EXPECT_EQ(scene.domain.cells, (std::array<unsigned int, 2>{{10u, 40u}}));
    EXPECT_DOUBLE_EQ(scene.domain.spacing()[0], 0.2);
    EXPECT_DOUBLE_EQ(scene.domain.spacing()[1], 0.1);
    EXPECT_DOUBLE_EQ(scene.horizon(), 0.4);
    EXPECT_EQ(scene.domain.nodes, NodePlacement::cell_centers);
    EXPECT_DOUBLE_EQ(scene.material.conductivity.value(Point<2>(2., 0.)), 5.);
    EXPECT_DOUBLE_EQ(scene.material.storage(Point<2>(2., 1.)), 8.);
    EXPECT_FALSE(scene.material.uniform_conductivity());
    EXPECT_EQ(scene.material.interface_rule, InterfaceRule::harmonic);
    EXPECT_TRUE(scene.initial_and_source.source.depends_on_time());
    ASSERT_EQ(bc.dirichlet.size(), 2u);
    EXPECT_EQ(bc.dirichlet[0].name, "top");
    EXPECT_EQ(bc.dirichlet[0].id, 3u);
    EXPECT_EQ(bc.dirichlet[1].id, 2u);
    EXPECT_DOUBLE_EQ(bc.dirichlet[0].value.value(Point<2>(0.5, 2.)), 50.);
    ASSERT_NE(find_condition(bc.transfers, 0), nullptr);
    EXPECT_DOUBLE_EQ(find_condition(bc.transfers, 0)->coefficient.value(Point<2>()), 25.);
    EXPECT_DOUBLE_EQ(find_condition(bc.transfers, 0)->ambient.value(Point<2>()), 20.);
    EXPECT_EQ(find_condition(bc.dirichlet, 1), nullptr);
    EXPECT_TRUE(bc.depends_on_time());
    ASSERT_EQ(scene.cracks.cracks.size(), 2u);
    EXPECT_EQ(scene.cracks.cracks[1][1], Point<2>(0.4, 0.5));
    EXPECT_EQ(scene.cracks.transmission.value(Point<2>()), 0.25);
    EXPECT_LT(scene.cracks.contact_conductance, 0.);
    EXPECT_EQ(scene.peridynamics.kernel, KernelShape::constant);
    EXPECT_EQ(scene.peridynamics.kernel_exponent, 1u);
    EXPECT_EQ(scene.peridynamics.sampling.volume_fraction, VolumeFraction::exact);
    EXPECT_EQ(scene.peridynamics.sampling.calibration, Calibration::analytic);
    EXPECT_EQ(scene.peridynamics.sampling.self_term, SelfTerm::paper);
    EXPECT_EQ(scene.peridynamics.sampling.nodal_volume, NodalVolume::full);
    EXPECT_EQ(scene.peridynamics.treatment, BoundaryTreatment::fictitious_mirror);
    EXPECT_EQ(scene.peridynamics.layer_rows, 2u);
    EXPECT_EQ(scene.peridynamics.flux_treatment, FluxTreatment::extrapolation);
    EXPECT_EQ(scene.peridynamics.surface_correction, SurfaceCorrection::crack_scaling);
    EXPECT_EQ(scene.peridynamics.form, OperatorForm::stored);
    EXPECT_TRUE(scene.finite_elements.consistent_capacity);
    EXPECT_EQ(scene.time.stepper, "crank nicolson");
    EXPECT_EQ(scene.time.time_step, 0.01);
    EXPECT_EQ(scene.time.tolerance, 1e-6);
    EXPECT_EQ(scene.solver.tolerance, 1e-8);
    EXPECT_EQ(scene.solver.max_iterations, 77u);
    EXPECT_FALSE(scene.output.vtu);
    EXPECT_TRUE(scene.output.hdf5);
    EXPECT_EQ(scene.output.write_times, (std::vector<double>{0.5, 1.5, 2.}));
    EXPECT_EQ(scene.output.times_beyond_end, (std::vector<double>{7.}));
    EXPECT_EQ(scene.output.probes, (std::vector<std::vector<double>>{{0., 0.1}, {0.5, 0.1}}));
    ASSERT_EQ(scene.output.line.size(), 5u);
    EXPECT_EQ(scene.output.line[1], (std::vector<double>{0., -0.5}));
    EXPECT_EQ(scene.output.line[4], (std::vector<double>{0., 1.}));
    ASSERT_EQ(scene.output.grid.size(), 12u + 4u); // x fastest, one lattice after the other
    EXPECT_EQ(scene.output.grid[1][1], scene.domain.lower[1]);
    EXPECT_EQ(scene.output.grid[2],
              (std::vector<double>{scene.domain.upper[0], scene.domain.lower[1]}));
    EXPECT_EQ(scene.output.grid[15],
              (std::vector<double>{scene.domain.upper[0], scene.domain.upper[1]}));
    EXPECT_EQ(scene.reference.solution, "x*t");
    EXPECT_EQ(scene.units.length, "cm");
    EXPECT_EQ(scene.units.time, "s");
  }


  TEST(Scenes, one_after_the_other_without_leftovers)
  {
    {
      Scene<2> scene;
      parse_scene<2>({"a.prm", "subsection Domain\n set Cells = 7, 8\nend\n"}, scene);
      EXPECT_EQ(scene.domain.cells[1], 8u);
    }
    {
      Scene<3> scene;
      parse_scene<3>({"a.prm", "set Dimension = 3\n"}, scene);
      EXPECT_EQ(scene.domain.cells[2], 20u);
      EXPECT_EQ(scene.general.dimension, 3u);
    }
    for (unsigned int i = 0; i < 20; ++i)
      {
        Scene<2> scene;
        EXPECT_EQ(scene.domain.cells[0], 20u);
        EXPECT_EQ(scene.domain.upper, Point<2>(1., 1.));
        parse_scene<2>({"a.prm", "set Title = x\n"}, scene);
        EXPECT_EQ(scene.domain.cells[0], 20u);
      }
    Scene<1> scene;
    scene.domain.set("Cells", "12");
    scene.parse_and_validate();
    EXPECT_EQ(scene.domain.cells[0], 12u);
  }


  TEST(Scenes, surface_corrections_by_themselves)
  {
    const auto taken = [](const std::vector<std::string> &more) {
      std::vector<std::string> overrides{"Cracks/Segments=0.2,0.5 ; 0.6,0.55",
                                         "Boundary conditions/Dirichlet=top: 1 ; bottom: 0"};
      overrides.insert(overrides.end(), more.begin(), more.end());
      Scene<2> scene;
      parse_scene<2>({"a.prm", apply_overrides("set Title = x\n", "a.prm", overrides)}, scene);
      return scene.peridynamics.surface_correction;
    };
    const std::string pd = "Peridynamics/", models = "Models=";
    const auto        scaled = SurfaceCorrection::crack_scaling, none = SurfaceCorrection::none;
    EXPECT_EQ(taken({}), scaled);
    EXPECT_EQ(taken({models + "finite elements"}), scaled);
    EXPECT_EQ(taken({models + "coupled"}), scaled);
    EXPECT_EQ(taken({"Physics=moisture"}), scaled);
    EXPECT_EQ(taken({pd + "Boundary treatment=fictitious mirror"}), scaled);
    EXPECT_EQ(taken({pd + "Boundary treatment=none", models + "finite elements, coupled"}), scaled);

    EXPECT_EQ(taken({pd + "Surface correction=none"}), none);
    EXPECT_EQ(taken({pd + "Surface correction=energy", "Domain/Nodes=cell centers"}),
              SurfaceCorrection::energy);
    EXPECT_EQ(taken({"Cracks/Segments="}), none);
    EXPECT_EQ(taken({"Cracks/Transmission=0.3"}), none);
    EXPECT_EQ(taken({"Cracks/Contact conductance=3"}), none);
    EXPECT_EQ(taken({"Cracks/Transmission=min(1, t)"}), none);
    EXPECT_EQ(taken({"Cracks/Growth=2: 0, 0.1,0"}), none);
    EXPECT_EQ(
      taken({"Cracks/Mesh=faces", "Cracks/Segments=0.25,0.5 ; 0.5,0.5", "Domain/Cells=8, 8"}),
      none);
    EXPECT_EQ(taken({"Cracks/Mesh=removed"}), none);
    EXPECT_EQ(taken({"Domain/Nodes=cell centers"}), none); // no exchange
    EXPECT_EQ(taken({pd + "Boundary treatment=none"}), none);
    EXPECT_EQ(taken({pd + "Boundary treatment=fictitious mirror", pd + "Calibration=analytic"}),
              none);
  }


  TEST(Scenes, general_errors)
  {
    expect_parts(fault("set Physics = moistrue\n"),
                 {"a.prm:2: ", "'Physics' outside all sections", "Did you mean 'moisture'?"});
    expect_parts(fault("set Models =\n"), {"a.prm:2: ", "'Models'", "is empty"});
    expect_parts(fault("set Models = peridynamics, peridynamics\n"), {"'Models'", "named twice"});
    expect_parts(fault("set Models = peridynamic\n"), {"'Models'", "Did you mean 'peridynamics'?"});
    expect_parts(fault("set Models = molecular\n"),
                 {"'Models'", "finite elements, peridynamics, coupled"});
    expect_parts(fault("set Output directory =\n"), {"'Output directory'", "is empty"});
    for (const std::string dimension : {"4", "0", "two", "2.5", ""})
      expect_parts(message_of([&] {
                     dimension_of({"a.prm", "\nset Dimension = " + dimension + "\n"});
                   }),
                   {"a.prm:2: ", "'Dimension'", "found '" + dimension + "'", "1, 2 or 3"});
    EXPECT_EQ(dimension_of({"a.prm", "set Dimension = 3"}), 3u);
    EXPECT_EQ(dimension_of({"a.prm", ""}), 2u);
  }
} // namespace PeriDeal
