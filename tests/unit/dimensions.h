// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <gtest/gtest.h>

#include <utility>

/** A test in several numbers of dimensions: what follows is its body, which has `dim`. */
#define TEST_IN_DIMENSIONS(suite, name, ...)                        \
  template <int dim>                                                \
  void suite##_##name();                                            \
                                                                    \
  template <int... dims>                                            \
  void suite##_##name##_in(std::integer_sequence<int, dims...>)     \
  {                                                                 \
    const auto run = [](auto test, const int dim) {                 \
      SCOPED_TRACE(dim);                                            \
      test();                                                       \
    };                                                              \
    (run(suite##_##name<dims>, dims), ...);                         \
  }                                                                 \
                                                                    \
  TEST(suite, name)                                                 \
  {                                                                 \
    suite##_##name##_in(std::integer_sequence<int, __VA_ARGS__>()); \
  }                                                                 \
                                                                    \
  template <int dim>                                                \
  void suite##_##name()
