// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>
#include <perideal/operators/solid/displacement_conditions.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * Displacements of sides between cell centers. Beyond such a side the displacement is continued
   * from u_s = 3/2 u_0 - 1/2 u_1 of the two outermost rows (FictitiousExtension), which is that of
   * the side. Where it is prescribed, u_s = g, the outer row follows the one behind it,
   *
   *   u_0 = (2 g + u_1)/3
   *
   * component by component: u = C u_free + G g. A force on the outer row then is one of 1/3 on the
   * row behind and of 2/3 on the side, K is C^T K C, and linear displacements are exact. At an edge
   * a node follows along the normal of the side that holds it, and may follow one that itself
   * follows along another. The rows' mass is that of the rows behind them.
   *
   * Unknowns are those of a solid; the rows are held ones of DisplacementConditions, with values of
   * the places that nodes_on_sides() gives. Without rows on any process all functions do nothing.
   */
  template <int dim>
  class HeldRows
  {
  public:
    /** The nodes on the sides, those that follow at the places next to them on their sides. */
    static std::vector<NodeOnSide<dim>> nodes_on_sides(const Families<dim>       &families,
                                                       const BodyParameters<dim> &body);

    using Layout = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;

    /** @param on_sides of nodes_on_sides() @param layout of the unknowns. Collective. */
    HeldRows(const Families<dim>                &families,
             const std::vector<NodeOnSide<dim>> &on_sides,
             const BodyParameters<dim>          &body,
             const Layout                       &layout);

    /** On any process. */
    bool any() const
    {
      return on_any_process;
    }

    /** u_0 := (2 u_0 + u_1)/3, where u_0 is the prescribed displacement. Collective. */
    void follow(Vector &u) const;

    /** r_1 += 1/3 r_0, of forces; r_0 stays as it is. Collective. */
    void pass_on(Vector &forces) const
    {
      pass_on(forces, 1. / 3.);
    }

    /** After pass_on(): leave in the rows the force on the side. Not collective. */
    void keep_share_of_side(Vector &forces) const;

    /** Give the rows' mass to those behind them, all but as good as nothing. Collective. */
    void move_mass(Vector &mass) const;

  private:
    struct Row
    {
      unsigned int unknown, behind; // the latter may be a ghost
    };

    void find_levels(const std::vector<Row> &rows, const Layout &layout);
    void pass_on(Vector &forces, const double share) const;

    std::vector<std::vector<Row>> levels; // each follows unknowns of lower ones, or free ones
    bool                          on_any_process = false;
    bool                          has_ghosts     = false; // some row behind is one, on any process
  };
} // namespace PeriDeal
