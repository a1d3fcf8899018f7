// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/dofs/dof_tools.h>

#include <perideal/problems/problem.h>

#include <nlohmann/json.hpp>

#include "guard_causes.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::string Problem<dim>::steady_name() const
  {
    return "the steady state";
  }


  template <int dim>
  std::vector<double> Problem<dim>::stops(const double, const double to) const
  {
    return {to};
  }


  template <int dim>
  std::string Problem<dim>::doing(const unsigned int, const unsigned int, const double) const
  {
    return name() + ": time stepping";
  }


  template <int dim>
  Trip Problem<dim>::watch(const double t)
  {
    return extent_of(state()).finite ?
             Trip() :
             values_not_finite(state(), n_components(), place_of_nodes(*this), field_name(), t);
  }


  template <int dim>
  Trip Problem<dim>::take_finding()
  {
    return {};
  }


  template <int dim>
  Trip Problem<dim>::watch_totals(const double) const
  {
    return {};
  }


  template <int dim>
  void Problem<dim>::explain(Trip &)
  {}


  template <int dim>
  void Problem<dim>::examine(const double)
  {}


  template <int dim>
  RecoveryIndicators Problem<dim>::indicators() const
  {
    Assert(false, dealii::ExcNotImplemented());
    return {};
  }


  template <int dim>
  void Problem<dim>::start_anew()
  {
    Assert(false, dealii::ExcNotImplemented());
  }


  template <int dim>
  void Problem<dim>::before_remesh()
  {
    Assert(false, dealii::ExcNotImplemented());
  }


  template <int dim>
  void Problem<dim>::after_remesh(const double, const bool)
  {
    Assert(false, dealii::ExcNotImplemented());
  }


  template <int dim>
  void Problem<dim>::rebuild(const double)
  {
    Assert(false, dealii::ExcNotImplemented());
  }


  template <int dim>
  void Problem<dim>::renew_stepper()
  {
    Assert(false, dealii::ExcNotImplemented());
  }


  template <int dim>
  void Problem<dim>::describe_end(nlohmann::ordered_json &, ResultRecord &) const
  {}


  template <int dim>
  void Problem<dim>::note_end(const RunContext &) const
  {}


  template <int dim>
  Vector component_of(const DoFHandler<dim> &dofs,
                      const Vector          &u,
                      const unsigned int     n,
                      const unsigned int     c)
  {
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    Vector component(dofs.locally_owned_dofs(), relevant, dofs.get_communicator());
    for (unsigned int i = 0; i < component.locally_owned_size(); ++i)
      component.local_element(i) = u.local_element(n * i + c);
    component.update_ghost_values();
    return component;
  }


#define PERIDEAL_INSTANTIATE(dim)                               \
  template class Problem<dim>;                                  \
  template Vector component_of(const dealii::DoFHandler<dim> &, \
                               const Vector &,                  \
                               const unsigned int,              \
                               const unsigned int);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
