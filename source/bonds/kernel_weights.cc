// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/bonds/kernel_weights.h>
#include <perideal/laws/kernel.h>
#include <perideal/laws/volume_fraction.h>
#include <perideal/scene/body_parameters.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  KernelWeights<dim>::KernelWeights(const KernelParameters              &parameters,
                                    const std::optional<Tensor<1, dim>> &spacing,
                                    const double                         smallest_spacing)
    : parameters(parameters)
    , spacing(spacing)
    , smallest_spacing(smallest_spacing)
    , scale(micro_conductivity(dim, parameters.kernel, parameters.exponent, parameters.horizon))
  {
    const double delta = parameters.horizon;
    if (spacing)
      make_members();
    else
      farthest = parameters.fraction == VolumeFraction::linear ? delta + 0.5 * smallest_spacing :
                                                                 delta * (1. + 1e-9);
  }


  template <int dim>
  void KernelWeights<dim>::make_members()
  {
    family = lattice_family<dim>(*spacing,
                                 parameters.horizon,
                                 parameters.kernel,
                                 parameters.exponent,
                                 parameters.fraction,
                                 parameters.calibration);
    if (parameters.self_term == SelfTerm::paper)
      self_additions = self_term_family<dim>(*spacing,
                                             parameters.horizon,
                                             parameters.kernel,
                                             parameters.exponent,
                                             parameters.fraction,
                                             parameters.calibration);
    for (const FamilyMember<dim> &member : family)
      farthest = std::max(farthest, member.r);
    for (const FamilyMember<dim> &member : self_additions)
      farthest = std::max(farthest, member.r);
    for (const FamilyMember<dim> &member : family)
      {
        int n_steps = 0;
        for (unsigned int d = 0; d < dim; ++d)
          n_steps += std::abs(member.offset[d]);
        if (n_steps == 1)
          nearest.push_back(member);
      }
  }


  template <int dim>
  double KernelWeights<dim>::of_length(const double r) const
  {
    const double h = smallest_spacing, delta = parameters.horizon;
    double       fraction = 1., at = r;
    if (r > delta - 0.5 * h) // else all of the neighbour is within the horizon
      {
        const bool linear = parameters.fraction == VolumeFraction::linear;
        fraction = linear ? linear_fraction(r, delta, h) : (r <= delta * (1. + 1e-9) ? 1. : 0.);
        if (fraction == 0.)
          return 0.;
        if (linear && parameters.kernel == KernelShape::conical)
          at = shifted_distance(r, delta, h);
      }
    double power = 1.; // r^n
    for (unsigned int k = 0; k < parameters.exponent; ++k)
      power *= r;
    return factor * scale * kernel_shape(parameters.kernel, at, delta) * fraction / power;
  }


  template <int dim>
  const FamilyMember<dim> *KernelWeights<dim>::find(const Tensor<1, dim> &xi) const
  {
    std::array<int, dim> offset;
    for (unsigned int d = 0; d < dim; ++d)
      offset[d] = static_cast<int>(std::lround(xi[d] / (*spacing)[d]));
    // The members are sorted with the last coordinate slowest.
    const auto found =
      std::lower_bound(family.begin(),
                       family.end(),
                       offset,
                       [](const FamilyMember<dim> &member, const std::array<int, dim> &wanted) {
                         return std::lexicographical_compare(member.offset.rbegin(),
                                                             member.offset.rend(),
                                                             wanted.rbegin(),
                                                             wanted.rend());
                       });
    return found != family.end() && found->offset == offset ? &*found : nullptr;
  }


  template <int dim>
  bool KernelWeights<dim>::is_offset(const Tensor<1, dim>    &xi,
                                     const FamilyMember<dim> &member) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (std::lround(xi[d] / (*spacing)[d]) != member.offset[d])
        return false;
    return true;
  }


  template <int dim>
  std::array<int, dim> KernelWeights<dim>::reach_in_sites() const
  {
    std::array<int, dim> largest{};
    for (const FamilyMember<dim> &member : family)
      for (unsigned int d = 0; d < dim; ++d)
        largest[d] = std::max(largest[d], member.offset[d]);
    return largest;
  }


  template <int dim>
  bool KernelWeights<dim>::wants_calibration() const
  {
    return parameters.calibration != Calibration::analytic && family.empty();
  }


  template <int dim>
  void KernelWeights<dim>::calibrate(const double moments, const double n)
  {
    complete_families = n > 0.;
    factor            = complete_families ? n / moments : 1.;
  }


  template <int dim>
  double KernelWeights<dim>::effective_conductivity() const
  {
    if (family.empty())
      return 1.;
    double volume = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      volume *= (*spacing)[d];
    double sum = 0.;
    for (const auto *list : {&family, &self_additions})
      for (const FamilyMember<dim> &member : *list)
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double xi = member.offset[d] * (*spacing)[d];
            sum += member.weight * volume * xi * xi / (2. * dim);
          }
    return sum;
  }


  template <int dim>
  double KernelWeights<dim>::horizon() const
  {
    return parameters.horizon;
  }

  PERIDEAL_INSTANTIATE_CLASS(class KernelWeights);
} // namespace PeriDeal
