// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/rules.h>
#include <perideal/solvers/stepper.h>
#include <perideal/study/cracked_box.h>
#include <perideal/study/scene_facts.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "attempts.h"

namespace PeriDeal
{
  namespace
  {
    /** What keeps `Models = auto` from choosing for a scene, or nothing. */
    template <int dim>
    std::string no_choice_for(const Scene<dim> &scene)
    {
      try
        {
          refuse_choice(scene);
        }
      catch (const UserError &error)
        {
          return error.message();
        }
      return "";
    }


    std::string name_of(const KernelShape kernel)
    {
      return kernel == KernelShape::constant ? "constant" :
             kernel == KernelShape::conical  ? "conical" :
                                               "gaussian";
    }


    std::string name_of(const VolumeFraction fraction)
    {
      return fraction == VolumeFraction::none   ? "none" :
             fraction == VolumeFraction::linear ? "linear" :
                                                  "exact";
    }


    /** The body is a box of equal cells, without layers beyond it. */
    template <int dim>
    bool has_plain_lattice(const Scene<dim> &scene)
    {
      return scene.domain.is_box() && !scene.domain.has_extra_layers();
    }


    /** What bonds have, whether or not there are any. */
    template <int dim>
    nlohmann::ordered_json facts_of_bonds(const Scene<dim> &scene)
    {
      const auto &bonds = scene.peridynamics;
      double      ratio = bonds.horizon_ratio;
      if (has_plain_lattice(scene) && bonds.horizon > 0.)
        {
          const auto h = scene.domain.spacing();
          ratio        = scene.horizon() / *std::min_element(h.begin_raw(), h.end_raw());
        }
      return {{"kernel", name_of(bonds.kernel)},
              {"kernel exponent", bonds.kernel_exponent},
              {"volume fraction", name_of(bonds.sampling.volume_fraction)},
              {"calibration",
               bonds.sampling.calibration == Calibration::analytic  ? "analytic" :
               bonds.sampling.calibration == Calibration::isotropic ? "isotropic" :
                                                                      "discrete"},
              {"m", ratio},
              {"break", scene.material.breaks()}};
    }


    /** Of waves along a bar, in the middle of the box. */
    template <int dim>
    double wave_speed(const Scene<dim> &scene)
    {
      const dealii::Point<dim> middle = 0.5 * (scene.domain.lower + scene.domain.upper);
      return std::sqrt(scene.moduli(middle).young() / scene.material.density.value(middle));
    }
  } // namespace


  template <int dim>
  std::string scene_facts(const Scene<dim> &scene)
  {
    const CrackedBox box   = cracked_box(scene);
    const bool       moves = scene.deforms && scene.elasticity.solver == ElasticSolver::dynamics;
    std::vector<std::string> models;
    for (const ModelKind model : scene.general.models)
      models.push_back(to_string(model));
    nlohmann::ordered_json facts = {
      {"title", scene.general.title},
      {"dimension", dim},
      {"models", models},
      {"box", scene.domain.shape == Shape::box},
      {"lattice", has_plain_lattice(scene)},
      {"mesh file", scene.domain.shape == Shape::mesh_file},
      {"refinements", scene.domain.coarsening.refinements},
      {"horizon", scene.peridynamics.horizon},
      {"holes", !scene.domain.holes.listed.empty()},
      {"lower", box.lower},
      {"upper", box.upper},
      {"cells", box.cells},
      {"coarsening", scene.domain.coarsening.times},
      {"nodes", scene.domain.has_nodes_at_centers() ? "cell centers" : "vertices"},
      {"cracks", box.cracks},
      {"cracks along axes", along_axes(box)},
      {"cracks change", scene.cracks.change()},
      {"cracks conduct", scene.cracks.conduct()},
      {"contact conductance", scene.cracks.contact_conductance},
      {"deforms", scene.deforms},
      {"moves", moves},
      {"steady", scene.time.steady},
      {"explicit steppers", explicit_stepper_names()},
      {"depends on the solution", scene.material.depends_on_temperature()},
      {"lumped", !scene.finite_elements.consistent_capacity},
      {"bonds", facts_of_bonds(scene)},
      {"exact solution", !scene.reference.solution.empty()},
      {"zone by a formula", scene.coupling.zone == ZoneKind::formula},
      {"no choice", no_choice_for(scene)}};
    if (moves)
      facts["wave speed"] = wave_speed(scene);
    return facts.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }


  PERIDEAL_INSTANTIATE_FUNCTION(scene_facts);
} // namespace PeriDeal
