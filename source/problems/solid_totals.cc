// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_totals.h"

#include <perideal/laws/elasticity.h>

#include <algorithm>

#include "diffusion_totals.h"
#include "finite_results.h"
#include "heat_of_deformation.h"
#include "solid_sides.h"
#include "solid_summary.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    nlohmann::ordered_json add_energies(const SolidProblem<dim> &problem,
                                        const double             t,
                                        const RunContext        &context)
    {
      using json = nlohmann::ordered_json;
      json       balance;
      const auto add =
        [&](const std::string &key, const std::string &quantity, const double value) {
          balance[key] = value;
          context.record.add_row(problem.name(), quantity, value, t);
        };
      const auto add_all = [&](const auto &energy, const double lost) {
        balance["strain"] = energy.strain;
        balance["start"]  = energy.start;
        add("work", "work of loads and supports", energy.work);
        if (problem.op().may_release_energy())
          {
            const double by_growth  = problem.op().energy_released_by_growth(),
                         by_joining = problem.op().energy_released_by_joining();
            if (problem.op().brittle())
              add("released",
                  "energy released by broken bonds",
                  problem.op().break_history()->released);
            if (problem.op().has_growing_cracks())
              add("released by cracks", "energy released by cracks", by_growth);
            if (problem.op().zone_follows_cracks())
              add("released by joining", "energy released by nodes joining the zone", by_joining);
            add("dissipated", "energy dissipated", lost);
          }
        if (problem.op().brittle())
          {
            const auto n_broken = problem.op().n_broken_bonds();
            add("broken bonds", "broken bonds", static_cast<double>(n_broken));
            if (json &kept = context.record.extremes[problem.name()];
                n_broken > 0 && !kept.contains("first broken bonds"))
              kept["first broken bonds"] = t;
          }
        if (!problem.scene.warms_slowly()) // what warming does to the strain energy is not followed
          add("imbalance", "energy imbalance", energy.imbalance());
      };
      if (problem.stepper)
        {
          const MotionEnergy energy =
            problem.stepper->energy(problem.displacement, problem.velocity);
          add("kinetic", "kinetic energy", energy.kinetic);
          add_all(energy, energy.released);
          add("drift", "energy drift", energy.drift);
        }
      else
        {
          const LoadingEnergy energy = problem.loading->energy(problem.displacement);
          add_all(energy, energy.dissipated);
        }
      return balance;
    }
  } // namespace


  template <int dim>
  void add_solid_totals(SolidProblem<dim> &problem, const double t, const RunContext &context)
  {
    const auto row = [&](const std::string &quantity, const double value) {
      context.record.add_row(problem.name(), quantity, value, t);
    };
    const ForceBalance          balance = problem.op().forces(problem.displacement, t);
    const double                energy  = problem.op().energy(problem.displacement);
    const SymmetricTensor<2, 3> mean    = problem.mean_stress();
    require_finite(
      {{"largest displacement", problem.displacement.linfty_norm()},
       {"strain energy", energy},
       {"sum of the forces", balance.throughput()},
       {"mean stress", von_mises(mean)}},
      problem.name(),
      t,
      "Numbers beyond 1e308 came up. Check the sizes and units of loads and displacements (sections 'Boundary conditions' and 'Initial and source') and of the "
      "moduli (section 'Material').");
    row("strain energy", energy);
    for (const auto &[side, force] : balance.sides)
      for (unsigned int d = 0; d < dim; ++d)
        row("force on " + side + " in " + "xyz"[d], force[d]);
    if (!problem.scene.time.steady)
      for (const auto &[side, moved] : displacements_of_sides(problem, problem.scene))
        for (unsigned int d = 0; d < dim; ++d)
          row("displacement of " + side + " in " + "xyz"[d], moved[d]);
    if (!problem.stepper)
      problem.force_scale =
        std::max(problem.force_scale,
                 find_force_scale(problem, problem.scene, balance.throughput()));
    keep_largest_force(balance, problem.force_scale, t, context.record.extremes[problem.name()]);
    context.progress.state(text_of_largest_force(balance, problem.force_scale));
    for (unsigned int d = 0; d < dim; ++d)
      row(std::string("body force in ") + "xyz"[d], balance.body[d]);
    row("throughput", balance.throughput());
    if (!problem.stepper) // of a motion it is the rate of its momentum
      row("imbalance", balance.imbalance());
    nlohmann::ordered_json stress = nlohmann::ordered_json::object();
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = a; b < 3; ++b)
        if (b < dim || (dim == 2 && a == 2))
          {
            const std::string name = std::string(1, "xyz"[a]) + "xyz"[b];
            row("mean stress " + name, mean[a][b]);
            stress[name] = mean[a][b];
          }
    stress["von mises"]         = von_mises(mean);
    nlohmann::ordered_json ends = nlohmann::ordered_json::object();
    // Where bonds have broken cracks end elsewhere.
    const bool grown = problem.op().n_broken_bonds() > 0;
    for (const StressIntensity &end :
         grown ? std::vector<StressIntensity>() : problem.stress_intensities(t))
      {
        row("J-integral at " + end.name, end.j);
        row("stress intensity I at " + end.name, end.mode_1);
        row("stress intensity II at " + end.name, end.mode_2);
        ends[end.name] = {{"J-integral", end.j}, {"I", end.mode_1}, {"II", end.mode_2}};
        if (end.mode_3)
          {
            row("stress intensity III at " + end.name, *end.mode_3);
            ends[end.name]["III"] = *end.mode_3;
          }
        if (end.place)
          ends[end.name]["place"] = {(*end.place)[0], (*end.place)[1], (*end.place)[2]};
      }
    context.record.balances[problem.name()] = {{"boundary force", balance.sides},
                                               {"strain energy", energy},
                                               {"mean stress", stress}};
    if (problem.stepper || problem.op().may_release_energy() ||
        (problem.scene.is_loaded_slowly() && !problem.scene.warms_slowly()))
      context.record.balances[problem.name()]["energy balance"] = add_energies(problem, t, context);
    if (!problem.stepper)
      {
        context.record.balances[problem.name()]["force balance"] = {
          {"throughput", balance.throughput()},
          {"imbalance", balance.imbalance()},
          {"scale", problem.force_scale}};
        problem.force_lost = balance.imbalance();
      }
    if (!ends.empty())
      context.record.balances[problem.name()]["stress intensity"] = ends;
    if (problem.heat != nullptr)
      add_heat_totals_of_solid(*problem.heat, t, context);
    if (const auto *const heat = problem.heat_of_deformation())
      {
        row("heat of deformation since start", heat->released());
        context.record.balances[problem.name()]["heat balance"]["heat of deformation"] =
          heat->released();
      }
  }


#define PERIDEAL_INSTANTIATE(dim) \
  template void add_solid_totals(SolidProblem<dim> &, const double, const RunContext &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
