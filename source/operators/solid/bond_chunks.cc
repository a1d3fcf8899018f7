// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// This file is compiled once per SIMD target, as stencil_tile.cc is, and for the same reason must
// not call inline functions of the standard library. The folder of this file must be on the include
// path, and it wants -O3.

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bond_chunks.cc"
#include "bond_chunks.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace PeriDeal
{
  namespace HWY_NAMESPACE
  {
    namespace hn = hwy::HWY_NAMESPACE;

    constexpr int width = BondChunk::width;

    using D = hn::CappedTag<double, width>;
    using V = hn::Vec<D>;

    /** What is remembered is read once a step and comes from far: ask for it some bonds ahead. */
    template <int dim>
    HWY_INLINE void ask_ahead(const double *remembered)
    {
      constexpr int ahead = 12;
      for (int a = 0; a < dim; ++a)
        __builtin_prefetch(remembered + (ahead * dim + a) * width);
    }


    /** Some of the sites, as many as there are lanes. */
    template <int dim>
    struct Sites
    {
      V own[dim], slopes[dim * dim];

      HWY_INLINE Sites(const BondChunk &chunk, const std::size_t first)
      {
        const D d;
        for (int a = 0; a < dim; ++a)
          own[a] = hn::LoadU(d, chunk.values[a] + first);
        for (int k = 0; chunk.slopes != nullptr && k < dim * dim; ++k)
          slopes[k] = hn::LoadU(d, chunk.slopes + k * width + first);
      }

      /** du of a bond. */
      HWY_INLINE void changes(const BondChunk  &chunk,
                              const std::size_t first,
                              const std::size_t bond,
                              V                *du) const
      {
        const D d;
        for (int a = 0; a < dim; ++a)
          du[a] = hn::Sub(hn::LoadU(d, chunk.values[a] + chunk.offsets[bond] + first), own[a]);
      }

      /** z_e of a bond from du. */
      HWY_INLINE void elastic(const BondChunk  &chunk,
                              const std::size_t bond,
                              const V          *plastic,
                              const V          *du,
                              V                *z) const
      {
        const D d;
        for (int a = 0; a < dim; ++a)
          {
            z[a] = hn::Sub(du[a], plastic[a]);
            for (int b = 0; b < dim; ++b)
              z[a] =
                hn::NegMulAdd(slopes[dim * a + b], hn::Set(d, chunk.vectors[dim * bond + b]), z[a]);
          }
      }
    };


    /** w V_j. */
    HWY_INLINE V weight(const BondChunk &chunk, const std::size_t first, const std::size_t bond)
    {
      const D d;
      return hn::Mul(hn::Set(d, chunk.weights[bond]),
                     hn::LoadU(d, chunk.volumes + chunk.offsets[bond] + first));
    }


    template <int dim>
    HWY_INLINE void load(const double *numbers, V (&vector)[dim])
    {
      for (int a = 0; a < dim; ++a)
        vector[a] = hn::LoadU(D(), numbers + a * width);
    }


    template <int dim>
    HWY_INLINE void add_elastic(const V w,
                                const V (&z_p)[dim],
                                const V (&du)[dim],
                                const V (&z)[dim],
                                V &squares,
                                V &products,
                                V (&pulls)[dim])
    {
      V square = hn::Zero(D()), product = square;
      for (int a = 0; a < dim; ++a)
        {
          square   = hn::MulAdd(z[a], z[a], square);
          product  = hn::MulAdd(z[a], du[a], product);
          pulls[a] = hn::MulAdd(w, z_p[a], pulls[a]);
        }
      squares  = hn::MulAdd(w, square, squares);
      products = hn::MulAdd(w, product, products);
    }


    template <int dim>
    HWY_INLINE void store(const V squares,
                          const V products,
                          const V (&pulls)[dim],
                          const std::size_t first,
                          ChunkSums        &sums)
    {
      const D d;
      hn::StoreU(squares, d, sums.squares + first);
      hn::StoreU(products, d, sums.products + first);
      for (int a = 0; a < dim; ++a)
        hn::StoreU(pulls[a], d, sums.pulls[a] + first);
    }


    template <int dim>
    void sum_elastic_of(const BondChunk &chunk, const double *plastic, ChunkSums &sums)
    {
      const D           d;
      const std::size_t lanes = hn::Lanes(d);
      for (std::size_t first = 0; first < width; first += lanes)
        {
          const Sites<dim> sites(chunk, first);
          V                squares = hn::Zero(d), products = squares, pulls[dim];
          for (int a = 0; a < dim; ++a)
            pulls[a] = squares;
          for (std::size_t bond = 0; bond < chunk.n_bonds; ++bond)
            {
              V z_p[dim], du[dim], z[dim];
              ask_ahead<dim>(plastic + dim * width * bond + first);
              load<dim>(plastic + dim * width * bond + first, z_p);
              sites.changes(chunk, first, bond, du);
              sites.elastic(chunk, bond, z_p, du, z);
              add_elastic(weight(chunk, first, bond), z_p, du, z, squares, products, pulls);
            }
          store(squares, products, pulls, first, sums);
        }
    }


    template <int dim>
    void let_flow_of(const BondChunk &chunk, const double *lost, double *plastic)
    {
      const D           d;
      const std::size_t lanes = hn::Lanes(d);
      for (std::size_t first = 0; first < width; first += lanes)
        {
          const Sites<dim> sites(chunk, first);
          const V          share = hn::LoadU(d, lost + first);
          for (std::size_t bond = 0; bond < chunk.n_bonds; ++bond)
            {
              double *const memory = plastic + dim * width * bond + first;
              V             z_p[dim], du[dim], z[dim];
              load<dim>(memory, z_p);
              sites.changes(chunk, first, bond, du);
              sites.elastic(chunk, bond, z_p, du, z);
              for (int a = 0; a < dim; ++a)
                hn::StoreU(hn::MulAdd(share, z[a], z_p[a]), d, memory + a * width);
            }
        }
    }


    template <int dim>
    void let_flow_and_sum_of(const BondChunk before,
                             const double   *lost,
                             const BondChunk now,
                             double         *plastic,
                             ChunkSums      &sums)
    {
      const D           d;
      const std::size_t lanes = hn::Lanes(d);
      for (std::size_t first = 0; first < width; first += lanes)
        {
          const Sites<dim> sites_before(before, first), sites(now, first);
          const V          share   = hn::LoadU(d, lost + first);
          V                squares = hn::Zero(d), products = squares, pulls[dim];
          for (int a = 0; a < dim; ++a)
            pulls[a] = squares;
          for (std::size_t bond = 0; bond < now.n_bonds; ++bond)
            {
              double *const memory = plastic + dim * width * bond + first;
              V             z_p[dim], du[dim], z[dim];
              ask_ahead<dim>(memory);
              load<dim>(memory, z_p);
              sites_before.changes(before, first, bond, du);
              sites_before.elastic(before, bond, z_p, du, z);
              for (int a = 0; a < dim; ++a)
                {
                  z_p[a] = hn::MulAdd(share, z[a], z_p[a]);
                  hn::StoreU(z_p[a], d, memory + a * width);
                }
              sites.changes(now, first, bond, du);
              sites.elastic(now, bond, z_p, du, z);
              add_elastic(weight(now, first, bond), z_p, du, z, squares, products, pulls);
            }
          store(squares, products, pulls, first, sums);
        }
    }


    template <int dim>
    void keep_elastic_of(const BondChunk &chunk,
                         const double    *plastic,
                         double          *elastic,
                         ChunkSums       &sums)
    {
      const D           d;
      const std::size_t lanes = hn::Lanes(d);
      for (std::size_t first = 0; first < width; first += lanes)
        {
          const Sites<dim> sites(chunk, first);
          V                pulls[dim];
          for (int a = 0; a < dim; ++a)
            pulls[a] = hn::Zero(d);
          for (std::size_t bond = 0; bond < chunk.n_bonds; ++bond)
            {
              const std::size_t at = dim * width * bond + first;
              V                 z_p[dim], du[dim], z[dim];
              load<dim>(plastic + at, z_p);
              sites.changes(chunk, first, bond, du);
              sites.elastic(chunk, bond, z_p, du, z);
              const V w = weight(chunk, first, bond);
              for (int a = 0; a < dim; ++a)
                {
                  hn::StoreU(z[a], d, elastic + at + a * width);
                  pulls[a] = hn::MulAdd(w, z[a], pulls[a]);
                }
            }
          for (int a = 0; a < dim; ++a)
            hn::StoreU(pulls[a], d, sums.pulls[a] + first);
        }
    }


    template <int dim>
    void sum_products_of(const BondChunk &chunk, const double *elastic, double *products)
    {
      const D           d;
      const std::size_t lanes = hn::Lanes(d);
      for (std::size_t first = 0; first < width; first += lanes)
        {
          const Sites<dim> sites(chunk, first);
          V                sum = hn::Zero(d);
          for (std::size_t bond = 0; bond < chunk.n_bonds; ++bond)
            {
              V du[dim], product = hn::Zero(d);
              sites.changes(chunk, first, bond, du);
              for (int a = 0; a < dim; ++a)
                product = hn::MulAdd(hn::LoadU(d, elastic + (dim * bond + a) * width + first),
                                     du[a],
                                     product);
              sum = hn::MulAdd(weight(chunk, first, bond), product, sum);
            }
          hn::StoreU(sum, d, products + first);
        }
    }


    template <int dim>
    void add_to_far_ends_of(const BondChunk chunk,
                            const double   *factors,
                            const double   *remembered,
                            double *const  *to)
    {
      const D           d;
      const std::size_t lanes = hn::Lanes(d);
      for (std::size_t first = 0; first < width; first += lanes)
        {
          const V factor = hn::LoadU(d, factors + first);
          for (std::size_t bond = 0; bond < chunk.n_bonds; ++bond)
            {
              const V             share = hn::Mul(hn::Set(d, chunk.weights[bond]), factor);
              const double *const from  = remembered + dim * width * bond + first;
              ask_ahead<dim>(from);
              for (int a = 0; a < dim; ++a)
                {
                  double *const sum = to[a] + chunk.offsets[bond] + first;
                  hn::StoreU(hn::MulAdd(share, hn::LoadU(d, from + a * width), hn::LoadU(d, sum)),
                             d,
                             sum);
                }
            }
        }
    }


    // What is exported is no template.
#define PERIDEAL_OF_DIMENSION(dim)                                                         \
  void sum_elastic_##dim(const BondChunk &chunk, const double *plastic, ChunkSums &sums)   \
  {                                                                                        \
    sum_elastic_of<dim>(chunk, plastic, sums);                                             \
  }                                                                                        \
  void let_flow_##dim(const BondChunk &chunk, const double *lost, double *plastic)         \
  {                                                                                        \
    let_flow_of<dim>(chunk, lost, plastic);                                                \
  }                                                                                        \
  void let_flow_and_sum_##dim(const BondChunk &before,                                     \
                              const double    *lost,                                       \
                              const BondChunk &now,                                        \
                              double          *plastic,                                    \
                              ChunkSums       &sums)                                       \
  {                                                                                        \
    let_flow_and_sum_of<dim>(before, lost, now, plastic, sums);                            \
  }                                                                                        \
  void keep_elastic_##dim(const BondChunk &chunk,                                          \
                          const double    *plastic,                                        \
                          double          *elastic,                                        \
                          ChunkSums       &sums)                                           \
  {                                                                                        \
    keep_elastic_of<dim>(chunk, plastic, elastic, sums);                                   \
  }                                                                                        \
  void sum_products_##dim(const BondChunk &chunk, const double *elastic, double *products) \
  {                                                                                        \
    sum_products_of<dim>(chunk, elastic, products);                                        \
  }                                                                                        \
  void add_to_far_ends_##dim(const BondChunk &chunk,                                       \
                             const double    *factors,                                     \
                             const double    *remembered,                                  \
                             double *const   *to)                                          \
  {                                                                                        \
    add_to_far_ends_of<dim>(chunk, factors, remembered, to);                               \
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
#  define PERIDEAL_DISPATCH(dim)                                                            \
    HWY_EXPORT(sum_elastic_##dim);                                                          \
    HWY_EXPORT(let_flow_##dim);                                                             \
    HWY_EXPORT(let_flow_and_sum_##dim);                                                     \
    HWY_EXPORT(keep_elastic_##dim);                                                         \
    HWY_EXPORT(sum_products_##dim);                                                         \
    HWY_EXPORT(add_to_far_ends_##dim);                                                      \
    template <>                                                                             \
    void sum_elastic<dim>(const BondChunk &chunk, const double *plastic, ChunkSums &sums)   \
    {                                                                                       \
      HWY_DYNAMIC_DISPATCH(sum_elastic_##dim)(chunk, plastic, sums);                        \
    }                                                                                       \
    template <>                                                                             \
    void let_flow<dim>(const BondChunk &chunk, const double *lost, double *plastic)         \
    {                                                                                       \
      HWY_DYNAMIC_DISPATCH(let_flow_##dim)(chunk, lost, plastic);                           \
    }                                                                                       \
    template <>                                                                             \
    void let_flow_and_sum<dim>(const BondChunk &before,                                     \
                               const double    *lost,                                       \
                               const BondChunk &now,                                        \
                               double          *plastic,                                    \
                               ChunkSums       &sums)                                       \
    {                                                                                       \
      HWY_DYNAMIC_DISPATCH(let_flow_and_sum_##dim)(before, lost, now, plastic, sums);       \
    }                                                                                       \
    template <>                                                                             \
    void keep_elastic<dim>(const BondChunk &chunk,                                          \
                           const double    *plastic,                                        \
                           double          *elastic,                                        \
                           ChunkSums       &sums)                                           \
    {                                                                                       \
      HWY_DYNAMIC_DISPATCH(keep_elastic_##dim)(chunk, plastic, elastic, sums);              \
    }                                                                                       \
    template <>                                                                             \
    void sum_products<dim>(const BondChunk &chunk, const double *elastic, double *products) \
    {                                                                                       \
      HWY_DYNAMIC_DISPATCH(sum_products_##dim)(chunk, elastic, products);                   \
    }                                                                                       \
    template <>                                                                             \
    void add_to_far_ends<dim>(const BondChunk &chunk,                                       \
                              const double    *factors,                                     \
                              const double    *remembered,                                  \
                              double *const   *to)                                          \
    {                                                                                       \
      HWY_DYNAMIC_DISPATCH(add_to_far_ends_##dim)(chunk, factors, remembered, to);          \
    }
  PERIDEAL_DISPATCH(1)
  PERIDEAL_DISPATCH(2)
  PERIDEAL_DISPATCH(3)
#  undef PERIDEAL_DISPATCH
} // namespace PeriDeal
#endif
