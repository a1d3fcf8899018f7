// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/family_completion.h>

#include <algorithm>
#include <cmath>

#include "least_additions.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FamilyCompletion<dim>::FamilyCompletion(const KernelWeights<dim> &weights,
                                          const Lattice<dim>       &lattice)
    : weights(weights)
    , cell_volume(lattice.cell_volume())
  {
    const auto &members = weights.members();
    for (const FamilyMember<dim> &member : members)
      {
        const auto other = std::find_if(members.begin(), members.end(), [&](const auto &candidate) {
          bool is_opposite = true;
          for (unsigned int d = 0; d < dim; ++d)
            is_opposite = is_opposite && candidate.offset[d] == -member.offset[d];
          return is_opposite;
        });
        AssertThrow(other != members.end(), ExcInternalError());
        opposite.push_back(other - members.begin());
        Tensor<1, dim> direction;
        for (unsigned int d = 0; d < dim; ++d)
          direction[d] = member.offset[d] * lattice.spacing[d] / member.r;
        Moments      all;
        unsigned int n = 0;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b, ++n)
            {
              all[n] = direction[a] * direction[a] * direction[b] * direction[b];
              complete[n] += member.weight * cell_volume * member.r * member.r * all[n];
            }
        moments.push_back(all);
      }
  }


  template <int dim>
  const std::vector<double> &FamilyCompletion<dim>::factors(const std::vector<double> &volumes)
  {
    constexpr std::size_t most  = 10000; // irregular bodies have many that occur once
    const auto            found = known.find(volumes);
    if (found != known.end())
      return found->second;
    if (known.size() >= most)
      known.clear();
    return known[volumes] = find_factors(volumes);
  }


  template <int dim>
  std::vector<double> FamilyCompletion<dim>::find_factors(const std::vector<double> &volumes) const
  {
    const auto         &members = weights.members();
    std::vector<double> factors(members.size(), 0.), weight(members.size(), 0.);
    Moments             gap = complete;
    for (unsigned int m = 0; m < members.size(); ++m)
      if (volumes[m] > 0.)
        {
          const double missing = std::max(0., cell_volume - volumes[opposite[m]]);
          factors[m]           = missing > 1e-9 * cell_volume ? missing / volumes[m] : 0.;
          weight[m] =
            members[m].weight * members[m].r * members[m].r * volumes[m] * (1. + factors[m]);
          for (unsigned int n = 0; n < n_moments; ++n)
            gap[n] -= weight[m] * moments[m][n];
        }
    const double size = *std::max_element(complete.begin(), complete.end());
    if (std::all_of(gap.begin(), gap.end(), [&](const double g) {
          return std::abs(g) < 1e-9 * size;
        }))
      return factors;
    const std::vector<double> additions = least_additions(moments, weight, gap, 1e-9);
    for (unsigned int m = 0; m < members.size(); ++m)
      if (volumes[m] > 0.)
        factors[m] += (1. + factors[m]) * additions[m];
    return factors;
  }


  PERIDEAL_INSTANTIATE_CLASS(class FamilyCompletion);
} // namespace PeriDeal
