// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Entries that are wrong by themselves or beside others: what is said about them.

#include <perideal/scene/rules.h>

#include "scene_tables.h"

namespace PeriDeal
{
  using namespace SceneTests;

  namespace
  {
    const Overrides plate{"Domain/Lower corner=0, 0",
                          "Domain/Upper corner=1, 1",
                          "Domain/Cells=12, 12",
                          "Boundary conditions/Dirichlet=top: 1; bottom: 0",
                          "Time/End time=0.01",
                          "Output/Fields=none",
                          "Output/Probes=0.5,0.5"};
    const Overrides elastic{"Physics=elasticity",
                            "Material/Young modulus=200",
                            "Material/Poisson ratio=0.3",
                            "Boundary conditions/Dirichlet=",
                            "Boundary conditions/Displacement=left: 0, 0"};


    template <int dim>
    std::string fault_of(const Overrides &overrides)
    {
      return message_of([&] {
        const std::string head = "set Dimension = " + std::to_string(dim) + "\n";
        Scene<dim>        scene;
        parse_computable<dim>({"a.prm", apply_overrides(head, "a.prm", overrides)}, scene);
      });
    }


    /** Rows `OVERRIDES => WORDS | WORDS` of the plate with further overrides. */
    void expect_said(const Overrides &further, const std::string &table)
    {
      for (const FaultRow &row : fault_rows(table))
        {
          SCOPED_TRACE(row.left);
          Overrides overrides = plate;
          overrides.insert(overrides.end(), further.begin(), further.end());
          std::string dimension = "2";
          for (const std::string &one : split_list(row.left, '&'))
            if (one.rfind("Dimension=", 0) == 0)
              dimension = one.substr(10);
            else
              overrides.push_back(one);
          const std::string message = dimension == "1" ? fault_of<1>(overrides) :
                                      dimension == "2" ? fault_of<2>(overrides) :
                                                         fault_of<3>(overrides);
          EXPECT_FALSE(row.words.empty());
          expect_parts(message, row.words);
          EXPECT_LT(message.size(), 700u) << message;
        }
    }


    Overrides elastic_and(const Overrides &more)
    {
      Overrides all = elastic;
      all.insert(all.end(), more.begin(), more.end());
      return all;
    }
  } // namespace


  TEST(SceneMistakes, of_heat)
  {
    expect_said({}, R"(
Output/Probes=0,0.1, 0.5,0.1 => 'Probes' | 2 points | 0, 0.1 ; 0.5, 0.1
Cracks/Segments=-0.5,0, 0.5,0 => 'Segments' | 2 points | -0.5, 0 ; 0.5, 0
Time/End time=soon => 'End time' | 'Time' | 'soon' is not a number
Domain/Cells=12.5, 12 => 'Cells' | 12.5 | whole number
Domain/Upper corner=80; 5 => 'Upper corner' | found 1 | Commas separate them: 80, 5
Peridynamics/Horizon=5 => 'Horizon' | longer than the body, 1 | three spacings of the nodes are 0.25
Material/Density=-2 => 'Density' | greater than 0
Peridynamics/Boundary treatment=exchange & Domain/Nodes=cell centers => 'Nodes' in section 'Domain' | 'Boundary treatment = exchange' | none
Peridynamics/Boundary treatment=exchange & Peridynamics/Flux treatment=extrapolation => 'Flux treatment' | 'Boundary treatment = exchange'
Models=coupled & Cracks/Segments= => 'Zone' | 'Coupling' | 'Cracks' | everywhere
Models=coupled & Dimension=1 & Domain/Lower corner=0 & Domain/Upper corner=1 & Domain/Cells=10 & Cracks/Segments= & Boundary conditions/Dirichlet=left: 0 & Output/Probes= & Output/Line= => 'Zone' | 'Dimension' 1 | formula
Models=coupled & Coupling/Zone=crack: 1 => 'Zone' | 'cracks: c'
Models=coupled & Coupling/Zone=cracks: -1 => 'Zone' | 0 or more
Models=coupled & Coupling/Zone=x - t => 'Zone' | may not depend on t
Models=coupled & Coupling/Zone=adaptive & Coupling/Scheme=splice => 'Zone' | 'adaptive' | exchange
Coupling/Adaptive tolerance=0 => 'Adaptive tolerance' | greater than 0
Coupling/Adaptive tolerance=0.1 => 'Adaptive tolerance' | 'Zone = adaptive'
Models=finite elements & Domain/Coarsening=1 => 'Coarsening' | 'Cracks' | 'Fine where'
Models=finite elements & Domain/Coarsening=1 & Domain/Shape=plate with hole => 'Coarsening' | 'Shape'
Domain/Fine where=x => 'Fine where' | 'Coarsening'
Models=coupled & Coupling/Zone=everywhere & Coupling/Scheme=blending & Coupling/Overlap=1000 => 'Overlap' | wider than the body
Models=coupled & Coupling/Zone=everywhere & Coupling/Overlap=1 => 'Overlap' | 'exchange'
Models=coupled & Finite elements/Degree=2 & Coupling/Zone=everywhere => 'Degree' | degree 1
Peridynamics/Horizon=-0.3 => 'Horizon' | greater than 0
Peridynamics/Horizon ratio=0.9 => 'Horizon ratio' | 1 or more
Peridynamics/Horizon=0.05 => 'Horizon' | shorter than the node spacing
Domain/Cells=0, 12 => 'Cells' | at least one
Domain/Upper corner=-1, 1 => 'Upper corner' | 'Lower corner'
Finite elements/Degree=7 => 'Degree' | 1, 2 or 3
Peridynamics/Horizon ratio=1e10 => 'Horizon ratio' | longer than the body
Material/Phases/Regions=core: x > 0.5 => 'Regions' | 'core' | no material
Material/Phases/Regions=core: x > 0.5 & Material/Phases/Conductivity=cor: 2 => 'Conductivity' | 'cor' | Did you mean 'core'?
Material/Phases/Regions=core: circle(0, 0) & Material/Phases/Conductivity=core: 2 => 'Regions' | circle(x, y, radius)
Physics=moisture & Material/Saturated concentration=0 => 'Saturated concentration' | greater than 0
Physics=moistrue => 'Physics' | Did you mean 'moisture'?
Boundary conditions/Displacement=left: 0, 0 => 'Displacement' | 'Physics = elasticity'
Time/Stepper=verlet => 'Stepper' | 'verlet' | 'Physics = elasticity' | 'auto'
Initial and source/Initial displacement=0, 0 => 'Initial displacement' | 'heat'
Initial and source/Source=2*x + foo => 'Source' | foo | column 7
Boundary conditions/Flux=top: 3 => 'Flux' | 'top' | 'Dirichlet'
Boundary conditions/Convection=left: -4, 20 => 'Convection' | 'left' | negative
Boundary conditions/Convection=left: 4*t, 20 => 'Convection' | 'left' | depends on t
Domain/Shape=plate with hole & Boundary conditions/Symmetry=hole => 'Symmetry' | flat
Boundary conditions/Flux=left: 1 & Boundary conditions/Convection=left: 4, 20 & Peridynamics/Flux treatment=extrapolation => 'Convection' | 'left' | 'Flux treatment' | 'natural'
Boundary conditions/Parts=a: top & Boundary conditions/Dirichlet=bottom: 0; a: 1 => 'Parts' | part 'a' | found 'top' | 'SIDE if FORMULA'
Boundary conditions/Parts=a: top if x >  & Boundary conditions/Dirichlet=bottom: 0; a: 1 => 'Parts' | part 'a' | column | ends too early
Boundary conditions/Parts=a: top if x > t & Boundary conditions/Dirichlet=bottom: 0; a: 1 => 'Parts' | part 'a' | depends on t
Boundary conditions/Parts=a: region 0 & Boundary conditions/Dirichlet=bottom: 0; a: 1 => 'Parts' | part 'a' | is empty
Boundary conditions/Parts=left: top if x > 0.5 => 'Parts' | 'left' | name of a side
Boundary conditions/Parts=a: top if x > 0.5 ; a: point 0, 0 & Boundary conditions/Dirichlet=bottom: 0; a: 1 => 'Parts' | 'a' is named twice
Boundary conditions/Parts=a: point 0, 0, 0 & Boundary conditions/Dirichlet=bottom: 0; a: 1 => 'Parts' | part 'a' | 2 coordinates
Boundary conditions/Parts=load: top if x > 0.5 & Boundary conditions/Dirichlet=bottom: 0; laod: 1 => 'Dirichlet' | 'laod' | Parts: load | Did you mean 'load'?
Boundary conditions/Parts=a: region x > 0.5 & Boundary conditions/Convection=a: 1, 2 => 'Convection' | 'a' | no area | 'Flux'
Boundary conditions/Parts=a: left if y > 0.5 & Boundary conditions/Symmetry=a => 'Symmetry' | 'a' | whole sides
Boundary conditions/Parts=a: left if y > 0.5 & Boundary conditions/Dirichlet=bottom: 0; a: 1 & Boundary conditions/Symmetry=left => 'Dirichlet' | 'a' | 'left' | 'Symmetry'
Boundary conditions/Parts=a: region x > 0.5 & Boundary conditions/Flux=a: 1 & Peridynamics/Flux treatment=extrapolation => 'Flux' | 'a' | 'natural'
Boundary conditions/Velocity=right: 1, free => 'Velocity' | 'Physics = elasticity'
Domain/Holes=circl: 0.5, 0.5, 0.2 => 'Holes' | Did you mean 'circle'?
Domain/Holes=circle: 0.5, 0.5 => 'Holes' | circle | x, y, radius
Domain/Holes=rectangle: 0.5, 0.5, 0.2, 0.7 => 'Holes' | rectangle | second corner
Domain/Holes=circle: 0.5, 0.5, 0.01 => 'Holes' | no centre of a cell | 'Cells'
Domain/Shape=plate with hole & Domain/Hole center=0.3,0.3 ; 0.7,0.7 => 'Hole center' | 'Holes'
Domain/Rims=fitted => 'Rims' | no hole
Domain/Holes=circle: 0.5, 0.5, 0.2 & Domain/Rims=fited => 'Rims' | Did you mean 'fitted'?
Domain/Refinements=2 => 'Refinements' | lattice | 'Cells'
Domain/Holes=circle: 0.5, 0.5, 0.2 & Domain/Refinements=2 => 'Refinements' | 'Rims = fitted'
Domain/Holes=circle: 0.5, 0.5, 0.2 & Domain/Rims=fitted & Domain/Refinements=13 => 'Refinements' | at most 12
Domain/Shape=generator => 'Generator' | hyper_shell
Domain/Shape=generator & Domain/Generator=hyper_shel => 'Generator' | Did you mean 'hyper_shell'?
Domain/Generator=hyper_shell => 'Generator' | 'Shape' | not 'generator'
Domain/Shape=generator & Domain/Generator=hyper_ball & Domain/Holes=circle: 0.5, 0.5, 0.2 => 'Holes' | generator
Models=finite elements & Domain/Shape=generator & Domain/Generator=hyper_ball & Domain/Coarsening=1 & Domain/Fine where=x => 'Coarsening' | 'Refinements'
Dimension=3 & Domain/Lower corner=0, 0, 0 & Domain/Upper corner=1, 1, 1 & Domain/Cells=4, 4, 4 & Output/Probes= & Cracks/Polygons=disc: 0.5,0.5,0.5, 0,0,0, 0.2 => 'Polygons' | disc | normal
Dimension=3 & Domain/Lower corner=0, 0, 0 & Domain/Upper corner=1, 1, 1 & Domain/Cells=4, 4, 4 & Output/Probes= & Cracks/Polygons=disc: 0.5,0.5,0.5, 0,0,1 => 'Polygons' | disc | 7 numbers
Boundary conditions/Flux=front: 3 => 'Flux' | 'front' | left, right, bottom, top
Cracks/Segments=2,2 ; 3,3 => 'Segments' | outside the body
Cracks/Segments=0.2,0.2 => 'Segments' | two points
Cracks/Segments=0.2,0.2 ; 0.2,0.2 => 'Segments' | no length
Material/Conductivity=1 + T & Material/Interface rule=harmonic => 'Interface rule' | arithmetic
Material/Diffusivity=2 => 'Diffusivity' | moisture | 'Conductivity'
Physics=moisture & Material/Diffusivity=2 & Material/Conductivity=2 => 'Conductivity' | beside 'Diffusivity'
Material/Phases/Regions=a: mesh(1) & Material/Phases/Conductivity=a: 2 => 'Regions' | mesh file
Output/Probes=0.5,0.5,0.5 => 'Probes' | needs 2 coordinates, found 3
)");
  }


  TEST(SceneMistakes, of_solids)
  {
    expect_said(elastic, R"(
Material/Poisson ratio= => 'Young modulus' | exactly two
Material/Poisson ratio= & Material/Bulk modulus=20 => 'Young modulus' | Poisson ratio would be -1.1666
Material/Poisson ratio=0.5 & Elasticity/Plane=strain => 'Poisson ratio' | less than 0.5
Boundary conditions/Displacement=bottom: 0, free => 'Displacement' | translation in y, rotation about z
Boundary conditions/Displacement=left: 0, 0; top: free, free => 'Displacement' | 'top' | empty grip
Boundary conditions/Traction=left: 1, 0 => 'Traction' | 'left' | displacement in x
Boundary conditions/Dirichlet=top: 1 => 'Dirichlet' | 'Displacement'
Time/Stepper=newmark => 'Stepper' | 'newmark' | 'Solver = dynamics'
Initial and source/Initial velocity=1, 0 => 'Initial velocity' | no effect | 'dynamics'
Boundary conditions/Displacement=left: 0, 0; right: t, 0 & Time/Steady=true => 'Steady' | depend on t
Models=coupled & Material/Critical stretch=0.1 & Coupling/Zone=cracks: 1 => 'Zone' | is empty | 'follow'
Material/Weibull modulus=10 & Material/Strength seed=1 => 'Weibull modulus' | bonds that break | 'Fracture energy' | 'Critical stretch'
Models=coupled & Material/Fracture energy=1 & Material/Criterion=energy & Coupling/Zone=follow => 'Criterion' | 'Models = peridynamics' | 'stretch'
Models=peridynamics & Elasticity/Model=correspondence & Material/Fracture energy=1 & Material/Criterion=energy => 'Criterion' | correspondence
Models=peridynamics & Boundary conditions/Displacement=bottom: 0, 0 & Boundary conditions/Symmetry=left & Material/Critical stress=1 & Material/Criterion=von mises => 'Criterion' | beyond the body | 'Symmetry'
Elasticity/Breaking=at rest => 'Breaking' in section 'Elasticity' | bonds that break | 'Fracture energy'
Material/Critical stretch=0.1 & Elasticity/Breaking=controlled => 'Breaking' | no load depends on t
Elasticity/Dissipation step=0.1 => 'Dissipation step' | 'Breaking = controlled'
Material/Critical stretch=0.1 & Elasticity/Breaking=controlled & Elasticity/Dissipation step=2 => 'Dissipation step' in section 'Elasticity' | 2 | less than 1
Material/Critical stretch=0.1 & Elasticity/Breaking=controlled & Elasticity/Kinematics=full & Elasticity/Solver=newton => 'Breaking' | in proportion to the loads | 'linear'
Material/Critical stretch=0.1 & Elasticity/Breaking=controlled & Elasticity/Temperature change=10 & Material/Thermal expansion=1e-5 => 'Breaking' | 'Temperature change' | 'at rest'
Elasticity/Kinematics=full => 'Kinematics' | 'linear' | 'conjugate gradients'
Elasticity/Preconditioner=none => 'Preconditioner' | conjugate gradients | 'linear'
Boundary conditions/Displacement=left: 0, 0 ; top: 1 + if(x > 0.5, 0, free), 0 => 'Displacement' | 'top' | component in x | if(condition, formula, free)
Boundary conditions/Displacement=left: 0, 0 ; top: if(t > 0.5, 0, free), 0 => 'Displacement' | 'top' | at some times
Boundary conditions/Traction=right: if(y > 0.5, 0, free), 0 => 'Traction' | 'right' | 'free'
Boundary conditions/Velocity=right: 1, free => 'Velocity' | 'Solver' | 'dynamics'
Cracks/Segments=0.25,0.5 ; 0.75,0.5 & Cracks/Bonds through tips=in part & Cracks/Growth=2: 0, 0.1,0 => 'Bonds through tips' | 'in part' | lie still
Cracks/Segments=0.25,0.5 ; 0.75,0.5 & Cracks/Bonds through tips=in part & Cracks/Mesh=faces => 'Bonds through tips' | 'in part' | 'Mesh = faces'
)");
  }


  TEST(SceneMistakes, of_motion)
  {
    expect_said(elastic_and({"Elasticity/Solver=dynamics"}), R"(
Time/Stepper=rk4 => 'Stepper' | 'rk4' | 'verlet' or 'newmark'
Initial and source/Initial velocity=1 => 'Initial velocity' | needs 2 components
Initial and source/Initial displacement=t, 0 => 'Initial displacement' | depends on t
Elasticity/Kinematics=full & Elasticity/Solver=conjugate gradients => 'Kinematics' | 'Models = peridynamics'
Boundary conditions/Velocity=left: 1, free => 'Velocity' | 'left' | displacement in x
)");
  }


  TEST(SceneMistakes, of_laws)
  {
    expect_said(elastic_and({"Models=peridynamics", "Elasticity/Plane=strain"}), R"(
Material/Law=visco => 'Law' in section 'Material' | visco | viscoelastic
Material/Relaxation=0.5, 1 => 'Relaxation' | 'Law = viscoelastic' | 'linear'
Material/Bond force=s => 'Bond force' | 'Law = formula' | 'linear'
Material/Law=viscoelastic => 'Relaxation' | is empty
Material/Law=viscoelastic & Material/Relaxation=0.5 => 'Relaxation' | a share and a time
Material/Law=viscoelastic & Material/Relaxation=0.5, 0 => 'Relaxation' | '0.5, 0' | greater than 0
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 ; 0.6, 2 => 'Relaxation' | 1.1 | at most 1
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Elasticity/Plane=stress => 'Law' | 'Plane = strain'
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Elasticity/Model=bond-based => 'Law' | 'Model = state-based'
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Time/Steady=true => 'Steady' | 'Law = viscoelastic'
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Models=coupled & Coupling/Zone=everywhere => 'Scheme' | 'exchange' | 'blending'
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Models=finite elements & Material/Thermal expansion=1e-5 & Elasticity/Temperature change=1 => 'Law' | 'Temperature change' | 'Models = peridynamics'
Material/Law=formula & Material/Bond force=s & Elasticity/Solver=newton & Peridynamics/Operator form=lattice => 'Operator form' | 'Law' | 'auto'
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Material/Thermal expansion=1e-5 & Elasticity/Temperature change=1 => 'Law' | 'Temperature change' | plane strain
Material/Yield stress=1 => 'Yield stress' | 'Law = plastic' | 'linear'
Material/Hardening modulus=1 => 'Hardening modulus' | 'Law = plastic' | 'linear'
Material/Law=plastic => 'Yield stress' | is empty
Material/Law=plastic & Material/Yield stress=0 & Elasticity/Solver=newton => 'Yield stress' | 0 | greater than 0
Material/Law=plastic & Material/Yield stress=1 => 'Solver' | 'linear' | 'newton'
Material/Law=plastic & Material/Yield stress=1 & Material/Hardening modulus=-1 & Elasticity/Solver=newton => 'Hardening modulus' | -1 | 'Law = softening'
Material/Law=plastic & Material/Yield stress=1 & Elasticity/Model=bond-based & Elasticity/Solver=newton => 'Law' | 'plastic' | 'state-based'
Material/Law=plastic & Material/Yield stress=1 & Elasticity/Kinematics=full & Elasticity/Solver=newton => 'Law' | small displacements | 'Kinematics = linear'
Material/Law=plastic & Material/Yield stress=1 & Material/Fracture energy=1 & Elasticity/Solver=newton => 'Law' | do not break
Material/Law=plastic & Material/Yield stress=1 & Models=coupled & Coupling/Zone=everywhere & Elasticity/Solver=newton => 'Law' | 'plastic' | 'coupled'
Material/Law=plastic & Material/Yield stress=1 & Peridynamics/Surface correction=moments & Elasticity/Solver=newton => 'Surface correction' | 'moments' | 'fictitious nodes'
Material/Law=plastic & Material/Yield stress=1 & Material/Thermal expansion=1e-5 & Elasticity/Temperature change=1 & Elasticity/Solver=newton & Models=coupled & Coupling/Zone=everywhere & Coupling/Scheme=blending & Elasticity/Model=correspondence => 'Law' | 'plastic' | 'Temperature change' | 'coupled'
Material/Law=plastic & Material/Yield stress=2 - T & Elasticity/Solver=newton => 'Yield stress' | depends on T | 'Temperature change'
Material/Law=plastic & Material/Yield stress=1 & Peridynamics/Operator form=lattice & Elasticity/Solver=newton => 'Operator form' | 'Law' | 'auto'
Material/Law=formula & Material/Bond force=s & Models=coupled & Coupling/Zone=everywhere & Coupling/Scheme=splice & Elasticity/Solver=conjugate gradients => 'Scheme' | 'splice' | 'Law = linear'
Material/Law=formula => 'Bond force' | is empty
Material/Law=formula & Material/Bond force=s+ => 'Bond force' | column 2
Material/Law=formula & Material/Bond force=2*x => 'Bond force' | 'x' | s, damage
Material/Law=formula & Material/Bond force=s+1 => 'Bond force' | is 1 at s = 0
Material/Law=formula & Material/Bond force=s => 'Solver' | 'linear' | 'conjugate gradients'
Material/Law=formula & Material/Bond force=s & Material/Fracture energy=1 => 'Fracture energy' | 'Critical stretch'
Material/Law=formula & Material/Bond force=s & Models=finite elements & Elasticity/Solver=conjugate gradients => 'Law' | 'finite elements'
)");
  }


  TEST(SceneMistakes, of_laws_of_users)
  {
    expect_said(elastic_and({"Models=finite elements",
                             "Material/Bulk modulus=",
                             "Material/Shear modulus=",
                             "Material/Young modulus=",
                             "Material/Poisson ratio=",
                             "Material/Law=user",
                             "Material/User law=law.so",
                             "Elasticity/Solver=newton"}),
                R"(
Material/User law= => 'User law' | is empty | 'Law = user'
Material/User properties=1, E => 'User properties' | E
Material/User states=-1 => 'User states' | -1
Material/User states=1.5 => 'User states' | 1.5
Material/Young modulus=1 => 'Young modulus' | 'Law = user' | 'User properties'
Material/Law=linear => 'User law' | 'Law = user' | 'linear'
Material/Law=linear & Material/User law= & Material/User properties=1 => 'User properties' | 'Law = user' | 'linear'
Material/Phases/User properties=core: 1, 2 => 'User properties' | no phase 'core'
Models=peridynamics => 'Law' | 'user' | 'Models = finite elements'
Models=peridynamics & Elasticity/Model=bond-based => 'Law' | 'user' | 'Models = finite elements'
Models=peridynamics & Material/Young modulus=1 & Material/Poisson ratio=0.2 & Material/Fracture energy=1 => 'Fracture energy' | 'Law = user' | 'Critical stretch'
Models=coupled & Coupling/Zone=everywhere => 'Law' | 'user' | 'Models = finite elements'
Elasticity/Solver=linear => 'Solver' | 'Law = user' | 'newton'
Material/Fracture energy=1 => 'Law' | 'user' | 'Fracture energy'
Material/Thermal expansion=1e-5 & Elasticity/Temperature change=1 & Elasticity/Kinematics=full & Elasticity/Plane=strain => 'Law' | 'user' | 'Temperature change'
Elasticity/Kinematics=full => 'Kinematics' | 'Law = user' | 'Plane = strain'
Models=coupled & Coupling/Zone=everywhere & Coupling/Scheme=blending & Elasticity/Model=correspondence & Elasticity/Kinematics=full & Elasticity/Plane=strain => 'Kinematics' | 'Models = coupled'
Elasticity/Plane=strain & Cracks/Segments=0.2,0.5 ; 0.4,0.5 => 'Contact' | 'Law = user' | 'false'
)");
  }


  TEST(SceneMistakes, of_hyperelastic_bodies)
  {
    expect_said(elastic_and({"Models=finite elements",
                             "Material/Law=hyperelastic",
                             "Elasticity/Kinematics=full",
                             "Elasticity/Solver=newton"}),
                R"(
Elasticity/Kinematics=linear => 'Law' | 'hyperelastic' | 'Kinematics = full'
Models=peridynamics => 'Law' | 'hyperelastic' | 'Models = finite elements' | 'Model = correspondence'
Models=peridynamics & Elasticity/Model=bond-based => 'Law' | 'hyperelastic' | 'Models = finite elements' | 'Model = correspondence'
Models=coupled & Coupling/Zone=everywhere => 'Law' | 'hyperelastic' | 'Models = finite elements'
Elasticity/Solver=linear => 'Kinematics' | 'linear' | 'conjugate gradients'
Material/Fracture energy=1 => 'Law' | 'hyperelastic' | 'Fracture energy'
Cracks/Segments=0.2,0.5 ; 0.5,0.5 & Cracks/Growth=2: 0, 0.1,0 => 'Law' | 'hyperelastic' | 'Growth'
Material/Thermal expansion=1e-5 & Elasticity/Temperature change=1 => 'Law' | 'hyperelastic' | 'Temperature change'
Material/Bulk modulus= & Material/Shear modulus= & Material/Young modulus=1 & Material/Poisson ratio=0.5 & Elasticity/Plane=stress => 'Poisson ratio' | 0.5 | 'Law = hyperelastic'
Material/Bulk modulus= & Material/Shear modulus= & Material/Young modulus=1 & Material/Poisson ratio=0.5 & Elasticity/Plane=strain => 'Poisson ratio' | less than 0.5
Material/Law=linear & Material/Thermal expansion=1e-5 & Elasticity/Temperature change=1 & Elasticity/Plane=strain => 'Kinematics' | 'full' | 'Temperature change'
Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Elasticity/Plane=strain => 'Kinematics' | 'Law = hyperelastic'
)");
  }


  TEST(SceneMistakes, of_correspondence)
  {
    expect_said(elastic_and({"Models=peridynamics", "Elasticity/Model=correspondence"}), R"(
Models=coupled & Coupling/Zone=everywhere => 'Scheme' | 'exchange' | 'Model = correspondence' | 'blending'
Models=coupled & Coupling/Zone=everywhere & Coupling/Scheme=blending & Material/Law=hyperelastic & Elasticity/Kinematics=full & Elasticity/Solver=newton => 'Model' | 'Models = coupled' | plastic and user | 'hyperelastic'
Models=coupled & Coupling/Zone=everywhere & Coupling/Scheme=splice & Material/Law=plastic & Material/Yield stress=1 & Elasticity/Solver=newton => 'Scheme' | 'splice' | 'Law = linear' | 'blending'
Models=coupled & Coupling/Zone=everywhere & Coupling/Scheme=blending & Peridynamics/Surface correction=fictitious nodes => 'Surface correction' | 'Model = correspondence' | 'auto'
Elasticity/Kinematics=full & Elasticity/Solver=newton => 'Model' | small displacements | 'Law = hyperelastic' | 'Kinematics = linear'
Models=coupled & Coupling/Zone=everywhere & Coupling/Scheme=blending & Material/Law=viscoelastic & Material/Relaxation=0.5, 1 & Elasticity/Plane=strain & Material/Fracture energy=1 => 'Law' | 'viscoelastic' | do not break | 'state-based'
Material/Law=formula & Material/Bond force=s & Elasticity/Solver=newton => 'Model' | 'Law = formula' | 'state-based'
Peridynamics/Surface correction=moments => 'Surface correction' | 'moments' | 'correspondence' | 'none'
Material/Law=hyperelastic & Elasticity/Kinematics=full & Elasticity/Solver=newton & Peridynamics/Operator form=lattice => 'Operator form' | 'Kinematics = full' | 'auto'
Material/Law=plastic & Material/Yield stress=1 & Elasticity/Solver=newton & Material/Fracture energy=1 => 'Law' | do not break
)");
  }


  TEST(SceneMistakes, of_orthotropic_bodies)
  {
    expect_said(elastic_and({"Models=finite elements",
                             "Material/Bulk modulus=",
                             "Material/Shear modulus=",
                             "Material/Young modulus=",
                             "Material/Poisson ratio=",
                             "Material/Young moduli=3, 1",
                             "Material/Shear moduli=1",
                             "Material/Poisson ratios=0",
                             "Elasticity/Plane=stress"}),
                R"(
Material/Young moduli= => 'Shear moduli' | 'Young moduli' | is empty
Material/Young modulus=1 => 'Young modulus' | isotropic | 'Young moduli'
Material/Young moduli=3 => 'Young moduli' | '3' | E1, E2 or E1, E2, E3
Material/Young moduli=3, t => 'Young moduli' | 't' | x, y, z
Material/Shear moduli=1, 1 => 'Shear moduli' | two
Material/Young moduli=3, -1 => 'Young moduli' | E2 | -1 | greater than 0
Material/Shear moduli= => 'Shear moduli' | G12
Material/Shear moduli=0 => 'Shear moduli' | G12 | 0 | greater than 0
Material/Poisson ratios=1.8 => 'Poisson ratios' | nu12 is 1.8 | sqrt(E1/E2) = 1.73205
Material/Young moduli=1, 1, 1 & Material/Shear moduli=1, 1, 1 & Material/Poisson ratios=0.6, 0.6, 0.6 => 'Poisson ratios' | nu12 nu13 nu23 | greater than 0
Material/Material angle=1, 2 => 'Material angle' | one angle
Elasticity/Plane=strain => 'Young moduli' | '3, 1' | E1, E2, E3
Material/Phases/Young moduli=core: 1, 2 => 'Young moduli' | no phase 'core'
Material/Law=plastic & Material/Yield stress=1 & Elasticity/Solver=newton => 'Young moduli' | 'Law = linear' | 'plastic'
Models=peridynamics & Elasticity/Model=correspondence & Material/Fracture energy=1 => 'Young moduli' | do not break
Models=peridynamics => 'Young moduli' | 'Models = finite elements'
Models=coupled & Coupling/Zone=everywhere => 'Young moduli' | 'Models = finite elements'
Material/Thermal expansion=1e-5 & Elasticity/Temperature change=1 => 'Young moduli' | 'Temperature change'
)");
  }


  TEST(SceneMistakes, of_elements_that_yield)
  {
    expect_said(elastic_and({"Models=finite elements",
                             "Material/Law=plastic",
                             "Material/Yield stress=1",
                             "Elasticity/Solver=newton"}),
                R"(
Material/Yield stress= => 'Yield stress' | is empty
Material/Yield stress=0 => 'Yield stress' | greater than 0
Material/Hardening modulus=-1 => 'Hardening modulus' | -1 | 0 or more
Material/Law=linear => 'Yield stress' | 'Law = plastic' | 'linear'
Material/Yield stress=2 - T => 'Yield stress' | depends on T | 'Temperature change'
Material/Fracture energy=1 => 'Law' | 'Fracture energy'
Elasticity/Solver=linear => 'Solver' | 'linear' | 'newton'
Models=coupled & Coupling/Zone=everywhere => 'Law' | 'coupled'
)");
  }


  TEST(SceneMistakes, of_bonds_that_break)
  {
    expect_said(elastic_and({"Models=peridynamics", "Material/Fracture energy=1"}), R"(
Models=finite elements => 'Fracture energy' | finite elements do not break | 'peridynamics'
Material/Strength seed=1 => 'Strength seed' in section 'Material' | no effect | 'Weibull modulus'
Material/Weibull modulus=0 & Material/Strength seed=1 => 'Weibull modulus' in section 'Material' | 0 | greater than 0
Material/Weibull modulus=-3 & Material/Strength seed=1 => 'Weibull modulus' in section 'Material' | -3 | greater than 0
Models=coupled & Material/Weibull modulus=10 & Material/Strength seed=1 & Coupling/Zone=follow => 'Weibull modulus' | 'Models = peridynamics' | not 'coupled'
Material/Weibull modulus=10 & Material/Strength seed=-1 => 'Strength seed' in section 'Material' | -1
Elasticity/Solver=dynamics & Elasticity/Breaking=at rest => 'Breaking' in section 'Elasticity' | bodies at rest | 'dynamics'
Elasticity/Breaking=in moton => 'Breaking' in section 'Elasticity' | 'in moton' | at rest | 'in motion'
Cracks/Segments=0.25,0.5 ; 0.75,0.5 & Cracks/Bonds through tips=in part => 'Bonds through tips' | 'in part' | 'Fracture energy'
)");
  }


  TEST(SceneMistakes, of_cracks)
  {
    expect_said({"Cracks/Segments=0.25,0.5 ; 0.75,0.5"}, R"(
Cracks/Mesh=faces & Boundary conditions/Symmetry=left => 'Symmetry' | 'Mesh = faces' | 'Mesh = pairs'
Models=coupled & Coupling/Zone=adaptive => 'Zone' | 'Coarsening' | at least 1
Models=finite elements & Coupling/Zone=adaptive & Domain/Coarsening=1 => 'Zone' | 'coupled'
Models=finite elements & Coupling/Zone=adaptive => 'Zone' | 'coupled'
Models=coupled & Coupling/Zone=adaptive & Domain/Coarsening=1 & Time/Stepper=euler & Time/Time step=1e-5 => 'Zone' | 'Time step' | auto
Models=coupled & Domain/Coarsening=3 => 'Coarsening' | 12 cells | 2 times
Domain/Coarsening=1 => 'Coarsening' | 'Models' | 'coupled'
Models=coupled & Domain/Coarsening=1 & Coupling/Scheme=splice => 'Coarsening' | 'Scheme' | 'exchange'
Cracks/Transmission=2 => 'Transmission' | from 0 to 1
Cracks/Mesh=removed & Cracks/Transmission=0.5 => 'Mesh' | 'Transmission' | 'pairs'
Cracks/Bonds through tips=in part => 'Bonds through tips' | 'in part' | 'Physics = elasticity'
Cracks/Growth=3: 0, 1,0 => 'Growth' | no end point 3 | 1 to 2
Cracks/Growth=2: 0, 1000,0 => 'Growth' | left the body
Cracks/Paths=2: 0, 0.5,0.5 | 1, 0.9,0.5 => 'Paths' | begins at (0.5, 0.5)
Cracks/Growth=2: 0, 0.1,0 & Cracks/Mesh=faces => 'Mesh' | 'pairs'
Cracks/Transmission=10000*t => 'Transmission' | from 0 to 1
Finite elements/Degree=2 => 'Degree' | pairs
)");
  }


  TEST(SceneMistakes, of_entries_together)
  {
    expect_said({}, R"(
Peridynamics/Boundary treatment=exchange & Peridynamics/Self term=paper => 'Self term' | not 'none' | 'Boundary treatment = exchange'
Peridynamics/Boundary treatment=exchange & Peridynamics/Surface correction=energy => 'Surface correction' | without finite elements | 'Boundary treatment = exchange'
Peridynamics/Boundary treatment=exchange & Peridynamics/Nodal volume=full => 'Nodal volume' | 'partial' | 'Boundary treatment = exchange'
Peridynamics/Correction direction=z => 'Correction direction' | no such direction | 'Dimension' = 2
Domain/Extra layers=2 => 'Extra layers' | 'Physics = elasticity'
Models=finite elements & Cracks/Segments=0.25,0.5 ; 0.75,0.5 & Cracks/Mesh=faces & Cracks/Contact conductance=1 & Domain/Coarsening=1 => 'Contact conductance' | 'Coarsening' | 'pairs'
Models=coupled & Cracks/Segments=0.25,0.5 ; 0.75,0.5 & Cracks/Mesh=faces & Coupling/Zone=adaptive & Domain/Coarsening=1 => 'Zone' | lie across cells | 'faces'
Models=finite elements & Domain/Coarsening=1 & Domain/Fine where=crack ends => 'Coarsening' | 'crack ends' | no crack
)");
    expect_said(elastic, R"(
Dimension=3 & Domain/Lower corner=0, 0, 0 & Domain/Upper corner=1, 1, 1 & Domain/Cells=4, 4, 4 & Output/Probes= & Boundary conditions/Displacement=left: 0, 0, 0 & Cracks/Polygons=disc: 0.5,0.5,0.5, 0,0,1, 0.2 & Cracks/Bonds through tips=in part => 'Bonds through tips' | 'Dimension = 2'
Models=coupled & Coupling/Zone=x - 0.5 & Coupling/Scheme=splice & Peridynamics/Surface correction=fictitious nodes & Boundary conditions/Symmetry=bottom => 'Surface correction' | 'Symmetry' | 'blending'
Models=finite elements & Peridynamics/Operator form=lattice => 'Operator form' | without 'Models = peridynamics' | 'auto'
Models=finite elements & Boundary conditions/Traction=right: 1, 0 & Boundary conditions/Traction layer=0.1 => 'Traction layer' | no effect without 'Models = peridynamics'
Models=finite elements & Elasticity/Contact=true => 'Contact' | no effect | 'Models = peridynamics'
)");
    expect_said(
      elastic_and({"Domain/Shape=mesh file",
                   "Domain/Mesh file=" PERIDEAL_SOURCE_DIR "/tests/data/two_materials.msh",
                   "Peridynamics/Horizon=0.3",
                   "Boundary conditions/Displacement=1: 0, 0"}),
      R"(
Cracks/Segments=0.25,0.5 ; 0.75,0.5 & Cracks/Bonds through tips=in part => 'Bonds through tips' | bodies on a lattice
Peridynamics/Surface correction=fictitious nodes => 'Surface correction' | flat sides
Models=coupled & Coupling/Zone=x - 0.5 & Coupling/Scheme=splice => 'Shape' | 'Scheme = exchange'
)");
    expect_said(elastic_and({"Elasticity/Temperature change=computed",
                             "Elasticity/Heat of deformation=true",
                             "Units/Absolute zero=-273",
                             "Material/Thermal expansion=1e-3"}),
                R"(
Material/Heat capacity=1 + T => 'Heat of deformation' | 'Heat capacity' | not depend on T
Finite elements/Capacity=consistent => 'Heat of deformation' | 'lumped'
Models=finite elements & Domain/Coarsening=1 & Domain/Fine where=x - 0.5 => 'Heat of deformation' | 'Coarsening'
)");
  }


  TEST(SceneMistakes, of_models_that_are_chosen)
  {
    const auto expect_not_chosen = [](const Overrides &further, const std::string &table) {
      for (const FaultRow &row : fault_rows(table))
        {
          SCOPED_TRACE(row.left);
          Overrides overrides = plate;
          overrides.insert(overrides.end(), further.begin(), further.end());
          for (const std::string &one : split_list(row.left + " & Models=auto", '&'))
            overrides.push_back(one);
          Scene<2> scene;
          parse_scene<2>({"a.prm", apply_overrides("set Dimension = 2\n", "a.prm", overrides)},
                         scene);
          expect_parts(message_of([&] {
                         refuse_choice(scene);
                         refuse_measure(scene);
                       }),
                       row.words);
        }
    };
    expect_not_chosen({}, R"(
Domain/Shape=plate with hole & Output/Probes= & Peridynamics/Horizon=0.3 => other than a box
Cracks/Segments=0.25,0.5 ; 0.75,0.5 & Cracks/Growth=2: 0, 0.1,0 & Peridynamics/Horizon=0.3 => grow or change
Cracks/Segments=0.25,0.5 ; 0.75,0.5 & Cracks/Transmission=0.5 => 'Transmission' of cracks | 'Contact conductance'
Output/Probes= & Accuracy/Measure=probes => 'Measure' | has no point
Accuracy/Measure=stress intensity => 'Measure' | not elasticity
)");
    expect_not_chosen(elastic, R"(
Elasticity/Solver=dynamics & Peridynamics/Horizon=0.3 => motion with cracks
Material/Critical stretch=0.1 => bonds that break
Accuracy/Measure=flow: left => 'Measure' | nothing flows
Accuracy/Measure=stress intensity => 'Measure' | has no crack
)");
  }


  TEST(SceneMistakes, of_steady_states)
  {
    expect_said({"Time/Steady=true"}, R"(
Boundary conditions/Dirichlet= => 'Steady' | not determined
Boundary conditions/Dirichlet=top: t; bottom: 0 => 'Dirichlet' | depends on t
)");
  }
} // namespace PeriDeal
