// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/decay_rate.h>
#include <perideal/analysis/exact_solid.h>
#include <perideal/problems/reference.h>

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
          context.family  = lattice_terms(lattice_family<dim>(scene.domain.spacing(),
                                                             context.horizon,
                                                             scene.peridynamics.kernel,
                                                             scene.peridynamics.kernel_exponent,
                                                             scene.peridynamics.volume_fraction,
                                                             scene.peridynamics.calibration),
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
        context.moduli = scene.material.moduli(middle);
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


  template std::unique_ptr<ExactSolution> make_reference(const Scene<1> &);
  template std::unique_ptr<ExactSolution> make_reference(const Scene<2> &);
  template std::unique_ptr<ExactSolution> make_reference(const Scene<3> &);
} // namespace PeriDeal
