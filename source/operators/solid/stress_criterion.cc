// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/base/instantiate.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/solid/stress_criterion.h>

#include <algorithm>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  StressCriterion<dim>::StressCriterion(const BreakableBonds<dim> &bonds)
    : nodes(bonds.families.nodes())
    , is_principal(bonds.material.law.breaking.criterion == BreakCriterion::principal_stress)
    , limits(bonds, scatter_factors(bonds), false)
    , stresses(nodes.n_local(), 0.)
    , least(nodes.n_local(), 0.)
    , along(is_principal ? nodes.n_local() : 0)
  {}


  template <int dim>
  void StressCriterion<dim>::take_state(const std::vector<Vector> &values)
  {
    double lowest = std::numeric_limits<double>::infinity();
    for (unsigned int i = 0; i < stresses.size(); ++i)
      {
        SymmetricTensor<2, 3> stress;
        for (unsigned int k = 0; k < values.size(); ++k)
          stress.access_raw_entry(k) = values[k].local_element(i);
        for (unsigned int a = 0; a < dim && is_principal; ++a)
          for (unsigned int b = a; b < dim; ++b)
            along[i][a][b] = stress[a][b];
        stresses[i] = is_principal ? eigenvalues(along[i])[0] : von_mises(stress);
        lowest      = std::min(lowest, limits.values()[i]);
      }
    // The mean of both ends is above no limit where none of them is.
    for (unsigned int i = 0; i < stresses.size(); ++i)
      least[i] = stresses[i] > lowest ? 0. : std::numeric_limits<double>::infinity();
  }


  template <int dim>
  BondMeasure StressCriterion<dim>::measure(const unsigned int i,
                                            const unsigned int j,
                                            const double       extension,
                                            const double /*length*/) const
  {
    constexpr double round_off = 1e-9;
    BondMeasure      found{0.5 * (stresses[i] + stresses[j]),
                      std::min(limits.values()[i], limits.values()[j])};
    if (!(extension > 0.) || found.value <= 0.)
      return {0., found.limit};
    if (is_principal)
      {
        const Tensor<1, dim> xi      = nodes.position(j) - nodes.position(i);
        const double         tension = 0.5 * ((along[i] + along[j]) * xi) * xi / xi.norm_square();
        if (tension < (0.5 - round_off) * found.value)
          found.value = 0.;
      }
    return found;
  }


  PERIDEAL_INSTANTIATE_CLASS(class StressCriterion);
} // namespace PeriDeal
