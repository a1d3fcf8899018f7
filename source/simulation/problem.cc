// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/simulation/problem.h>

#include <nlohmann/json.hpp>

namespace PeriDeal
{
  template <int dim>
  std::vector<double> Problem<dim>::stops(const double, const double to) const
  {
    return {to};
  }


  template <int dim>
  bool Problem<dim>::tells_at_stops() const
  {
    return false;
  }


  template <int dim>
  std::string Problem<dim>::doing(const unsigned int, const unsigned int, const double) const
  {
    return name() + ": time stepping";
  }


  template <int dim>
  void Problem<dim>::examine(const double)
  {}


  template <int dim>
  Difference Problem<dim>::error(const ExactValue<dim> &) const
  {
    Assert(false, dealii::ExcNotImplemented());
    return {};
  }


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
  void Problem<dim>::renew_stepper()
  {
    Assert(false, dealii::ExcNotImplemented());
  }


  template <int dim>
  void Problem<dim>::describe_end(nlohmann::ordered_json &, ResultRecord &) const
  {}


  template <int dim>
  void Problem<dim>::note_end(const RunContext<dim> &) const
  {}


  template class Problem<1>;
  template class Problem<2>;
  template class Problem<3>;
} // namespace PeriDeal
