// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/breaking_motion.h>
#include <perideal/solvers/step_tools.h>

#include <cmath>

namespace PeriDeal
{
  BreakingMotion::BreakingMotion(ElasticOperator &op)
    : op(op)
    , inverse_mass(inverse_capacity(op))
  {
    op.initialize_vector(velocity);
    op.initialize_vector(residual);
  }


  void BreakingMotion::choose_step()
  {
    constexpr double share = 0.9; // of the stable step
    step                   = share * 2. / std::sqrt(op.spectrum().sharp);
    // Bonds shall break at the same step on any number of processes.
    const double unit = std::pow(10., std::floor(std::log10(step)) - 3.);
    step              = std::floor(step / unit) * unit;
  }


  unsigned int BreakingMotion::run(Vector &u, const double t)
  {
    constexpr double       damping = 0.01; // rate times step; a wave passes a horizon in two steps
    constexpr unsigned int wait    = 60;   // steps without a break
    constexpr double       keep = (2. - damping) / (2. + damping), push = 2. / (2. + damping);
    if (step == 0.)
      choose_step();
    velocity                 = 0.;
    unsigned int       n     = 0;
    const unsigned int n_own = velocity.locally_owned_size();
    for (unsigned int quiet = 0; quiet < wait; ++n)
      {
        op.residual(residual, u, t);
        for (unsigned int i = 0; i < n_own; ++i)
          velocity.local_element(i) = keep * velocity.local_element(i) +
                                      push * step * inverse_mass[i] * residual.local_element(i);
        u.add(step, velocity);
        op.distribute(u, t);
        quiet = op.break_bonds(u, t) > 0 ? 0 : quiet + 1;
      }
    return n;
  }
} // namespace PeriDeal
