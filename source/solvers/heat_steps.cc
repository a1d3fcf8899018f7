// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/heat_steps.h>

#include <cmath>

namespace PeriDeal
{
  double sum_of_held(const DiffusionOperator &op, const Vector &y, Vector &work)
  {
    work = y;
    op.clear_constrained(work);
    double sum = 0.;
    for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
      sum += y.local_element(i) - work.local_element(i);
    return sum;
  }


  HeldHeat::HeldHeat(const DiffusionOperator &op)
    : op(op)
    , needed(!op.capacity_depends_on_solution() &&
             (!op.capacity_is_diagonal() || op.depends_on_time() || !op.symmetric()))
  {
    if (needed)
      for (Vector *v : {&before, &heat, &work})
        op.initialize_vector(*v);
  }


  void HeldHeat::begin(const Vector &u)
  {
    if (needed)
      before = u;
  }


  double HeldHeat::taken(const Vector &u)
  {
    if (!needed)
      return 0.;
    op.heat_between(heat, before, u);
    return sum_of_held(op, heat, work);
  }


  void HeldHeat::exchange(Archive &archive, const NodeKeys &keys)
  {
    if (needed)
      archive.exchange("start of span", before, keys);
  }


  ConservativeStep::ConservativeStep(const DiffusionOperator &op)
    : op(op)
  {
    if (needed())
      for (Vector *v : {&heat, &work})
        op.initialize_vector(*v);
  }


  bool ConservativeStep::needed() const
  {
    return op.capacity_depends_on_solution();
  }


  double ConservativeStep::correct(const Vector &u, Vector &v)
  {
    if (!needed())
      return 0.;
    const Vector &capacity = op.lumped_capacity();
    op.heat_between(heat, u, v);
    const double held = sum_of_held(op, heat, work); // work is left with what is free
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      {
        const double change = v.local_element(i) - u.local_element(i),
                     taken = work.local_element(i), frozen = capacity.local_element(i);
        if (taken == 0. || change == 0.)
          continue;
        const double mean = taken / change, end = 2. * mean - frozen;
        v.local_element(i) -= (taken - frozen * change) / (end > 0.1 * mean ? end : mean);
      }
    return held;
  }


  std::size_t ConservativeStep::memory_consumption() const
  {
    return heat.memory_consumption() + work.memory_consumption();
  }
} // namespace PeriDeal
