// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Scenes of elasticity: what their entries give, and what is said about mistakes.
#include <perideal/scene/rigid_motions.h>

#include "elastic_scene_tools.h"

namespace PeriDeal
{
  using namespace SceneTests;
  using dealii::Point;

  namespace
  {
    const std::string m = "Material/", p = "Material/Phases/", b = "Boundary conditions/",
                      e = "Elasticity/";
  } // namespace


  TEST(ElasticScenes, all_entries_in_two_dimensions)
  {
    Scene<2> scene;
    parse_scene<2>({"a.prm", R"(
set Physics = elasticity
set Models = peridynamics, finite elements
subsection Domain
  set Nodes = cell centers
end
subsection Material
  set Bulk modulus = 100 + x
  set Shear modulus = 40
  set Density = 8
  set Thermal expansion = 1e-5*(1 + y)
  set Fracture energy = 10
  subsection Phases
    set Regions = hard: x > 0.5 ; light: x < 0.25
    set Bulk modulus = hard: 300
    set Density = light: 2
    set Fracture energy = hard: 20
    set Thermal expansion = hard: -1e-6
  end
end
subsection Initial and source
  set Body force = 0, -9.81*(1 + t)
end
subsection Boundary conditions
  set Displacement = left: 0, free ; bottom: free, 1e-3*x*t
  set Traction = right: 1e6, max(0, y) ; bottom: 5, 0
  set Traction layer = 0.1
  set Symmetry = top
end
subsection Elasticity
  set Model = bond-based
  set Plane = strain
  set Kinematics = full
  set Temperature change = 100*x
  set Solver = dynamics
end
)"},
                   scene);
    const Point<2> middle(0.4, 0.5), hard(0.75, 0.5), light(0.1, 0.5);
    EXPECT_EQ(scene.general.physics, Physics::elasticity);
    EXPECT_EQ(names_of(scene.general.physics).field, "displacement");
    EXPECT_EQ(scene.units.of_field(scene.general.physics), "m");
    const Material &material = scene.material;
    EXPECT_DOUBLE_EQ(material.moduli(middle).bulk, 100.4);
    EXPECT_DOUBLE_EQ(material.moduli(middle).shear, 40.);
    EXPECT_DOUBLE_EQ(material.moduli(hard).bulk, 300.);
    EXPECT_FALSE(material.uniform_moduli());
    EXPECT_DOUBLE_EQ(material.density.value(light), 2.);
    EXPECT_DOUBLE_EQ(material.thermal_expansion.value(middle), 1.5e-5);
    EXPECT_DOUBLE_EQ(material.thermal_expansion.value(hard), -1e-6);
    ASSERT_TRUE(material.fracture_energy);
    EXPECT_EQ(material.fracture_energy->value(middle), 10.);
    EXPECT_EQ(material.fracture_energy->value(hard), 20.);
    EXPECT_FALSE(material.critical_stretch);
    ASSERT_EQ(scene.initial_and_source.body_force.size(), 2u);
    EXPECT_DOUBLE_EQ(scene.initial_and_source.body_force[1].value(middle, 1.), -19.62);

    const auto &bc = scene.boundary_conditions;
    ASSERT_EQ(bc.displacement.size(), 2u);
    EXPECT_EQ(bc.displacement[0].name, "left");
    EXPECT_EQ(bc.displacement[1].id, 2u);
    ASSERT_EQ(bc.displacement[1].values.size(), 2u);
    EXPECT_TRUE(bc.displacement[0].values[0]);
    EXPECT_FALSE(bc.displacement[0].values[1]);
    EXPECT_FALSE(bc.displacement[1].values[0]);
    EXPECT_DOUBLE_EQ(bc.displacement[1].values[1]->value(middle, 2.), 8e-4);
    ASSERT_EQ(bc.traction.size(), 2u);
    EXPECT_DOUBLE_EQ(bc.traction[0].values[1]->value(middle), 0.5);
    EXPECT_EQ(find_condition(bc.traction, 2)->values[0]->value(middle), 5.);
    EXPECT_EQ(find_condition(bc.traction, 0), nullptr);
    EXPECT_EQ(bc.traction_layer, 0.1);
    EXPECT_EQ(bc.symmetry, (std::vector<dealii::types::boundary_id>{3}));
    EXPECT_TRUE(bc.depends_on_time());

    EXPECT_EQ(scene.elasticity.model, ElasticModel::bond_based);
    EXPECT_EQ(scene.elasticity.plane, PlaneState::strain);
    EXPECT_EQ(scene.elasticity.kinematics, Kinematics::full);
    EXPECT_DOUBLE_EQ(scene.elasticity.temperature_change.value(middle), 40.);
    EXPECT_EQ(scene.elasticity.solver, ElasticSolver::dynamics);
    EXPECT_FALSE(scene.elasticity.is_static());
    EXPECT_FALSE(scene.time.steady);
  }


  TEST(ElasticScenes, one_and_three_dimensions_and_defaults)
  {
    {
      Scene<1> bar;
      parse_scene<1>(elastic_scene<1>({m + "Poisson ratio=", b + "Traction=right: 3"}), bar);
      EXPECT_DOUBLE_EQ(bar.material.moduli(Point<1>(0.3)).young(), 200.);
      EXPECT_TRUE(bar.material.uniform_moduli());
      EXPECT_EQ(bar.boundary_conditions.traction[0].values.size(), 1u);
    }
    {
      Scene<3> body;
      parse_scene<3>(elastic_scene<3>({b + "Traction=front: 0, 0, -x",
                                       b + "Symmetry=back",
                                       "Initial and source/Body force=0, 0, -10"}),
                     body);
      EXPECT_NEAR(body.material.moduli(Point<3>()).poisson(), 0.3, 1e-14);
      EXPECT_EQ(body.boundary_conditions.traction[0].id, 5u);
      EXPECT_EQ(body.boundary_conditions.displacement[0].values.size(), 3u);
      EXPECT_EQ(body.initial_and_source.body_force.size(), 3u);
    }
    Scene<2> plate;
    parse_scene<2>(elastic_scene<2>({}), plate);
    EXPECT_EQ(plate.elasticity.model, ElasticModel::state_based);
    EXPECT_EQ(plate.elasticity.plane, PlaneState::stress);
    EXPECT_EQ(plate.elasticity.kinematics, Kinematics::linear);
    EXPECT_EQ(plate.elasticity.solver, ElasticSolver::linear);
    EXPECT_EQ(plate.elasticity.solver_name(), "linear");
    EXPECT_TRUE(plate.elasticity.is_static() && plate.time.steady);
    EXPECT_TRUE(plate.boundary_conditions.traction.empty());
    EXPECT_LT(plate.boundary_conditions.traction_layer, 0.);
    EXPECT_TRUE(plate.initial_and_source.body_force.empty());
    EXPECT_EQ(plate.material.thermal_expansion.value(Point<2>()), 0.);
    EXPECT_FALSE(plate.material.fracture_energy || plate.material.critical_stretch);
    EXPECT_EQ(plate.peridynamics.treatment, BoundaryTreatment::none);
  }


  TEST(ElasticScenes, moduli_errors)
  {
    const Overrides none = {m + "Young modulus=", m + "Poisson ratio="};
    expect(elastic_fault(none), m + "Young modulus", {"is empty", "exactly two"});
    expect(elastic_fault({m + "Poisson ratio="}),
           m + "Young modulus",
           {"a.prm:", "is the only one"});
    expect(elastic_fault<1>({m + "Young modulus="}),
           m + "Poisson ratio",
           {"'Young modulus' alone"});
    expect(elastic_fault({m + "Bulk modulus=100"}),
           m + "Poisson ratio",
           {"one of 3", "exactly two"});
    expect(elastic_fault({m + "Young modulus=-200"}), m + "Young modulus", {"greater than 0"});
    expect(elastic_fault({m + "Young modulus=1 + t"}), m + "Young modulus", {"depends on t"});
    expect(elastic_fault({m + "Young modulus=1 + T"}), m + "Young modulus", {"depends on T"});
    expect(elastic_fault({m + "Density=1 + T"}), m + "Density", {"no unknown", "elasticity"});
    expect(elastic_fault({m + "Poisson ratio=0.51"}), m + "Poisson ratio", {"0.51", "at most 0.5"});
    expect(elastic_fault({m + "Poisson ratio=-1"}), m + "Poisson ratio", {"greater than -1"});
    expect(elastic_fault({m + "Poisson ratio=0.5", e + "Plane=strain"}),
           m + "Poisson ratio",
           {"less than 0.5"});
    expect(elastic_fault<3>({m + "Poisson ratio=0.5"}), m + "Poisson ratio", {"less than 0.5"});
    EXPECT_EQ(elastic_fault({m + "Poisson ratio=0.5"}), "");
    EXPECT_EQ(elastic_fault<1>({m + "Poisson ratio=0.5"}), "");
    expect(elastic_fault({m + "Young modulus=", m + "Bulk modulus=1", m + "Poisson ratio=0.5"}),
           m + "Poisson ratio",
           {"no shear modulus"});
    // E < 9 K and E <= 3 G
    expect(elastic_fault({m + "Poisson ratio=", m + "Bulk modulus=20"}),
           m + "Young modulus",
           {"contradict", "Poisson ratio would be -1.16666666667"});
    expect(elastic_fault({m + "Poisson ratio=", m + "Shear modulus=50"}),
           m + "Young modulus",
           {"would be 1, "});
  }


  TEST(ElasticScenes, moduli_out_of_range_at_points)
  {
    Scene<2> scene;
    parse_scene<2>(elastic_scene<2>({m + "Poisson ratio=0.6*x"}), scene);
    EXPECT_NEAR(scene.material.moduli(Point<2>(0.5, 0.)).poisson(), 0.3, 1e-14);
    expect(message_of([&] { scene.material.moduli(Point<2>(1., 0.25)); }),
           m + "Poisson ratio",
           {"(1, 0.25)", "found 0.6", "at most 0.5"});
    scene.material.set("Poisson ratio", "0.3");
    scene.material.set("Young modulus", "x - 0.5");
    scene.material.parse(Physics::elasticity);
    expect(message_of([&] { scene.material.moduli(Point<2>(0.25, 0.)); }),
           m + "Young modulus",
           {"(0.25, 0)", "found -0.25", "greater than 0"});
    const DeferredFormulaErrors errors;
    scene.material.moduli(Point<2>(0., 0.25));
    expect(message_of([&] { errors.throw_if_any(MPI_COMM_SELF); }), m + "Young modulus");
  }


  TEST(ElasticScenes, phase_errors)
  {
    const std::string regions = p + "Regions=rim: x > 0.9";
    EXPECT_EQ(elastic_fault({regions, p + "Young modulus=rim: 2"}), "");
    expect(elastic_fault({regions, p + "Conductivity=rim: 2"}),
           p + "Regions",
           {"'rim' has no material", "Young modulus"});
    expect(elastic_fault({regions, p + "Bulk modulus=rim: 2"}),
           p + "Bulk modulus",
           {"'Young modulus', 'Poisson ratio'", "same moduli"});
    expect(elastic_fault({regions, p + "Poisson ratio=rim: 0.7"}),
           p + "Poisson ratio",
           {"phase 'rim'", "0.7"});
    expect(elastic_fault({regions, p + "Young modulus=rim: 0"}),
           p + "Young modulus",
           {"phase 'rim'", "greater than 0"});
    expect(elastic_fault({regions, p + "Fracture energy=rim: 2"}),
           m + "Fracture energy",
           {"is empty", "rest of the body"});
    EXPECT_EQ(elastic_fault({regions, p + "Thermal expansion=rim: -1e-5"}), "");
    // under heat, the elastic properties of a phase are not its material
    expect(fault("subsection Material\nsubsection Phases\nset Regions = rim: x > 0.9\n"
                 "set Young modulus = rim: 2\nend\nend\n"),
           p + "Regions",
           {"'rim' has no material", "Conductivity"});
  }


  TEST(ElasticScenes, strength_and_temperature_errors)
  {
    expect(elastic_fault({m + "Fracture energy=10", m + "Critical stretch=1e-3"}),
           m + "Critical stretch",
           {"'Fracture energy' is given"});
    expect(elastic_fault({m + "Fracture energy=0"}), m + "Fracture energy", {"greater than 0"});
    expect(elastic_fault({m + "Critical stretch=t"}), m + "Critical stretch", {"depends on t"});
    expect(elastic_fault({e + "Temperature change=10"}),
           e + "Temperature change",
           {"no effect", "'Thermal expansion' in section 'Material' is 0"});
    expect(elastic_fault({e + "Temperature change=t", m + "Thermal expansion=1"}),
           e + "Temperature change",
           {"depends on t"});
    EXPECT_EQ(elastic_fault({e + "Temperature change=x", m + "Thermal expansion=1e-5"}), "");
  }


  TEST(ElasticScenes, displacement_errors)
  {
    const std::string d = b + "Displacement";
    expect(elastic_fault({d + "=lefd: 0, 0"}), d, {"unknown side 'lefd'", "Did you mean 'left'?"});
    expect(elastic_fault({d + "=left: 0"}), d, {"side 'left'", "needs 2 components"});
    expect(elastic_fault({d + "=left: 0, 0, 0"}), d, {"needs 2 components"});
    expect(elastic_fault<1>({d + "=left: 0, 0"}), d, {"needs 1 component,"});
    expect(elastic_fault({d + "=left: 0, 0; left: 0, free"}), d, {"'left' is named twice"});
    expect(elastic_fault({d + "=left: 0, 0; right: free, free"}),
           d,
           {"side 'right'", "empty grip"});
    expect(elastic_fault<1>({d + "=left: free"}), d, {"side 'left'", "empty grip"});
    expect(elastic_fault({d + "=left: 0, 2*yy"}), d, {"component in y", "column 3"});
    expect(elastic_fault({d + "=left: 0, fre"}), d, {"component in y", "'fre'"});
    expect(elastic_fault({b + "Symmetry=left"}), d, {"'left'", "'Symmetry'", "one of the two"});
    for (const char *solver : {"linear", "dynamics"})
      EXPECT_EQ(elastic_fault({d + "=left: 0, t", e + "Solver=" + solver}), "");
    expect(elastic_fault({d + "=left: 0, t", "Time/Steady=true"}),
           "Time/Steady",
           {"is true", "depend on t"});
  }


  TEST(ElasticScenes, traction_errors)
  {
    const std::string t = b + "Traction";
    expect(elastic_fault({t + "=right: free, 1"}), t, {"side 'right'", "'free'", "give 0"});
    expect(elastic_fault({t + "=right: 1"}), t, {"needs 2 components"});
    expect(elastic_fault({t + "=left: 0, 1"}), t, {"'left'", "displacement in y", "contradicts"});
    EXPECT_EQ(elastic_fault({t + "=left: 0, 0"}), "");
    EXPECT_EQ(elastic_fault({b + "Displacement=left: 0, 0; right: 1, free", t + "=right: 0, x"}),
              "");
    expect(elastic_fault({b + "Symmetry=top", t + "=top: 0, 1"}), t, {"'top'", "'Symmetry'"});
    EXPECT_EQ(elastic_fault({b + "Symmetry=top", t + "=top: 0, 0"}), "");
    EXPECT_EQ(elastic_fault({t + "=right: t, 0"}), ""); // slowly
    expect(elastic_fault({t + " layer=0.1"}), t + " layer", {"no effect"});
    expect(elastic_fault({t + "=right: 1, 0", t + " layer=0"}), t + " layer", {"greater than 0"});
    expect(elastic_fault({t + "=right: 1, 0", t + " layer=wide"}), t + " layer", {"not a number"});
    expect(elastic_fault({t + "=right: 1, 0", t + " layer=2"}),
           t + " layer",
           {"wider than the body"});
  }


  TEST(ElasticScenes, entries_of_another_physics)
  {
    const std::string i = "Initial and source/";
    expect(elastic_fault({b + "Dirichlet=top: 1"}), b + "Dirichlet", {"Use 'Displacement'"});
    expect(elastic_fault({b + "Flux=top: 1"}), b + "Flux", {"Use 'Traction'"});
    expect(elastic_fault({b + "Convection=top: 1, 2"}), b + "Convection", {"'elasticity'"});
    expect(elastic_fault({i + "Source=1"}), i + "Source", {"use 'Body force'"});
    expect(elastic_fault({i + "Initial value=1"}), i + "Initial value", {"at rest"});
    expect(elastic_fault({i + "Body force=1"}), i + "Body force", {"needs 2 components"});
    expect(elastic_fault({i + "Body force=1, free"}), i + "Body force", {"'free'"});
    EXPECT_EQ(elastic_fault({i + "Body force=1, t"}), "");

    const Overrides heat   = {"Physics=heat", b + "Displacement="};
    const auto      heated = [&](const std::string &given) {
      Overrides overrides = heat;
      overrides.push_back(given);
      return elastic_fault(overrides);
    };
    EXPECT_EQ(elastic_fault(heat), ""); // properties of the material are read and not used
    expect(heated(m + "Bulk modulus=-1"), m + "Bulk modulus", {"greater than 0"});
    expect(heated(b + "Displacement=left: 0, 0"), b + "Displacement", {"'heat'", "'Dirichlet'"});
    expect(heated(b + "Traction=left: 0, 0"), b + "Traction", {"'heat'", "'Flux'"});
    expect(heated(b + "Traction layer=1"), b + "Traction layer", {"'heat'"});
    expect(heated(i + "Body force=1, 0"), i + "Body force", {"'heat'"});
    expect(heated(e + "Solver=dynamics"), e + "Solver", {"'heat'"});
  }


  TEST(ElasticScenes, rigid_motions)
  {
    const std::string d    = b + "Displacement";
    const auto        held = [&](const std::string &grips, const std::string &symmetry = "") {
      return elastic_fault({d + "=" + grips, b + "Symmetry=" + symmetry});
    };
    expect(held(""), d, {"against: translation in x, translation in y, rotation about z."});
    expect(held("left: 0, free"), d, {"against: translation in y."});
    expect(held("left: free, 0"), d, {"against: translation in x, rotation about z."});
    expect(held("left: free, 0; right: free, 1"), d, {"against: translation in x."});
    expect(held("bottom: 0, free"), d, {"against: translation in y, rotation about z."});
    EXPECT_EQ(held("left: 0, free; bottom: free, 0"), "");
    EXPECT_EQ(held("", "left, bottom"), "");
    EXPECT_EQ(held("right: free, 0", "left"), "");
    // each alone leaves a rotation, about a point of the left and of the bottom side
    expect(held("left: free, 0; bottom: 0, free"), d, {"against: rotation about z."});
    expect(elastic_fault<1>({d + "="}), d, {"against: translation in x."});

    const auto held_in_space = [&](const std::string &grips, const std::string &symmetry = "") {
      return elastic_fault<3>({d + "=" + grips, b + "Symmetry=" + symmetry});
    };
    expect(held_in_space("left: 0, free, free"),
           d,
           {"against: translation in y, translation in z, rotation about x."});
    expect(held_in_space("left: free, 0, 0"),
           d,
           {"against: translation in x, rotation about y, rotation about z."});
    expect(held_in_space("", "left, bottom"), d, {"against: translation in z."});
    EXPECT_EQ(held_in_space("", "left, bottom, back"), "");
    EXPECT_EQ(held_in_space("front: 0, 0, 0"), "");

    // a hole holds both, and a body that moves need not be held
    EXPECT_EQ(elastic_fault({"Domain/Shape=plate with hole", d + "=hole: 0, 0"}), "");
    expect(elastic_fault({"Domain/Shape=plate with hole", d + "=hole: 0, free"}),
           d,
           {"against: translation in y."});
    EXPECT_EQ(elastic_fault({d + "=", e + "Solver=dynamics"}), "");

    // sides of a mesh file lie anywhere
    const Overrides mesh    = {"Domain/Shape=mesh file",
                               "Domain/Mesh file=" PERIDEAL_SOURCE_DIR "/tests/data/quads.msh",
                               "Peridynamics/Horizon=0.1"};
    const auto      on_mesh = [&](const std::string &grips, const std::string &symmetry = "") {
      Overrides overrides = mesh;
      overrides.push_back(d + "=" + grips);
      overrides.push_back(b + "Symmetry=" + symmetry);
      return elastic_fault(overrides);
    };
    expect(on_mesh("1: 0, free; 2: 1, free"), d, {"against: translation in y."});
    EXPECT_EQ(on_mesh("1: 0, free; 2: free, 1"), "");
    EXPECT_EQ(on_mesh("1: 0, free", "2"), "");
  }


  TEST(ElasticScenes, contradicting_choices)
  {
    const std::string pd = "Peridynamics/", t = "Time/";
    expect(elastic_fault({e + "Model=bond base"}), e + "Model", {"Did you mean 'bond-based'?"});
    expect(elastic_fault({e + "Solver=conjugate gradient"}),
           e + "Solver",
           {"Did you mean 'conjugate gradients'?"});
    expect(elastic_fault<1>({e + "Plane=strain"}), e + "Plane", {"a bar"});
    expect(elastic_fault<3>({e + "Plane=strain"}), e + "Plane", {"'Dimension' is 3"});
    expect(elastic_fault({e + "Kinematics=full"}), e + "Kinematics", {"'conjugate gradients'"});
    const Overrides full{"Models=peridynamics", e + "Kinematics=full", e + "Solver=dynamics"};
    EXPECT_EQ(elastic_fault(full), "");
    expect(elastic_fault({full[1], full[2]}), e + "Kinematics", {"small displacements"});
    expect(elastic_fault({t + "Steady=true", e + "Solver=dynamics"}), t + "Steady", {"'dynamics'"});
    EXPECT_EQ(elastic_fault({t + "Steady=true"}), "");
    expect(elastic_fault({t + "Stepper=rk4"}), t + "Stepper", {"'Solver' in section 'Elasticity'"});
    expect(elastic_fault({"Output/Write at=0.1"}), "Output/Write at", {"equilibrium"});
    EXPECT_EQ(elastic_fault({"Output/Write at=0.1", e + "Solver=dynamics"}), "");
    const std::string a = "Cracks/Segments=0.2,0.5 ; 0.5,0.5", b = "Cracks/Growth=2: 0, 0.1,0";
    expect(elastic_fault({a, b, t + "Steady=true"}), t + "Steady", {"cracks that grow"});
    EXPECT_EQ(elastic_fault({a, b, "Output/Write at=0.1"}), "");
    expect(elastic_fault({"Cracks/Segments=0.2,0.5 ; 0.5,0.5", "Cracks/Transmission=0.5"}),
           "Cracks/Transmission",
           {"no force"});
    expect(elastic_fault({pd + "Calibration=analytic"}),
           pd + "Calibration",
           {"not for use", "own families"});
    expect(elastic_fault({pd + "Self term=paper"}), pd + "Self term", {"has no effect"});
    expect(elastic_fault({pd + "Flux treatment=extrapolation"}),
           pd + "Flux treatment",
           {"has no effect", "'natural'"});
    EXPECT_EQ(elastic_fault({pd + "Surface correction=moments"}), "");
    expect(elastic_fault({pd + "Surface correction=energy", "Models=finite elements"}),
           pd + "Surface correction",
           {"has no effect"});
    expect(elastic_fault({pd + "Surface correction=crack scaling"}),
           pd + "Surface correction",
           {"has no effect", "coupled"});
    for (const char *const treatment : {"fictitious mirror", "fictitious constant", "layer"})
      expect(elastic_fault({pd + "Boundary treatment=" + treatment}),
             pd + "Boundary treatment",
             {"not defined", "use 'none'"});
    expect(elastic_fault({pd + "Boundary treatment=exchange"}),
           pd + "Boundary treatment",
           {"dilatation", "use 'none'"});
    EXPECT_EQ(elastic_fault({pd + "Operator form=lattice"}), "");
    expect(elastic_fault({pd + "Operator form=lattice", full[0], full[1], full[2]}),
           pd + "Operator form",
           {"'Kinematics = full'", "'auto'"});
    expect(elastic_fault({pd + "Operator form=lattice", "Material/Critical stretch=0.1"}),
           pd + "Operator form",
           {"may break", "'auto'"});
    EXPECT_EQ(elastic_fault({"Output/Grid=5, 5"}), "");
    expect(elastic_fault({"Finite elements/Capacity=consistent"}),
           "Finite elements/Capacity",
           {"lumped"});
  }


  TEST(ElasticScenes, fictitious_nodes)
  {
    const std::string entry = "Peridynamics/Surface correction",
                      given = entry + "=fictitious nodes";
    EXPECT_EQ(elastic_fault({given}), "");
    EXPECT_EQ(elastic_fault<1>({given}), "");
    EXPECT_EQ(
      elastic_fault({given, "Models=coupled", "Coupling/Zone=x-0.5", "Coupling/Scheme=blending"}),
      "");
    const std::vector<std::pair<Overrides, std::string>> list = {
      {{"Models=finite elements"}, "has no effect"},
      {{"Models=coupled", "Coupling/Zone=x-0.5"}, "'splice' or 'blending'"},
      {{"Domain/Nodes=cell centers"}, "'cell centers'"},
      {{"Peridynamics/Nodal volume=full"}, "'Nodal volume = partial'"},
      {{"Cracks/Segments=0.2,0.5 ; 0.5,0.5", "Cracks/Mesh=faces"}, "'removed'"},
      {{"Models=peridynamics", e + "Kinematics=full", e + "Solver=dynamics"},
       "'Kinematics = full'"},
      {{"Material/Critical stretch=0.1"}, "may break"},
      {{b + "Traction=right: 1, 0", b + "Traction layer=0.1"}, "'Traction layer'"},
      {{e + "Model=bond-based"}, "'Model = state-based'"},
      {{b + "Symmetry=bottom, top"}, "'bottom' and 'top'"},
      {{b + "Symmetry=top", "Cracks/Segments=0.2,0.5 ; 0.5,0.99"}, "symmetry 'top'"},
      {{"Peridynamics/Operator form=lattice"}, "makes a matrix"}};
    for (const auto &[more, words] : list)
      {
        Overrides overrides = more;
        overrides.push_back(given);
        expect(elastic_fault(overrides), entry, {words});
      }
  }


  TEST(ElasticScenes, coupled)
  {
    const std::string pd = "Peridynamics/", c = "Coupling/";
    const Overrides   coupled = {"Models=coupled", c + "Zone=x - 0.5"};
    const auto        with    = [&](const Overrides &more) {
      Overrides overrides = coupled;
      overrides.insert(overrides.end(), more.begin(), more.end());
      return elastic_fault(overrides);
    };
    EXPECT_EQ(with({}), "");
    expect(with({c + "Zone=adaptive", "Domain/Coarsening=1"}), c + "Zone", {"'adaptive'"});
    Overrides faces = {"Cracks/Segments=0.2,0.3 ; 0.6,0.3", "Cracks/Mesh=faces"};
    EXPECT_EQ(with(faces), "");
    faces.push_back(c + "Scheme=splice");
    expect(with(faces), "Cracks/Mesh", {"'Scheme = exchange'", "'removed'"});
    EXPECT_EQ(with({c + "Scheme=splice", c + "Overlap=1"}), "");
    EXPECT_EQ(with({c + "Scheme=blending", e + "Solver=conjugate gradients"}), "");
    expect(with({c + "Scheme=splice", e + "Solver=conjugate gradients"}),
           e + "Solver",
           {"'Scheme = splice'", "energy", "'linear'"});
    expect(with({c + "Scheme=blending", pd + "Surface correction=crack scaling"}),
           pd + "Surface correction",
           {"'Scheme = exchange'", "blending"});
    expect(with({c + "Overlap=1"}), c + "Overlap", {"splice", "'exchange'"});
    EXPECT_EQ(with({e + "Model=bond-based"}), "");
    expect(with({e + "Model=bond-based", c + "Scheme=splice"}),
           e + "Model",
           {"Poisson ratio of its own", "'Scheme = exchange'"});
    expect(with({e + "Model=bond-based", e + "Kinematics=full", e + "Solver=conjugate gradients"}),
           e + "Kinematics",
           {"coupled"});
    faces[1] = "Cracks/Mesh=pairs";
    expect(with(faces), "Cracks/Mesh", {"'removed' or 'faces'"});
    expect(with({c + "Scheme=splice", "Domain/Nodes=cell centers"}), "Domain/Nodes", {"coupled"});
  }
} // namespace PeriDeal
