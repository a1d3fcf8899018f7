// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

/**
 * Marks a function that GCC is to compile for each instruction set; the first call picks one. What
 * it calls has to be inlined (PERIDEAL_INLINE) to be compiled so, too. Where sums must not depend
 * on the machine the file wants -ffp-contract=off.
 */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
  !defined(__SANITIZE_ADDRESS__)
#  define PERIDEAL_FOR_ALL_VECTORS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#  define PERIDEAL_FOR_ALL_VECTORS
#endif
#define PERIDEAL_INLINED __attribute__((always_inline)) // of lambdas
#define PERIDEAL_INLINE inline PERIDEAL_INLINED
