// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What is said of the places where the first bonds break.

#include <perideal/scene/lists.h>
#include <perideal/simulation/elastic_simulation.h>

#include <algorithm>
#include <sstream>

#include "result_record.h"

namespace PeriDeal
{
  namespace
  {
    /** `side 'top'`, or `sides 'bottom' (3,340) and 'top' (3,340)`. */
    std::string list_of_sides(const std::map<std::string, unsigned long long> &n_bonds)
    {
      if (n_bonds.size() == 1)
        return "side '" + n_bonds.begin()->first + "'";
      std::string text = "sides ";
      std::size_t left = n_bonds.size();
      for (const auto &[side, n] : n_bonds)
        {
          text += "'" + side + "' (" + readable_count(n) + ")";
          --left;
          text += left == 0 ? "" : left == 1 ? " and " : ", ";
        }
      return text;
    }
  } // namespace


  template <int dim>
  void ElasticSimulation<dim>::tell_first_break(const ElasticRun<dim> &model, const double t)
  {
    const BreakPlaces &places = model.op().break_places();
    auto              &kept   = record->extremes[model.name()];
    if (places.first.empty() || kept.contains("first broken bond"))
      return;
    kept["first broken bond"] = places.first;
    std::ostringstream line;
    line.precision(4);
    line << "  " << model.name() << ": the first bond broke at (";
    for (unsigned int d = 0; d < dim; ++d)
      line << (d > 0 ? ", " : "") << places.first[d];
    line << ")" << (model.stepper ? ", by t = " : " at t = ") << t;
    if (!places.beside_loads.empty())
      line << ", beside the loaded " << list_of_sides(places.beside_loads);
    progress.line(line.str());
  }


  template <int dim>
  void ElasticSimulation<dim>::note_torn_sides(const ElasticRun<dim> &model)
  {
    const auto &torn = model.op().break_places().beside_loads;
    if (torn.empty())
      return;
    unsigned long long n = 0;
    for (const auto &[side, n_bonds] : torn)
      n += n_bonds;
    record->extremes[model.name()]["broken beside loads"] = torn;
    const std::string layer    = "'Traction layer' in section 'Boundary conditions'",
                      tear_off = "They act on the outermost nodes, and tear them off: ";
    const bool  of_file        = scene.domain.shape == Shape::mesh_file;
    const auto &parts          = scene.boundary_conditions.parts;
    const bool  on_spot        = std::any_of(parts.begin(), parts.end(), [&](const Part &part) {
      return part.kind != Part::of_side && torn.count(part.name) > 0;
    });
    std::string remedy         = tear_off;
    if (on_spot)
      remedy += "spread them over a larger region, or a part of a side";
    else if (of_file)
      remedy += "move the side by 'Displacement' in their place";
    else if (scene.boundary_conditions.traction_layer > 0.)
      remedy = layer + " is too thin for them: make it deeper";
    else
      remedy += "spread them by " + layer + ", over a horizon or more";
    if (!on_spot && !of_file && scene.peridynamics.surface_correction == SurfaceCorrection::none)
      remedy +=
        ", or let families go on beyond the sides by 'Surface correction = auto' in section 'Peridynamics'";
    record->notes.push_back(
      model.name() + ": " + readable_count(n) + (n == 1 ? " bond" : " bonds") +
      " broke beside the loaded " + list_of_sides(torn) +
      " before any did elsewhere. The tractions are more than what they act on bears. " + remedy +
      ". Tractions that come suddenly may be too much all the same.");
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                \
  template void ElasticSimulation<dim>::tell_first_break(const ElasticRun<dim> &, const double); \
  template void ElasticSimulation<dim>::note_torn_sides(const ElasticRun<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
