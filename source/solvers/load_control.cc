// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/load_control.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    // By so much bonds are stretched farther than before at an equilibrium, or less: then what they
    // have been found to bear is right in the mean.
    constexpr double span = 5e-3;
  } // namespace


  LoadControl::LoadControl(ElasticOperator &op, const double share)
    : op(op)
    , share(share)
  {
    op.initialize_vector(scaled);
    op.stepping.scales_loads = true;
  }


  void LoadControl::take_forward(Vector &u)
  {
    u /= op.stepping.load_factor;
    op.stepping.load_factor = 1.;
  }


  void LoadControl::take_back(Vector &u, const double t)
  {
    const double most = op.stretch_over_critical(u, t);
    if (most <= 1. + span)
      return;
    op.stepping.load_factor = (1. + span) / most;
    u *= op.stepping.load_factor;
    least = std::min(least, op.stepping.load_factor);
  }


  bool LoadControl::break_bonds(Vector      &u,
                                const double t,
                                const double energy,
                                const double dissipated)
  {
    largest            = std::max(largest, energy);
    const double loses = dissipated - last.dissipated;
    if (energy - last.energy + loses < 0.)
      last.going_back += loses;
    last.energy     = energy;
    last.dissipated = dissipated;
    // Those that are pressed are so at any loads; others do not change at so little.
    scaled = u;
    scaled /= 1. + 2. * span; // by round-off no bond is to be above its limit
    if (op.break_bonds(scaled, t) > 0)
      return true;
    if (op.stepping.load_factor == 1. || last.going_back >= share * largest)
      return false;
    scaled = u;
    scaled *= 1. + span;
    return op.break_bonds(scaled, t) > 0;
  }


  void LoadControl::exchange(Archive &archive)
  {
    archive.exchange("load factor", op.stepping.load_factor);
    archive.exchange("least load factor", least);
    archive.exchange("largest strain energy", largest);
    archive.exchange("energy before", last.energy);
    archive.exchange("dissipated before", last.dissipated);
    archive.exchange("dissipated going back", last.going_back);
  }
} // namespace PeriDeal
