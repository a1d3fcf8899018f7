// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/problem_factory.h>

namespace PeriDeal
{
  /** Of heat, moisture and electricity. */
  template <int dim>
  std::unique_ptr<ProblemFactory<dim>> make_diffusion_factory();

  /** Of elastic bodies. */
  template <int dim>
  std::unique_ptr<ProblemFactory<dim>> make_solid_factory();

  /** Of cracks that grow, and entries that have no effect, in diffusion. */
  template <int dim>
  void note_diffusion(const Scene<dim> &scene, std::vector<std::string> &notes);
} // namespace PeriDeal
