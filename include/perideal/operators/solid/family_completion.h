// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/kernel_weights.h>
#include <perideal/mesh/lattice.h>

#include <array>
#include <map>
#include <vector>

namespace PeriDeal
{
  /**
   * How much more the bonds of a lattice's node count in its own family where this ends at a
   * surface, so that the family is to uniform strains what a complete one is. What lies opposite to
   * a missing volume counts for it, too: it has the same extension, and with it all sums over
   * products of an even number of components of xi are those of a complete family. Where both are
   * missing, as at corners and in bodies thinner than a family, the bonds that are there get the
   * least (in the mean of their weights) that completes
   *
   *   sum w x^2 n_a^2 n_b^2,   n = xi/x.
   *
   * Nothing is ever taken away, so that springs stay positive. Only the node's own share of a bond
   * counts more: the energy is that of a state-based body whose influence function differs from
   * node to node, forces along bonds are opposite, and K is symmetric.
   */
  template <int dim>
  class FamilyCompletion
  {
  public:
    /** The weights have to outlive this object. */
    FamilyCompletion(const KernelWeights<dim> &weights, const Lattice<dim> &lattice);

    /**
     * By how much of itself each bond counts more.
     * @param volumes at the sites of the members that a node has bonds to; 0: it has none
     * The result holds until the next call.
     */
    const std::vector<double> &factors(const std::vector<double> &volumes);

  private:
    static constexpr unsigned int n_moments = dim * (dim + 1) / 2;
    using Moments                           = std::array<double, n_moments>;

    std::vector<double> find_factors(const std::vector<double> &volumes) const;

    const KernelWeights<dim>                          &weights;
    const double                                       cell_volume;
    std::vector<unsigned int>                          opposite; // of the members
    std::vector<Moments>                               moments;  // n_a^2 n_b^2 of each
    Moments                                            complete{};
    std::map<std::vector<double>, std::vector<double>> known; // nodes along a side are alike
  };
} // namespace PeriDeal
