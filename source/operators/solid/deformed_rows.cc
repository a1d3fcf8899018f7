// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// This file is compiled once per SIMD target, as stencil_tile.cc is, and for the same reason must
// not call inline functions of the standard library. The folder of this file must be on the include
// path, and it wants -O3.

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deformed_rows.cc"
#include <perideal/operators/solid/deformed_rows.h>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace PeriDeal
{
  namespace HWY_NAMESPACE
  {
    namespace hn = hwy::HWY_NAMESPACE;

    // Wider vectors take roots and quotients no faster, and gathers several times as long as pairs
    // of numbers that are loaded one by one.
    constexpr int most_lanes = 4;

    using Node = DeformedRows::Node;
    using D    = hn::CappedTag<double, most_lanes>;
    using V    = hn::Vec<D>;

#if HWY_TARGET == HWY_SCALAR
    HWY_INLINE void load_numbers(const Node         *nodes,
                                 const unsigned int *neighbors,
                                 const int           first,
                                 V                  &a,
                                 V                  &b)
    {
      a = hn::LoadU(D(), nodes[*neighbors].numbers + first);
      b = hn::LoadU(D(), nodes[*neighbors].numbers + first + 1);
    }
#else
    /** Two numbers of each of the nodes 0, 2, ... */
    template <typename Tag>
    HWY_INLINE hn::Vec<Tag> load_pairs(const Tag           tag,
                                       const Node         *nodes,
                                       const unsigned int *neighbors,
                                       const int           first)
    {
      if constexpr (hn::MaxLanes(Tag()) <= 2)
        return hn::LoadU(tag, nodes[*neighbors].numbers + first);
      else
        {
          const hn::Half<Tag> half;
          return hn::Combine(tag,
                             load_pairs(half, nodes, neighbors + hn::MaxLanes(half), first),
                             load_pairs(half, nodes, neighbors, first));
        }
    }


    /** The numbers @p first and the next one of as many nodes as there are lanes. */
    HWY_INLINE void load_numbers(const Node         *nodes,
                                 const unsigned int *neighbors,
                                 const int           first,
                                 V                  &a,
                                 V                  &b)
    {
      const D d;
      const V even = load_pairs(d, nodes, neighbors, first),
              odd  = load_pairs(d, nodes, neighbors + 1, first);
      a            = hn::InterleaveLower(d, even, odd);
      b            = hn::InterleaveUpper(d, even, odd);
    }
#endif


    /** As many bonds of a node as there are lanes. */
    template <int dim>
    struct Bonds
    {
      V along[dim];  // Y
      V norm, x;     // |Y|, |xi|
      V difference;  // |Y|^2 - |xi|^2
      V tau, strain; // tau of the neighbours, s of the bonds

      HWY_INLINE Bonds(const DeformedRows &rows, const std::size_t i, const unsigned int *neighbors)
      {
        const D      d;
        const double half = 0.5, *const own = rows.nodes[i].numbers;
        V there[8];
        for (int k = 0; k < 8; k += 2)
          load_numbers(rows.nodes, neighbors, k, there[k], there[k + 1]);
        V square = hn::Zero(d), square_now = hn::Zero(d);
        difference = hn::Zero(d);
        for (int c = 0; c < dim; ++c)
          {
            const V xi  = hn::Sub(there[c], hn::Set(d, own[c])),
                    eta = hn::Sub(there[Node::displacement + c],
                                  hn::Set(d, own[Node::displacement + c]));
            along[c]    = hn::Add(xi, eta);
            square      = hn::MulAdd(xi, xi, square);
            square_now  = hn::MulAdd(along[c], along[c], square_now);
            difference  = hn::MulAdd(hn::Add(hn::Add(xi, xi), eta), eta, difference);
          }
        x    = hn::Sqrt(square);
        norm = hn::Sqrt(square_now);
        tau  = there[Node::tau];
        strain =
          hn::Mul(hn::Set(d, half), hn::Add(there[Node::strain], hn::Set(d, own[Node::strain])));
      }
    };


    /** Bonds that are left over in a row, filled up with bonds of a node to itself. */
    struct Rest
    {
      unsigned int neighbors[most_lanes];
      double       lengths[most_lanes], springs[most_lanes];

      HWY_INLINE Rest(const DeformedRows &rows, const std::size_t i, const std::size_t begin)
      {
        const std::size_t n = rows.starts[i + 1] - begin;
        for (std::size_t k = 0; k < most_lanes; ++k)
          {
            neighbors[k] = k < n ? rows.neighbors[begin + k] : static_cast<unsigned int>(i);
            lengths[k]   = k < n ? rows.lengths[begin + k] : 0.;
            springs[k]   = k < n ? rows.springs[begin + k] : 0.;
          }
      }
    };


    /**
     * Visit the bonds of a row, a vector at a time, with W x and springs. Numbers of bonds that
     * bear nothing need not be finite.
     */
    template <int dim, typename Visit>
    HWY_INLINE void for_each_of(const DeformedRows &rows, const std::size_t i, const Visit &visit)
    {
      const D           d;
      const std::size_t lanes = hn::Lanes(d), end = rows.starts[i + 1];
      std::size_t       k = rows.starts[i];
      for (; k + lanes <= end; k += lanes)
        visit(Bonds<dim>(rows, i, rows.neighbors + k),
              hn::LoadU(d, rows.lengths + k),
              hn::LoadU(d, rows.springs + k));
      if (k == end)
        return;
      const Rest rest(rows, i, k);
      visit(Bonds<dim>(rows, i, rest.neighbors),
            hn::LoadU(d, rest.lengths),
            hn::LoadU(d, rest.springs));
    }


    HWY_INLINE V where_it_bears(const V length, const V value)
    {
      return hn::IfThenElseZero(hn::Gt(length, hn::Zero(D())), value);
    }


    HWY_INLINE double sum_of(const V v)
    {
      return hn::GetLane(hn::SumOfLanes(D(), v));
    }


    template <bool strained, int dim>
    HWY_INLINE V extension(const Bonds<dim> &bonds, const V gap)
    {
      if constexpr (strained)
        return hn::NegMulAdd(bonds.strain, bonds.x, gap);
      else
        return gap;
    }


    template <int dim, bool strained>
    void extensions(const DeformedRows &rows, double *sums, double *squares)
    {
      const D d;
      for (std::size_t i = rows.begin; i < rows.end; ++i)
        {
          V sum = hn::Zero(d), square = hn::Zero(d);
          for_each_of<dim>(rows,
                           i,
                           [&](const Bonds<dim> &bonds, const V length, const V spring) HWY_ATTR {
                             const V gap = hn::Div(bonds.difference, hn::Add(bonds.norm, bonds.x));
                             const V found =
                               where_it_bears(length,
                                              hn::Mul(length, extension<strained>(bonds, gap)));
                             sum    = hn::Add(sum, found);
                             square = hn::MulAdd(hn::Mul(spring, found), found, square);
                           });
          sums[i] = sum_of(sum);
          if (squares != nullptr)
            squares[i] = sum_of(square);
        }
    }


    template <int dim, bool strained, bool limited>
    void forces(const DeformedRows &rows, const double *limits, double *y, unsigned char *exceeds)
    {
      const D d;
      for (std::size_t i = rows.begin; i < rows.end; ++i)
        {
          const V own   = hn::Set(d, rows.nodes[i].numbers[Node::tau]),
                  limit = hn::Set(d, limited ? limits[i] : 0.);
          V most        = hn::Zero(d); // e - limit x of the bonds, if that is above 0
          V sum[dim];
          for (int c = 0; c < dim; ++c)
            sum[c] = hn::Zero(d);
          for_each_of<dim>(
            rows,
            i,
            [&](const Bonds<dim> &bonds, const V length, const V spring) HWY_ATTR {
              // One division for both 1/(|Y| + |xi|) and 1/|Y|.
              const V both    = hn::Add(bonds.norm, bonds.x);
              const V inverse = hn::Div(hn::Set(d, 1.), hn::Mul(both, bonds.norm));
              const V gap     = hn::Mul(hn::Mul(bonds.difference, bonds.norm), inverse);
              const V e       = extension<strained>(bonds, gap);
              const V size    = hn::MulAdd(hn::Mul(spring, length), e, hn::Add(own, bonds.tau));
              const V factor =
                where_it_bears(length, hn::Mul(hn::Mul(size, length), hn::Mul(both, inverse)));
              for (int c = 0; c < dim; ++c)
                sum[c] = hn::MulAdd(factor, bonds.along[c], sum[c]);
              if constexpr (limited)
                most = hn::Max(most, where_it_bears(length, hn::NegMulAdd(limit, bonds.x, e)));
            });
          for (int c = 0; c < dim; ++c)
            y[dim * i + c] = -sum_of(sum[c]);
          if constexpr (limited)
            exceeds[i] = hn::GetLane(hn::MaxOfLanes(d, most)) > 0. ? 1 : 0;
        }
    }


    template <int dim>
    double largest_stretch(const DeformedRows &rows)
    {
      V most = hn::Zero(D());
      for (std::size_t i = rows.begin; i < rows.end; ++i)
        for_each_of<dim>(rows, i, [&](const Bonds<dim> &bonds, const V length, const V) HWY_ATTR {
          const V both = hn::Mul(hn::Add(bonds.norm, bonds.x), bonds.x);
          most = hn::Max(most, where_it_bears(length, hn::Abs(hn::Div(bonds.difference, both))));
        });
      return hn::GetLane(hn::MaxOfLanes(D(), most));
    }


    // What is exported is no template.
#define PERIDEAL_OF_DIMENSION(dim)                                               \
  void extensions_##dim(const DeformedRows &rows, double *sums, double *squares) \
  {                                                                              \
    rows.strained ? extensions<dim, true>(rows, sums, squares) :                 \
                    extensions<dim, false>(rows, sums, squares);                 \
  }                                                                              \
  void forces_##dim(const DeformedRows &rows,                                    \
                    const double       *limits,                                  \
                    double             *y,                                       \
                    unsigned char      *exceeds)                                 \
  {                                                                              \
    if (limits != nullptr)                                                       \
      rows.strained ? forces<dim, true, true>(rows, limits, y, exceeds) :        \
                      forces<dim, false, true>(rows, limits, y, exceeds);        \
    else                                                                         \
      rows.strained ? forces<dim, true, false>(rows, limits, y, exceeds) :       \
                      forces<dim, false, false>(rows, limits, y, exceeds);       \
  }                                                                              \
  double largest_stretch_##dim(const DeformedRows &rows)                         \
  {                                                                              \
    return largest_stretch<dim>(rows);                                           \
  }
    PERIDEAL_OF_DIMENSION(1)
    PERIDEAL_OF_DIMENSION(2)
    PERIDEAL_OF_DIMENSION(3)
#undef PERIDEAL_OF_DIMENSION
  } // namespace HWY_NAMESPACE
} // namespace PeriDeal
HWY_AFTER_NAMESPACE();


#if HWY_ONCE
namespace PeriDeal
{
#  define PERIDEAL_DISPATCH(dim)                                                      \
    HWY_EXPORT(extensions_##dim);                                                     \
    HWY_EXPORT(forces_##dim);                                                         \
    HWY_EXPORT(largest_stretch_##dim);                                                \
    template <>                                                                       \
    void sum_extensions<dim>(const DeformedRows &rows, double *sums, double *squares) \
    {                                                                                 \
      HWY_DYNAMIC_DISPATCH(extensions_##dim)(rows, sums, squares);                    \
    }                                                                                 \
    template <>                                                                       \
    void sum_forces<dim>(const DeformedRows &rows,                                    \
                         const double       *limits,                                  \
                         double             *y,                                       \
                         unsigned char      *exceeds)                                 \
    {                                                                                 \
      HWY_DYNAMIC_DISPATCH(forces_##dim)(rows, limits, y, exceeds);                   \
    }                                                                                 \
    template <>                                                                       \
    double largest_of_stretches<dim>(const DeformedRows &rows)                        \
    {                                                                                 \
      return HWY_DYNAMIC_DISPATCH(largest_stretch_##dim)(rows);                       \
    }
  PERIDEAL_DISPATCH(1)
  PERIDEAL_DISPATCH(2)
  PERIDEAL_DISPATCH(3)
#  undef PERIDEAL_DISPATCH
} // namespace PeriDeal
#endif
