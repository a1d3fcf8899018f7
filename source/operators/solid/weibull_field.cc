// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/weibull_field.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** SplitMix64 (Steele, Lea and Flood 2014): each bit depends on all bits of the state. */
    std::uint64_t mixed(std::uint64_t state)
    {
      state += 0x9e3779b97f4a7c15ull;
      state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9ull;
      state = (state ^ (state >> 27)) * 0x94d049bb133111ebull;
      return state ^ (state >> 31);
    }
  } // namespace


  template <int dim>
  WeibullField<dim>::WeibullField(const Nodes<dim>  &nodes,
                                  const double       modulus,
                                  const unsigned int seed)
    : modulus(modulus)
    , scale(1. / std::tgamma(1. + 1. / modulus))
    , start(mixed(seed))
  {
    double size = 0.;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        size = std::max(size, std::abs(nodes.position(i)[d]));
    size = Utilities::MPI::max(size, nodes.communicator());
    unit = std::exp2(std::ceil(std::log2(size)) - 28.);
  }


  template <int dim>
  double WeibullField<dim>::factor(const Point<dim> &p) const
  {
    constexpr double aside = 0.37; // lattices have their nodes at no half units
    std::uint64_t    state = start;
    for (unsigned int d = 0; d < dim; ++d)
      state = mixed(state ^ static_cast<std::uint64_t>(std::llround(p[d] / unit + aside)));
    const double uniform = std::ldexp(static_cast<double>(state >> 12) + 0.5, -52);
    return scale * std::pow(-std::log(uniform), 1. / modulus);
  }


  PERIDEAL_INSTANTIATE_CLASS(class WeibullField);
} // namespace PeriDeal
