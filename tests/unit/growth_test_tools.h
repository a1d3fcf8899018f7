// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <perideal/scene/crack_geometry.h>

#include <algorithm>
#include <set>

#include "operator_test_tools.h"

namespace PeriDeal
{
  /** What the tests of growing cracks share. */
  namespace OperatorTests
  {
    /** Through all events to the end, t = 1. */
    inline void grow(DiffusionOperator &op)
    {
      for (double t = 0.; t < 1.; t = op.next_event(t))
        op.update(t);
    }


    template <int dim>
    Vector image(const Problem<dim> &problem)
    {
      Vector u = problem.values(bumpy<dim>);
      problem.op().distribute(u, 0.);
      return problem.residual(u);
    }


    /** The operator after all updates, against one built for the cracks as they are then. */
    template <int dim>
    void expect_grown(const std::string &what,
                      const Settings    &base,
                      const Settings    &changing,
                      const Settings    &final,
                      const ModelKind    model = ModelKind::peridynamics)
    {
      const Problem<dim> grown(base + changing, model), built(base + final, model);
      Vector             before = image(grown);
      grow(grown.op());
      const double size = built.op().diagonal().linfty_norm();
      EXPECT_GT(largest_difference(before, image(grown)), 1e-3 * size) << what;
      EXPECT_LE(largest_difference(image(grown), image(built)), 1e-13 * size) << what;
      EXPECT_LE(largest_difference(grown.op().diagonal(), built.op().diagonal()), 1e-13 * size)
        << what;
      EXPECT_EQ(grown.op().size().bonds, built.op().size().bonds) << what;
      EXPECT_GE(grown.op().spectrum().sharp, built.op().spectrum().sharp * 0.99) << what;
    }


    /**
     * At every event each bond of the zone is broken if and only if the whole crack as it is then
     * separates its nodes. Returns how many are broken as soon as they join: those that pass behind
     * a tip. Collective.
     */
    template <int dim>
    unsigned int expect_history_kept(const Problem<dim> &problem, const std::string &what)
    {
      const Coupling<dim>     &coupling = cells_of(problem.op()).bonds();
      const Families<dim>     &families = coupling.families();
      const CrackHistory<dim> &history  = families.cracks().history();
      const bool               at_tips =
        problem.scene.cracks.cuts_bonds_at_tips(problem.scene.peridynamics.surface_correction);
      std::set<std::pair<unsigned int, unsigned int>> known;
      std::vector<typename Coupling<dim>::Bond>       bonds;
      unsigned int                                    n_broken = 0, n_wrong = 0;
      for (double t = 0.; t < 1.; t = problem.op().next_event(t))
        {
          problem.op().update(t);
          const auto cracks =
            make_crack_geometries(history.pieces(history.representative(t), at_tips));
          for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
            {
              coupling.bonds_of(i, bonds);
              for (const auto &bond : bonds)
                {
                  const bool separated =
                    std::any_of(cracks.begin(), cracks.end(), [&](const auto &crack) {
                      return crack.separates(families.nodes().crack_point(i),
                                             families.nodes().crack_point(bond.neighbor));
                    });
                  n_wrong += bond.cut != separated || (separated && bond.weight != 0.) ||
                             (!separated && bond.weight != bond.intact);
                  n_broken += known.emplace(i, bond.neighbor).second && separated && t > 0.;
                }
            }
        }
      EXPECT_EQ(n_wrong, 0u) << what;
      return sum_of_all(n_broken);
    }
  } // namespace OperatorTests
} // namespace PeriDeal
