// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/progress.h>
#include <perideal/solvers/breaking_motion.h>
#include <perideal/solvers/step_tools.h>

#include <cmath>

namespace PeriDeal
{
  BreakingMotion::BreakingMotion(ElasticOperator &op, const double share)
    : op(op)
    , share(share)
    , inverse_mass(inverse_capacity(op))
  {
    op.initialize_vector(velocity);
    op.initialize_vector(residual);
  }


  void BreakingMotion::choose_step()
  {
    const double largest = op.spectrum().sharp;
    if (!(largest > 0.)) // nothing is bonded any more
      return;
    step = share * 2. / std::sqrt(largest);
    // Bonds shall break at the same step on any number of processes.
    const double unit = std::pow(10., std::floor(std::log10(step)) - 3.);
    step              = std::floor(step / unit) * unit;
  }


  double BreakingMotion::kinetic_energy() const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < inverse_mass.size(); ++i)
      if (const double v = velocity.local_element(i); v != 0.)
        sum += 0.5 * v * v / inverse_mass[i];
    return sum;
  }


  double BreakingMotion::lost() const
  {
    return dealii::Utilities::MPI::sum(damped + kinetic_energy(), velocity.get_mpi_communicator());
  }


  unsigned int BreakingMotion::run(Vector &u, const double t)
  {
    constexpr double damping    = 0.011; // rate times stable step: a wave passes a horizon in two
    constexpr unsigned int wait = 54;    // stable steps without a break
    velocity                    = 0.;
    damped                      = 0.;
    if (step == 0.)
      choose_step();
    if (step == 0.)
      return 0;
    const double       half = 0.5 * step, slows = 0.5 * damping * share; // rate times half a step
    const unsigned int n_own   = velocity.locally_owned_size();
    const unsigned int n_quiet = std::lround(wait / share);
    unsigned int       n       = 0;
    unsigned long long broken  = op.n_broken_bonds();
    op.update_contact(u);
    op.residual(residual, u, t);
    for (unsigned int quiet = 0; quiet < n_quiet; ++n)
      {
        for (unsigned int i = 0; i < n_own; ++i)
          velocity.local_element(i) = (1. - slows) * velocity.local_element(i) +
                                      half * inverse_mass[i] * residual.local_element(i);
        u.add(step, velocity);
        op.distribute(u, t);
        op.update_contact(u);
        op.residual(residual, u, t);
        for (unsigned int i = 0; i < n_own; ++i)
          velocity.local_element(i) =
            (velocity.local_element(i) + half * inverse_mass[i] * residual.local_element(i)) /
            (1. + slows);
        damped += 4. * slows * kinetic_energy();
        const bool               widened = op.widen_zone(u);
        const unsigned long long breaks  = op.break_bonds(u, t);
        quiet                            = breaks > 0 ? 0 : quiet + 1;
        if (breaks > 0)
          tell_broken_bonds(broken += breaks);
        if (quiet == 0 || widened)
          op.residual(residual, u, t);
      }
    return n;
  }
} // namespace PeriDeal
