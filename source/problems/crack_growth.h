// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/crack_surface.h>
#include <perideal/output/crack_writer.h>
#include <perideal/problems/run_context.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  class SolidProblem;

  /**
   * The cracks that run through the breaking bonds of a solid: their surface, how far they have got
   * and how fast. All of it follows from the bonds that are broken and since when; nothing has to
   * be archived. Looks at them when asked, and only if more have broken since. All functions are
   * collective.
   */
  template <int dim>
  class CrackGrowth
  {
  public:
    /** Rows of totals.csv and what the summary says of t; none where no bonds may break. */
    void add_totals(const SolidProblem<dim> &solid, const double t, const RunContext &context);

    /** For files. */
    NewCracks surfaces(const SolidProblem<dim> &solid);

  private:
    void look_at(const SolidProblem<dim> &solid);
    void add_tips(const SolidProblem<dim> &solid,
                  const double             t,
                  const RunContext        &context,
                  nlohmann::ordered_json  &summary) const;

    std::unique_ptr<CrackSurface<dim>> surface; // null before anything has broken
    unsigned long long                 n_broken = 0;
    std::vector<CrackFacet<dim>>       facets;
    double                             area = 0., damaged_volume = 0.;
  };
} // namespace PeriDeal
