// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * What a coupling of a solid has of families: all bonds of a node, joined by a dilatation, with a
   * matrix over all of their nodes. Not collective.
   */
  template <int dim>
  class NodeFamilies
  {
  public:
    /** What the family of a node adds to the body, or a part of it. */
    struct Family
    {
      std::vector<unsigned int>  nodes;     // the node, and its neighbours
      std::vector<bool>          has_row;   // of these nodes those to whose rows it adds
      dealii::FullMatrix<double> stiffness; // K_f, rows and columns interleaved like the unknowns
      dealii::Vector<double>     thermal;   // the load by thermal strains
      double                     thermal_energy = 0.; // of a family that is held everywhere
      double n_bonds = 0.; // unbroken ones in the zone; of all families each is counted once
    };

    /** The thermal strain at a node, by its local number. */
    using ThermalStrain = std::function<double(const unsigned int)>;

    virtual ~NodeFamilies() = default;

    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** What counts of the energy of the family of a node known here, and of that of a cell. */
    virtual double share_of(const unsigned int node) const = 0;
    virtual double share_of(const Cell &cell) const        = 0;

    /**
     * Visit what the family of an owned node adds, also to rows of other processes.
     *
     * @param intact as if no crack were there
     * @param strain empty: without thermal strains
     */
    virtual void visit_family(const unsigned int                         node,
                              const bool                                 intact,
                              const ThermalStrain                       &strain,
                              const std::function<void(const Family &)> &visit) const = 0;

    /** The same, with `nodes` and `has_row` of the intact body only. */
    virtual void visit_nodes_of_family(const unsigned int                         node,
                                       const std::function<void(const Family &)> &visit) const = 0;

    /** What is wrong with an owned node of the body with its cracks, or nothing. */
    virtual std::string fault_of(const unsigned int node) const = 0;

    /**
     * Planes of symmetry beyond which families go on: what the other half of the body does normal
     * to them acts on all nodes near them, not on those in the plane alone. At most one along each
     * axis.
     */
    virtual std::vector<dealii::types::boundary_id> mirrors() const = 0;
  };
} // namespace PeriDeal
