// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/decay_rate.h>
#include <perideal/analysis/exact_solid.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/grading.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>
#include <perideal/solvers/motion_stepper.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

#include "problem_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::unique_ptr<ExactSolution> of_diffusion(const Scene<dim> &scene)
    {
      ExactSolutionContext context;
      context.dim = dim;
      context.lower.resize(dim);
      context.upper.resize(dim);
      for (unsigned int d = 0; d < dim; ++d)
        {
          context.lower[d] = scene.domain.lower[d];
          context.upper[d] = scene.domain.upper[d];
        }
      const Point<dim> middle =
        scene.domain.lower + 0.5 * (scene.domain.upper - scene.domain.lower);
      context.conductivity = scene.material.conductivity.value(middle);
      context.storage      = scene.material.storage(middle);
      context.kernel       = scene.peridynamics.kernel;
      context.exponent     = scene.peridynamics.kernel_exponent;
      if (scene.domain.has_lattice())
        {
          context.horizon = scene.horizon();
          context.family =
            lattice_terms(lattice_family<dim>(scene.domain.spacing(),
                                              context.horizon,
                                              scene.peridynamics.kernel,
                                              scene.peridynamics.kernel_exponent,
                                              scene.peridynamics.sampling.volume_fraction,
                                              scene.peridynamics.sampling.calibration),
                          scene.domain.spacing(),
                          context.conductivity);
        }
      if (scene.domain.shape != Shape::box)
        context.no_named = "is the solution in a box, but 'Shape' in section 'Domain' is another.";
      else if (!scene.material.conductivity.is_constant() ||
               !scene.material.density.is_constant() || !scene.material.heat_capacity.is_constant())
        context.no_named = "holds for a uniform material only (section 'Material').";
      return make_exact_solution(scene.reference.solution, context);
    }


    template <int dim>
    std::unique_ptr<ExactSolution> of_solid(const Scene<dim> &scene)
    {
      const Domain<dim> &domain = scene.domain;
      const bool         layers = domain.has_extra_layers();
      const Point<dim>   lower  = layers ? domain.extra.body_lower : domain.lower,
                       upper    = layers ? domain.extra.body_upper : domain.upper;
      const Point<dim>  middle  = lower + 0.5 * (upper - lower);
      ExactSolidContext context;
      context.dim = dim;
      context.lower.resize(dim);
      context.upper.resize(dim);
      for (unsigned int d = 0; d < dim; ++d)
        {
          context.lower[d] = lower[d];
          context.upper[d] = upper[d];
        }
      context.plane      = scene.elasticity.plane;
      context.has_cracks = !scene.cracks.cracks.empty();
      context.has_holes  = domain.shape == Shape::plate_with_hole;
      if (scene.material.uniform_moduli())
        context.moduli = scene.moduli(middle);
      if (scene.material.density.is_constant())
        context.density = scene.material.density.value(middle);
      if constexpr (dim == 2)
        {
          if (domain.shape == Shape::plate_with_hole && domain.holes.has_one &&
              domain.holes.listed.empty() && domain.holes.shape == HoleShape::circle)
            context.hole = {domain.holes.center[0], domain.holes.center[1], domain.holes.radius};
          else if (domain.holes.listed.size() == 1 && !domain.holes.has_one &&
                   domain.holes.listed[0].radius > 0.)
            context.hole = {domain.holes.listed[0].center[0],
                            domain.holes.listed[0].center[1],
                            domain.holes.listed[0].radius};
          const auto is_inside = [&](const Point<dim> &p) {
            return (p - lower)[0] > 0. && (p - lower)[1] > 0. && (upper - p)[0] > 0. &&
                   (upper - p)[1] > 0.;
          };
          const auto pieces = scene.cracks.pieces(0.);
          if (pieces.size() == 1 && pieces[0].corners.size() == 2 && !scene.cracks.change())
            {
              const Point<dim> &a = pieces[0].corners[0], &b = pieces[0].corners[1];
              context.crack         = {a[0], a[1], b[0], b[1]};
              context.begins_inside = is_inside(a);
              context.ends_inside   = is_inside(b);
            }
        }
      if (!domain.has_lattice() || domain.shape == Shape::image)
        context.no_named = "is the solution in a box, but 'Shape' in section 'Domain' is another.";
      else if (!scene.material.uniform_moduli() || !scene.material.density.is_constant())
        context.no_named = "holds for a uniform material only (section 'Material').";
      return make_exact_solid(scene.reference.solution, context);
    }
  } // namespace


  template <int dim>
  std::unique_ptr<ExactSolution> make_reference(const Scene<dim> &scene)
  {
    if (scene.reference.solution.empty())
      return nullptr;
    return scene.general.physics == Physics::elasticity ? of_solid(scene) : of_diffusion(scene);
  }


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
      refuse_grading(scene);
    });
  }


  template <int dim>
  void set_problem_factory(const Physics physics, std::unique_ptr<ProblemFactory<dim>> factory)
  {
    factories<dim>()[physics] = std::move(factory);
  }


  template <int dim>
  void note_growth(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    if (scene.cracks.tips.empty())
      return;
    const CrackHistory<dim> history = scene.crack_history();
    const double            leaps =
      scene.domain.has_lattice() ?
                   history.longest_advance() / scene.domain.spacing().norm() * std::sqrt(dim) :
                   0.;
    notes.push_back(
      "the cracks grow in " + std::to_string(history.events().size()) +
      " events, between which no tip advances more than " + number_text(history.longest_advance()) +
      (leaps > 1.5 ? ", a leap over " + rounded_text(leaps) + " nodes at once" : "") +
      "; bonds are cut too early or too late by at most the time that it needs for half of that ('Growth step' in section "
      "'Cracks').");
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


#define PERIDEAL_TEMPLATES(dim) \
  template const ProblemFactory<dim> &problem_factory<dim>(const Physics);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES


  PERIDEAL_INSTANTIATE_FUNCTION(make_reference);
  PERIDEAL_INSTANTIATE_FUNCTION(require_computable);
  PERIDEAL_INSTANTIATE_FUNCTION(set_problem_factory);
  PERIDEAL_INSTANTIATE_FUNCTION(note_growth);
  PERIDEAL_INSTANTIATE_FUNCTION(describe_physics);
} // namespace PeriDeal
