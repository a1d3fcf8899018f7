// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/exact_solution.h>
#include <perideal/scene/scene.h>

#include <memory>

namespace PeriDeal
{
  /** The solution that a scene knows (section `Reference`), or nullptr. Throws UserError. */
  template <int dim>
  std::unique_ptr<ExactSolution> make_reference(const Scene<dim> &scene);
} // namespace PeriDeal
