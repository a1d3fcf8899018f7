// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/surface_transfer.h>

namespace PeriDeal
{
  TransferKind convection()
  {
    return {
      "Convection",
      "power/(area temperature), temperature",
      "`side: coefficient, ambient temperature`, several separated by `;`: the flux "
      "coefficient x (ambient - T) enters. The coefficient may depend on x, y, z, the ambient temperature on t, too. "
      "Adds to a Flux on the same side.",
      {"coefficient", "ambient value"},
      "convection",
      true,
      [](SurfaceTransfer &transfer, const std::string &) {
        transfer.coefficient = transfer.formulas[0];
        transfer.ambient     = transfer.formulas[1];
      }};
  }
} // namespace PeriDeal
