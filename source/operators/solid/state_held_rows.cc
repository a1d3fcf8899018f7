// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Rows between cell centers that follow others (HeldRows).

#include <perideal/operators/solid/state_operator.h>

namespace PeriDeal
{
  template <int dim>
  void StateOperator<dim>::distribute(Vector &u, const double t) const
  {
    conditions->distribute(u, t);
    held_rows->follow(u);
  }


  template <int dim>
  const Vector &StateOperator<dim>::with_rows(const Vector &x) const
  {
    if (!held_rows->any())
      return x;
    completed = x;
    conditions->mask(completed);
    held_rows->follow(completed);
    return completed;
  }


  template <int dim>
  void StateOperator<dim>::apply(Vector &y, const Vector &x) const
  {
    ++this->applications;
    const Vector &all = with_rows(x);
    multiply(y, all);
    contact->add_tangent(y, all);
    held_rows->pass_on(y);
    conditions->mask(y);
  }


  template <int dim>
  void StateOperator<dim>::residual(Vector &r, const Vector &u, const double t) const
  {
    if (held_rows->any())
      {
        // Solvers have moved what is free since u was distributed.
        completed = u;
        distribute(completed, t);
      }
    SolidOperator<dim>::residual(r, held_rows->any() ? completed : u, t);
  }


  template <int dim>
  void StateOperator<dim>::unbalanced(Vector &r, const Vector &u, const double t) const
  {
    SolidOperator<dim>::unbalanced(r, u, t);
    held_rows->pass_on(r);
  }


  template <int dim>
  void StateOperator<dim>::mechanical_loads(Vector &all_loads, const double t) const
  {
    SolidOperator<dim>::mechanical_loads(all_loads, t);
    held_rows->pass_on(all_loads);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                    \
  template void          StateOperator<dim>::distribute(Vector &, const double) const;               \
  template const Vector &StateOperator<dim>::with_rows(const Vector &) const;                        \
  template void          StateOperator<dim>::apply(Vector &, const Vector &) const;                  \
  template void          StateOperator<dim>::residual(Vector &, const Vector &, const double) const; \
  template void StateOperator<dim>::unbalanced(Vector &, const Vector &, const double) const;        \
  template void StateOperator<dim>::mechanical_loads(Vector &, const double) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
