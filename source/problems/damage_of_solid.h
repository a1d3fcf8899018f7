// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>

#include <cstddef>

namespace PeriDeal
{
  template <int dim>
  class SolidProblem;

  /**
   * Tells the heat of a solid, on the same nodes, which of the solid's bonds have broken, if it has
   * any that follows. All functions are collective.
   */
  template <int dim>
  class DamageOfSolid
  {
  public:
    /** What has broken since this was called last. */
    void tell(const SolidProblem<dim> &solid);

    /** The bonds of the solid have been loaded, and the heat. */
    void exchange(Archive &archive, const SolidProblem<dim> &solid);

  private:
    std::size_t n_told   = 0;     // marks of bonds of this process
    bool        was_told = false; // when the run was resumed, of what broke in this step
  };
} // namespace PeriDeal
