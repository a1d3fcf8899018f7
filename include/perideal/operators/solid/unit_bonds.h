// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>

#include <cstdint>
#include <vector>

namespace PeriDeal
{
  /**
   * A bond of a complete family on a lattice, with volumes of 1 at both ends. All others of its
   * offset follow from it and two volumes, so that which one of its family it is needs to be known
   * of a bond, and no more.
   */
  template <int dim>
  struct UnitBond
  {
    typename Lattice<dim>::Index offset;
    dealii::Tensor<1, dim>       moment; // w xi
    double                       weight; // w x^2
  };


  /** Number of a bond in the list of unit bonds, with what else is to be known of it. */
  namespace BondCode
  {
    using Code = std::uint16_t;

    constexpr Code gone    = 0x7fff; // bears nothing
    constexpr Code in_part = 0x8000; // added: a crack leaves a part of it, which is kept elsewhere

    inline bool is_in_part(const Code code)
    {
      return code & in_part;
    }

    /** Of what is not gone. */
    inline unsigned int number(const Code code)
    {
      return code & ~in_part;
    }
  } // namespace BondCode


  /** In the order of families. On a lattice with unique sites. */
  template <int dim>
  std::vector<UnitBond<dim>> unit_bonds(const Families<dim> &families)
  {
    std::vector<UnitBond<dim>> list;
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        UnitBond<dim> bond;
        bond.offset = member.offset;
        for (unsigned int d = 0; d < dim; ++d)
          bond.moment[d] =
            member.weight * (member.offset[d] * families.nodes().lattice()->spacing[d]);
        bond.weight = member.weight * member.r * member.r;
        list.push_back(bond);
      }
    return list;
  }

} // namespace PeriDeal
