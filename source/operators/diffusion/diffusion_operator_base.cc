// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/operators/diffusion/diffusion_operator_base.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  DiffusionOperatorBase<dim>::DiffusionOperatorBase(const BodyParameters<dim>           &body,
                                                    const double                         start,
                                                    const Layout                        &layout,
                                                    const std::function<void(Vector &)> &fill_noise)
    : body(body)
    , history(body.crack_history())
    , cracks_of(history.representative(start))
    , bounds(*this, fill_noise)
  {
    if (layout)
      set_layout(layout);
  }


  template <int dim>
  void DiffusionOperatorBase<dim>::set_layout(const Layout &of_vectors)
  {
    layout = of_vectors;
    initialize_vector(capacity);
    initialize_vector(stiffness_diagonal);
  }


  template <int dim>
  void DiffusionOperatorBase<dim>::apply_capacity(Vector &y, const Vector &x) const
  {
    y = x;
    y.scale(capacity);
  }


  template <int dim>
  bool DiffusionOperatorBase<dim>::update(const double t)
  {
    const auto change = history.change(cracks_of, t);
    if (!change)
      return false;
    cracks_of = change->to;
    return apply_change(*change);
  }


  template <int dim>
  bool DiffusionOperatorBase<dim>::follow(ChangeSet<dim> change)
  {
    change.from = change.to = cracks_of;
    return apply_change(change);
  }


  template <int dim>
  Balance DiffusionOperatorBase<dim>::balance(const Vector &u,
                                              const double  t,
                                              const bool    steady) const
  {
    const MPI_Comm communicator = layout->get_mpi_communicator();
    Balance        balance;
    body.boundary_conditions.for_each(
      [&](const auto &, const auto &condition) { balance.sides[condition.name]; });
    balance.cracks.assign(body.cracks.cracks.size(), 0.);
    Vector heat(layout);
    find_flows(balance, heat, u, t);
    this->clear_constrained(heat);
    if (!steady)
      for (unsigned int i = 0; i < heat.locally_owned_size(); ++i)
        balance.stored -= heat.local_element(i);
    for (auto &[name, value] : balance.sides)
      value = Utilities::MPI::sum(value, communicator);
    for (double *value : {&balance.sources, &balance.stored, &balance.content})
      *value = Utilities::MPI::sum(*value, communicator);
    for (double &value : balance.cracks)
      value = Utilities::MPI::sum(value, communicator);
    return balance;
  }


  template <int dim>
  std::string DiffusionOperatorBase<dim>::place_of(const unsigned int local_index) const
  {
    return place_text(position(local_index));
  }


  template <int dim>
  OperatorSize DiffusionOperatorBase<dim>::size() const
  {
    OperatorSize size;
    size.unknowns = layout->size();
    size.memory   = capacity.memory_consumption() + stiffness_diagonal.memory_consumption();
    return size;
  }


  PERIDEAL_INSTANTIATE_CLASS(class DiffusionOperatorBase);
} // namespace PeriDeal
