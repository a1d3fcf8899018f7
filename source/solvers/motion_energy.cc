// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/node_loops.h>
#include <perideal/solvers/motion_energy.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

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


  double WorkOfForces::counted_too_much(const Vector &from,
                                        const Vector &to,
                                        const Vector &unbalanced) const
  {
    double work = 0.;
    for (const unsigned int i : active)
      if (held[i])
        work +=
          0.5 *
          (last_forces.local_element(i) - load.local_element(i) + unbalanced.local_element(i)) *
          (to.local_element(i) - from.local_element(i));
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


  MotionAccount::MotionAccount(ElasticOperator           &op,
                               const std::vector<double> &inverse_mass,
                               const std::vector<double> &free_inverse_mass,
                               const std::vector<bool>   &held,
                               const double               c)
    : op(op)
    , inverse_mass(inverse_mass)
    , free_inverse_mass(free_inverse_mass)
    , held(held)
    , work_of_forces(op)
    , c(c)
  {}


  double MotionAccount::kinetic_energy(const Vector &v, const Nodes which) const
  {
    double sum = 0.;
    if (which == Nodes::free) // looked at while steps are taken
      sum = NodeLoops::square_over(free_inverse_mass.data(), v.begin(), held.size());
    else
      for (unsigned int i = 0; i < held.size(); ++i)
        if (which == Nodes::all || held[i])
          sum += v.local_element(i) * v.local_element(i) / inverse_mass[i];
    return 0.5 * Utilities::MPI::sum(sum, v.get_mpi_communicator());
  }


  double MotionAccount::kept_back(const double dt, const Vector &forces) const
  {
    const double factor = c * dt * dt;
    if (factor == 0.)
      return 0.;
    const double sum =
      NodeLoops::weighted_square(free_inverse_mass.data(), forces.begin(), held.size());
    return factor * Utilities::MPI::sum(sum, forces.get_mpi_communicator());
  }


  double MotionAccount::kept_back(const Vector &forces) const
  {
    return kept_back(step_now, forces);
  }


  void MotionAccount::begin(const Vector &u,
                            const Vector &v,
                            const Vector &forces,
                            const double  t,
                            const double  before)
  {
    work_of_forces.begin(forces, t);
    jumps += kept_back(forces) - before;
    if (started)
      return;
    started       = true;
    start         = kinetic_energy(v, Nodes::all) + op.energy(u);
    support_start = kinetic_energy(v, Nodes::held);
  }


  void MotionAccount::set_step(const double dt, const Vector &forces)
  {
    constexpr double same = 1e-6; // not another step, but round-off of the times
    if (std::abs(dt - step_now) > same * step_now)
      jumps += kept_back(dt, forces) - kept_back(forces);
    step_now = dt;
  }


  void MotionAccount::add_step(const Vector &from,
                               const Vector &to,
                               const Vector &forces,
                               const double  t)
  {
    const double gain = work_of_forces.step(from, to, forces, t);
    work += gain;
    effort += std::abs(gain);
    exchanged = std::max(exchanged, start + std::abs(work));
  }


  void MotionAccount::add_jump(const Vector &forces, const double t, const double before)
  {
    jumps -= before;
    work_of_forces.begin(forces, t);
    jumps += kept_back(forces);
  }


  MotionEnergy MotionAccount::energy(const Vector &u, const Vector &v, const Vector &forces) const
  {
    MotionEnergy result;
    result.kinetic  = kinetic_energy(v, Nodes::all);
    result.strain   = op.energy(u);
    result.released = op.released_energy();
    result.start    = started ? start : result.kinetic + result.strain;
    // What supports give to the nodes that they hold themselves.
    result.work      = started ? work + kinetic_energy(v, Nodes::held) - support_start : 0.;
    result.exchanged = std::max(exchanged, result.start + std::abs(result.work));
    if (started)
      result.drift = result.imbalance() - (kept_back(forces) - jumps);
    return result;
  }


  Trip MotionAccount::fault(const Vector &v, const unsigned long long n_steps)
  {
    constexpr double too_much = 30.; // steps near the stable one exchange some energy with nothing
    // A force that sets in gives a velocity before it has done any work, which it has a step later.
    constexpr unsigned int later   = 10;
    const double           kinetic = kinetic_energy(v, Nodes::free);
    if (!(kinetic > too_much * (start + effort)))
      suspected_at = never;
    else if (suspected_at == never)
      suspected_at = n_steps;
    Trip trip;
    if (!std::isfinite(kinetic))
      {
        trip.monitor = "finite values";
        trip.found   = "produced values that are not finite";
      }
    else if (suspected_at != never && n_steps >= suspected_at + later)
      {
        std::ostringstream message;
        message << "made a kinetic energy of " << kinetic
                << " where start and loads had brought in " << start + effort;
        trip.monitor = "energy";
        trip.found   = message.str();
      }
    trip.value = kinetic;
    trip.bound = too_much * (start + effort);
    return trip;
  }


  std::string MotionAccount::drift_fault(const MotionEnergy &found, const double allowed) const
  {
    // Of the energies some may be differences of larger numbers (thermal strain).
    constexpr double   round_off = 1e-10;
    const double       sizes     = found.kinetic + std::abs(found.strain) + effort;
    std::ostringstream message;
    if (!(std::abs(found.drift) <= allowed * found.exchanged + round_off * sizes))
      message << (found.drift < 0. ? "lost " : "made ") << std::abs(found.drift)
              << " of it, more than " << 100. * allowed
              << " % of what start and loads have brought in, " << found.exchanged;
    return message.str();
  }


  void MotionAccount::exchange(Archive &archive, const NodeKeys &keys)
  {
    archive.exchange("started", started);
    archive.exchange("suspected at", suspected_at);
    archive.exchange("last step", step_now);
    archive.exchange("start", start);
    archive.exchange("work", work);
    archive.exchange("effort", effort);
    archive.exchange("start of supports", support_start);
    archive.exchange("jumps", jumps);
    archive.exchange("exchanged", exchanged);
    work_of_forces.exchange(archive, keys);
  }
} // namespace PeriDeal
