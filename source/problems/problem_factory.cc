// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/mesh/grading.h>
#include <perideal/solvers/motion_stepper.h>

#include <nlohmann/json.hpp>

#include <map>

#include "physics_factories.h"

namespace PeriDeal
{
  namespace
  {
    template <int dim>
    using Factories = std::map<Physics, std::unique_ptr<ProblemFactory<dim>>>;


    /** One line for each physics. */
    template <int dim>
    Factories<dim> own_factories()
    {
      Factories<dim> list;
      for (const Physics physics : {Physics::heat, Physics::moisture, Physics::electricity})
        list[physics] = make_diffusion_factory<dim>();
      list[Physics::elasticity] = make_solid_factory<dim>();
      return list;
    }


    template <int dim>
    Factories<dim> &factories()
    {
      static Factories<dim> list = own_factories<dim>();
      return list;
    }
  } // namespace


  template <int dim>
  const ProblemFactory<dim> &problem_factory(const Physics physics)
  {
    const auto found = factories<dim>().find(physics);
    AssertThrow(found != factories<dim>().end(),
                UserError("'Physics = " + names_of(physics).physics +
                          "' cannot be computed with 'Dimension' " + std::to_string(dim) + "."));
    return *found->second;
  }


  template <int dim>
  void require_computable(const Scene<dim> &scene, const SceneText &text)
  {
    with_location(text, [&] {
      require_stepper(scene);
      problem_factory(scene).require_computable(scene);
      Grading<dim>::require(scene);
    });
  }


  template <int dim>
  void set_problem_factory(const Physics physics, std::unique_ptr<ProblemFactory<dim>> factory)
  {
    factories<dim>()[physics] = std::move(factory);
  }


  template <int dim>
  void describe_physics(const Scene<dim> &scene, nlohmann::ordered_json &summary)
  {
    summary["units"]          = {{"length", scene.units.length},
                                 {"time", scene.units.time},
                                 {"temperature", scene.units.temperature},
                                 {"force", scene.units.force},
                                 {"energy", scene.units.energy},
                                 {"mass", scene.units.mass},
                                 {"current", scene.units.current},
                                 {"field", scene.units.of_field(scene.general.physics)}};
    const PhysicsNames &names = names_of(scene.general.physics);
    summary["physics"]        = names.physics;
    summary["names"]          = {{"field", names.field},
                                 {"flux", names.flux},
                                 {"content", names.content},
                                 {"flow", names.flow},
                                 {"quantity", names.quantity},
                                 {"property", names.property}};
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                \
  template void                       require_computable(const Scene<dim> &, const SceneText &); \
  template const ProblemFactory<dim> &problem_factory<dim>(const Physics);                       \
  template void set_problem_factory(const Physics, std::unique_ptr<ProblemFactory<dim>>);        \
  template void describe_physics(const Scene<dim> &, nlohmann::ordered_json &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
