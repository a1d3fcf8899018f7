// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/decay_rate.h>
#include <perideal/problems/reference.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::unique_ptr<ExactSolution> make_reference(const Scene<dim> &scene)
  {
    if (scene.reference.solution.empty())
      return nullptr;
    ExactSolutionContext context;
    context.dim = dim;
    context.lower.resize(dim);
    context.upper.resize(dim);
    for (unsigned int d = 0; d < dim; ++d)
      {
        context.lower[d] = scene.domain.lower[d];
        context.upper[d] = scene.domain.upper[d];
      }
    const Point<dim> middle = scene.domain.lower + 0.5 * (scene.domain.upper - scene.domain.lower);
    context.conductivity    = scene.material.conductivity.value(middle);
    context.storage         = scene.material.storage(middle);
    context.kernel          = scene.peridynamics.kernel;
    context.exponent        = scene.peridynamics.kernel_exponent;
    if (scene.domain.shape != Shape::mesh_file)
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
    else if (!scene.material.conductivity.is_constant() || !scene.material.density.is_constant() ||
             !scene.material.heat_capacity.is_constant())
      context.no_named = "holds for a uniform material only (section 'Material').";
    return make_exact_solution(scene.reference.solution, context);
  }


  template std::unique_ptr<ExactSolution> make_reference(const Scene<1> &);
  template std::unique_ptr<ExactSolution> make_reference(const Scene<2> &);
  template std::unique_ptr<ExactSolution> make_reference(const Scene<3> &);
} // namespace PeriDeal
