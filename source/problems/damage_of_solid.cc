// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "damage_of_solid.h"

#include <deal.II/base/mpi.h>

#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/expression.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What has broken since there were @p n_told marks, with the places of the first nodes. */
    template <int dim>
    ChangeSet<dim> damage_since(const SolidProblem<dim> &solid, std::size_t &n_told)
    {
      const MPI_Comm          all = solid.dofs().get_communicator();
      std::vector<NodePair>   own = solid.op().broken_since(n_told);
      std::vector<Point<dim>> places; // of first nodes, each once
      std::sort(own.begin(), own.end());
      for (std::size_t k = 0; k < own.size(); ++k)
        if (k == 0 || own[k][0] != own[k - 1][0])
          places.push_back(
            solid.position(solid.dofs().locally_owned_dofs().index_within_set(own[k][0])));
      ChangeSet<dim> change;
      change.damage = true;
      for (const auto &list : Utilities::MPI::all_gather(all, own))
        change.broken.insert(change.broken.end(), list.begin(), list.end());
      for (const auto &list : Utilities::MPI::all_gather(all, places))
        for (const Point<dim> &p : list)
          change.cuts.push_back(BoundingBox<dim>({p, p}));
      std::sort(change.broken.begin(), change.broken.end());
      return change;
    }


    template <int dim>
    bool heat_follows(const SolidProblem<dim> &solid)
    {
      return solid.heat != nullptr && solid.heat->scene.broken_bonds_conduct < 1.;
    }
  } // namespace


  template <int dim>
  void DamageOfSolid<dim>::tell(const SolidProblem<dim> &solid)
  {
    if (!heat_follows(solid))
      return;
    const ChangeSet<dim> damage = damage_since(solid, n_told);
    if (!damage.broken.empty() || was_told)
      solid.heat->apply_change(damage);
    was_told = false;
  }


  template <int dim>
  void DamageOfSolid<dim>::exchange(Archive &archive, const SolidProblem<dim> &solid)
  {
    if (!heat_follows(solid))
      return;
    std::size_t n_marks = n_told;
    const bool  any     = !solid.op().broken_since(n_marks).empty();
    bool untold = was_told || Utilities::MPI::max(any ? 1 : 0, solid.dofs().get_communicator()) > 0;
    archive.exchange("damage that heat does not know", untold);
    if (!archive.loads())
      return;
    was_told                    = untold;
    n_told                      = 0;
    const ChangeSet<dim> damage = damage_since(solid, n_told);
    with_formulas(solid.dofs().get_communicator(), [&] { solid.heat->follow(damage); });
  }


  template class DamageOfSolid<1>;
  template class DamageOfSolid<2>;
  template class DamageOfSolid<3>;
} // namespace PeriDeal
