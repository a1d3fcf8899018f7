// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  /** A term of a Prony series: a share of the shear modulus that fades with exp(-t/time). */
  struct Relaxation
  {
    double share, time;
  };
} // namespace PeriDeal
