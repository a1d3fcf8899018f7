// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/bond_kinematics.h>
#include <perideal/operators/fictitious_bonds.h>

#include <memory>

namespace PeriDeal
{
  /**
   * The bonds of the linear peridynamic solid, inside the body and beyond its sides, with what
   * their forces follow from.
   */
  template <int dim>
  struct SolidBonds
  {
    /** Adds the halo to the nodes. Collective. Throws UserError, among others: isolated nodes. */
    SolidBonds(Nodes<dim> &nodes, const Scene<dim> &scene);

    SolidBonds(const SolidBonds &) = delete;

    Families<dim>                         families;
    NodeLaws<dim>                         laws;
    ThermalStrains                        thermal;
    SolidRows<dim>                        rows;
    BondKinematics<dim>                   kinematics;
    std::unique_ptr<FictitiousBonds<dim>> beyond; // or none, on all processes
  };
} // namespace PeriDeal
