// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

#include <perideal/base/types.h>
#include <perideal/operators/solid/law_steps.h>

#include <functional>
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
    /** @param layout of the unknowns; null if there is no law. Collective. */
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

    /**
     * The energy that is stored, or dissipated in the step, where the shear stiffness S makes the
     * image y = S x. Collective.
     */
    double energy(const Vector                                          &u,
                  const bool                                             dissipated,
                  const std::function<void(Vector &y, const Vector &x)> &multiply) const;

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
      of_bond.resize(histories.size());
      for (unsigned int k = 0; k < of_bond.size(); ++k)
        {
          of_bond[k] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            of_bond[k] += xi[d] * (histories[k].local_element(dim * j + d) -
                                   histories[k].local_element(dim * i + d));
        }
      return of_bond.data();
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

  private:
    mutable std::vector<double> of_bond;

    /** act(i, displacement, history) for all unknowns of this process and ghosts. */
    template <typename Act>
    void for_each(const Vector &u, const Act &act) const;
  };
} // namespace PeriDeal
