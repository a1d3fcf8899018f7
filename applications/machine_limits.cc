// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Highway includes this file once for each instruction set; its folder must be on the include path.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "machine_limits.cc"

#include "machine_limits.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace PeriDeal
{
  namespace HWY_NAMESPACE
  {
    namespace hn = hwy::HWY_NAMESPACE;
    using D      = hn::ScalableTag<double>;
    using V      = hn::Vec<D>;

    // Keeps a value in a register without a use of it.
#define PERIDEAL_KEEP(x) asm volatile("" : "+x"(x))
#define PERIDEAL_KEEP_VECTOR(x) asm volatile("" : "+v"(x))
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
#  define PERIDEAL_HOLD(x) PERIDEAL_KEEP_VECTOR(x)
#elif HWY_ARCH_X86
#  define PERIDEAL_HOLD(x) PERIDEAL_KEEP(x)
#elif HWY_ARCH_ARM_A64
#  define PERIDEAL_HOLD(x) asm volatile("" : "+w"(x))
#else
#  define PERIDEAL_HOLD(x) asm volatile("" ::: "memory")
#endif

    /// n times 12 independent chains of multiply-adds. Returns the number of multiply-adds of
    /// doubles.
    double multiply_add(const long n)
    {
      const D d;
      V       w = hn::Set(d, 0.99), c = hn::Set(d, 0.01);
      V a0 = c, a1 = c, a2 = c, a3 = c, a4 = c, a5 = c, a6 = c, a7 = c, a8 = c, a9 = c, a10 = c,
        a11 = c;
      for (long i = 0; i < n; ++i)
        {
#define PERIDEAL_STEP(a)   \
  a = hn::MulAdd(a, w, c); \
  PERIDEAL_HOLD(a)
          PERIDEAL_STEP(a0);
          PERIDEAL_STEP(a1);
          PERIDEAL_STEP(a2);
          PERIDEAL_STEP(a3);
          PERIDEAL_STEP(a4);
          PERIDEAL_STEP(a5);
          PERIDEAL_STEP(a6);
          PERIDEAL_STEP(a7);
          PERIDEAL_STEP(a8);
          PERIDEAL_STEP(a9);
          PERIDEAL_STEP(a10);
          PERIDEAL_STEP(a11);
#undef PERIDEAL_STEP
        }
      return 12. * static_cast<double>(n) * static_cast<double>(hn::Lanes(d));
    }

    /// Read @p length doubles n times, 8 vectors at once. Returns the number of doubles read.
    double load(const double *p, const long length, const long n)
    {
      const D    d;
      const long lanes = static_cast<long>(hn::Lanes(d));
      for (long k = 0; k < n; ++k)
        for (long i = 0; i < length; i += 8 * lanes)
          {
#define PERIDEAL_LOAD(j)                   \
  {                                        \
    V v = hn::LoadU(d, p + i + j * lanes); \
    PERIDEAL_HOLD(v);                      \
  }
            PERIDEAL_LOAD(0)
            PERIDEAL_LOAD(1)
            PERIDEAL_LOAD(2)
            PERIDEAL_LOAD(3)
            PERIDEAL_LOAD(4)
            PERIDEAL_LOAD(5)
            PERIDEAL_LOAD(6)
            PERIDEAL_LOAD(7)
#undef PERIDEAL_LOAD
          }
      return static_cast<double>(n) * static_cast<double>(length);
    }

    void triad(double *a, const double *b, const double *c, const long n)
    {
      const D d;
      const V s = hn::Set(d, 3.);
      for (long i = 0; i < n; i += static_cast<long>(hn::Lanes(d)))
        hn::Store(hn::MulAdd(s, hn::Load(d, c + i), hn::Load(d, b + i)), d, a + i);
    }

    const char *name()
    {
      return hwy::TargetName(HWY_TARGET);
    }
#undef PERIDEAL_HOLD
#undef PERIDEAL_KEEP
#undef PERIDEAL_KEEP_VECTOR
  } // namespace HWY_NAMESPACE
} // namespace PeriDeal
HWY_AFTER_NAMESPACE();



#if HWY_ONCE
#  include <hwy/aligned_allocator.h>

#  include <algorithm>
#  include <chrono>

namespace PeriDeal
{
  HWY_EXPORT(multiply_add);
  HWY_EXPORT(load);
  HWY_EXPORT(triad);
  HWY_EXPORT(name);

  namespace
  {
    /** Raise a rate to the best of some trials of a piece of work that returns its amount. */
    template <typename Work>
    void improve(double &best, const unsigned int n_trials, const Work &work)
    {
      for (unsigned int k = 0; k < n_trials; ++k)
        {
          const auto   start  = std::chrono::steady_clock::now();
          const double amount = work();
          best                = std::max(
            best,
            amount /
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
    }
  } // namespace


  void measure_machine(MachineLimits &limits)
  {
    limits.target = HWY_DYNAMIC_DISPATCH(name)();
    improve(limits.fma, 20, [] { return HWY_DYNAMIC_DISPATCH(multiply_add)(1000000); });

    constexpr long length = 2048;
    const auto     small  = hwy::AllocateAligned<double>(length + 64);
    std::fill_n(small.get(), length + 64, 1.);
    improve(limits.loads, 20, [&] {
      return HWY_DYNAMIC_DISPATCH(load)(small.get(), length, 10000);
    });
    improve(limits.unaligned, 20, [&] {
      return HWY_DYNAMIC_DISPATCH(load)(small.get() + 1, length, 10000);
    });

    Triad triad;
    for (unsigned int k = 0; k < 10; ++k)
      limits.triad = std::max(limits.triad, triad.rate());
  }


  struct Triad::Arrays
  {
    static constexpr long n = 16 << 20;

    hwy::AlignedFreeUniquePtr<double[]> a = hwy::AllocateAligned<double>(n),
                                        b = hwy::AllocateAligned<double>(n),
                                        c = hwy::AllocateAligned<double>(n);
  };


  Triad::Triad()
    : arrays(std::make_unique<Arrays>())
  {
    std::fill_n(arrays->a.get(), Arrays::n, 0.);
    std::fill_n(arrays->b.get(), Arrays::n, 1.);
    std::fill_n(arrays->c.get(), Arrays::n, 2.);
  }


  Triad::~Triad() = default;


  double Triad::rate()
  {
    double best = 0.;
    improve(best, 1, [&] {
      HWY_DYNAMIC_DISPATCH(triad)(arrays->a.get(), arrays->b.get(), arrays->c.get(), Arrays::n);
      return 24. * Arrays::n;
    });
    return best;
  }
} // namespace PeriDeal
#endif
