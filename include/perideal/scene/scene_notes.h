// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  template <int dim>
  struct Scene;

  /**
   * Appends to the notes of the domain what is allowed, but rarely meant: a body in motion without
   * a density, velocities beyond that of waves, wetness that is not from 0 to 1, parts that no
   * condition names. To be called when all is parsed.
   */
  template <int dim>
  void note_doubtful_entries(Scene<dim> &scene);
} // namespace PeriDeal
