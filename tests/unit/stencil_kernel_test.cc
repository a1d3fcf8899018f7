// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/bonds/stencil_kernel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace PeriDeal;

namespace
{
  using Offset = std::array<int, 3>;

  struct Stencil
  {
    std::vector<Offset> offsets;
    std::vector<double> weights;
    Offset              halo = {{0, 0, 0}};
    std::array<bool, 3> odd  = {{false, false, false}};

    void add(const Offset &offset, const double weight)
    {
      offsets.push_back(offset);
      weights.push_back(weight);
      for (unsigned int i = 0; i < 3; ++i)
        halo[i] = std::max(halo[i], offset[i]);
    }
  };

  /// Offsets with 0 < r < radius; isotropic weights depend on r alone, others are random.
  Stencil ball(const unsigned int dim,
               const double       radius,
               const bool         isotropic,
               std::mt19937      &random)
  {
    std::uniform_real_distribution<double> uniform(0.5, 1.5);
    std::map<int, double>                  by_distance;
    Stencil                                s;
    const int                              m = static_cast<int>(std::ceil(radius));
    for (int a = 0; a <= m; ++a)
      for (int b = 0; b <= (dim > 1 ? m : 0); ++b)
        for (int c = 0; c <= (dim > 2 ? m : 0); ++c)
          {
            const int r2 = a * a + b * b + c * c;
            if (r2 == 0 || r2 >= radius * radius)
              continue;
            const double w = uniform(random);
            s.add({{a, b, c}}, isotropic ? by_distance.emplace(r2, w).first->second : w);
          }
    return s;
  }

  /// A random field on n points with exactly the padding that is asked for, and no double more.
  struct Field
  {
    Field(const Offset &n, const Offset &halo, std::mt19937 &random)
      : n(n)
    {
      const std::ptrdiff_t sx = n[0] + 2 * halo[0], sy = n[1] + 2 * halo[1],
                           sz = n[2] + 2 * halo[2];
      size                    = sx * sy * sz;
      values                  = std::make_unique<double[]>(size);
      std::uniform_real_distribution<double> uniform(-1., 1.);
      for (std::size_t i = 0; i < size; ++i)
        values[i] = uniform(random);
      grid.row_stride   = sx;
      grid.plane_stride = sx * sy;
      grid.data         = values.get() + halo[0] + halo[1] * sx + halo[2] * sx * sy;
    }

    double at(const std::ptrdiff_t x, const std::ptrdiff_t y, const std::ptrdiff_t z) const
    {
      return grid.data[x + y * grid.row_stride + z * grid.plane_stride];
    }

    Offset                    n;
    std::size_t               size;
    std::unique_ptr<double[]> values;
    StencilKernel::Grid       grid;
  };

  /// The sum, bond by bond, and the sum of absolute values that its rounding is measured against.
  std::pair<long double, long double> direct_sum(const Stencil &s,
                                                 const Field   &f,
                                                 const int      x,
                                                 const int      y,
                                                 const int      z)
  {
    long double sum = 0, size = 0;
    for (std::size_t i = 0; i < s.offsets.size(); ++i)
      for (int image = 0; image < 8; ++image)
        {
          Offset o    = s.offsets[i];
          bool   skip = false;
          int    sign = 1;
          for (unsigned int k = 0; k < 3; ++k)
            {
              skip = skip || (s.odd[k] && o[k] == 0);
              if (image & (1 << k))
                {
                  skip = skip || o[k] == 0;
                  o[k] = -o[k];
                  sign = s.odd[k] ? -sign : sign;
                }
            }
          if (skip)
            continue;
          const long double term =
            sign * static_cast<long double>(s.weights[i]) * f.at(x + o[0], y + o[1], z + o[2]);
          sum += term;
          size += std::abs(term);
        }
    return {sum, size};
  }

  /// All points of the field, full rows at once, in the order x, y, z.
  std::vector<double> apply_whole(const StencilKernel &kernel, const Field &f)
  {
    std::vector<double>             out(static_cast<std::size_t>(f.n[0]) * f.n[1] * f.n[2],
                            std::numeric_limits<double>::quiet_NaN());
    std::vector<StencilKernel::Run> runs;
    for (int z = 0; z < f.n[2]; ++z)
      for (int y = 0; y < f.n[1]; ++y)
        runs.push_back({0,
                        y,
                        z,
                        static_cast<std::size_t>(f.n[0]),
                        &out[static_cast<std::size_t>(z * f.n[1] + y) * f.n[0]]});
    StencilKernel::sort_for_reuse(runs);
    kernel.apply(f.grid, runs);
    return out;
  }

  void expect_direct_sum(const Stencil &s, const Field &f, const unsigned int dim)
  {
    const StencilKernel       kernel(dim, s.offsets, s.weights, s.odd);
    const std::vector<double> out = apply_whole(kernel, f);
    EXPECT_EQ(kernel.halo(), s.halo);
    double worst = 0;
    for (int z = 0, i = 0; z < f.n[2]; ++z)
      for (int y = 0; y < f.n[1]; ++y)
        for (int x = 0; x < f.n[0]; ++x, ++i)
          {
            const auto [sum, size] = direct_sum(s, f, x, y, z);
            const double error     = static_cast<double>(std::abs(out[i] - sum) / size);
            worst                  = std::isnan(error) ? HUGE_VAL : std::max(worst, error);
          }
    EXPECT_LT(worst, 1e-13);
  }

  bool same_bits(const double *a, const double *b, const std::size_t n)
  {
    return std::memcmp(a, b, n * sizeof(double)) == 0;
  }

  /// Runs of length 1..70 from random places, one by one: same bits as in whole(), and no write
  /// beyond.
  void expect_same_row_by_row(const StencilKernel       &kernel,
                              const Field               &f,
                              const std::vector<double> &whole,
                              std::mt19937              &random)
  {
    for (int n = 1; n <= std::min(70, f.n[0]); ++n)
      for (int shift = 0; shift < 9; ++shift)
        {
          const int           x = shift < 8 ? std::min(shift, f.n[0] - n) : f.n[0] - n;
          const int           y = random() % f.n[1], z = random() % f.n[2];
          std::vector<double> buffer(n + 2 + shift, 77.);
          double             *out = buffer.data() + 1 + shift;
          kernel.row(f.grid, {x, y, z, static_cast<std::size_t>(n), out});
          EXPECT_TRUE(
            same_bits(out, &whole[static_cast<std::size_t>(z * f.n[1] + y) * f.n[0] + x], n))
            << "n = " << n << ", x = " << x;
          EXPECT_EQ(out[-1], 77.);
          EXPECT_EQ(out[n], 77.);
        }
  }

  /// The field cut into random runs, some points left out, in random order or sorted: same bits.
  void expect_same_however_cut(const StencilKernel       &kernel,
                               const Field               &f,
                               const std::vector<double> &whole,
                               const bool                 sorted,
                               std::mt19937              &random)
  {
    std::vector<double>             out(whole.size(), 77.), expected(whole.size(), 77.);
    std::vector<StencilKernel::Run> runs;
    for (int z = 0; z < f.n[2]; ++z)
      for (int y = 0; y < f.n[1]; ++y)
        for (int x = 0; x < f.n[0];)
          {
            const std::size_t n = std::min<std::size_t>(1 + random() % 70, f.n[0] - x);
            const std::size_t i = static_cast<std::size_t>(z * f.n[1] + y) * f.n[0] + x;
            if (random() % 4 != 0)
              {
                runs.push_back({x, y, z, n, &out[i]});
                std::copy_n(&whole[i], n, &expected[i]);
              }
            x += n;
          }
    std::shuffle(runs.begin(), runs.end(), random);
    if (sorted)
      StencilKernel::sort_for_reuse(runs);
    kernel.apply(f.grid, runs);
    EXPECT_TRUE(same_bits(out.data(), expected.data(), out.size()));
  }

  void check(const Stencil &s, const unsigned int dim, const Offset &n, std::mt19937 &random)
  {
    const Field         f(n, s.halo, random);
    const StencilKernel kernel(dim, s.offsets, s.weights, s.odd);
    expect_direct_sum(s, f, dim);
    const std::vector<double> whole = apply_whole(kernel, f);
    expect_same_row_by_row(kernel, f, whole, random);
    expect_same_however_cut(kernel, f, whole, true, random);
    expect_same_however_cut(kernel, f, whole, false, random);
  }
} // namespace


TEST(StencilKernel, OneDimension)
{
  std::mt19937 random(1);
  for (const int m : {1, 2, 3, 7, 16, 21})
    for (const int n : {1, 7, 71, 613})
      check(ball(1, m + 0.5, false, random), 1, {{n, 1, 1}}, random);
}


TEST(StencilKernel, TwoDimensions)
{
  std::mt19937 random(2);
  // A radius of 10 and 12.5 is beyond the filters that are kept in registers.
  for (const double radius : {1.1, 2.5, 3.5, 4.5, 5.5, 6.5, 7., 8.5, 10., 12.5})
    for (const bool isotropic : {true, false})
      check(ball(2, radius, isotropic, random), 2, {{73, 37, 1}}, random);
  check(ball(2, 7., true, random), 2, {{531, 67, 1}}, random);
  check(ball(2, 3.5, true, random), 2, {{3, 1, 1}}, random);
}


TEST(StencilKernel, ThreeDimensions)
{
  std::mt19937 random(3);
  for (const double radius : {1.1, 2.5, 3.5, 4.5})
    for (const bool isotropic : {true, false})
      check(ball(3, radius, isotropic, random), 3, {{21, 11, 9}}, random);
  check(ball(3, 3.5, true, random), 3, {{71, 35, 5}}, random);
  check(ball(3, 10.5, true, random), 3, {{5, 3, 2}}, random);
}


TEST(StencilKernel, OddStencils)
{
  std::mt19937 random(7);
  for (unsigned int dim = 1; dim <= 3; ++dim)
    for (unsigned int parity = 1; parity < (1u << dim); ++parity)
      for (const double radius : {2.5, 5.5, 10.})
        for (const bool isotropic : {true, false})
          {
            Stencil s = ball(dim, dim == 3 ? 0.5 * radius + 1. : radius, isotropic, random);
            for (unsigned int d = 0; d < dim; ++d)
              s.odd[d] = (parity & (1u << d)) != 0;
            check(s, dim, {{41, dim > 1 ? 35 : 1, dim > 2 ? 4 : 1}}, random);
          }
}


TEST(StencilKernel, SumsOfTerms)
{
  std::mt19937 random(8);
  for (unsigned int dim = 1; dim <= 3; ++dim)
    {
      Stencil      even = ball(dim, 3.5, true, random), odd = even, none = even;
      const Offset n = {{77, dim > 1 ? 37 : 1, dim > 2 ? 3 : 1}};
      odd.odd[0]     = true;
      none.weights.assign(even.weights.size(), 0.);
      const Field         a(n, even.halo, random), b(n, even.halo, random);
      const StencilKernel k_even(dim, even.offsets, even.weights),
        k_odd(dim, odd.offsets, odd.weights, odd.odd), k_none(dim, none.offsets, none.weights);
      const std::vector<double> of_a = apply_whole(k_even, a), of_b = apply_whole(k_odd, b);
      const StencilKernel::Term terms[] = {{&k_none, b.grid}, {&k_even, a.grid}, {&k_odd, b.grid}};
      std::vector<double>       found(n[0]);
      for (int y = 0; y < n[1]; ++y)
        {
          const StencilKernel::Run run = {0, y, 0, found.size(), found.data()};
          StencilKernel::apply_sum(terms, 3, &run, 1);
          for (int x = 0; x < n[0]; ++x)
            EXPECT_NEAR(found[x],
                        of_a[x + y * n[0]] + of_b[x + y * n[0]],
                        1e-13 * even.offsets.size());
          StencilKernel::apply_sum(terms, 1, &run, 1);
          EXPECT_EQ(found, std::vector<double>(n[0], 0.));
        }
    }
}


TEST(StencilKernel, ReachMayDifferByCoordinate)
{
  std::mt19937 random(4);
  Stencil      along_y, along_z, flat, holes, centre;
  along_y.add({{0, 3, 0}}, 0.7);
  check(along_y, 2, {{19, 9, 1}}, random);
  along_z.add({{0, 0, 2}}, -1.3);
  check(along_z, 3, {{19, 3, 4}}, random);
  flat.add({{5, 1, 0}}, 0.3);
  flat.add({{2, 0, 1}}, 0.9);
  check(flat, 3, {{33, 5, 6}}, random);
  holes.add({{3, 5, 0}}, 1.);
  holes.add({{0, 2, 0}}, 2.);
  check(holes, 2, {{33, 40, 1}}, random);
  centre.add({{0, 0, 0}}, -4.);
  centre.add({{1, 0, 0}}, 1.);
  centre.add({{0, 1, 0}}, 1.);
  check(centre, 2, {{17, 8, 1}}, random);
  EXPECT_EQ(StencilKernel(2, centre.offsets, centre.weights).n_bonds(), 4u);
}


TEST(StencilKernel, CountsBonds)
{
  std::mt19937  random(5);
  const Stencil s2 = ball(2, 7., true, random), s3 = ball(3, 3.5, true, random);
  // Lattice points within the circle and the ball, less the centre (sequences A057655 and A117609).
  EXPECT_EQ(StencilKernel(2, s2.offsets, s2.weights).n_bonds(), 144u);
  EXPECT_EQ(StencilKernel(3, s3.offsets, s3.weights).n_bonds(), 178u);
  EXPECT_LT(StencilKernel(3, s3.offsets, s3.weights).n_multiplications(), 30u);
}


TEST(StencilKernel, EmptyAndNegativeRuns)
{
  std::mt19937        random(6);
  const Stencil       s = ball(2, 3.5, true, random);
  const Field         f({{40, 90, 1}}, s.halo, random);
  const StencilKernel kernel(2, s.offsets, s.weights);
  const auto          whole = apply_whole(kernel, f);

  // Seen from point (13, 50), all coordinates of the first rows are negative.
  const StencilKernel::Grid       moved = {f.grid.data + 13 + 50 * f.grid.row_stride,
                                           f.grid.row_stride,
                                           0};
  std::vector<double>             out(whole.size());
  std::vector<StencilKernel::Run> runs;
  for (int y = 0; y < 90; ++y)
    {
      runs.push_back({-13, y - 50, 0, 40, &out[y * 40]});
      runs.push_back({0, y - 50, 0, 0, nullptr});
    }
  kernel.apply(moved, runs);
  EXPECT_TRUE(same_bits(out.data(), whole.data(), out.size()));
  kernel.apply(moved, nullptr, 0);
}


TEST(StencilKernel, ThreadsDoNotInterfere)
{
  std::mt19937        random(7);
  const Stencil       s = ball(2, 6.5, true, random);
  const Field         f({{200, 100, 1}}, s.halo, random);
  const StencilKernel kernel(2, s.offsets, s.weights);
  const auto          whole = apply_whole(kernel, f);
  std::vector<double> a, b;
  std::thread         first([&]() { a = apply_whole(kernel, f); });
  std::thread         second([&]() { b = apply_whole(kernel, f); });
  first.join();
  second.join();
  EXPECT_EQ(a, whole);
  EXPECT_EQ(b, whole);
}


TEST(StencilKernel, RefusesWrongInput)
{
  const auto make = [](const unsigned int         dim,
                       const std::vector<Offset> &o,
                       const std::vector<double> &w) { const StencilKernel kernel(dim, o, w); };
  EXPECT_THROW(make(0, {{{1, 0, 0}}}, {1.}), std::invalid_argument);
  EXPECT_THROW(make(4, {{{1, 0, 0}}}, {1.}), std::invalid_argument);
  EXPECT_THROW(make(1, {}, {}), std::invalid_argument);
  EXPECT_THROW(make(1, {{{1, 0, 0}}}, {1., 2.}), std::invalid_argument);
  EXPECT_THROW(make(1, {{{1, 1, 0}}}, {1.}), std::invalid_argument);
  EXPECT_THROW(make(2, {{{-1, 0, 0}}}, {1.}), std::invalid_argument);
  EXPECT_THROW(make(2, {{{1, 0, 0}}, {{1, 0, 0}}}, {1., 1.}), std::invalid_argument);
  EXPECT_THROW(make(2, {{{1, 0, 0}}}, {std::nan("")}), std::invalid_argument);
}


TEST(StencilKernel, NamesItsTarget)
{
  EXPECT_FALSE(StencilKernel::target().empty());
}
