// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/analysis/decay_rate.h>
#include <perideal/base/instantiate.h>
#include <perideal/laws/gauss_rule.h>
#include <perideal/laws/kernel.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::vector<LatticeTerm> lattice_terms(const std::vector<FamilyMember<dim>> &family,
                                         const Tensor<1, dim>                 &spacing,
                                         const double                          conductivity)
  {
    double volume = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      volume *= spacing[d];
    std::vector<LatticeTerm> terms;
    terms.reserve(family.size());
    for (const FamilyMember<dim> &member : family)
      {
        LatticeTerm term{{{0., 0., 0.}}, conductivity * member.weight * volume};
        for (unsigned int d = 0; d < dim; ++d)
          term.xi[d] = member.offset[d] * spacing[d];
        terms.push_back(term);
      }
    return terms;
  }


  double lattice_decay_rate(const std::vector<LatticeTerm> &terms,
                            const std::array<double, 3>    &wave_numbers,
                            const double                    storage)
  {
    double sum = 0.;
    for (const LatticeTerm &term : terms)
      {
        // 1 - abc = (1-a) + a(1-b) + ab(1-c) with 1 - cos z = 2 sin^2(z/2): no cancellation for
        // long waves.
        double product = 1., one_minus = 0.;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double half = std::sin(0.5 * wave_numbers[d] * term.xi[d]);
            one_minus += product * 2. * half * half;
            product *= 1. - 2. * half * half;
          }
        sum += term.coefficient * one_minus;
      }
    return sum / storage;
  }


  namespace
  {
    /**
     * 1 minus the mean of exp(i z cos) over directions: 1 - cos z, 1 - J_0(z), 1 - sin z/z; by its
     * series where it would cancel.
     */
    double one_minus_mean_wave(const unsigned int dim, const double z)
    {
      if (z > 1.)
        return dim == 1 ? 1. - std::cos(z) : (dim == 2 ? 1. - ::j0(z) : 1. - std::sin(z) / z);
      // The term of z^(2k) is the one before times -z^2/(2k (2k + dim - 2)).
      double term = -1., sum = 0.;
      for (unsigned int k = 1; k <= 12; ++k)
        {
          term *= -z * z / (2. * k * (2. * k + dim - 2.));
          sum += term;
        }
      return sum;
    }
  } // namespace


  double nonlocal_decay_rate(const unsigned int           dim,
                             const KernelShape            shape,
                             const unsigned int           n,
                             const double                 delta,
                             const std::array<double, 3> &wave_numbers,
                             const double                 conductivity,
                             const double                 storage)
  {
    Assert(dim >= 1 && dim <= 3, ExcMessage("Dimensions are 1, 2 and 3."));
    double k2 = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      k2 += wave_numbers[d] * wave_numbers[d];
    const double k       = std::sqrt(k2);
    const double pi      = std::acos(-1.);
    const double sphere  = dim == 1 ? 2. : (dim == 2 ? 2. * pi : 4. * pi);
    const int    power   = static_cast<int>(dim) - 1 - static_cast<int>(n);
    const auto   density = [&](const double r) {
      return kernel_shape(shape, r, delta) * std::pow(r, power) * one_minus_mean_wave(dim, k * r);
    };
    static const GaussRule rule(24);
    const unsigned int     n_pieces = 1 + static_cast<unsigned int>(k * delta / pi);
    double                 integral = 0.;
    for (unsigned int i = 0; i < n_pieces; ++i)
      integral += rule.integrate(delta * i / n_pieces, delta * (i + 1.) / n_pieces, density);
    return micro_conductivity(dim, shape, n, delta, conductivity) * sphere * integral / storage;
  }


  double classical_decay_rate(const std::array<double, 3> &wave_numbers,
                              const double                 conductivity,
                              const double                 storage)
  {
    double k2 = 0.;
    for (const double k : wave_numbers)
      k2 += k * k;
    return conductivity * k2 / storage;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(lattice_terms);
} // namespace PeriDeal
