// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>
#include <perideal/operators/solid/fictitious_images.h>

#include <memory>

namespace PeriDeal
{
  /**
   * The nodes at the far ends of a solid's bonds: those of the body by their local numbers, and
   * behind these the fictitious ones, whose displacements have to be found (find()).
   */
  template <int dim>
  class BondEnds
  {
  public:
    using Term = typename FictitiousImages<dim>::Term;

    /** Families, whose nodes have their halo, have to outlive this object. */
    explicit BondEnds(const Families<dim> &families)
      : families(families)
      , n_real(families.nodes().n_local())
    {}

    bool is_fictitious(const unsigned int j) const
    {
      return j >= n_real;
    }

    /** The number of a fictitious node among the images, and back. */
    unsigned int image(const unsigned int j) const
    {
      return j - n_real;
    }

    unsigned int node_of_image(const unsigned int image) const
    {
      return n_real + image;
    }

    /** xi of a bond of an owned node. */
    dealii::Tensor<1, dim> vector(const unsigned int i, const unsigned int j) const
    {
      if (is_fictitious(j))
        return (*images)[image(j)].place - families.nodes().position(i);
      return families.neighbors().bond_vector(i, j);
    }

    double volume(const unsigned int j) const
    {
      return is_fictitious(j) ? (*images)[image(j)].volume : families.nodes().volume(j);
    }

    /** The node itself, or that of which it is an image. */
    unsigned int origin(const unsigned int j) const
    {
      return is_fictitious(j) ? (*images)[image(j)].origin : j;
    }

    const double *value(const double *u, const unsigned int j) const
    {
      return is_fictitious(j) ? images->value(image(j)) : u + dim * j;
    }

    /** u_j - u_i. */
    dealii::Tensor<1, dim> change(const double *u, const unsigned int i, const unsigned int j) const
    {
      const double *const    far = value(u, j);
      dealii::Tensor<1, dim> eta;
      for (unsigned int d = 0; d < dim; ++d)
        eta[d] = far[d] - u[dim * i + d];
      return eta;
    }

    /**
     * A bond of an owned node may break by itself: beyond planes of symmetry as those of the whole
     * body.
     */
    bool may_break(const unsigned int j) const
    {
      return !is_fictitious(j) || images->is_mirrored_alone(image(j));
    }

    /** How many of its ends count: a mirrored bond that lies in its plane has none. */
    unsigned int n_ends(const unsigned int i, const unsigned int j) const;

    /** The far end is the image of the node itself in a plane of symmetry alone. */
    bool is_own_image(const unsigned int i, const unsigned int j) const;

    /** Find the displacements of fictitious nodes. @p u has up-to-date ghosts. */
    void find(const double *u) const
    {
      if (images)
        images->find(u);
    }

    std::unique_ptr<FictitiousImages<dim>> images; // or none, on all processes

  private:
    const Families<dim> &families;
    const unsigned int   n_real;
  };
} // namespace PeriDeal
