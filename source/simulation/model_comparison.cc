// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "model_comparison.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <perideal/analysis/comparison.h>
#include <perideal/base/instantiate.h>
#include <perideal/scene/scene.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    const Problem<dim> *find(const std::vector<const Problem<dim> *> &problems,
                             const ModelKind                          kind)
    {
      for (const Problem<dim> *problem : problems)
        if (problem->name() == to_string(kind))
          return problem;
      return nullptr;
    }


    /** A component of one problem, and the other's interpolant at the same nodes. Collective. */
    template <int dim>
    std::pair<Vector, Vector> at_nodes_of(const Problem<dim> &one,
                                          const Problem<dim> &other,
                                          const unsigned int  c)
    {
      const Vector of_other = component_of(other.dofs(), other.state(), other.n_components(), c);
      Vector       of_one   = component_of(one.dofs(), one.state(), one.n_components(), c);
      Vector       interpolant(of_one.get_partitioner());
      interpolate_to(other.dofs(), of_other, one.dofs(), interpolant);
      return {std::move(of_one), std::move(interpolant)};
    }


    /** What compare_models() appends of one pair of models. */
    template <int dim>
    void compare_two(const Problem<dim> &one,
                     const Problem<dim> &other,
                     const Domain<dim>  &domain,
                     const double        t,
                     ResultRecord::json &entries)
    {
      const unsigned int  n = one.state().locally_owned_size() / one.n_components();
      std::vector<double> squares(n);
      double              square = 0., reference = 0., largest = 0.;
      for (unsigned int c = 0; c < one.n_components(); ++c)
        {
          const auto [of_one, interpolant] = at_nodes_of(one, other, c);
          for (unsigned int i = 0; i < n; ++i)
            {
              if (domain.has_extra_layers() && !domain.shows(one.position(i)))
                continue;
              const double value      = interpolant.local_element(i),
                           difference = of_one.local_element(i) - value, v = one.volume(i);
              squares[i] += difference * difference;
              square += v * difference * difference;
              reference += v * value * value;
            }
        }
      for (const double s : squares)
        largest = std::max(largest, std::sqrt(s));
      const MPI_Comm communicator = one.dofs().get_communicator();
      square                      = Utilities::MPI::sum(square, communicator);
      reference                   = Utilities::MPI::sum(reference, communicator);
      entries["relative l2"].push_back(
        {t, std::sqrt(reference > 0. ? square / reference : square)});
      entries["maximum"].push_back({t, Utilities::MPI::max(largest, communicator)});
    }
  } // namespace


  template <int dim>
  void compare_models(const std::vector<const Problem<dim> *> &problems,
                      const Domain<dim>                       &domain,
                      const double                             t,
                      ResultRecord                            &record)
  {
    const Problem<dim> *fem     = find(problems, ModelKind::finite_elements),
                       *pd      = find(problems, ModelKind::peridynamics),
                       *coupled = find(problems, ModelKind::coupled);
    if (fem != nullptr && pd != nullptr)
      compare_two(*pd, *fem, domain, t, record.comparison);
    for (const Problem<dim> *other : {fem, pd})
      if (coupled != nullptr && other != nullptr)
        compare_two(*coupled,
                    *other,
                    domain,
                    t,
                    record.comparisons[coupled->name() + " minus " + other->name()]);
  }


  template <int dim>
  std::vector<Vector> difference_of_models(const std::vector<const Problem<dim> *> &problems)
  {
    const Problem<dim> *fem = find(problems, ModelKind::finite_elements),
                       *pd  = find(problems, ModelKind::peridynamics);
    std::vector<Vector> difference;
    if (fem != nullptr && pd != nullptr)
      for (unsigned int c = 0; c < pd->n_components(); ++c)
        {
          auto [of_pd, interpolant] = at_nodes_of(*pd, *fem, c);
          of_pd.add(-1., interpolant);
          of_pd.update_ghost_values();
          difference.push_back(std::move(of_pd));
        }
    return difference;
  }


  template <int dim>
  bool shows_difference(const Problem<dim> &problem)
  {
    return problem.columns().size() == 1;
  }


  template <int dim>
  double components_written(const Problem<dim> &problem, const std::size_t n_problems)
  {
    double n = shows_difference(problem) && n_problems > 1 &&
                   problem.name() == to_string(ModelKind::peridynamics) ?
                 1. :
                 0.;
    for (const OutputField &field : problem.fields(0.))
      n += field.components.size();
    return n;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(compare_models);
  PERIDEAL_INSTANTIATE_FUNCTION(difference_of_models);
  PERIDEAL_INSTANTIATE_FUNCTION(shows_difference);
  PERIDEAL_INSTANTIATE_FUNCTION(components_written);
} // namespace PeriDeal
