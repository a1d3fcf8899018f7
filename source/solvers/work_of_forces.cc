// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/work_of_forces.h>

namespace PeriDeal
{
  WorkOfForces::WorkOfForces(ElasticOperator &op)
    : op(op)
    , held(held_unknowns(op))
  {
    for (Vector *v : {&load, &forces, &last_forces})
      op.initialize_vector(*v);
  }


  void WorkOfForces::find_active()
  {
    // What was loaded may still have a force of the last step.
    active.clear();
    for (unsigned int i = 0; i < held.size(); ++i)
      if (held[i] || load.local_element(i) != 0. || last_forces.local_element(i) != 0. ||
          forces.local_element(i) != 0.)
        active.push_back(i);
  }


  void WorkOfForces::find_load(const double t)
  {
    op.mechanical_loads(load, t);
    find_active();
  }


  void WorkOfForces::find_forces(const Vector &unbalanced)
  {
    for (const unsigned int i : active)
      forces.local_element(i) =
        load.local_element(i) - (held[i] ? unbalanced.local_element(i) : 0.);
  }


  void WorkOfForces::begin(const Vector &unbalanced, const double t)
  {
    if (!begun || op.depends_on_time())
      find_load(t);
    begun = true;
    find_forces(unbalanced);
    last_forces.swap(forces);
  }


  double WorkOfForces::step(const Vector &from,
                            const Vector &to,
                            const Vector &unbalanced,
                            const double  t)
  {
    if (op.depends_on_time())
      find_load(t);
    find_forces(unbalanced);
    double work = 0.;
    for (const unsigned int i : active)
      work += 0.5 * (forces.local_element(i) + last_forces.local_element(i)) *
              (to.local_element(i) - from.local_element(i));
    last_forces.swap(forces);
    return dealii::Utilities::MPI::sum(work, to.get_mpi_communicator());
  }


  void WorkOfForces::exchange(Archive &archive, const NodeKeys &keys)
  {
    archive.exchange("work has begun", begun);
    archive.exchange("load", load, keys);
    archive.exchange("last forces", last_forces, keys);
    if (archive.loads())
      find_active();
  }
} // namespace PeriDeal
