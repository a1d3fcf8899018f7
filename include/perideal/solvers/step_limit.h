// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/operators/solid/elastic_operator.h>

namespace PeriDeal
{
  /**
   * Watches that the steps of an explicit motion stay stable while the body deforms and breaks: the
   * limit 2/omega_max is that of the tangent, which changes with the directions and forces of the
   * bonds. Looking costs half an application where bonds are those of the deformed body, else
   * nothing; a new estimate, by Lanczos iterations, some thirty. There is one only when the largest
   * stretch has changed much, bonds have broken or cracks have grown since the last, and only as
   * long as all of them together take at most some percent of the applications, or the body has
   * stretched far since.
   */
  class StepLimit
  {
  public:
    /** How many steps to take between two looks. */
    static constexpr unsigned int between_looks = 25;

    /**
     * @param op is referred to; @param step the first one, stable for the K that it has now;
     *           @param may_change else the user has given it
     */
    StepLimit(ElasticOperator &op, const double step, const bool may_change);

    /**
     * The step to go on with from u at time t, after so many steps: smaller where the old one would
     * be above nine tenths of the limit, longer again, up to the first, once the deformation has
     * gone. Throws UserError where a given step is above the limit. K becomes the tangent at u if
     * the limit is estimated. Collective.
     */
    double follow(const Vector &u, const double t, const unsigned long long n_steps);

    /** Its last estimate, and what all have taken. Collective. */
    void exchange(Archive &archive);

    /** 0.8 of the limit: what is chosen for the user. */
    static constexpr double share = 0.8;

  private:
    double estimate(const Vector &u);

    ElasticOperator   &op;
    const double       first;
    const bool         may_change;
    double             step, stretch   = 0.; // those of the last estimate
    unsigned long long n_broken, spent = 0;
    double             next_growth; // of cracks, after the last estimate
  };
} // namespace PeriDeal
