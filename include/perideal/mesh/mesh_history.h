// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/base/archive.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** How an adapted mesh has become what it is, so that it can be made once more. */
  class MeshHistory
  {
  public:
    /** Keep the marks that the mesh is about to be adapted by. Collective. */
    template <int dim>
    void record(const dealii::Triangulation<dim> &mesh);

    /** Adapt a mesh as it was from its beginning on all that have been recorded. Collective. */
    template <int dim>
    void repeat(dealii::Triangulation<dim> &mesh) const;

    unsigned int n_adaptations() const
    {
      return marks.size();
    }

    void exchange(Archive &archive);

  private:
    std::vector<std::string> marks; // cells to be refined; cells to be coarsened
  };
} // namespace PeriDeal
