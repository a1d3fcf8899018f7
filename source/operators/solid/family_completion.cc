// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <perideal/operators/solid/family_completion.h>

#include <algorithm>

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
    const auto            &members = weights.members();
    std::vector<double>    factors(members.size(), 0.), weight(members.size(), 0.);
    dealii::Vector<double> gap(n_moments);
    for (unsigned int n = 0; n < n_moments; ++n)
      gap[n] = complete[n];
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
    if (gap.linfty_norm() < 1e-9 * size)
      return factors;
    // Of all additions the smallest: weight times the positive part of multipliers . moments. Which
    // are positive is found by turns with the multipliers (Newton's method).
    const auto product = [&](const unsigned int m, const dealii::Vector<double> &multipliers) {
      double sum = 0.;
      for (unsigned int n = 0; n < n_moments; ++n)
        sum += moments[m][n] * multipliers[n];
      return sum;
    };
    dealii::Vector<double> multipliers(n_moments);
    std::vector<bool>      grows(members.size(), true);
    for (unsigned int round = 0; round < 50; ++round)
      {
        FullMatrix<double> matrix(n_moments);
        for (unsigned int m = 0; m < members.size(); ++m)
          if (grows[m])
            for (unsigned int n = 0; n < n_moments; ++n)
              for (unsigned int k = 0; k < n_moments; ++k)
                matrix(n, k) += weight[m] * moments[m][n] * moments[m][k];
        // Directions in which there are no bonds have no moments to be completed.
        const double least = 1e-9 * matrix.linfty_norm();
        if (!(least > 0.))
          break;
        for (unsigned int n = 0; n < n_moments; ++n)
          matrix(n, n) += least;
        matrix.gauss_jordan();
        matrix.vmult(multipliers, gap);
        bool changes = false;
        for (unsigned int m = 0; m < members.size(); ++m)
          {
            const bool positive = product(m, multipliers) > 0.;
            changes             = changes || positive != grows[m];
            grows[m]            = positive;
          }
        if (!changes)
          break;
      }
    for (unsigned int m = 0; m < members.size(); ++m)
      if (volumes[m] > 0.)
        factors[m] += (1. + factors[m]) * std::max(0., product(m, multipliers));
    return factors;
  }


  template class FamilyCompletion<1>;
  template class FamilyCompletion<2>;
  template class FamilyCompletion<3>;
} // namespace PeriDeal
