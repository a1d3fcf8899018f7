// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Scenes of elasticity: what their entries give, and what is said about mistakes.
#include <perideal/scene/rigid_motions.h>

#include "scene_tables.h"

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
    expect_elastic_faults({}, R"(
Material/Young modulus= & Material/Poisson ratio= => Material/Young modulus | is empty | exactly two
Material/Poisson ratio= => Material/Young modulus | a.prm: | is the only one
Material/Bulk modulus=100 => Material/Poisson ratio | one of 3 | exactly two
Material/Young modulus=-200 => Material/Young modulus | greater than 0
Material/Young modulus=1 + t => Material/Young modulus | depends on t
Material/Young modulus=1 + T => Material/Young modulus | depends on T | 'Temperature change'
Material/Poisson ratio=0.1 + T/1000 => Material/Poisson ratio | depends on T | 'Temperature change'
Material/Thermal expansion=1e-5*(1 + T) => Material/Thermal expansion | depends on T | 'Temperature change'
Material/Thermal expansion=1e-5*(1 + t) & Elasticity/Temperature change=10 => Material/Thermal expansion | depends on t
Material/Young modulus=1 + T & Elasticity/Temperature change=10 =>
Material/Thermal expansion=1e-5*(1 + T) & Elasticity/Temperature change=10 =>
Material/Density=1 + T => Material/Density | no unknown | elasticity
Material/Poisson ratio=0.51 => Material/Poisson ratio | 0.51 | at most 0.5
Material/Poisson ratio=-1 => Material/Poisson ratio | greater than -1
Material/Poisson ratio=0.5 & Elasticity/Plane=strain => Material/Poisson ratio | less than 0.5
Material/Poisson ratio=0.5 =>
Material/Young modulus= & Material/Bulk modulus=1 & Material/Poisson ratio=0.5 => Material/Poisson ratio | no shear modulus
# E < 9 K and E <= 3 G
Material/Poisson ratio= & Material/Bulk modulus=20 => Material/Young modulus | contradict | Poisson ratio would be -1.16666666667
Material/Poisson ratio= & Material/Shear modulus=50 => Material/Young modulus | would be 1, 
)");
    expect_elastic_faults<1>({}, R"(
Material/Young modulus= => Material/Poisson ratio | 'Young modulus' alone
Material/Poisson ratio=0.5 =>
)");
    expect_elastic_faults<3>(
      {},
      "Material/Poisson ratio=0.5 => Material/Poisson ratio | less than 0.5");
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
    expect_elastic_faults({p + "Regions=rim: x > 0.9"}, R"(
Material/Phases/Young modulus=rim: 2 =>
Material/Phases/Conductivity=rim: 2 => Material/Phases/Regions | 'rim' has no material | Young modulus
Material/Phases/Bulk modulus=rim: 2 => Material/Phases/Bulk modulus | 'Young modulus', 'Poisson ratio' | same moduli
Material/Phases/Poisson ratio=rim: 0.7 => Material/Phases/Poisson ratio | phase 'rim' | 0.7
Material/Phases/Young modulus=rim: 0 => Material/Phases/Young modulus | phase 'rim' | greater than 0
Material/Phases/Fracture energy=rim: 2 => Material/Fracture energy | is empty | rest of the body
Material/Phases/Thermal expansion=rim: -1e-5 =>
)");
    // under heat, the elastic properties of a phase are not its material
    expect(fault("subsection Material\nsubsection Phases\nset Regions = rim: x > 0.9\n"
                 "set Young modulus = rim: 2\nend\nend\n"),
           p + "Regions",
           {"'rim' has no material", "Conductivity"});
  }


  TEST(ElasticScenes, strength_and_temperature_errors)
  {
    expect_elastic_faults({}, R"(
Material/Fracture energy=10 & Material/Critical stretch=1e-3 => Material/Critical stretch | 'Fracture energy' is given
Material/Fracture energy=0 => Material/Fracture energy | greater than 0
Material/Critical stretch=1e-3*(1 + t/T) =>
Material/Critical stretch=1e-3*(1 + s) => Material/Critical stretch | 's' | x, y, z, t, T
Material/Criterion=energy => Material/Fracture energy | is empty | 'Criterion = energy'
Material/Criterion=energy & Material/Critical stretch=1 => Material/Critical stretch | no effect | 'Fracture energy'
Material/Criterion=principal stress => Material/Critical stress | is empty | principal stress
Material/Criterion=von mises & Material/Critical stress=0 => Material/Critical stress | greater than 0
Material/Criterion=von mises & Material/Critical stress=1 & Material/Fracture energy=1 => Material/Fracture energy | no effect | 'Critical stress'
Material/Criterion=von mises & Material/Critical stress=1 & Material/Unbreakable=x =>
Material/Critical stress=1 => Material/Critical stress | 'Criterion = principal stress' | Leave one
Material/Unbreakable=x => Material/Unbreakable | bonds break | 'Fracture energy'
Material/Unbreakable=t & Material/Critical stretch=1 => Material/Unbreakable | depends on t
Material/Phases/Unbreakable=grip: 1 & Material/Critical stretch=1 => Material/Phases/Unbreakable | no phase 'grip'
Material/Rate factor=1 + rate => Material/Rate factor | bonds break | 'Fracture energy'
Material/Rate factor=1 + rate & Material/Critical stretch=1 & Elasticity/Solver=dynamics =>
Material/Rate factor=1 + rate & Material/Critical stretch=1 => Material/Rate factor | bodies in motion | 'linear'
Material/Rate factor=2 + rate & Material/Critical stretch=1 & Elasticity/Solver=dynamics => Material/Rate factor | is 2 at a rate of 0
Material/Rate factor=1 + t & Material/Critical stretch=1 & Elasticity/Solver=dynamics => Material/Rate factor | 't' | rate
Material/Rate factor=1 + rate & Material/Law=softening & Material/Tensile strength=1 & Material/Fracture energy=1 & Elasticity/Solver=dynamics => Material/Rate factor | 'Law = softening'
Material/Law=softening & Material/Tensile strength=1 & Material/Fracture energy=1 & Material/Criterion=energy => Material/Criterion | soften by their stretch
Material/Law=softening & Material/Tensile strength=1 & Material/Fracture energy=1 + t => Material/Fracture energy | depends on t or T
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Material/Fracture energy=1 & Material/Criterion=energy => Material/Criterion | 'Law = linear'
Elasticity/Crack direction=mean tension => Elasticity/Crack direction | bonds that break
Material/Critical stretch=1e-3 & Elasticity/Crack direction=mean tension => Elasticity/Crack direction | there is none
Material/Critical stretch=1e-3 & Elasticity/Crack direction=mean tension & Elasticity/Solver=dynamics => Elasticity/Crack direction | bodies at rest
Elasticity/Temperature change=10 => Elasticity/Temperature change | no effect | 'Thermal expansion' in section 'Material' is 0
Elasticity/Temperature change=t & Material/Thermal expansion=1 => Elasticity/Temperature change | depends on t
Elasticity/Temperature change=x & Material/Thermal expansion=1e-5 =>
)");
  }


  TEST(ElasticScenes, displacement_errors)
  {
    expect_elastic_faults({}, R"(
Boundary conditions/Displacement=lefd: 0, 0 => Boundary conditions/Displacement | unknown side 'lefd' | Did you mean 'left'?
Boundary conditions/Displacement=left: 0 => Boundary conditions/Displacement | side 'left' | needs 2 components
Boundary conditions/Displacement=left: 0, 0, 0 => Boundary conditions/Displacement | needs 2 components
Boundary conditions/Displacement=left: 0, 0; left: 0, free => Boundary conditions/Displacement | 'left' is named twice
Boundary conditions/Displacement=left: 0, 0; right: free, free => Boundary conditions/Displacement | side 'right' | empty grip
Boundary conditions/Displacement=left: 0, 2*yy => Boundary conditions/Displacement | component in y | column 3
Boundary conditions/Displacement=left: 0, fre => Boundary conditions/Displacement | component in y | 'fre'
Boundary conditions/Symmetry=left => Boundary conditions/Displacement | 'left' | 'Symmetry' | one of the two
Boundary conditions/Displacement=left: 0, t & Elasticity/Solver=linear =>
Boundary conditions/Displacement=left: 0, t & Elasticity/Solver=dynamics =>
Boundary conditions/Displacement=left: 0, t & Time/Steady=true => Time/Steady | is true | depend on t
)");
    expect_elastic_faults<1>({}, R"(
Boundary conditions/Displacement=left: 0, 0 => Boundary conditions/Displacement | needs 1 component,
Boundary conditions/Displacement=left: free => Boundary conditions/Displacement | side 'left' | empty grip
)");
  }


  TEST(ElasticScenes, traction_errors)
  {
    expect_elastic_faults({}, R"(
Boundary conditions/Traction=right: free, 1 => Boundary conditions/Traction | side 'right' | 'free' | give 0
Boundary conditions/Traction=right: 1 => Boundary conditions/Traction | needs 2 components
Boundary conditions/Traction=left: 0, 1 => Boundary conditions/Traction | 'left' | displacement in y | contradicts
Boundary conditions/Traction=left: 0, 0 =>
Boundary conditions/Displacement=left: 0, 0; right: 1, free & Boundary conditions/Traction=right: 0, x =>
Boundary conditions/Symmetry=top & Boundary conditions/Traction=top: 0, 1 => Boundary conditions/Traction | 'top' | 'Symmetry'
Boundary conditions/Symmetry=top & Boundary conditions/Traction=top: 0, 0 =>
# slowly
Boundary conditions/Traction=right: t, 0 =>
Boundary conditions/Traction layer=0.1 => Boundary conditions/Traction layer | no effect
Boundary conditions/Traction=right: 1, 0 & Boundary conditions/Traction layer=0 => Boundary conditions/Traction layer | greater than 0
Boundary conditions/Traction=right: 1, 0 & Boundary conditions/Traction layer=wide => Boundary conditions/Traction layer | not a number
Boundary conditions/Traction=right: 1, 0 & Boundary conditions/Traction layer=2 => Boundary conditions/Traction layer | wider than the body
)");
  }


  TEST(ElasticScenes, entries_of_another_physics)
  {
    expect_elastic_faults({}, R"(
Boundary conditions/Dirichlet=top: 1 => Boundary conditions/Dirichlet | Use 'Displacement'
Boundary conditions/Flux=top: 1 => Boundary conditions/Flux | Use 'Traction'
Boundary conditions/Convection=top: 1, 2 => Boundary conditions/Convection | 'elasticity'
Initial and source/Source=1 => Initial and source/Source | use 'Body force'
Initial and source/Initial value=1 => Initial and source/Initial value | at rest
Initial and source/Body force=1 => Initial and source/Body force | needs 2 components
Initial and source/Body force=1, free => Initial and source/Body force | 'free'
Initial and source/Body force=1, t =>
)");

    expect_elastic_faults({"Physics=heat", b + "Displacement="}, R"(
 =>
# properties of the material are read and not used
Material/Bulk modulus=-1 => Material/Bulk modulus | greater than 0
Boundary conditions/Displacement=left: 0, 0 => Boundary conditions/Displacement | 'heat' | 'Dirichlet'
Boundary conditions/Traction=left: 0, 0 => Boundary conditions/Traction | 'heat' | 'Flux'
Boundary conditions/Traction layer=1 => Boundary conditions/Traction layer | 'heat'
Initial and source/Body force=1, 0 => Initial and source/Body force | 'heat'
Elasticity/Solver=dynamics => Elasticity/Solver | 'heat'
)");
  }


  TEST(ElasticScenes, rigid_motions)
  {
    expect_elastic_faults({}, R"(
Boundary conditions/Displacement= => Boundary conditions/Displacement | against: translation in x, translation in y, rotation about z.
Boundary conditions/Displacement=left: 0, free => Boundary conditions/Displacement | against: translation in y.
Boundary conditions/Displacement=left: free, 0 => Boundary conditions/Displacement | against: translation in x, rotation about z.
Boundary conditions/Displacement=left: free, 0; right: free, 1 => Boundary conditions/Displacement | against: translation in x.
Boundary conditions/Displacement=bottom: 0, free => Boundary conditions/Displacement | against: translation in y, rotation about z.
Boundary conditions/Displacement=left: 0, free; bottom: free, 0 =>
Boundary conditions/Displacement= & Boundary conditions/Symmetry=left, bottom =>
Boundary conditions/Displacement=right: free, 0 & Boundary conditions/Symmetry=left =>
# each alone leaves a rotation, about a point of the left and of the bottom side
Boundary conditions/Displacement=left: free, 0; bottom: 0, free => Boundary conditions/Displacement | against: rotation about z.
# a hole holds both, and a body that moves need not be held
Domain/Shape=plate with hole & Boundary conditions/Displacement=hole: 0, 0 =>
Domain/Shape=plate with hole & Boundary conditions/Displacement=hole: 0, free => Boundary conditions/Displacement | against: translation in y.
Boundary conditions/Displacement= & Elasticity/Solver=dynamics =>
)");
    expect_elastic_faults<1>(
      {},
      "Boundary conditions/Displacement= => Boundary conditions/Displacement | against: translation in x.");
    expect_elastic_faults<3>({}, R"(
Boundary conditions/Displacement=left: 0, free, free => Boundary conditions/Displacement | against: translation in y, translation in z, rotation about x.
Boundary conditions/Displacement=left: free, 0, 0 => Boundary conditions/Displacement | against: translation in x, rotation about y, rotation about z.
Boundary conditions/Displacement= & Boundary conditions/Symmetry=left, bottom => Boundary conditions/Displacement | against: translation in z.
Boundary conditions/Displacement= & Boundary conditions/Symmetry=left, bottom, back =>
Boundary conditions/Displacement=front: 0, 0, 0 =>
)");
    // sides of a mesh file lie anywhere
    expect_elastic_faults({"Domain/Shape=mesh file",
                           "Domain/Mesh file=" PERIDEAL_SOURCE_DIR "/tests/data/two_materials.msh",
                           "Peridynamics/Horizon=0.3"},
                          R"(
Boundary conditions/Displacement=1: 0, free; 2: 1, free => Boundary conditions/Displacement | against: translation in y.
Boundary conditions/Displacement=1: 0, free; 2: free, 1 =>
Boundary conditions/Displacement=1: 0, free & Boundary conditions/Symmetry=2 =>
)");
  }


  TEST(ElasticScenes, contradicting_choices)
  {
    expect_elastic_faults({}, R"(
Elasticity/Model=bond base => Elasticity/Model | Did you mean 'bond-based'?
Elasticity/Solver=conjugate gradient => Elasticity/Solver | Did you mean 'conjugate gradients'?
Elasticity/Kinematics=full => Elasticity/Kinematics | 'conjugate gradients'
Time/Steady=true & Elasticity/Solver=dynamics => Time/Steady | 'dynamics'
Time/Steady=true =>
Time/Stepper=rk4 => Time/Stepper | 'Solver' in section 'Elasticity'
Output/Write at=0.1 => Output/Write at | equilibrium
Output/Write at=0.1 & Elasticity/Solver=dynamics =>
Cracks/Segments=0.2,0.5 ; 0.5,0.5 & Cracks/Growth=2: 0, 0.1,0 & Time/Steady=true => Time/Steady | cracks that grow
Cracks/Segments=0.2,0.5 ; 0.5,0.5 & Cracks/Growth=2: 0, 0.1,0 & Output/Write at=0.1 =>
Cracks/Segments=0.2,0.5 ; 0.5,0.5 & Cracks/Transmission=0.5 => Cracks/Transmission | no force
Peridynamics/Calibration=analytic => Peridynamics/Calibration | not for use | own families
Peridynamics/Self term=paper => Peridynamics/Self term | has no effect
Peridynamics/Flux treatment=extrapolation => Peridynamics/Flux treatment | has no effect | 'natural'
Peridynamics/Surface correction=moments =>
Peridynamics/Surface correction=energy & Models=finite elements => Peridynamics/Surface correction | has no effect
Peridynamics/Surface correction=crack scaling => Peridynamics/Surface correction | has no effect | coupled
Peridynamics/Boundary treatment=exchange => Peridynamics/Boundary treatment | dilatation | use 'none'
Peridynamics/Operator form=lattice =>
Peridynamics/Operator form=lattice & Material/Critical stretch=0.1 => Peridynamics/Operator form | may break | 'auto'
Output/Grid=5, 5 =>
Finite elements/Capacity=consistent => Finite elements/Capacity | lumped
Models=peridynamics & Elasticity/Kinematics=full & Elasticity/Solver=dynamics =>
Elasticity/Kinematics=full & Elasticity/Solver=dynamics => Elasticity/Kinematics | 'Plane = strain' | 'Law = hyperelastic' | 'Models = peridynamics'
Elasticity/Kinematics=full & Elasticity/Solver=dynamics & Elasticity/Plane=strain =>
Peridynamics/Boundary treatment=fictitious mirror => Peridynamics/Boundary treatment | not defined | use 'none'
Peridynamics/Boundary treatment=fictitious constant => Peridynamics/Boundary treatment | not defined | use 'none'
Peridynamics/Boundary treatment=layer => Peridynamics/Boundary treatment | not defined | use 'none'
Peridynamics/Operator form=lattice & Models=peridynamics & Elasticity/Kinematics=full & Elasticity/Solver=dynamics => Peridynamics/Operator form | 'Kinematics = full' | 'auto'
)");
    expect_elastic_faults<1>({}, "Elasticity/Plane=strain => Elasticity/Plane | a bar");
    expect_elastic_faults<3>({}, "Elasticity/Plane=strain => Elasticity/Plane | 'Dimension' is 3");
  }


  TEST(ElasticScenes, fictitious_nodes)
  {
    const Overrides given{"Peridynamics/Surface correction=fictitious nodes"};
    expect_elastic_faults(given, R"(
 =>
Models=coupled & Coupling/Zone=x-0.5 & Coupling/Scheme=blending =>
Models=finite elements => Peridynamics/Surface correction | has no effect
Models=coupled & Coupling/Zone=x-0.5 => Peridynamics/Surface correction | 'splice' or 'blending'
Domain/Nodes=cell centers => Peridynamics/Surface correction | 'cell centers'
Peridynamics/Nodal volume=full => Peridynamics/Surface correction | 'Nodal volume = partial'
Cracks/Segments=0.2,0.5 ; 0.5,0.5 & Cracks/Mesh=faces => Peridynamics/Surface correction | 'removed'
Models=peridynamics & Elasticity/Kinematics=full & Elasticity/Solver=dynamics => Peridynamics/Surface correction | 'Kinematics = full'
Material/Critical stretch=0.1 => Peridynamics/Surface correction | may break
Boundary conditions/Traction=right: 1, 0 & Boundary conditions/Traction layer=0.1 => Peridynamics/Surface correction | 'Traction layer'
Elasticity/Model=bond-based => Peridynamics/Surface correction | 'Model = state-based'
Boundary conditions/Symmetry=bottom, top => Peridynamics/Surface correction | 'bottom' and 'top'
Boundary conditions/Symmetry=top & Cracks/Segments=0.2,0.5 ; 0.5,0.99 => Peridynamics/Surface correction | symmetry 'top'
Peridynamics/Operator form=lattice => Peridynamics/Surface correction | makes a matrix
)");
    EXPECT_EQ(elastic_fault<1>(given), "");
  }


  TEST(ElasticScenes, coupled)
  {
    expect_elastic_faults({"Models=coupled", "Coupling/Zone=x - 0.5"}, R"(
 =>
Coupling/Zone=adaptive & Domain/Coarsening=1 => Coupling/Zone | 'adaptive'
Coupling/Scheme=splice & Coupling/Overlap=1 =>
Coupling/Scheme=blending & Elasticity/Solver=conjugate gradients =>
Coupling/Scheme=splice & Elasticity/Solver=conjugate gradients => Elasticity/Solver | 'Scheme = splice' | energy | 'linear'
Coupling/Scheme=blending & Peridynamics/Surface correction=crack scaling => Peridynamics/Surface correction | 'Scheme = exchange' | blending
Coupling/Overlap=1 => Coupling/Overlap | splice | 'exchange'
Elasticity/Model=bond-based =>
Elasticity/Model=bond-based & Coupling/Scheme=splice => Elasticity/Model | Poisson ratio of its own | 'Scheme = exchange'
Elasticity/Model=bond-based & Elasticity/Kinematics=full & Elasticity/Solver=conjugate gradients => Elasticity/Kinematics | coupled
Coupling/Scheme=splice & Domain/Nodes=cell centers => Domain/Nodes | coupled
Cracks/Segments=0.2,0.3 ; 0.6,0.3 & Cracks/Mesh=faces =>
Cracks/Segments=0.2,0.3 ; 0.6,0.3 & Cracks/Mesh=faces & Coupling/Scheme=splice => Cracks/Mesh | 'Scheme = exchange' | 'removed'
Cracks/Segments=0.2,0.3 ; 0.6,0.3 & Cracks/Mesh=pairs & Coupling/Scheme=splice => Cracks/Mesh | 'removed' or 'faces'
)");
  }


  TEST(ElasticScenes, only_motion_needs_density)
  {
    expect_elastic_faults({"Material/Density=0"}, R"(
 =>
Elasticity/Solver=dynamics => Material/Density | greater than 0
)");
  }


  TEST(ElasticScenes, constant_micromodulus_is_for_bonds_alone)
  {
    expect_elastic_faults({"Elasticity/Micromodulus=constant"}, R"(
 => Elasticity/Micromodulus | bond-based
Models=peridynamics & Elasticity/Model=bond-based =>
Models=finite elements & Elasticity/Model=bond-based => Elasticity/Micromodulus | 'peridynamics'
Models=peridynamics & Elasticity/Model=bond-based & Peridynamics/Surface correction=moments => Elasticity/Micromodulus | 'Surface correction'
)");
  }
} // namespace PeriDeal
