// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

#include <perideal/base/types.h>
#include <perideal/operators/solid/law_steps.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * A law of bonds in a body with finite elements. What the body went through is kept at the nodes:
   * a law with a history is linear there (BondLaw::relaxes_dilatation()), so that the history of a
   * bond, and that of the strain in a cell, follow from histories of displacements. Nodes that join
   * a zone, and cells that are parted, thus have theirs.
   */
  class NodalLaw
  {
  public:
    /** Of another law than the linear one. @param layout of the unknowns. Collective. */
    NodalLaw(const Material::Law &law, const Vector &layout);

    /** Cells follow the law, too, not the bonds alone. */
    bool relaxes() const
    {
      return steps->relaxes_dilatation();
    }

    /**
     * e* of displacements u, less these themselves; ghosts of u and of what is made are up to date.
     */
    void find_change(Vector &change, const Vector &u) const;

    /** BondLaw::part() of displacements u, likewise. */
    void find_part(Vector            &part,
                   const Vector      &u,
                   const unsigned int k,
                   const bool         dissipated) const;

    /** The state u, with ghosts, is accepted. */
    void accept(const Vector &u, const double t);

    /** Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

    /** What the law sees of a bond between two nodes whose c = xi . (u_j - u_i). */
    template <int dim>
    BondValues values(const unsigned int            i,
                      const unsigned int            j,
                      const dealii::Tensor<1, dim> &xi,
                      const double                  c) const
    {
      return {c, xi.norm_square(), damage.empty() ? 0. : 0.5 * (damage[i] + damage[j])};
    }

    /** The history of such a bond, until the next call. */
    template <int dim>
    const double *history(const unsigned int            i,
                          const unsigned int            j,
                          const dealii::Tensor<1, dim> &xi) const
    {
      of_one.resize(histories.size());
      for (unsigned int k = 0; k < of_one.size(); ++k)
        {
          of_one[k] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            of_one[k] += xi[d] * (histories[k].local_element(dim * j + d) -
                                  histories[k].local_element(dim * i + d));
        }
      return of_one.data();
    }

    /** c* of such a bond. */
    template <int dim>
    double effective(const unsigned int            i,
                     const unsigned int            j,
                     const dealii::Tensor<1, dim> &xi,
                     const double                  c) const
    {
      return steps->effective(values(i, j, xi, c), history(i, j, xi));
    }

    LawSteps            steps;
    std::vector<Vector> histories; // of the displacements of nodes, ghosts up to date
    std::vector<double> damage;    // of nodes of this process and ghosts; empty: none

    mutable std::vector<double> of_node; // memory of who sums histories over bonds

  private:
    mutable std::vector<double> of_one; // bond or unknown

    /** act(i, displacement, history) for all unknowns of this process and ghosts. */
    template <typename Act>
    void for_each(const Vector &u, const Act &act) const;
  };
} // namespace PeriDeal
