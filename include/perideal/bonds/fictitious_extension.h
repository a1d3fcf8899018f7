// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>
#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/body_parameters.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /**
   * Fictitious nodes beyond the flat sides of an elastic body on a lattice, over the whole reach of
   * a family. Beyond a side that is continued their displacement is that of the body, linearly,
   *
   *   u(x_s + d n) = 2 u(x_s) - u(x_s - d n)
   *
   * with x_s on the side and n its normal; where a displacement is prescribed at x_s this is the
   * mirror rule of Dirichlet values. Between cell centres u(x_s) is drawn on from the two outermost
   * rows, 3/2 u_0 - 1/2 u_1. Beyond planes of symmetry they mirror it: the normal component changes
   * its sign, the others do not. At edges and corners one side after the other continues the body,
   * and so do opposite sides of a body that is narrower than a family.
   *
   * Vertices on a side have half a cell (a quarter, an eighth at edges and corners); the missing
   * part lies at the same place and moves with them, so that they count with their whole volume in
   * the families of others.
   */
  template <int dim>
  class FictitiousExtension
  {
  public:
    using Index = typename Lattice<dim>::Index;

    /** A site inside or beyond the body: a sum over nodes, and what it counts in families. */
    struct Site
    {
      struct Term
      {
        unsigned int node;
        unsigned int mirrored; // bits: the axes along which it is a mirror image
        double       factor;   // of what is no vector

        /** The factor of a component of the displacement. */
        double of_component(const unsigned int d) const
        {
          return (mirrored >> d) & 1 ? -factor : factor;
        }
      };

      std::vector<Term> terms;
      unsigned int      origin = 0; // the node that it is an image of
      double            volume = 0.;
    };

    FictitiousExtension(const Families<dim>                   &families,
                        const std::array<BeyondSide, 2 * dim> &beyond);

    /**
     * Whether families go on there and all nodes that the site follows from exist, and which.
     * @p site is overwritten.
     */
    bool find(const Index &index, Site &site) const;

    /** The site lies in the body, and on no side beyond which it goes on. */
    bool is_inside(const Index &index) const;

    /**
     * How many sites lie between a site of the body and the nearest side beyond which it goes on.
     */
    int distance(const Index &index) const;

  private:
    struct Step
    {
      int    site;
      double factor;
      bool   even;
    };

    /** What a place along an axis follows from, and the site in the body that it is an image of. */
    bool resolve(const unsigned int axis, int k, std::vector<Step> &steps, int &inner) const;

    /** How much of what lies at a place beyond sides counts; see BeyondSide::in_part. */
    double share_of(const Index &index) const;

    const Families<dim>            &families;
    std::array<BeyondSide, 2 * dim> beyond;
  };


  /** Throws UserError for bodies narrower than a family reaches. Not collective. */
  template <int dim>
  void throw_if_narrow(const Families<dim> &families);
} // namespace PeriDeal
