// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/elasticity_control.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/vector_conditions.h>

namespace PeriDeal
{
  ElasticityControl::ElasticityControl()
    : SceneSection("Elasticity")
  {
    declare(model, "Model", "state-based", {"state-based", "bond-based", "correspondence"}) =
      "Peridynamic solid: state-based (linear peridynamic solid, any Poisson ratio), bond-based (prototype microelastic, whose "
      "Poisson ratio is 1/4, in plane stress 1/3; its stiffness against equal strains in all directions is that of the moduli; see `Micromodulus`), or correspondence (nodes make a stress of their "
      "displacement gradient, by the laws of stresses that finite elements have: linear, isotropic or orthotropic, plastic, hyperelastic, and those of users; in 2 and 3 dimensions, with `Models = peridynamics`; `Horizon ratio = 2` is best).";
    declare(micromodulus, "Micromodulus", "family", {"family", "constant"}) =
      "Of `Model = bond-based`: the stiffness of a bond is divided by the sum over the family of each of its ends as it is (`family`), so that a surface costs little "
      "stiffness, or by that of a complete one, the same for all bonds (`constant`), as in the prototype microelastic brittle material of the literature, "
      "whose surfaces are soft. Inside the body both are the same.";
    declare(plane, "Plane", "stress", {"stress", "strain"}) =
      "Two dimensions only: no stress, or no strain, out of the plane.";
    declare(kinematics, "Kinematics", "linear", {"linear", "full"}) =
      "Strains of small displacements, or of the deformed body with whatever rotations (`full`): in peridynamics with `Model = state-based` or `bond-based`, in finite elements and `correspondence` with `Law = hyperelastic` and `user` (section `Material`), in finite elements with `Law = linear`, too. Loads are forces per area and volume of the undeformed body.";
    declare("Temperature change", EntryType::formula, "0", "temperature") =
      "Temperature above that of the unstrained body, a number or a formula of x, y, z; it strains the body by "
      "`Thermal expansion` in section `Material` times this. Or `computed`: each model first solves the heat problem that the scene describes, too "
      "(Conductivity, Density and Heat capacity, Initial value and Source, Dirichlet, Flux and Convection, section `Time`), and the change is its temperature "
      "less `Reference temperature`.";
    declare(reference_temperature, "Reference temperature", "0", "temperature") =
      "With `Temperature change = computed`: temperature of the unstressed body.";
    declare(broken_bonds_conduct,
            "Broken bonds conduct",
            "0",
            "1",
            Bounds{0., 1., true, "a number from 0 to 1"}) =
      "With `Temperature change = computed` that changes in time: the part of its heat that a bond still conducts once it has broken, from 0 (nothing) to 1 (as before).";
    declare("Heat of deformation", EntryType::boolean, "false") =
      "With `Temperature change = computed` that changes in time: a body that expands cools, one that is compressed warms, by the source -T0 beta d(theta)/dt of heat per volume, "
      "with theta the trace of the strain in three dimensions, beta = 3 K alpha of bulk modulus and `Thermal expansion`, and T0 = `Reference temperature` - `Absolute zero` (section `Units`). "
      "Moduli, and `Density` times `Heat capacity` (at constant strain), need the same unit of energy. Heat and equilibrium agree at each `Time step`, at each hundredth of "
      "`End time` where none is given, and where results are written.";
    declare("Contact", EntryType::choice, "auto", "", {"auto", "true", "false"}) =
      "Faces of cracks press on each other, without friction, where they close: those of section `Cracks` and those that breaking bonds have left. `auto` does so wherever it can: in "
      "peridynamics, and in `coupled` with `Scheme = exchange`, with `Kinematics = linear`; and with `Kinematics = full` in peridynamics in motion with `Stepper = verlet`, "
      "where not only faces of cracks but all nodes without a bond between them repel each other that come near, of fragments and of separate bodies. Finite elements alone do not know of it.";
    declare(solver,
            "Solver",
            "linear",
            {"linear",
             "newton",
             "conjugate gradients",
             "dynamic relaxation",
             "adaptive dynamic relaxation",
             "dynamics"}) =
      "Equilibrium by the linear system, by Newton's method (where forces are not linear in the displacement), by nonlinear conjugate gradients, or by dynamic relaxation with given or adaptive damping; or "
      "`dynamics`, the motion until `End time`. Where loads depend on t there is an equilibrium at each `Time step` (section `Time`), else one.";
    declare("Preconditioner", EntryType::choice, "multigrid", "", {"multigrid", "none"}) =
      "Of `Solver = conjugate gradients`: multigrid on springs between nearest neighbours, or none as published (Le 2014).";
    declare_breaking();
    parse();
  }


  void ElasticityControl::declare_breaking()
  {
    declare("Breaking",
            EntryType::choice,
            "auto",
            "",
            {"auto", "in motion", "at rest", "controlled"}) =
      "Of bodies at rest whose bonds break, `in motion`: once the first bonds have broken, the others break in a damped motion from equilibrium to equilibrium; or `at rest`, "
      "in one equilibrium after the other, in each those whose stretch is at least 0.9 of the largest. Then slow cracks are drawn to the rows of the lattice. "
      "`auto` is in motion; bonds that soften (`Law = softening`) do so at rest. `controlled`: where the body would give way at once (snap-back) loads and prescribed displacements go back, "
      "as in a test that is controlled by the opening of a crack; `load factor` in totals.csv multiplies all of them. For `Law = linear` and `softening`, linear kinematics, one temperature.";
    declare(dissipation_step,
            "Dissipation step",
            "0.02",
            "1",
            {0., 1., false, "a share, greater than 0 and less than 1"}) =
      "With `Breaking = controlled`: a load step ends when the whole loads of its time are borne, or, on a way back, this share of the largest strain energy so far has been dissipated.";
    declare("Crack direction", EntryType::choice, "bonds", "", {"bonds", "mean tension"}) =
      "Two dimensions only, of bodies at rest whose bonds break: where cracks of section `Cracks` go as they grow, wherever bonds are stretched too far (`bonds`), or straight across the "
      "largest tension, a mean over the bonds about the tip (`mean tension`): then of the bonds within two horizons of a crack those alone break that lie in its way. "
      "So its direction hardly depends on that of the rows of nodes.";
  }


  void ElasticityControl::parse(const Physics physics, const unsigned int dim)
  {
    computes_temperature = text("Temperature change") == "computed";
    temperature_change =
      computes_temperature ?
        Expression(0.) :
        Expression(text("Temperature change"), where("Temperature change"), "x, y, z");
    for (const Entry &entry : entries())
      refuse_unless_elastic(entry.name, physics);
    SceneSection::parse();
    contact = text("Contact") != "false" && !(has_full_kinematics() && is_static());
    refuse(is_given("Micromodulus") && model != ElasticModel::bond_based,
           "Micromodulus",
           "is for 'Model = bond-based'; 'Model' is '" + text("Model") + "'. Leave the entry out.");
    refuse(
      temperature_change.depends_on_time(),
      "Temperature change",
      "'" + temperature_change.text() +
        "' depends on t; known variables here: x, y, z. A temperature that changes in time can be 'computed'.");
    refuse(
      computes_temperature && !is_static(),
      "Temperature change",
      "'computed' is for bodies at rest, but 'Solver' is 'dynamics'. Use another solver, or a formula of x, y, z here.");
    for (const std::string entry : {"Reference temperature", "Broken bonds conduct"})
      refuse(is_given(entry) && !computes_temperature,
             entry,
             "has no effect: 'Temperature change' is '" + text("Temperature change") +
               "'. Use 'Temperature change = computed', or leave the entry out.");
    refuse(dim != 2 && is_given("Plane"),
           "Plane",
           "found '" + text("Plane") + "', but 'Dimension' is " + std::to_string(dim) +
             (dim == 1 ? ": a bar has no plane." : ": a body in space has no plane.") +
             " Leave the entry out.");
    refuse(is_given("Preconditioner") && solver != ElasticSolver::conjugate_gradients,
           "Preconditioner",
           "is for 'Solver = conjugate gradients'; 'Solver' is '" + solver_name() + "'.");
    parse_breaking(dim);
    refuse(
      contact_is_asked() && has_full_kinematics() && is_static(),
      "Contact",
      "found 'true', which with 'Kinematics = full' is for 'Solver = dynamics' only; 'Solver' is '" +
        solver_name() + "'. Leave one of them out.");
    refuse(
      has_full_kinematics() && solver == ElasticSolver::linear,
      "Kinematics",
      "'full' is not linear in the displacement, but 'Solver' is 'linear'. Use 'conjugate gradients' or another solver.");
  }


  void ElasticityControl::parse_breaking(const unsigned int dim) const
  {
    refuse(is_given("Breaking") && !is_static(),
           "Breaking",
           "is for bodies at rest; 'Solver' is 'dynamics'. Leave the entry out.");
    refuse(is_given("Dissipation step") && !controls_loads(),
           "Dissipation step",
           "has no effect: 'Breaking' is '" + text("Breaking") +
             "'. Use 'Breaking = controlled', or leave the entry out.");
    refuse(controls_loads() &&
             (has_full_kinematics() || computes_temperature || !is_zero(temperature_change)),
           "Breaking",
           std::string(
             "'controlled' is for bodies whose displacements are in proportion to the loads; ") +
             (has_full_kinematics() ?
                "'Kinematics' is 'full'. Use 'linear', or" :
                "those of a 'Temperature change' are not. Leave it out, or use") +
             " 'at rest' or 'in motion' here.");
    refuse(is_given("Crack direction") && !is_static(),
           "Crack direction",
           "is for bodies at rest; 'Solver' is 'dynamics'. Leave the entry out.");
    refuse(text("Crack direction") == "mean tension" && dim != 2,
           "Crack direction",
           "found 'mean tension', which is for 'Dimension = 2'. Leave the entry out.");
  }


  void ElasticityControl::take_absolute_zero(const Units &units)
  {
    const std::string entry = "Heat of deformation";
    absolute_reference.reset();
    if (text(entry) != "true")
      return;
    refuse(
      !computes_temperature,
      entry,
      "found 'true', but 'Temperature change' is '" + text("Temperature change") +
        "', which nothing warms. Use 'Temperature change = computed', or leave the entry out.");
    refuse(
      !units.knows_absolute_zero(),
      entry,
      "found 'true', which needs 'Absolute zero' in section 'Units': 0 where the temperatures of the scene are in kelvins, -273.15 in degrees Celsius.");
    const double zero  = units.absolute_zero();
    absolute_reference = reference_temperature - zero;
    units.refuse(
      !(*absolute_reference > 0.),
      "Absolute zero",
      "is " + number_text(zero) + ", but 'Reference temperature' in section 'Elasticity' is " +
        text("Reference temperature") +
        ", not above it: their difference is the absolute temperature of the unstressed body, which 'Heat of deformation' multiplies.");
  }
} // namespace PeriDeal
