// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <string>

namespace PeriDeal
{
  /**
   * What `check` and the summary say of a law that is not the linear one of isotropic bodies, and
   * of where a model evaluates it; empty: it is that one.
   */
  template <int dim>
  std::string law_text(const BodyParameters<dim> &body, const ModelKind model);
} // namespace PeriDeal
