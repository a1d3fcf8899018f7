// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/operators/interface/operator.h>

#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Add to a balance what bonds conduct through the cracks that cut them. A bond between two nodes
   * counts half at each, since it comes up at both of its ends; with a self term they differ.
   *
   * @param u        with ghosts up to date
   * @param bonds_of call for the bonds of an owned node: (node, list to be set)
   * @param beyond   call for the value of a fictitious node, by its number from 0 on
   *
   * Not collective.
   */
  template <int dim, typename BondsOf, typename Beyond>
  void add_heat_of_cut_bonds(const Families<dim> &families,
                             const Vector        &u,
                             const BondsOf       &bonds_of,
                             const Beyond        &beyond,
                             Balance             &balance)
  {
    const unsigned int                              n_local = families.nodes().n_local();
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    std::vector<std::pair<unsigned int, int>>       crossed;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      if (families.near_crack(i))
        {
          bonds_of(i, family);
          for (const auto &bond : family)
            if (bond.cut && bond.weight != 0.)
              {
                const bool   real  = bond.neighbor < n_local;
                const double other = real ? u.local_element(bond.neighbor) :
                                            beyond(bond.neighbor - n_local);
                const double heat  = (real ? 0.5 : 1.) * bond.weight * (other - u.local_element(i));
                families.cracks().crossed_cracks(i, bond.neighbor, crossed);
                for (const auto &[crack, side] : crossed)
                  balance.cracks[crack] += side * heat;
              }
        }
  }
} // namespace PeriDeal
