// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/elasticity_control.h>

namespace PeriDeal
{
  ElasticityControl::ElasticityControl()
    : SceneSection("Elasticity")
  {
    declare(
      "Model",
      EntryType::choice,
      "state-based",
      "",
      "Peridynamic solid: state-based (linear peridynamic solid, any Poisson ratio), or bond-based (prototype microelastic, whose "
      "Poisson ratio is 1/4, in plane stress 1/3; its stiffness against equal strains in all directions is that of the moduli).",
      {"state-based", "bond-based"});
    declare("Plane",
            EntryType::choice,
            "stress",
            "",
            "Two dimensions only: no stress, or no strain, out of the plane.",
            {"stress", "strain"});
    declare(
      "Kinematics",
      EntryType::choice,
      "linear",
      "",
      "Strains of small displacements, or of the deformed body with whatever rotations (`full`).",
      {"linear", "full"});
    declare(
      "Temperature change",
      EntryType::formula,
      "0",
      "temperature",
      "Temperature above that of the unstrained body, a number or a formula of x, y, z; it strains the body by "
      "`Thermal expansion` in section `Material` times this.");
    declare(
      "Solver",
      EntryType::choice,
      "linear",
      "",
      "Equilibrium by the linear system, by nonlinear conjugate gradients, or by dynamic relaxation with given or adaptive damping; or "
      "`dynamics`, the motion until `End time`. Where loads depend on t there is an equilibrium at each `Time step` (section `Time`), else one.",
      {"linear",
       "conjugate gradients",
       "dynamic relaxation",
       "adaptive dynamic relaxation",
       "dynamics"});
    declare(
      "Preconditioner",
      EntryType::choice,
      "multigrid",
      "",
      "Of `Solver = conjugate gradients`: multigrid on springs between nearest neighbours, or none as published (Le 2014).",
      {"multigrid", "none"});
    parse();
  }


  bool ElasticityControl::is_static() const
  {
    return solver != ElasticSolver::dynamics;
  }


  const std::string &ElasticityControl::solver_name() const
  {
    return choice_name("Solver");
  }


  void ElasticityControl::parse(const Physics physics, const unsigned int dim)
  {
    model              = choice<ElasticModel>("Model");
    plane              = choice<PlaneState>("Plane");
    kinematics         = choice<Kinematics>("Kinematics");
    solver             = choice<ElasticSolver>("Solver");
    multigrid          = choice_name("Preconditioner") == "multigrid";
    temperature_change = Expression(text("Temperature change"), where("Temperature change"));
    if (physics != Physics::elasticity)
      for (const Entry &entry : entries())
        if (is_given(entry.name))
          error(entry.name,
                "is for 'Physics = elasticity'; 'Physics' is '" + names_of(physics).physics + "'.");
    if (temperature_change.depends_on_time())
      error("Temperature change",
            "'" + temperature_change.text() + "' depends on t; known variables here: x, y, z.");
    if (dim != 2 && is_given("Plane"))
      error("Plane",
            "found '" + text("Plane") + "', but 'Dimension' is " + std::to_string(dim) +
              (dim == 1 ? ": a bar has no plane." : ": a body in space has no plane.") +
              " Leave the entry out.");
    if (is_given("Preconditioner") && solver != ElasticSolver::conjugate_gradients)
      error("Preconditioner",
            "is for 'Solver = conjugate gradients'; 'Solver' is '" + solver_name() + "'.");
    if (kinematics == Kinematics::full && solver == ElasticSolver::linear)
      error(
        "Kinematics",
        "'full' is not linear in the displacement, but 'Solver' is 'linear'. Use 'conjugate gradients' or another solver.");
  }
} // namespace PeriDeal
