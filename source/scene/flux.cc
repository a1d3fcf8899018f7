// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/surface_transfer.h>

namespace PeriDeal
{
  TransferKind flux()
  {
    return {
      "Flux",
      "power/area",
      "Given heat fluxes, positive into the body: `side: formula of x, y, z, t`, several "
      "separated by `;`. A side named nowhere is insulated.",
      {"flux"},
      "flux",
      false,
      [](SurfaceTransfer &transfer, const std::string &) { transfer.flux = transfer.formulas[0]; }};
  }
} // namespace PeriDeal
