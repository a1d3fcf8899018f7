// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/base/types.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/gauss_rule.h>
#include <perideal/operators/solid/softening_strengths.h>
#include <perideal/operators/solid/weibull_field.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The integral of T(z(s))^2/s ds from s_0 on, with z = (s/s_0 - 1)/a. */
    double integral_over_stretches(const SofteningCurve &curve, const double a)
    {
      constexpr unsigned int n_parts = 16;
      static const GaussRule rule(5);
      const double           all = std::log1p(a * SofteningCurve::longest); // of log(s/s_0)
      double                 sum = 0.;
      for (unsigned int k = 0; k < n_parts; ++k)
        sum += rule.integrate(all * k / n_parts, all * (k + 1) / n_parts, [&](const double v) {
          const double value = curve(std::expm1(v) / a);
          return value * value;
        });
      return sum;
    }
  } // namespace


  template <int dim>
  typename SofteningStrengths<dim>::Limits SofteningStrengths<dim>::of_node(
    const CrossingEnergy &crossing,
    const double          strength,
    const double          energy)
  {
    constexpr unsigned int n_rounds = 20; // the integral goes with the logarithm of w
    // What dilatations bear fades with 1 - d, which falls much sooner than T: where it is against
    // the extensions, the largest stress is that of these; else half of it is left.
    const double left     = 0.5 * std::max(0., crossing.stress_of_dilatations);
    const double onset    = strength / (crossing.stress + left);
    const double at_onset = onset * onset * crossing.total();
    stored                = std::max(stored, at_onset / energy);
    if (at_onset >= energy)
      return {std::sqrt(energy / crossing.total()), 0.};
    const double length = crossing.extensions / crossing.over_lengths,
                 factor = 2. * onset * crossing.over_lengths;
    double opening      = (energy - at_onset) / factor;
    for (unsigned int k = 0; k < n_rounds && crossing.dilatations != 0.; ++k)
      opening = std::max(1e-3 * opening,
                         (energy - at_onset -
                          2. * onset * onset * crossing.dilatations *
                            integral_over_stretches(curve, opening / (onset * length))) /
                           factor);
    return {onset, opening};
  }


  template <int dim>
  SofteningStrengths<dim>::SofteningStrengths(const BreakableBonds<dim> &bonds)
    : curve(bonds.material.law.softening)
    , interfaces(bonds)
  {
    const Nodes<dim>                &places   = bonds.families.nodes();
    const Material                  &material = bonds.material;
    const std::size_t                n        = places.n_local();
    std::string                      message;
    Vector                           onset(places.partitioner()), opening(onset);
    std::optional<WeibullField<dim>> field;
    const auto                       value = [&](const MaterialProperty &property,
                           const std::string      &entry,
                           const Point<dim>       &p) {
      const double found = property.value(p);
      if (message.empty() && !(found > 0.))
        message = "'" + entry + "' in section 'Material' is not positive at " + place_text(p) + ".";
      return found;
    };
    if (material.scatter)
      field.emplace(places, material.scatter->modulus, material.scatter->seed);
    // Of phases, then of interfaces.
    for (unsigned int k = 0; k <= material.law.interfaces.size(); ++k)
      {
        for (unsigned int i = 0; i < places.n_owned(); ++i)
          {
            const Point<dim> &p = places.position(i);
            const double      strength =
                           (k > 0 ? *material.law.interfaces[k - 1].tensile_strength :
                                    value(*material.law.tensile_strength, "Tensile strength", p)) *
                           (field ? field->factor(p) : 1.),
                         energy = k > 0 ? material.law.interfaces[k - 1].fracture_energy :
                                          value(*material.fracture_energy, "Fracture energy", p);
            if (!message.empty())
              continue;
            const Limits found       = of_node(bonds.crossing_energy(i), strength, energy);
            onset.local_element(i)   = found.onset;
            opening.local_element(i) = found.opening;
          }
        throw_on_all_if_any(places.communicator(), message);
        onset.update_ghost_values();
        opening.update_ghost_values();
        for (unsigned int i = 0; i < n; ++i)
          nodes.push_back({onset.local_element(i), opening.local_element(i)});
        if (k == 0)
          onsets.assign(onset.begin(), onset.begin() + n);
        onset.zero_out_ghost_values();
        opening.zero_out_ghost_values();
      }
    stored = Utilities::MPI::max(stored, places.communicator());
    if (!interfaces.any())
      return;
    least = onsets;
    interfaces.lower(
      bonds.families,
      [&](const unsigned int i, const unsigned int j, int) { return limits(i, j).onset; },
      least);
    std::copy_n(least.begin(), places.n_owned(), onset.begin());
    onset.update_ghost_values();
    least.assign(onset.begin(), onset.begin() + n);
  }


  PERIDEAL_INSTANTIATE_CLASS(class SofteningStrengths);
} // namespace PeriDeal
