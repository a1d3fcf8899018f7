// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /**
   * Fictitious nodes beyond the flat sides of an elastic body on a lattice of vertices, over the whole reach of a family. Their displacement continues that of the body linearly,
   *
   *   u(x_s + d n) = 2 u(x_s) - u(x_s - d n)
   *
   * with x_s on the side and n its normal; where a displacement is prescribed at x_s this is the mirror rule of Dirichlet values. Beyond planes of symmetry they mirror it: the normal component
   * changes its sign, the others do not. At edges and corners one side after the other continues the body. Nodes on a side have half a cell (a quarter, an eighth at edges and corners);
   * the missing part lies at the same place and moves with them, so that they count with their whole volume in the families of others.
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
        unsigned int           node;
        double                 factor;       // of what is no vector
        dealii::Tensor<1, dim> of_component; // factors of the displacement's components
      };

      std::array<Term, (1 << dim)> terms; // the first n_terms
      unsigned int                 n_terms = 0;
      double                       volume  = 0.;
    };

    /** Throws UserError for bodies narrower than a family reaches. Not collective. */
    FictitiousExtension(const Families<dim>                           &families,
                        const std::vector<dealii::types::boundary_id> &symmetry_sides);

    /** Whether all nodes that the site follows from exist, and which. */
    bool find(const Index &index, Site &site) const;

  private:
    const Families<dim>      &families;
    std::array<bool, 2 * dim> symmetric{}; // sides left, right, bottom, top, back, front
  };
} // namespace PeriDeal
