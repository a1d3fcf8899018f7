// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>

#include <map>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Where the first bonds of a body broke. */
  struct BreakPlaces
  {
    /**
     * The middle of the bond that was stretched most of all that broke first; empty: none has
     * broken.
     */
    std::vector<double> first;
    /**
     * How many bonds within a horizon of a side or part in `Traction` broke, by its name, before
     * any did elsewhere.
     */
    std::map<std::string, unsigned long long> beside_loads;
    bool                                      elsewhere = false; // some broke there, too

    /** Collective. */
    void exchange(Archive &archive);
  };


  /** Strain energy that has been released so far, other than by bonds that broke. */
  struct ReleasedEnergy
  {
    double by_growth  = 0.; // of cracks
    double by_joining = 0.; // of nodes a zone: bonds store another energy than the cells before
    double by_law     = 0.; // turned into heat, in steps that were accepted
  };


  /** What has broken of a body so far. The same on all processes. */
  struct BreakHistory
  {
    double             released = 0.; // strain energy
    unsigned long long n_broken = 0;  // bonds
    BreakPlaces        places;

    /** Collective. */
    void exchange(Archive &archive);
  };
} // namespace PeriDeal
