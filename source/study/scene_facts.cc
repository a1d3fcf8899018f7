// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/study/cracked_box.h>
#include <perideal/study/scene_facts.h>

#include <nlohmann/json.hpp>

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
          require_choice(scene);
        }
      catch (const UserError &error)
        {
          return error.message();
        }
      return "";
    }


    /** Of waves along a bar, in the middle of the box. */
    template <int dim>
    double wave_speed(const Scene<dim> &scene)
    {
      const dealii::Point<dim> middle = 0.5 * (scene.domain.lower + scene.domain.upper);
      return std::sqrt(scene.material.moduli(middle).young() /
                       scene.material.density.value(middle));
    }
  } // namespace


  template <int dim>
  std::string scene_facts(const Scene<dim> &scene)
  {
    const CrackedBox box   = cracked_box(scene);
    const bool       moves = scene.deforms && scene.elasticity.solver == ElasticSolver::dynamics;
    nlohmann::ordered_json facts = {{"title", scene.general.title},
                                    {"dimension", dim},
                                    {"box", scene.domain.shape == Shape::box},
                                    {"holes", !scene.domain.holes.listed.empty()},
                                    {"lower", box.lower},
                                    {"upper", box.upper},
                                    {"cells", box.cells},
                                    {"cracks", box.cracks},
                                    {"cracks along axes", along_axes(box)},
                                    {"cracks change", scene.cracks.change()},
                                    {"cracks conduct", scene.cracks.conduct()},
                                    {"contact conductance", scene.cracks.contact_conductance},
                                    {"deforms", scene.deforms},
                                    {"moves", moves},
                                    {"steady", scene.time.steady},
                                    {"exact solution", !scene.reference.solution.empty()},
                                    {"zone by a formula", scene.coupling.zone == ZoneKind::formula},
                                    {"no choice", no_choice_for(scene)}};
    if (moves)
      facts["wave speed"] = wave_speed(scene);
    return facts.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }


  template std::string scene_facts(const Scene<1> &);
  template std::string scene_facts(const Scene<2> &);
  template std::string scene_facts(const Scene<3> &);
} // namespace PeriDeal
