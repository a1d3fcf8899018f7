// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/quadrature_lib.h>

#include <perideal/bonds/families.h>
#include <perideal/laws/elasticity.h>
#include <perideal/laws/kernel.h>
#include <perideal/operators/solid/damage_criterion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What a plane through the full family of a lattice cuts, mean over its normals along the axes
   * n; lengths.
   */
  struct CrossingSums
  {
    double bonds        = 0.; // sum over half the family of omega f V xi_n x^2, over q
    double over_lengths = 0.; // the same with x
    // h_n times the sum over the layers of nodes on one side of (sum over what crosses of
    // omega f V x^2, over q)^2
    double dilatations = 0.;
    // Of the stress across the plane: the sum over half the family of omega f V xi_n^2, over q;
    // h_n times the sum over those layers of the sum in `dilatations` and that with xi_n/x^2.
    double stress = 0., stress_of_dilatations = 0.;
  };

  template <int dim>
  CrossingSums crossing_sums(const Families<dim> &bonds)
  {
    const dealii::Tensor<1, dim> &spacing = bonds.nodes().lattice()->spacing;
    double                        q       = 0.;
    for (const FamilyMember<dim> &member : bonds.weights().members())
      q += member.weight * member.r * member.r;
    CrossingSums sums;
    for (unsigned int d = 0; d < dim; ++d)
      {
        std::vector<double> shares, normal; // of the layers
        for (const FamilyMember<dim> &member : bonds.weights().members())
          {
            const double share = member.weight * member.r * member.r / q;
            const int    n     = std::max(0, member.offset[d]);
            sums.bonds += n * spacing[d] * share / dim;
            sums.over_lengths += n * spacing[d] * share / member.r / dim;
            const double normal_share = n * spacing[d] * share / (member.r * member.r);
            sums.stress += n * spacing[d] * normal_share / dim;
            shares.resize(std::max<std::size_t>(shares.size(), n), 0.);
            normal.resize(shares.size(), 0.);
            for (int layer = 0; layer < n; ++layer)
              {
                shares[layer] += share;
                normal[layer] += normal_share;
              }
          }
        for (std::size_t layer = 0; layer < shares.size(); ++layer)
          {
            sums.dilatations += spacing[d] * shares[layer] * shares[layer] / dim;
            sums.stress_of_dilatations += spacing[d] * shares[layer] * normal[layer] / dim;
          }
      }
    return sums;
  }

  /** The sum over bonds in a ball: half the mean of |n| over directions, a mean length. */
  template <int dim>
  double crossing_of_ball(const Peridynamics &p, const double delta)
  {
    constexpr double        mean = dim == 1 ? 1. : dim == 2 ? 2. / dealii::numbers::PI : 0.5;
    const dealii::QGauss<1> points(20);
    double                  longer = 0., all = 0.; // moments of omega
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        const double r = points.point(q)[0] * delta;
        const double omega =
          points.weight(q) * kernel_shape(p.kernel, r, delta) / std::pow(r, p.kernel_exponent);
        all += omega * std::pow(r, dim + 1);
        longer += omega * std::pow(r, dim + 2);
      }
    return 0.5 * mean * longer / all;
  }

  /**
   * The same for a node's own family, where there is no lattice. Half of what lies on both sides
   * of the node counts for each side, so that families that end at the surface have no smaller
   * sums than others.
   */
  template <int dim>
  CrossingSums own_crossing_sums(const Families<dim>                         &bonds,
                                 const unsigned int                           node,
                                 std::vector<typename Families<dim>::Member> &family)
  {
    bonds.members_of(node, family);
    std::vector<std::array<double, 3>> crossing(family.size()); // distance, share, over x^2
    CrossingSums                       sums;
    double                             q = 0.;
    for (const auto &bond : family)
      q += bond.weight * bonds.neighbors().bond_vector(node, bond.neighbor).norm_square();
    for (unsigned int d = 0; d < dim; ++d)
      {
        for (std::size_t k = 0; k < family.size(); ++k)
          {
            const dealii::Tensor<1, dim> xi =
              bonds.neighbors().bond_vector(node, family[k].neighbor);
            crossing[k] = {{std::abs(xi[d]),
                            0.5 * family[k].weight * xi.norm_square() / q,
                            0.5 * family[k].weight / q}};
            sums.over_lengths += crossing[k][0] * crossing[k][1] / xi.norm() / dim;
            sums.stress += crossing[k][0] * crossing[k][0] * crossing[k][2] / dim;
          }
        std::sort(crossing.begin(), crossing.end());
        // What reaches farther than a plane, as the plane moves away from the node.
        double beyond = 0.5, normal = 0., last = 0.;
        for (const auto &bond : crossing)
          normal += bond[0] * bond[2];
        for (const auto &[distance, share, over_square] : crossing)
          {
            sums.bonds += distance * share / dim;
            sums.dilatations += (distance - last) * beyond * beyond / dim;
            sums.stress_of_dilatations += (distance - last) * beyond * normal / dim;
            beyond -= share;
            normal -= distance * over_square;
            last = distance;
          }
      }
    return sums;
  }

  /**
   * BreakableBonds::crossing_energy of state-based families.
   * @param law_of the StateLaw of an owned node @param volumetric there are dilatations
   */
  template <int dim, typename LawOf>
  std::function<CrossingEnergy(unsigned int)> crossing_energies(const Families<dim> &bonds,
                                                                const LawOf         &law_of,
                                                                const bool           volumetric)
  {
    const bool         on_lattice = bonds.nodes().lattice().has_value();
    const CrossingSums of_lattice = on_lattice ? crossing_sums(bonds) : CrossingSums();
    std::vector<typename Families<dim>::Member> family;
    return [=, &bonds](const unsigned int i) mutable {
      const StateLaw     law  = law_of(i);
      const CrossingSums sums = on_lattice ? of_lattice : own_crossing_sums(bonds, i, family);
      const double       volumetric_part = volumetric ? law.volumetric * law.dilatation : 0.;
      CrossingEnergy     energy;
      energy.extensions            = law.extension * sums.bonds;
      energy.dilatations           = volumetric_part * sums.dilatations;
      energy.over_lengths          = law.extension * sums.over_lengths;
      energy.stress                = 2. * law.extension * sums.stress;
      energy.stress_of_dilatations = 2. * volumetric_part * sums.stress_of_dilatations;
      return energy;
    };
  }
} // namespace PeriDeal
