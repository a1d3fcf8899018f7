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
   * The unknowns that are not free: those with a `Dirichlet` value, where several meet that of the
   * condition named first, and of finite elements hanging nodes. All by local numbers of owned
   * unknowns. Conditions must outlive this.
   */
  template <int dim>
  class PrescribedValues : public HeldUnknowns
  {
  public:
    struct Entry
    {
      unsigned int         unknown;
      dealii::Point<dim>   position;
      const SideCondition *condition;
    };

    /**
     * Of finite elements.
     *
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

    virtual ~PrescribedValues() = default;

    /** Some unknown of any process has a value. Not collective. */
    bool any() const
    {
      return on_any_process;
    }

    /** Some unknown of any process follows from others by its bonds. Not collective. */
    virtual bool any_slave() const
    {
      return false;
    }

    /** Set the values of time t, and slaves; hanging nodes are left as they are. */
    virtual void distribute(Vector &u, const double t) const;

    /** The same with zero values. Hanging nodes are zero. */
    virtual void distribute_homogeneous(Vector &x) const
    {
      this->mask(x);
    }

    /** Whether the row of an owned unknown counts in Gershgorin's bound. Not collective. */
    virtual bool counts_in_bounds(const unsigned int /*row*/) const
    {
      return true;
    }

    /** In the order of unknowns. */
    const std::vector<Entry> &entries() const
    {
      return with_value;
    }

    /** Add y of this process's prescribed unknowns to what their conditions have, by name. */
    void add_to(std::map<std::string, double> &sides, const Vector &y) const;

  protected:
    using Counts = std::vector<unsigned long long>; // of each condition

    PrescribedValues() = default;

    /**
     * Take entries in the order of unknowns. Collective. Throws UserError for parts without any.
     *
     * @param n_nodes that lie where conditions hold, of this process
     * @param n_held  what carries their values beside the entries
     */
    void set_entries(std::vector<Entry>             list,
                     const BoundaryConditions<dim> &conditions,
                     const Counts                  &n_nodes,
                     Counts                         n_held,
                     const MPI_Comm                 communicator);

  private:
    std::vector<Entry> with_value;
    bool               on_any_process = false;
  };
} // namespace PeriDeal
