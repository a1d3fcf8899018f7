// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/solid/node_limits.h>
#include <perideal/operators/solid/weibull_field.h>
#include <perideal/scene/lists.h>

#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::vector<double> scatter_factors(const BreakableBonds<dim> &bonds)
  {
    const Nodes<dim>   &nodes = bonds.families.nodes();
    std::vector<double> factors(nodes.n_local(), 1.);
    if (!bonds.material.scatter)
      return factors;
    const WeibullField<dim> field(nodes,
                                  bonds.material.scatter->modulus,
                                  bonds.material.scatter->seed);
    for (unsigned int i = 0; i < factors.size(); ++i)
      factors[i] = field.factor(nodes.position(i));
    return factors;
  }


  template <int dim>
  NodeLimits<dim>::NodeLimits(const BreakableBonds<dim> &bonds,
                              std::vector<double>        of_nodes,
                              const bool                 of_root)
    : nodes(bonds.families.nodes())
    , formula(limit_of_bonds(bonds.material))
    , entry(name_of_limit(bonds.material))
    , factors(std::move(of_nodes))
    , of_root(of_root)
    , now(factors.size(), std::numeric_limits<double>::infinity())
    , known_temperatures(bonds.temperatures)
  {
    std::string message;
    // A computed temperature is not known yet.
    if (!formula.depends_on_temperature() || !known_temperatures.empty())
      for (unsigned int i = 0; i < now.size(); ++i)
        {
          now[i] = limit(i, 0., known_temperatures);
          if (message.empty() && !(now[i] > 0.))
            message = fault_at(nodes.position(i), 0.);
        }
    else
      known_time = -1.;
    throw_on_all_if_any(nodes.communicator(), message);
  }


  template <int dim>
  std::string NodeLimits<dim>::fault_at(const Point<dim> &p, const double t) const
  {
    return "'" + entry + "' in section 'Material' is not positive at " + place_text(p) +
           (formula.depends_on_time() ? ", t = " + number_text(t) : "") + ".";
  }


  template <int dim>
  double NodeLimits<dim>::limit(const unsigned int         i,
                                const double               t,
                                const std::vector<double> &temperatures)
  {
    const double value =
      formula.value(nodes.position(i), temperatures.empty() ? 0. : temperatures[i], t);
    return factors[i] * (of_root ? std::sqrt(value) : value);
  }


  template <int dim>
  bool NodeLimits<dim>::take_time(const double t, const std::vector<double> &temperatures)
  {
    const bool follows_time        = formula.depends_on_time() && t != known_time,
               follows_temperature = formula.depends_on_temperature() &&
                                     temperatures != known_temperatures;
    if (!follows_time && !follows_temperature)
      return false;
    known_time = t;
    if (follows_temperature)
      known_temperatures = temperatures;
    for (unsigned int i = 0; i < now.size(); ++i)
      {
        now[i] = limit(i, t, temperatures);
        if (!(now[i] > 0.)) // roots of negative values are none
          report_formula_error(fault_at(nodes.position(i), t));
      }
    return true;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(scatter_factors);
  PERIDEAL_INSTANTIATE_CLASS(class NodeLimits);
} // namespace PeriDeal
