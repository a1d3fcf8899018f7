// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/held_unknowns.h>
#include <perideal/operators/parts/condition_faces.h>
#include <perideal/operators/parts/hanging_nodes.h>

#include <map>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * The unknowns of finite elements that are not free: those with a `Dirichlet` value, where
   * several meet that of the condition named first, and hanging nodes. All by local numbers of
   * owned unknowns. Conditions must outlive this.
   */
  template <int dim>
  class PrescribedValues : public HeldUnknowns
  {
  public:
    /**
     * @param layout of the vectors
     * @param parts  the unknowns in regions and at points
     *
     * Throws UserError for parts that hold no node, or none that is left to them. Collective.
     */
    PrescribedValues(const dealii::DoFHandler<dim>             &dofs,
                     const dealii::Utilities::MPI::Partitioner &layout,
                     const BoundaryConditions<dim>             &conditions,
                     const HangingNodes<dim>                   &hanging,
                     const std::vector<PartUnknown<dim>>       &parts);

    /** Some unknown of any process has a value. Not collective. */
    bool any() const
    {
      return on_any_process;
    }

    /** Set the values of time t; hanging nodes are left as they are. Not collective. */
    void distribute(Vector &u, const double t) const;

    /** Add y of this process's prescribed unknowns to what their conditions have, by name. */
    void add_to(std::map<std::string, double> &sides, const Vector &y) const;

  private:
    struct Entry
    {
      unsigned int         unknown;
      dealii::Point<dim>   position;
      const SideCondition *condition;
    };

    std::vector<Entry> entries; // in the order of unknowns
    bool               on_any_process = false;
  };
} // namespace PeriDeal
