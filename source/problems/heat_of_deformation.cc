// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/diverged.h>
#include <perideal/base/instantiate.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/elasticity_control.h>
#include <perideal/scene/expression.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "solid_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** S_i at the temperatures of the heat problem. */
    template <int dim>
    std::vector<double> entropies(const SolidProblem<dim> &solid)
    {
      return solid.body.entropies_of_deformation(computed_temperature_change(solid));
    }


    /**
     * 9 K alpha^2 T0 of a node's volume: what free expansion takes up besides the capacity. 0 where
     * formulas have no value at the node, which elements need not use.
     */
    template <int dim>
    double capacity_of_expansion(const SolidProblem<dim> &solid,
                                 const double             T0,
                                 const unsigned int       i)
    {
      try
        {
          const auto  &material = solid.scene.material;
          const auto   p        = solid.position(i);
          const auto   moduli   = material.moduli(p); // of no T
          const double alpha    = material.thermal_expansion.value(p);
          const double bulk     = moduli.young() / (3. * (1. - 2. * moduli.poisson()));
          return T0 * 9. * bulk * alpha * alpha * solid.volume(i);
        }
      catch (const UserError &)
        {
          return 0.;
        }
    }


    /** What the rounds of one step need of each owned node. */
    struct HeatedNodes
    {
      Vector              start; // temperatures before any heat is released
      Vector              free;  // 1; 0 where the temperature is given or follows from others
      std::vector<double> slope; // of the heat that is missing, about, over temperature
    };


    template <int dim>
    HeatedNodes heated_nodes(const SolidProblem<dim> &solid, const double T0)
    {
      const Vector &capacity = solid.heat->op().lumped_capacity();
      HeatedNodes   nodes{solid.heat->solution, solid.heat->solution, {}};
      for (unsigned int i = 0; i < nodes.free.locally_owned_size(); ++i)
        {
          nodes.free.local_element(i) = 1.;
          // Of equilibria S grows by something between nothing and that of free expansion.
          nodes.slope.push_back(capacity.local_element(i) +
                                0.5 * capacity_of_expansion(solid, T0, i));
        }
      solid.heat->op().clear_constrained(nodes.free);
      return nodes;
    }


    template <int dim>
    [[noreturn]] void throw_no_agreement(const SolidProblem<dim> &solid,
                                         const double             T0,
                                         const double             t,
                                         const unsigned int       rounds)
    {
      const Vector &capacity = solid.heat->op().lumped_capacity();
      double        most     = 0.;
      for (unsigned int i = 0; i < capacity.locally_owned_size(); ++i)
        most = std::max(most, capacity_of_expansion(solid, T0, i) / capacity.local_element(i));
      most = Utilities::MPI::max(most, capacity.get_mpi_communicator());
      std::ostringstream message;
      message
        << "'Heat of deformation' in section 'Elasticity': temperatures and equilibrium at t = "
        << t << " do not agree after " << rounds
        << " rounds. 9 K alpha^2 T0/(rho c), which is 0.01 to 0.05 in metals and less than 1 in all materials, is "
        << most
        << " here. Check that moduli and 'Density' times 'Heat capacity' in section 'Material' have the same unit of energy, or use a smaller 'Time step' in section 'Time'.";
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      throw Diverged(message.str(), "solver", none, none, t);
    }
  } // namespace


  template <int dim>
  Vector computed_temperature_change(const SolidProblem<dim> &solid)
  {
    // Both have the nodes of the model, each with its own ghosts.
    Vector change;
    solid.op().initialize_nodal_vector(change);
    for (unsigned int i = 0; i < change.locally_owned_size(); ++i)
      change.local_element(i) =
        solid.heat->solution.local_element(i) - solid.scene.elasticity.reference_temperature;
    return change;
  }


  template <int dim>
  void HeatOfDeformation<dim>::begin(const SolidProblem<dim> &solid)
  {
    const std::vector<double> s = entropies(solid);
    const bool                fine =
      std::all_of(s.begin(), s.end(), [](const double value) { return std::isfinite(value); });
    solid.scene.elasticity.refuse(
      Utilities::MPI::min(fine ? 1 : 0, solid.dofs().get_communicator()) == 0,
      "Heat of deformation",
      "found 'true', but 3 K alpha ('Thermal expansion' and the moduli in section 'Material') is not finite everywhere: it needs a 'Poisson ratio' below 1/2.");
    solid.op().initialize_nodal_vector(counted);
    std::copy(s.begin(), s.end(), counted.begin());
  }


  template <int dim>
  void HeatOfDeformation<dim>::add(const SolidProblem<dim>     &solid,
                                   const double                 t,
                                   const std::function<void()> &renew)
  {
    constexpr unsigned int most_rounds = 100;
    DiffusionProblem<dim> &heat        = *solid.heat;
    const MPI_Comm         all         = solid.dofs().get_communicator();
    const Vector          &capacity    = heat.op().lumped_capacity();
    const double           T0          = *solid.scene.elasticity.absolute_reference;
    const double           tolerance   = std::max(10. * solid.scene.solver.tolerance, 1e-12);
    const HeatedNodes      nodes       = heated_nodes(solid, T0);
    const unsigned int     n           = nodes.slope.size();
    std::vector<double>    s;
    for (unsigned int round = 1;; ++round)
      {
        s              = entropies(solid);
        double largest = 0., scale = 0.;
        for (unsigned int i = 0; i < n; ++i)
          {
            const double c = capacity.local_element(i), before = counted.local_element(i);
            double      &T      = heat.solution.local_element(i);
            const double left   = -T0 * (s[i] - before) - c * (T - nodes.start.local_element(i)),
                         change = nodes.free.local_element(i) * left / nodes.slope[i];
            T += change;
            if (std::isfinite(change))
              largest = std::max(largest, std::abs(change));
            else
              largest = std::numeric_limits<double>::infinity();
            scale = std::max({scale, T0 * std::abs(s[i]) / c, T0 * std::abs(before) / c});
          }
        heat.op().distribute(heat.solution, t);
        largest = Utilities::MPI::max(largest, all);
        if (!(largest > std::max(tolerance * Utilities::MPI::max(scale, all), 1e-14 * T0)))
          break;
        if (round == most_rounds || !std::isfinite(largest))
          throw_no_agreement(solid, T0, t, round);
        renew();
      }
    // What has been counted is what was released, whatever the last round has left.
    double sum = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        double      &before = counted.local_element(i);
        const double now =
          nodes.free.local_element(i) > 0. ?
            before - capacity.local_element(i) / T0 *
                       (heat.solution.local_element(i) - nodes.start.local_element(i)) :
            s[i];
        sum -= T0 * (now - before);
        before = now;
      }
    set_free += Utilities::MPI::sum(sum, all);
    Vector stored(heat.solution);
    heat.op().heat_between(stored, nodes.start, heat.solution);
    heat.ledger.add(
      Utilities::MPI::sum(std::accumulate(stored.begin(), stored.begin() + n, 0.), all));
    heat.stepper->restart();
  }


  template <int dim>
  void HeatOfDeformation<dim>::exchange(Archive                 &archive,
                                        const SolidProblem<dim> &solid,
                                        const NodeKeys          &keys)
  {
    if (counted.size() == 0)
      solid.op().initialize_nodal_vector(counted);
    archive.exchange("entropies of deformation", counted, keys);
    archive.exchange("heat of deformation", set_free);
  }


  namespace
  {
    /** What has broken since there were @p n_told marks, with the places of the first nodes. */
    template <int dim>
    ChangeSet<dim> damage_since(const SolidProblem<dim> &solid, std::size_t &n_told)
    {
      const MPI_Comm          all = solid.dofs().get_communicator();
      std::vector<NodePair>   own = solid.op().broken_since(n_told);
      std::vector<Point<dim>> places; // of first nodes, each once
      std::sort(own.begin(), own.end());
      for (std::size_t k = 0; k < own.size(); ++k)
        if (k == 0 || own[k][0] != own[k - 1][0])
          places.push_back(
            solid.position(solid.dofs().locally_owned_dofs().index_within_set(own[k][0])));
      ChangeSet<dim> change;
      change.damage = true;
      for (const auto &list : Utilities::MPI::all_gather(all, own))
        change.broken.insert(change.broken.end(), list.begin(), list.end());
      for (const auto &list : Utilities::MPI::all_gather(all, places))
        for (const Point<dim> &p : list)
          change.cuts.push_back(BoundingBox<dim>({p, p}));
      std::sort(change.broken.begin(), change.broken.end());
      return change;
    }


    template <int dim>
    bool heat_follows(const SolidProblem<dim> &solid)
    {
      return solid.heat != nullptr && solid.heat->scene.broken_bonds_conduct < 1.;
    }
  } // namespace


  template <int dim>
  void DamageOfSolid<dim>::tell(const SolidProblem<dim> &solid)
  {
    if (!heat_follows(solid))
      return;
    const ChangeSet<dim> damage = damage_since(solid, n_told);
    if (!damage.broken.empty() || was_told)
      solid.heat->apply_change(damage);
    was_told = false;
  }


  template <int dim>
  void DamageOfSolid<dim>::exchange(Archive &archive, const SolidProblem<dim> &solid)
  {
    if (!heat_follows(solid))
      return;
    std::size_t n_marks = n_told;
    const bool  any     = !solid.op().broken_since(n_marks).empty();
    bool untold = was_told || Utilities::MPI::max(any ? 1 : 0, solid.dofs().get_communicator()) > 0;
    archive.exchange("damage that heat does not know", untold);
    if (!archive.loads())
      return;
    was_told                    = untold;
    n_told                      = 0;
    const ChangeSet<dim> damage = damage_since(solid, n_told);
    with_formulas(solid.dofs().get_communicator(), [&] { solid.heat->op().follow(damage); });
  }


  PERIDEAL_INSTANTIATE_CLASS(class HeatOfDeformation);
  PERIDEAL_INSTANTIATE_FUNCTION(computed_temperature_change);
  PERIDEAL_INSTANTIATE_CLASS(class DamageOfSolid);
} // namespace PeriDeal
