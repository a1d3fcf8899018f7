// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>
#include <perideal/bonds/fictitious_extension.h>

#include <vector>

namespace PeriDeal
{
  /**
   * A crack, as it is now, lies between an owned node and the node of a term of an image, or its
   * mirror image; instead of cracks the bond is mirrored, about each set of the planes of symmetry
   * that it passes. Not collective.
   * @param mirror of the image: its place on a lattice, on a mesh BoundaryImage::twice_planes
   */
  template <int dim>
  bool is_separated(const Families<dim>                                 &families,
                    const unsigned int                                   node,
                    const typename FictitiousExtension<dim>::Site::Term &term,
                    const dealii::Point<dim>                            &mirror);


  /**
   * So for any of the terms of an image: what is continued from the other side of a crack is no
   * part of a family. Not collective.
   */
  template <int dim>
  bool is_cut(const Families<dim>                                              &families,
              const unsigned int                                                node,
              const std::vector<typename FictitiousExtension<dim>::Site::Term> &terms,
              const dealii::Point<dim>                                         &mirror);
} // namespace PeriDeal
