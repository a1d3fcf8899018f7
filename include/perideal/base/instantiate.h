// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

/**
 * @file
 * Explicit instantiation of templates of the dimension, at the end of the source that defines them:
 * `PERIDEAL_INSTANTIATE(class Nodes);` and, of functions by their names alone,
 * `PERIDEAL_INSTANTIATE_FUNCTION(build_mesh);`. Overloads and members are listed in a macro of the
 * dimension for PERIDEAL_FOR_EACH_DIM.
 */

#define PERIDEAL_FOR_EACH_DIM(MACRO) MACRO(1) MACRO(2) MACRO(3)

#define PERIDEAL_INSTANTIATE_2_3(Class) \
  template Class<2>;                    \
  template Class<3>

#define PERIDEAL_INSTANTIATE(Class) \
  template Class<1>;                \
  PERIDEAL_INSTANTIATE_2_3(Class)

#define PERIDEAL_INSTANTIATE_FUNCTION_2_3(name) \
  template decltype(name<2>) name<2>;           \
  template decltype(name<3>) name<3>

#define PERIDEAL_INSTANTIATE_FUNCTION(name) \
  template decltype(name<1>) name<1>;       \
  PERIDEAL_INSTANTIATE_FUNCTION_2_3(name)
